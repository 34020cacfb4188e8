"""No way leads over a hole or a no-go area, whose edge a robot of known width keeps off."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, Point, box

from fieldmon.errors import PlotError
from fieldmon.plot.clear_lanes import clear_lanes
from fieldmon.plot.clearance import Clearance
from fieldmon.plot.field import Field
from fieldmon.plot.layout import grid_from_plants, lay
from fieldmon.plot.obstacles import Obstacles, Where, off_limits, row_lines
from fieldmon.plot.passing import legs_of
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.crossing import crosses_rows
from tests.cut_lanes import (
    FRAME,
    OFF_M,
    WIDE,
    cut_plot,
    on_plot,
    perhaps_reachable,
    surely_reachable,
)
from tests.thorough import seeds

AREA = box(-6, -6, 34, 26)
ROWS, PLANTS = 4, 15


def measured(bend_m, *holes, no_go=False):
    """Return four rows of fifteen plants 2 m apart, which may bend, and what stands among them."""
    x, y = np.meshgrid(np.arange(0, 2 * PLANTS, 2.0), np.arange(0, 4 * ROWS, 4.0))
    y = y + bend_m * (x / x.max()) ** 2
    lonlat = FRAME.lonlat(np.stack([x.ravel(), y.ravel()], axis=1))
    shut = shapely.union_all(holes)
    field = Field("plot", on_plot(shapely.difference(AREA, shut)))
    if no_go:
        field = Field("plot", on_plot(AREA), no_go=on_plot(shut))
    grid = grid_from_plants(lonlat, Planting(row_bearing_deg=90.0), field)
    return grid, grid.frame.geometry_m(field.no_go), grid.frame.geometry_m(on_plot(shut))


def needs(grid, width_m):
    return Clearance.of(Robot(width_m=width_m), grid)


def driven(aisles):
    """Return the line from the gate to every plant that can be come near, and back."""
    plants = np.flatnonzero(~aisles.too_narrow)
    return shapely.linestrings(aisles.line(np.array([-1, *plants, *plants[::-3], -1]))[0])


def beside(bend_m, x, up_m=2.0):
    return Point(x, 4 + up_m + bend_m * (x / 28) ** 2)


@pytest.mark.parametrize("bend_m", [0.0, 6.0])
@pytest.mark.parametrize("x", [13.0, 13.7, 14.0])
def test_nobody_is_led_through_a_pole_in_an_aisle(bend_m, x):
    pole = beside(bend_m, x).buffer(0.2)
    grid, _, pole_m = measured(bend_m, pole)
    assert (grid.aisles_m is not None) == (bend_m > 0)
    way, hidden = driven(Aisles.of(grid)), Aisles.of(grid).too_narrow
    assert not shapely.intersects(way, shapely.buffer(pole_m, -0.02))
    assert not hidden.any()


@pytest.mark.parametrize("bend_m", [0.0, 6.0])
@pytest.mark.parametrize("no_go", [False, True])
def test_a_robot_of_known_width_keeps_half_of_it_off_holes_and_no_go_areas(bend_m, no_go):
    pole = beside(bend_m, 13.7).buffer(0.2)
    grid, no_go_m, pole_m = measured(bend_m, pole, no_go=no_go)
    aisles = Aisles.of(grid, no_go_m=no_go_m).for_robot(WIDE)
    assert not aisles.too_narrow.any()
    assert shapely.distance(driven(aisles), pole_m) > 0.65 - 0.03
    # those beside the pole are inspected from before it, all others as they were
    moved = np.flatnonzero(np.abs(aisles.stop_m - grid.stop_m).max(axis=1) > 1e-9)
    assert 1 <= len(moved) <= 2
    assert np.hypot(*(aisles.stop_m - grid.stop_m)[moved].T).max() < 1.5


@pytest.mark.parametrize("no_go", [False, True])
def test_each_stretch_of_a_lane_cut_for_a_wide_robot_is_driven_from_its_own_end(no_go):
    # in the upper half of the aisle: a point passes beside it
    shed = box(9, 6.1, 11, 7.5)
    grid, no_go_m, shed_m = measured(0.0, shed, no_go=no_go)
    point = Aisles.of(grid, no_go_m=no_go_m)
    assert not point.too_narrow.any()
    aisles = point.for_robot(WIDE)
    # it stands amid the hole
    assert np.flatnonzero(aisles.too_narrow).tolist() == [PLANTS + 5]
    assert shapely.distance(driven(aisles), shed_m) > 0.65 - 0.03
    assert not crosses_rows(grid, shapely.get_coordinates(driven(aisles)))
    assert aisles.narrow_sentence() == (
        "1 plant cannot be inspected: a hole or a no-go area, off which the robot keeps 0.65 m, "
        "cuts their aisle."
    )
    # a row whose lane is cut is as much in the way as it was
    boxes = [Obstacles.of(one, no_go_m, needs(grid, 1.1)).row_box_m for one in (grid, aisles.grid)]
    assert np.array_equal(*boxes)
    assert shapely.equals(row_lines(aisles.grid), row_lines(grid)).all()
    # from one side of it to the other: out, round a row's end, and in again
    before, after = PLANTS + 3, PLANTS + 8
    out_m = grid.xy_m[before, 0] - grid.lane_x_m[1, 0]
    in_m = grid.lane_x_m[1, 1] - grid.xy_m[after, 0]
    through_m = np.ptp(grid.lane_x_m[1])
    assert point.distance_m(before, after) == pytest.approx(10.0)
    assert aisles.distance_m(before, after) == pytest.approx(out_m + through_m + in_m + 2 * 4.0)
    leg = legs_of(aisles).leg(before, after)
    assert leg.out_m == pytest.approx(out_m)
    # through another aisle: a team keeps that free too
    assert len(leg.through) == 1
    assert leg.through[0] != aisles.grid.corridor[aisles.grid.row[before]]
    at_the_cut = legs_of(aisles).leg(PLANTS + 4, -1)
    assert not aisles.grid.cut_ends.ravel()[at_the_cut.end]


@pytest.mark.parametrize("bend_m", [0.0, 6.0])
def test_the_plants_of_a_stretch_that_is_cut_at_both_ends_are_said_to_be_out_of_reach(bend_m):
    sheds = [beside(bend_m, x, 2.9).buffer(0.6, cap_style="square") for x in (7.0, 21.0)]
    grid, _, shed_m = measured(bend_m, *sheds)
    assert not Aisles.of(grid).too_narrow.any()
    aisles = Aisles.of(grid).for_robot(WIDE)
    assert np.flatnonzero(aisles.too_narrow).tolist() == [PLANTS + k for k in range(4, 11)]
    assert aisles.narrow_sentence().startswith("7 plants cannot be inspected: a hole")
    assert shapely.distance(driven(aisles), shed_m) > 0.65 - 0.03


@pytest.mark.parametrize("faces", [1, 2])
@pytest.mark.parametrize("seed", seeds(4, 12))
def test_a_wide_robot_gets_to_all_plants_to_which_a_free_way_leads_and_to_no_others(seed, faces):
    aisles, point, shed_m = cut_plot(seed, faces=faces)
    hidden = aisles.too_narrow
    assert not (hidden & surely_reachable(aisles, point, shed_m)).any()
    assert not (~hidden & ~perhaps_reachable(aisles, point, shed_m)).any()
    stops = np.random.default_rng(seed).permutation(np.flatnonzero(~hidden))
    places = np.array([-1, *stops, -1])
    line, ends = aisles.line(places)
    assert np.allclose(line[ends[:-1]], aisles.stop_m[stops])
    assert shapely.distance(shapely.linestrings(line), shed_m) > OFF_M - 0.03
    assert not crosses_rows(aisles.grid, line)
    driven_m = np.hypot(*np.diff(line, axis=0).T).sum()
    assert aisles.distance_m(places[:-1], places[1:]).sum() == pytest.approx(driven_m)


def test_where_a_lane_is_cut_nobody_has_room_to_turn():
    # plants are missing about the hole: a long robot could turn there, but not at the row ends
    gap = box(7, -3, 21, 15)
    x, y = np.meshgrid(np.arange(0, 2 * PLANTS, 2.0), np.arange(0, 4 * ROWS, 4.0))
    there = ~shapely.intersects_xy(gap, x.ravel(), y.ravel())
    lonlat = FRAME.lonlat(np.stack([x.ravel(), y.ravel()], axis=1)[there])
    field = Field("plot", on_plot(shapely.difference(AREA, box(13.5, 6.1, 14.5, 7.5))))
    grid = grid_from_plants(lonlat, Planting(row_bearing_deg=90.0), field)
    long = Robot(width_m=1.1, length_m=5.2)
    clear = clear_lanes(grid, off_limits(grid, None, needs(grid, 1.1).off_m)).grid
    assert clear.cut_ends.any()
    asked = Clearance.of(long, grid)
    roomy = asked.end_room_m(clear) >= asked.turn_m
    assert roomy[clear.cut_ends].all()
    assert not roomy[~clear.cut_ends].any()
    with pytest.raises(PlotError, match="room to turn at the ends of rows"):
        Aisles.of(grid).for_robot(long)


def test_ways_keep_half_the_width_off_the_boundary_where_there_is_room():
    # two headlands meet at a corner that bulges into the plot
    grid = lay(Field("L", on_plot(box(0, 0, 60, 40) - box(50, 30, 60, 40))), Planting())
    corner_m = grid.frame.xy_m(FRAME.lonlat([[50.0, 30.0]]))[0]
    edge_m = shapely.boundary(grid.drivable_m)
    far, near = (Obstacles.of(grid, MultiPolygon(), needs(grid, w)) for w in (1.1, 0.3))
    point = Obstacles.of(grid, MultiPolygon())
    inwards = np.array([shapely.get_coordinates(c)[0] for c in (grid.drivable_m.centroid,)])[0]
    ahead = (inwards - corner_m) / np.hypot(*(inwards - corner_m))
    beside = np.array([-ahead[1], ahead[0]])

    def past(off_m, obstacles, where=Where.INSIDE):
        middle = corner_m + off_m * ahead
        from_m, to_m = middle - 1.5 * beside, middle + 1.5 * beside
        assert shapely.distance(edge_m, shapely.points([from_m, to_m])).min() > 0.55
        return obstacles.clear(from_m[None], to_m[None], where)[0]

    assert [past(0.3, one) for one in (point, near, far)] == [True, True, False]
    assert past(0.6, far)
    assert past(0.3, far, Where.TIGHT)
    # where a lane ends nearer to it, its way may come as near
    start = corner_m + 0.2 * ahead
    assert far.clear(start[None], (start + 2.0 * ahead)[None])[0]


def test_a_gate_beside_a_no_go_area_stays_where_it_is():
    grid, no_go_m, shed_m = measured(0.0, box(-5, -5, -3, -3), no_go=True)
    gate_m = shapely.get_coordinates(shed_m).max(axis=0) + np.array([0.2, -1.0])
    aisles = Aisles.of(grid, tuple(gate_m), no_go_m).for_robot(WIDE)
    assert aisles.gate_m == pytest.approx(gate_m)
    beyond = shapely.difference(driven(aisles), Point(gate_m).buffer(0.7))
    assert shapely.distance(beyond, shed_m) > 0.65 - 0.03


def test_a_robot_of_known_width_goes_to_trees_beside_a_no_go_area():
    x, y = np.meshgrid(np.arange(0, 20, 4.0), np.arange(0, 20, 4.0))
    lonlat = FRAME.lonlat(np.stack([x.ravel(), y.ravel()], axis=1))
    no_go = on_plot(box(8.1, 0.5, 11.5, 11.5))
    field = Field("trees", on_plot(AREA), plants=lonlat, no_go=no_go, in_rows=False)
    aisles = Plot.of_trees(field).aisles
    assert not aisles.for_robot(Robot(width_m=0.2)).too_narrow.any()
