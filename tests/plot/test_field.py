"""What people know about a plot: a valid area, and what is left of it to drive on."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import example, given
from shapely import MultiPolygon, Polygon, box

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from tests.crooked import crooked_fields

SQUARE = box(35.15, 30.36, 35.152, 30.362)
EAST = box(35.151, 30.3, 35.16, 30.4)
# four centimetres wide, with corners known to a millionth of a micrometre
SLIVER = Field(
    "sliver",
    MultiPolygon(
        [
            Polygon(
                [
                    (9.99992091835541, 1.6922608838771196e-05),
                    (9.999868621389696, -0.00022908803039815262),
                    (9.999972534391517, 0.00026307895958055914),
                ]
            )
        ]
    ),
    no_go=MultiPolygon(
        [
            Polygon(
                [
                    (9.999955533393436, 0.00013022920469523962),
                    (9.999925215252595, 0.00014785136087969926),
                    (9.999925215252595, 0.0001126070485107316),
                ]
            )
        ]
    ),
)


def test_an_area_that_is_none_is_refused_with_what_is_wrong():
    bow_tie = MultiPolygon([Polygon([(0, 0), (1, 1), (1, 0), (0, 1)])])
    for area, words in ((MultiPolygon(), "it is empty"), (bow_tie, "Self-intersection")):
        with pytest.raises(PlotError, match=f"'Gate' must be a valid.*{words}"):
            Field("Gate", area)


def test_measured_plants_cannot_be_changed_behind_its_back():
    field = Field("Gate", MultiPolygon([SQUARE]), plants=np.array([[35.151, 30.361]]))
    with pytest.raises(ValueError, match="read-only"):
        field.plants[0] = 0.0


def test_no_go_areas_are_not_driven_on():
    field = Field("Gate", MultiPolygon([SQUARE]), no_go=MultiPolygon([EAST]))
    west = box(35.15, 30.36, 35.151, 30.362)
    assert field.drivable().equals(west)
    assert Field("Gate", MultiPolygon([SQUARE])).drivable().equals(SQUARE)


def test_an_edge_that_is_only_touched_leaves_no_slivers_behind():
    touching = box(35.152, 30.36, 35.153, 30.362)
    field = Field("Gate", MultiPolygon([SQUARE]), no_go=MultiPolygon([touching]))
    assert {part.geom_type for part in field.drivable().geoms} == {"Polygon"}
    assert field.drivable().equals(SQUARE)


def test_a_plot_that_may_nowhere_be_entered_is_refused():
    field = Field("Gate", MultiPolygon([SQUARE]), no_go=MultiPolygon([SQUARE.buffer(0.001)]))
    with pytest.raises(PlotError, match=r"nothing does\. Remove or shrink a no-go area"):
        field.drivable()


@example(field=SLIVER)
@given(field=crooked_fields())
def test_what_is_driven_on_is_the_plot_without_what_is_not_to_the_last_part(field):
    left = field.drivable()
    assert left.is_valid
    total = shapely.area(field.boundary)
    shared = shapely.area(shapely.intersection(field.boundary, field.no_go))
    # a corner that GEOS computes is rounded to the next number: of a sliver that is more than
    # a thousand millionth of its area
    rounding = np.spacing(180.0) * shapely.length(field.boundary)
    assert shapely.area(left) == pytest.approx(total - shared, abs=1e-9 * total + rounding)
    assert shapely.area(shapely.intersection(left, field.no_go)) <= 1e-9 * total + rounding


@given(field=crooked_fields())
def test_its_plane_is_centred_on_it_and_leads_back(field):
    corners = shapely.get_coordinates(field.boundary)
    frame = field.frame(20.0)
    xy_m = frame.xy_m(corners)
    np.testing.assert_allclose(frame.lonlat(xy_m), corners, atol=1e-9)
    size_m = np.hypot(*np.ptp(xy_m, axis=0))
    assert np.abs(xy_m).max() <= size_m


def test_it_says_itself_with_its_parts_and_measured_plants():
    two = MultiPolygon([SQUARE, box(35.16, 30.36, 35.161, 30.361)])
    assert repr(Field("Gate", two)) == "<Field Gate: 2 parts>"
    measured = Field("ענבים", MultiPolygon([SQUARE]), plants=np.zeros((1, 2)))
    assert repr(measured) == "<Field ענבים: 1 part, 1 measured plant>"


def test_what_was_added_later_is_told_only_where_it_is_said():
    field = Field("a", MultiPolygon([box(35.15, 30.36, 35.151, 30.361)]))
    rows = np.array(["1", "2"])
    assert len(replace(field, plant_rows=rows).content) == len(field.content) + 1
    for name in ("plant_rows", "plant_blocks", "plant_names"):
        assert replace(field, **{name: rows}).content[-1] is rows
    assert set(map(type, field.content)) <= {type(value) for value in vars(field).values()}


def test_a_plot_cut_at_longitude_180_is_refused_for_that():
    # RFC 7946, 3.1.9 writes an area across it so
    west, east = box(179.9995, -16.801, 180, -16.8), box(-180, -16.801, -179.9995, -16.8)
    with pytest.raises(PlotError, match="one side of longitude 180, but this one lies on both"):
        Field("Taveuni", MultiPolygon([west, east])).frame()
    # each part is a plot
    for part in (west, east):
        assert Field("Taveuni", part).frame().lon == pytest.approx(part.centroid.x)


def test_an_area_drawn_on_across_longitude_180_has_its_middle_beyond():
    frame = Field("Taveuni", box(179.9995, -16.801, 180.0015, -16.8)).frame()
    assert frame.lon == pytest.approx(-179.9995)
    assert np.abs(frame.xy_m([[180.0015, -16.8], [-179.9985, -16.8]])[:, 0]) == pytest.approx(
        106.6, abs=0.1
    )
