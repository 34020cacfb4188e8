from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given
from hypothesis import strategies as st
from pyproj import Geod
from shapely import MultiPolygon, Polygon

from fieldmon.errors import PlotError, SettingError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import found_planting, grid_from_plants, lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from tests.crooked import crooked_fields, plantings

GEOD = Geod(ellps="WGS84")
CM = 0.01
# lanes run on the edge of their strip, so rounding decides on which side of it
EDGE = 1e-4

# once the faces on both sides of an aisle found themselves in two, as its y was 11.1625 for one
# and a last digit less for the other, and was rounded to millimetres
HALF_A_MILLIMETRE = Field(
    "crooked",
    MultiPolygon(
        [
            Polygon(
                [
                    (5.5871913342776505e-05, -0.00020364310713755213),
                    (5.5871913342776505e-05, -0.00020364310713755213),
                    (3.081089739911748e-05, -0.0002166628836138613),
                    (4.2676138877648655e-05, -0.00022433281297508885),
                    (-9.227240685423487e-06, -0.0003057123226027007),
                    (-0.00027228261457086376, -0.00013566806859734894),
                    (-0.0002421303652150472, -8.839224017581659e-05),
                    (-0.0002461151947041223, -0.00010551798275692041),
                    (-0.00021796207685991558, -6.366185658507488e-05),
                    (-0.0002045809078471928, -5.9095673465091246e-05),
                    (-0.00019978397230777692, -4.571637825355912e-05),
                    (-0.00020718346054250233, -3.359885313265379e-05),
                    (-0.00020718346054250238, -3.359885313265379e-05),
                    (-0.00014560317970535372, 6.295310744233445e-05),
                    (-1.4075492762785432e-05, -2.20690195600296e-05),
                    (1.4075492762785432e-05, 2.20690195600296e-05),
                    (-0.00011745219417986197, 0.00010709114656238592),
                    (9.227240685423611e-06, 0.0003057123226027007),
                    (0.00027228261457086376, 0.00013566806859734891),
                ]
            )
        ]
    ),
)


def laid(field, planting):
    """Return the grid, leaving out plots without room for a plant."""
    try:
        grid = lay(field, planting)
    except PlotError:
        assume(False)
    assume(len(grid) <= 5000)
    return grid


def plot_of(length_m, width_m, bearing_deg=90.0, *, holes=(), no_go=None):
    """Return a rectangular plot, `length_m` along the bearing; holes in metres of its frame."""
    frame = Frame(35.15, 30.36, bearing_deg)
    box = shapely.box(-length_m / 2, -width_m / 2, length_m / 2, width_m / 2)
    area = shapely.difference(box, shapely.union_all(list(holes)))
    return Field(
        "plot",
        MultiPolygon([frame.geometry_lonlat(area)]),
        no_go=MultiPolygon([frame.geometry_lonlat(no_go)] if no_go else []),
    )


def lanes(grid):
    low, high = grid.lane_x_m.T
    ends = [np.stack([x, grid.lane_y_m], axis=1) for x in (low, high)]
    return shapely.linestrings(np.stack(ends, axis=1))


# --- on any crooked plot ---------------------------------------------------------------------


@given(crooked_fields(50), plantings())
def test_every_plant_is_inside_the_boundary_and_outside_holes_and_no_go_areas(field, planting):
    grid = laid(field, planting)
    places = grid.lonlat()
    assert shapely.contains_xy(field.boundary, places).all()
    assert not shapely.contains_xy(field.no_go, places).any()


@given(crooked_fields(50), plantings())
def test_every_plant_keeps_half_a_row_or_a_headland_from_every_edge(field, planting):
    grid = laid(field, planting)
    clear_m = shapely.distance(shapely.boundary(grid.drivable_m), shapely.points(grid.xy_m))
    assert clear_m.min() >= min(planting.row_spacing_m / 2, planting.headland_m) - EDGE


@given(crooked_fields(50), plantings())
def test_rows_and_lanes_and_what_lies_between_them_are_on_the_plot(field, planting):
    grid = laid(field, planting)
    row_y = grid.xy_m[grid.row_start[:-1], 1]
    between = shapely.box(
        grid.lane_x_m[:, 0],
        np.minimum(row_y, grid.lane_y_m),
        grid.lane_x_m[:, 1],
        np.maximum(row_y, grid.lane_y_m),
    )
    assert shapely.covers(shapely.buffer(grid.drivable_m, EDGE), between).all()


@given(crooked_fields(50), plantings())
def test_lanes_reach_beyond_the_last_plants_of_their_row_and_meet_no_other_row(field, planting):
    grid = laid(field, planting)
    first = grid.xy_m[grid.row_start[:-1], 0]
    last = grid.xy_m[grid.row_start[1:] - 1, 0]
    assert (grid.lane_x_m[:, 0] <= first - planting.headland_m / 2 + EDGE).all()
    assert (grid.lane_x_m[:, 1] >= last + planting.headland_m / 2 - EDGE).all()
    row_y = np.unique(grid.xy_m[:, 1])
    off = np.abs(grid.lane_y_m[:, None] - row_y).min(axis=1)
    assert off == pytest.approx(planting.row_spacing_m / 2)


@given(crooked_fields(50), plantings(faces=(1,)))
def test_rows_come_line_by_line_and_plants_along_them(field, planting):
    grid = laid(field, planting)
    same_row = np.diff(grid.row) == 0
    assert (np.diff(grid.xy_m[:, 0])[same_row] > 0).all()
    assert (np.diff(grid.xy_m[:, 1])[same_row] == 0).all()
    assert grid.row_line[0] == 0
    assert set(np.diff(grid.row_line)) <= {0, 1}
    order = np.lexsort((grid.xy_m[:, 0], grid.row_line[grid.row]))
    assert order.tolist() == list(range(len(grid)))
    assert (np.diff(grid.row_start) > 0).all()


@given(crooked_fields(50), plantings())
def test_plants_stand_one_spacing_apart_measured_over_the_ellipsoid(field, planting):
    grid = laid(field, planting)
    same_row = np.flatnonzero(np.diff(grid.row) == 0)[:200]
    (lon, lat), (lon_next, lat_next) = grid.lonlat(same_row).T, grid.lonlat(same_row + 1).T
    apart = GEOD.inv(lon, lat, lon_next, lat_next)[2]
    assert apart == pytest.approx(np.full(len(same_row), planting.plant_spacing_m), abs=CM)


@given(crooked_fields(50), plantings())
def test_every_plant_is_where_a_geodesic_from_the_middle_of_the_plot_leads(field, planting):
    grid = laid(field, planting)
    west, south, east, north = field.boundary.bounds
    x, y = grid.xy_m.T
    azimuth = grid.frame.bearing_deg - np.rad2deg(np.arctan2(y, x))
    middle = [np.full(len(x), v) for v in ((west + east) / 2, (south + north) / 2)]
    lon, lat, _ = GEOD.fwd(*middle, azimuth, np.hypot(x, y))
    assert max(GEOD.inv(lon, lat, *grid.lonlat().T)[2]) < CM
    if planting.row_bearing_deg is not None:
        assert grid.frame.bearing_deg == planting.row_bearing_deg


@given(crooked_fields(max_radius_m=25), plantings(faces=(1,)))
def test_neighbours_are_the_plants_next_to_each_other(field, planting):
    grid = laid(field, planting)
    assume(len(grid) < 400)
    x, y = grid.xy_m.T
    dx, dy = np.abs(x[:, None] - x), np.abs(y[:, None] - y)
    along = (grid.row[:, None] == grid.row) & (np.abs(dx - planting.plant_spacing_m) < EDGE)
    across = (dx < EDGE) & (np.abs(dy - planting.row_spacing_m) < EDGE)
    for start, plant, truth in (
        (grid.along_start, grid.along_plant, along),
        (grid.across_start, grid.across_plant, across),
    ):
        found = np.zeros_like(truth)
        found[np.repeat(np.arange(len(grid)), np.diff(start)), plant] = True
        assert (found == truth).all()
        assert np.count_nonzero(truth) == len(plant)


@given(crooked_fields(50), plantings(faces=(2,)))
def test_both_faces_of_a_plant_are_inspected_from_the_aisles_on_its_two_sides(field, planting):
    grid = laid(field, planting)
    one_face = lay(field, Planting(**{**vars(planting), "faces": 1}))
    assert len(grid) == 2 * len(one_face)
    assert (grid.twin[grid.twin] == np.arange(len(grid))).all()
    assert (grid.xy_m[grid.twin] == grid.xy_m).all()
    side = grid.side[grid.row]
    assert (side[grid.twin] == -side).all()
    lane_off = grid.lane_y_m[grid.row] - grid.xy_m[:, 1]
    assert lane_off == pytest.approx(-side * planting.row_spacing_m / 2)
    assert grid.across_plant.tolist() == grid.twin.tolist()


@example(field=HALF_A_MILLIMETRE, planting=Planting(None, 1.9, 1.0, 1.0, faces=2))
@given(crooked_fields(50), plantings(faces=(2,)))
def test_rows_of_one_corridor_share_an_unbroken_stretch_of_aisle(field, planting):
    grid = laid(field, planting)
    for corridor in np.unique(grid.corridor):
        rows = np.flatnonzero(grid.corridor == corridor)
        assert np.ptp(grid.lane_y_m[rows]) < EDGE
        stretch = shapely.union_all(lanes(grid)[rows], grid_size=0.001)
        assert shapely.line_merge(stretch).geom_type == "LineString"
        apart = np.flatnonzero(grid.corridor != corridor)
        same_aisle = apart[np.abs(grid.lane_y_m[apart] - grid.lane_y_m[rows[0]]) < EDGE]
        low, high = grid.lane_x_m[rows, 0].min(), grid.lane_x_m[rows, 1].max()
        clear = (grid.lane_x_m[same_aisle, 1] < low) | (grid.lane_x_m[same_aisle, 0] > high)
        assert clear.all()


@given(crooked_fields(50), plantings(faces=(2,)))
def test_without_outer_faces_every_face_looks_at_another_row(field, planting):
    both = laid(field, planting)
    facing = {
        corridor
        for corridor in both.corridor
        if len(set(both.side[both.corridor == corridor])) == 2
    }
    kept = np.isin(both.corridor, list(facing))
    inner = Planting(**{**vars(planting), "outer_faces": False})
    if not kept.any():
        with pytest.raises(PlotError, match="face each other"):
            lay(field, inner)
        return
    grid = lay(field, inner)
    assert grid.lane_y_m.tolist() == both.lane_y_m[kept].tolist()
    assert grid.row_start[-1] == np.diff(both.row_start)[kept].sum()
    twins = np.flatnonzero(grid.twin >= 0)
    assert (grid.twin[grid.twin[twins]] == twins).all()


# --- on plots of known size ------------------------------------------------------------------


@given(st.integers(1, 12), st.integers(1, 12), st.floats(0, 360), plantings(faces=(1,)))
def test_a_rectangle_that_holds_so_many_rows_and_plants_exactly_gets_them(
    n_rows, n_plants, bearing_deg, planting
):
    planting = Planting(**{**vars(planting), "row_bearing_deg": bearing_deg})
    length_m = (n_plants - 1) * planting.plant_spacing_m + 2 * planting.headland_m
    grid = lay(plot_of(length_m, n_rows * planting.row_spacing_m, bearing_deg), planting)
    assert np.diff(grid.row_start).tolist() == [n_plants] * n_rows
    assert grid.xy_m.mean(axis=0) == pytest.approx([0, 0], abs=1e-3)


def test_a_plot_all_under_no_go_areas_is_refused_in_a_sentence():
    field = plot_of(60, 20)
    with pytest.raises(PlotError, match="must lie outside its no-go areas, but nothing does"):
        lay(replace(field, no_go=field.boundary), Planting(row_bearing_deg=90))


def test_a_hole_cuts_the_rows_it_touches_into_pieces_with_headlands():
    hole = shapely.box(-5, -3, 5, 3)
    grid = lay(plot_of(60, 20, holes=[hole]), Planting(row_bearing_deg=90))
    assert grid.row_line.tolist() == [0, 1, 1, 2, 2, 3, 3, 4]
    low, high = grid.lane_x_m.T
    assert low[1:3] == pytest.approx([-28, 7], abs=1e-3)
    assert high[1:3] == pytest.approx([-7, 28], abs=1e-3)
    assert grid.xy_m[grid.row == 1, 0].max() <= -9
    assert grid.corridor.tolist() == list(range(8))


def test_a_no_go_area_is_kept_clear_as_a_hole_is():
    patch = shapely.box(-5, -3, 5, 3)
    planting = Planting(row_bearing_deg=90)
    with_hole = lay(plot_of(60, 20, holes=[patch]), planting)
    with_no_go = lay(plot_of(60, 20, no_go=patch), planting)
    assert with_no_go.xy_m == pytest.approx(with_hole.xy_m)


def test_rows_run_along_the_long_side_if_nothing_else_is_known():
    grid = lay(plot_of(200, 50, bearing_deg=27.0), Planting())
    assert grid.frame.bearing_deg == pytest.approx(27.0, abs=0.01)


def test_rows_run_along_drawn_rows_if_there_are_any():
    plot = plot_of(200, 50, bearing_deg=27.0)
    row = shapely.LineString(Frame(35.15, 30.36, 117.0).lonlat([[-20, 0], [20, 0]]))
    drawn = Field("plot", plot.boundary, row_lines=shapely.MultiLineString([row]))
    assert lay(drawn, Planting()).frame.bearing_deg == pytest.approx(117.0, abs=0.01)


def test_neighbouring_plants_stand_opposite_each_other_in_all_parts_of_a_plot():
    parts = [shapely.box(0, 0, 50, 40.1), shapely.box(70, 3, 113, 40.1)]
    boundary = MultiPolygon([Frame(35.15, 30.36).geometry_lonlat(part) for part in parts])
    grid = lay(Field("two", boundary), Planting(row_bearing_deg=90))
    assert grid.n_rows == 19
    lattice = (grid.xy_m - grid.xy_m[0]) / [3.0, 4.0]
    assert lattice == pytest.approx(np.round(lattice), abs=1e-6)


def test_a_line_without_plants_parts_neighbours_and_gets_no_number():
    waist = [shapely.box(x, -2, x + 29, 2) for x in (-30, 1)]
    grid = lay(plot_of(60, 20, holes=waist), Planting(row_bearing_deg=90))
    assert grid.row_line.tolist() == [0, 1, 2, 3]
    assert np.diff(grid.xy_m[grid.row_start[:-1], 1]) == pytest.approx([4, 8, 4])
    upper = grid.row >= 2
    for plant in np.flatnonzero(upper):
        assert upper[grid.adjacent.plant[slice(*grid.adjacent.start[plant : plant + 2])]].all()


@pytest.mark.parametrize(("length_m", "width_m"), [(7.9, 30.0), (30.0, 3.9), (1.0, 1.0)])
def test_a_plot_without_room_for_a_plant_is_refused_with_its_sizes(length_m, width_m):
    with pytest.raises(PlotError, match=r"'plot'.*along the rows.*Choose") as refusal:
        lay(plot_of(length_m, width_m), Planting(row_bearing_deg=90))
    assert f"{length_m:.1f} m along the rows" in str(refusal.value)
    assert f"{width_m:.1f} m across" in str(refusal.value)


def test_a_plot_with_more_plants_than_memory_is_refused_before_it_is_laid():
    with pytest.raises(PlotError, match="Check the spacings"):
        lay(plot_of(9000, 9000), Planting(row_spacing_m=0.5, plant_spacing_m=0.2))


# --- the thesis's fields ---------------------------------------------------------------------


@pytest.mark.parametrize("n", [28, 64, 91])
def test_a_field_of_the_thesis_has_exactly_its_plants(n):
    grid = rectangle(n, n)
    assert len(grid) == n * n
    assert grid.row_start.tolist() == list(range(0, n * n + 1, n))
    assert np.ptp(grid.xy_m, axis=0) == pytest.approx([3.0 * (n - 1), 4.0 * (n - 1)])
    assert grid.lane_y_m == pytest.approx(grid.xy_m[::n, 1] + 2.0)
    n_neighbours = np.diff(grid.adjacent.start).reshape(n, n)
    assert (n_neighbours[1:-1, 1:-1] == 4).all()
    assert n_neighbours.sum() == 4 * n * (n - 1)


@pytest.mark.parametrize(("n_rows", "n_plants"), [(2, 10), (5, 10), (10, 50)])
def test_a_two_faced_field_of_the_thesis_has_its_sides_and_aisles(n_rows, n_plants):
    grid = rectangle(n_rows, n_plants, Planting(faces=2, outer_faces=False))
    n_sides = 2 * n_rows - 2
    assert np.diff(grid.row_start).tolist() == [n_plants] * n_sides
    side, plant = np.divmod(np.arange(len(grid)), n_plants)
    inner = (side > 0) & (side < n_sides - 1)
    other = np.where(side % 2 == 1, side + 1, side - 1)
    assert grid.twin.tolist() == np.where(inner, other * n_plants + plant, -1).tolist()
    assert grid.corridor.tolist() == (np.arange(n_sides) // 2).tolist()


def test_a_rectangle_needs_a_plant():
    with pytest.raises(SettingError, match="0 rows"):
        rectangle(0, 5)


# --- from measured plants --------------------------------------------------------------------


@given(crooked_fields(50), plantings(faces=(1,)), st.randoms(use_true_random=False))
def test_measured_plants_fall_into_the_rows_they_were_laid_in(field, planting, random):
    truth = laid(field, planting)
    order = np.array(random.sample(range(len(truth)), len(truth)))
    planting = Planting(**{**vars(planting), "row_bearing_deg": truth.frame.bearing_deg})
    grid = grid_from_plants(truth.lonlat(order), planting, field)
    line_y = np.round(truth.xy_m[truth.row_start[:-1], 1], 3)
    assert grid.xy_m[:, 1] == pytest.approx(np.sort(truth.xy_m[:, 1]), abs=1e-3)
    assert len(np.unique(grid.row_line)) == len(np.unique(line_y))
    same_line = np.diff(grid.row_line[grid.row]) == 0
    assert (np.abs(np.diff(grid.xy_m[:, 1])[same_line]) < 1e-3).all()
    assert (np.diff(grid.xy_m[:, 0])[same_line] > 0).all()


@given(crooked_fields(50), plantings(), st.booleans(), st.integers(0, 2**32))
def test_lanes_of_measured_rows_meet_no_plant_and_stay_where_driving_is_allowed(
    field, planting, with_field, seed
):
    truth = laid(field, Planting(**{**vars(planting), "faces": 1}))
    rng = np.random.default_rng(seed)
    jitter = 0.1 * min(planting.row_spacing_m, planting.plant_spacing_m)
    xy_m = truth.xy_m + rng.uniform(-jitter, jitter, truth.xy_m.shape)
    kept = rng.random(len(xy_m)) > 0.1
    assume(kept.any())
    lonlat = truth.frame.lonlat(xy_m[kept])
    planting = Planting(**{**vars(planting), "row_bearing_deg": truth.frame.bearing_deg})
    grid = grid_from_plants(lonlat, planting, field if with_field else None)
    assert len(grid) == planting.faces * np.count_nonzero(kept)
    above = np.where(grid.side == -1, 1, -1)[grid.row]
    assert ((grid.lane_y_m[grid.row] - grid.xy_m[:, 1]) * above > 0.05).all()
    plants = shapely.multipoints(grid.xy_m)
    assert shapely.distance(lanes(grid), plants).min() > 0.2 * planting.row_spacing_m
    assert shapely.covers(shapely.buffer(grid.drivable_m, EDGE), plants)
    if not with_field:
        assert shapely.covers(shapely.buffer(grid.drivable_m, EDGE), lanes(grid)).all()


def test_lanes_of_measured_rows_run_midway_and_end_in_the_headland():
    lonlat = Frame(35.15, 30.36).lonlat([[0, 0], [3, 0.1], [6, 0], [1, 4], [4, 3.9], [7, 4]])
    grid = grid_from_plants(lonlat, Planting(row_bearing_deg=90.0))
    middle = grid.frame.xy_m([[35.15, 30.36]])[0]
    assert grid.lane_y_m - middle[1] == pytest.approx([2.0, 6.0], abs=1e-3)
    assert grid.lane_x_m - middle[0] == pytest.approx(np.array([[-2, 8], [-1, 9]]), abs=1e-3)


def test_a_gap_in_a_measured_row_is_missing_plants_but_a_no_go_area_cuts_it():
    x = np.array([0, 3, 6, 21, 24, 27.0])
    xy_m = np.concatenate([np.stack([x, np.full(6, y)], axis=1) for y in (0, 4)])
    frame = Frame(35.15, 30.36)
    around = MultiPolygon([frame.geometry_lonlat(shapely.box(-6, -6, 33, 10))])
    open_field = Field("open", around)
    pond = MultiPolygon([frame.geometry_lonlat(shapely.box(11, 1, 16, 2.5))])
    with_pond = Field("pond", around, no_go=pond)
    planting = Planting(row_bearing_deg=90.0)
    whole = grid_from_plants(frame.lonlat(xy_m), planting, open_field)
    assert whole.n_rows == 2
    assert len(whole.along_plant) == 16
    cut = grid_from_plants(frame.lonlat(xy_m), planting, with_pond)
    assert cut.row_line.tolist() == [0, 0, 1]
    pond_m = cut.frame.geometry_m(pond)
    assert not shapely.intersects(pond_m, lanes(cut)).any()
    tight = MultiPolygon([frame.geometry_lonlat(shapely.box(-1, -1, 28, 5))])
    widened = grid_from_plants(frame.lonlat(xy_m), planting, Field("tight", tight, no_go=pond))
    assert shapely.covers(shapely.buffer(widened.ground_m, EDGE), lanes(widened)).all()
    assert shapely.intersection(widened.ground_m, pond_m).area < EDGE


def test_a_boundary_too_tight_for_the_aisles_is_widened_by_them():
    truth = rectangle(4, 6, Planting(row_bearing_deg=90.0))
    tight = shapely.convex_hull(shapely.multipoints(truth.lonlat()))
    field = Field("tight", MultiPolygon([tight.buffer(1e-6)]))
    grid = grid_from_plants(truth.lonlat(), Planting(row_bearing_deg=90.0), field)
    assert shapely.covers(shapely.buffer(grid.ground_m, EDGE), lanes(grid)).all()
    assert grid.drivable_m.area == pytest.approx(grid.frame.geometry_m(field.boundary).area)
    roomy = Field("roomy", MultiPolygon([tight.buffer(2e-4)]))
    grid = grid_from_plants(truth.lonlat(), Planting(row_bearing_deg=90.0), roomy)
    assert grid.drivable_m.area == pytest.approx(grid.frame.geometry_m(roomy.boundary).area)


def test_what_plants_do_not_show_is_taken_from_the_given_planting():
    one_row = rectangle(1, 20, Planting(row_bearing_deg=40.0, plant_spacing_m=1.2))
    found = found_planting(one_row.lonlat(), Planting(row_spacing_m=3.5, headland_m=7.0))
    assert found.row_bearing_deg == pytest.approx(40.0, abs=0.01)
    assert (found.row_spacing_m, found.headland_m) == (3.5, 7.0)
    assert found.plant_spacing_m == pytest.approx(1.2, abs=1e-3)


def test_one_plant_is_a_row_if_its_bearing_is_given():
    grid = grid_from_plants(np.array([[35.0, 30.0]]), Planting(row_bearing_deg=10.0))
    assert (len(grid), grid.n_rows) == (1, 1)
    with pytest.raises(PlotError, match="2 plants or more"):
        grid_from_plants(np.array([[35.0, 30.0]]))


@pytest.mark.parametrize(
    ("lonlat", "sentence"),
    [
        (np.empty((0, 2)), "at least one plant"),
        (np.array([[35.0, 30.0], [np.nan, 30.0]]), "plant 2 has none"),
        (np.array([[35.0, 30.0], [35.0001, 30.0], [35.0, 30.0000001]]), "plant 3 at"),
    ],
)
def test_positions_that_are_none_or_double_are_refused(lonlat, sentence):
    with pytest.raises(PlotError, match=sentence):
        grid_from_plants(lonlat, Planting(row_bearing_deg=0.0))


def test_plants_beside_their_plot_are_refused():
    plot = plot_of(50, 50)
    elsewhere = rectangle(5, 5, centre=(35.16, 30.36)).lonlat()
    with pytest.raises(PlotError, match="none of 25"):
        grid_from_plants(elsewhere, Planting(row_bearing_deg=90.0), plot)
