"""No way leads over a hole or a no-go area, whose edge a robot of known width keeps off."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, Point, box

from fieldmon.plot.clearance import Clearance
from fieldmon.plot.field import Field
from fieldmon.plot.layout import grid_from_plants, lay
from fieldmon.plot.obstacles import Obstacles, Where
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles

FRAME = Frame(35.15, 30.36)
AREA = box(-6, -6, 34, 26)
WIDE = Robot(width_m=1.1, length_m=1.4)
ROWS, PLANTS = 4, 15


def on_plot(area):
    return MultiPolygon(list(shapely.get_parts(FRAME.geometry_lonlat(area))))


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


def test_of_a_lane_cut_for_a_wide_robot_the_plants_beyond_are_said_to_be_left_out():
    # in the upper half of the aisle: a point passes beside it
    shed = box(9, 6.1, 11, 7.5)
    grid, _, shed_m = measured(0.0, shed)
    assert not Aisles.of(grid).too_narrow.any()
    aisles = Aisles.of(grid).for_robot(WIDE)
    left_out = int(aisles.too_narrow.sum())
    assert 0 < left_out < PLANTS / 2
    assert shapely.distance(driven(aisles), shed_m) > 0.65 - 0.03
    assert aisles.narrow_sentence() == (
        f"{left_out} plants cannot be inspected: a hole or a no-go area, off which the robot keeps "
        "0.65 m, cuts their aisle."
    )


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
