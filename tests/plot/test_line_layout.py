"""Plants along rows that are known as lines."""

import re
from itertools import pairwise

import numpy as np
import pytest
import shapely
from shapely import MultiLineString, MultiPolygon

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.line_layout import copies, is_straight, lay_along
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_lines import Ground
from fieldmon.plot.travel import Aisles

FRAME = Frame(8.0, 47.0)
PLANTING = Planting(row_spacing_m=3.0, plant_spacing_m=1.5)
NOTHING = MultiPolygon()


def arcs(n_rows=12, radius_m=80.0, low=-0.4, high=0.4):
    turn = np.linspace(low, high, 40)
    ways = np.stack([np.sin(turn), np.cos(turn)], axis=1)
    return [(radius_m + 3.0 * k) * ways - [0.0, radius_m + 16.0] for k in range(n_rows)]


def drawn(lines, area=None):
    area = shapely.box(-60, -60, 60, 60) if area is None else area
    rows = MultiLineString([FRAME.lonlat(line) for line in lines])
    return Field("drawn", MultiPolygon([FRAME.geometry_lonlat(area)]), row_lines=rows)


def test_plants_stand_on_the_rows_drawn_a_spacing_apart():
    lines = arcs()
    grid = lay(drawn(lines), PLANTING)
    assert grid.n_rows == 12
    xy_m = FRAME.xy_m(grid.lonlat())
    off_m = shapely.distance(shapely.multilinestrings(lines), shapely.points(xy_m))
    assert off_m.max() < 0.01
    step_m = np.hypot(*np.diff(xy_m, axis=0).T)[np.diff(grid.row) == 0]
    assert step_m == pytest.approx(np.full(len(step_m), 1.5), abs=0.01)
    # a row of 64 m and more holds as many as fit
    assert np.diff(grid.row_start).min() == int(80 * 0.8 / 1.5) + 1


def test_the_distance_of_rows_is_theirs_whatever_is_said():
    wide = Planting(row_spacing_m=5.0, plant_spacing_m=1.5)
    assert lay(drawn(arcs()), wide).row_spacing_m == pytest.approx(3.0, abs=0.02)


def test_rows_end_a_headland_before_the_boundary_and_beside_ponds():
    area = shapely.difference(shapely.box(-20, -14, 18, 14), shapely.Point(3, 2).buffer(4))
    grid = lay(drawn(arcs(), area), PLANTING)
    xy_m = FRAME.xy_m(grid.lonlat())
    assert shapely.covers(area, shapely.multipoints(xy_m))
    assert (np.abs(xy_m[:, 0] + 1.0) < 19.0 - 3.0).all()
    assert grid.n_rows > len(np.unique(grid.row_line))
    stops = FRAME.xy_m(grid.frame.lonlat(grid.stop_m))
    assert shapely.covers(shapely.buffer(area, 0.01), shapely.multipoints(stops))


def test_one_bent_row_is_copied_over_the_plot():
    field = drawn(arcs()[6:7], shapely.box(-30, -20, 30, 20))
    grid = lay(field, PLANTING)
    xy_m = FRAME.xy_m(grid.lonlat()) + np.array([0.0, 96.0])
    radius = np.hypot(*xy_m.T)
    first = radius[grid.row_start[:-1]]
    assert np.diff(np.unique(np.round(first, 1))) == pytest.approx(3.0, abs=0.11)
    for k in range(grid.n_rows):
        assert np.ptp(radius[grid.row_start[k] : grid.row_start[k + 1]]) < 0.1


def test_one_straight_row_tells_the_direction_of_straight_rows():
    field = drawn([np.array([[-30.0, -10.0], [30.0, 10.0]])], shapely.box(-40, -30, 40, 30))
    grid = lay(field, PLANTING)
    assert grid.aisles_m is None
    assert grid.frame.bearing_deg == pytest.approx(90 - np.rad2deg(np.arctan2(20, 60)), abs=0.01)


def test_rows_without_room_for_a_plant_are_refused():
    with pytest.raises(PlotError, match="room for one plant on its rows, but 'drawn' has none"):
        lay(drawn(arcs(), shapely.box(-3, -30, 3, 30)), PLANTING)


@pytest.mark.parametrize("touching", [[(0.0, -40.0), (0.0, 40.0)], [(0.0, 6.03), (1.0, 20.0)]])
def test_rows_that_cross_or_touch_are_refused_with_the_place(touching):
    rows = [np.array([(-30.0, y), (30.0, y)]) for y in (-3.0, 0.0, 3.0, 6.0)]
    with pytest.raises(PlotError, match="Rows must lie beside each other") as told:
        lay(drawn([*rows, np.array(touching)]), PLANTING)
    lon, lat = re.search(r"first at \((.+), (.+)\)", str(told.value)).groups()
    at = FRAME.xy_m([(float(lon), float(lat))])[0]
    assert min(float(np.hypot(*(at - (0.0, y)))) for y in (-3.0, 0.0, 3.0, 6.0)) < 0.2
    beyond = np.array([(90.0, -3.0), (90.0, 0.0)])  # where rows leave the plot nobody drives
    fan = [np.array([(-30.0, y), (30.0, y), *beyond[:1]]) for y in (-3.0, 0.0, 3.0, 6.0)]
    assert len(lay(drawn(fan, shapely.box(-60, -60, 40, 60)), PLANTING))


def test_rows_that_are_all_drawn_beside_the_plot_are_told_how_far():
    with pytest.raises(PlotError, match="of 12 none is on 'drawn': the nearest is 96 m"):
        lay(drawn([line + np.array([200.0, 0.0]) for line in arcs()]), PLANTING)


def test_without_a_boundary_plants_stand_on_the_whole_of_each_row():
    lines = arcs(4)
    grid = lay_along("free", FRAME, lines, Ground(None, NOTHING), PLANTING)
    assert len(grid) == sum(int(shapely.linestrings(line).length / 1.5) + 1 for line in lines)
    assert shapely.covers(grid.drivable_m, shapely.multipoints(grid.stop_m))


def test_blocks_of_drawn_rows_are_told_apart():
    across = [line[:, ::-1] + [60.0, 0.0] for line in arcs(5)]
    grid = lay_along("two", FRAME, [*arcs(6), *across], Ground(None, NOTHING), PLANTING)
    assert grid.n_blocks == 2
    assert np.diff(grid.row_start).shape == (11,)
    assert grid.counts.endswith("of 2 blocks")


def test_copies_are_a_spacing_apart_and_reach_over_the_whole_area():
    area = shapely.box(-20, -20, 20, 20)
    line = np.array([[-25.0, 0.0], [0.0, 5.0], [25.0, 0.0]])
    rows = [shapely.linestrings(row) for row in copies(line, area, 2.5)]
    for a, b in pairwise(rows):
        if b.length > 20 and a.length > 20:
            assert shapely.distance(a, b) == pytest.approx(2.5, abs=0.01)
    bare = shapely.difference(area, shapely.buffer(shapely.union_all(rows), 2.6))
    assert bare.area < 1.0


def test_what_is_straight_is_known_by_how_far_it_strays():
    bow = np.array([[0.0, 0.0], [10.0, 0.2], [20.0, 0.0]])
    assert is_straight(bow, 3.0)
    assert not is_straight(bow, 1.0)


@pytest.mark.parametrize("bow_m", [4.0, 9.0, 15.0])
def test_rows_drawn_along_the_boundary_can_be_reached(bow_m):
    area = shapely.box(-130, -45, 130, 45)
    middle = np.array([[-130.0, 0.0], [-60.0, 0.0], [0.0, bow_m], [60.0, 0.0], [130.0, 0.0]])
    lines = copies(middle, area, 4.0)
    grid = lay_along("bow", FRAME, lines, Ground(area, NOTHING), PLANTING)
    aisles = Aisles.of(grid)
    assert np.isfinite(aisles.travel.between_m).all()
    whole = lay_along("bow", FRAME, lines, Ground(area, NOTHING), PLANTING, whole=True)
    assert len(whole) < len(grid)
