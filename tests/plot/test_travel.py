"""Driving from plant to plant: as far as said, across no row, hardly farther than must be."""

from dataclasses import replace
from itertools import pairwise

import numba as nb
import numpy as np
import pytest
import shapely
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from shapely import MultiPolygon, Polygon, box

from fieldmon.errors import SettingError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import grid_from_plants, lay, rectangle
from fieldmon.plot.obstacles import row_lines
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles, drive_m, driven_s, robot_clock
from fieldmon.plot.trees import trees_grid
from tests.crooked import crooked_grids
from tests.crossing import crosses_rows

FRAME = Frame(35.15, 30.36)
EASTWARD = Planting(row_bearing_deg=90.0, row_spacing_m=4.0, plant_spacing_m=2.0)


def laid(*areas, planting=EASTWARD):
    """Return plants in rows; the areas are metres about a fixed place, east and north."""
    field = Field("test", FRAME.geometry_lonlat(MultiPolygon(areas)))
    return lay(field, planting)


SHAPES = {
    "rectangle": rectangle(9, 12),
    "skew": laid(Polygon([(-60, -60), (20, -60), (80, 60), (0, 60)])),
    "hole": laid(box(-60, -60, 60, 60).difference(box(-25, -15, 5, 30))),
    "C": laid(box(-60, -60, 60, 60).difference(box(-20, -20, 70, 20))),
    "U": laid(box(-60, -60, 60, 60).difference(box(-20, -20, 20, 70))),
    "two parts": laid(box(-60, -40, -4, 40), box(4, -40, 60, 40)),
    "two faces": rectangle(5, 9, Planting(faces=2)),
    "one plant": rectangle(1, 1),
    "one row": rectangle(1, 20),
    "one plant a row": rectangle(12, 1),
}


def some_plants(grid, n, seed=0):
    """Return a choice of plants, the first, the last and the gate among them."""
    rng = np.random.default_rng(seed)
    return np.concatenate([[-1, 0, len(grid) - 1], rng.integers(-1, len(grid), n)])


def length_m(line):
    return float(np.hypot(*np.diff(line, axis=0).T).sum())


def check_paths(aisles, plants):
    """Check that each path is as long as said, starts and ends rightly and crosses no row."""
    stops = np.concatenate([aisles.stop_m, [aisles.gate_m]])
    for i, j in pairwise(plants):
        line = aisles.path(i, j)
        assert len(line) >= 2
        assert line[[0, -1]] == pytest.approx(stops[[i, j]])
        assert length_m(line) == pytest.approx(aisles.distance_m(i, j), abs=1e-6)
        assert not crosses_rows(aisles.grid, line)


def shortest_m(grid, points):
    """Return the shortest ways between points that cross no row and stay on the plot.

    The plain visibility graph of rows' ends and the boundary's corners: nothing in it is shared
    with the code under test, and it is allowed to touch what a robot would keep clear of.
    """
    first = grid.xy_m[grid.row_start[:-1]]
    last = grid.xy_m[grid.row_start[1:] - 1]
    short = np.minimum(0.001, (last[:, :1] - first[:, :1]) / 2) * np.array([1.0, 0.0])
    rows = shapely.linestrings(np.stack([first + short, last - short], axis=1))
    plot = shapely.buffer(grid.drivable_m, 0.02, join_style="mitre")
    shapely.prepare(plot)
    corners = np.concatenate([points, first, last, shapely.get_coordinates(plot)])
    a, b = np.triu_indices(len(corners), 1)
    steps = shapely.linestrings(np.stack([corners[a], corners[b]], axis=1))
    seen = shapely.covers(plot, steps)
    seen[shapely.STRtree(rows).query(steps, predicate="intersects")[0]] = False
    far = np.maximum(np.hypot(*(corners[a] - corners[b]).T), 1e-9)[seen]
    graph = csr_array((far, (a[seen], b[seen])), shape=(len(corners),) * 2)
    reach = dijkstra(graph, directed=False, indices=np.arange(len(points)))
    return reach[:, : len(points)]


def test_next_row_is_reached_round_the_row_end():
    grid = rectangle(3, 10, Planting(row_spacing_m=4.0, plant_spacing_m=3.0, headland_m=4.0))
    aisles = Aisles.of(grid)
    # lanes end 2 m beyond the last plants, rows are 4 m apart
    assert aisles.distance_m(0, 10) == pytest.approx(2 + 4 + 2, abs=1e-5)
    assert aisles.distance_m(0, 12) == pytest.approx(2 + 4 + 2 + 6, abs=1e-5)
    assert aisles.distance_m(5, 25) == pytest.approx(12 + 2 + 8 + 2 + 12, abs=1e-5)
    assert aisles.distance_m(3, 7) == pytest.approx(12)
    assert aisles.distance_m(4, 4) == 0.0


def test_the_path_round_a_row_end_turns_where_the_lanes_end():
    grid = rectangle(2, 10)
    (low_x, _), lane_y = grid.lane_x_m[0], grid.lane_y_m
    x = grid.xy_m[:, 0]
    expected = [(x[1], lane_y[0]), (low_x, lane_y[0]), (low_x, lane_y[1]), (x[12], lane_y[1])]
    assert Aisles.of(grid).path(1, 12) == pytest.approx(np.array(expected))


def test_the_gate_is_plant_minus_one():
    grid = rectangle(3, 10)
    aisles = Aisles.of(grid)
    assert aisles.distance_m(-1, -1) == 0.0
    assert aisles.distance_m(-1, 0) == pytest.approx(grid.xy_m[0, 0] - grid.lane_x_m[0, 0])
    assert aisles.distance_m(0, -1) == aisles.distance_m(-1, 0)
    assert aisles.path(-1, -1) == pytest.approx(np.stack([aisles.gate_m] * 2))


def test_distances_broadcast_like_numpy():
    aisles = Aisles.of(SHAPES["rectangle"])
    plants = np.arange(-1, 20)
    table = aisles.distance_m(plants[:, None], plants)
    assert table.shape == (21, 21)
    assert (table == table.T).all()
    assert table[3, 8] == aisles.distance_m(2, 7)
    assert aisles.distance_m(np.empty(0, int), 3).shape == (0,)


@pytest.mark.parametrize("wrong", [108, 10_000_000, -2, 1.5, [0, 108], None])
def test_no_way_leads_to_what_is_no_plant(wrong):
    aisles = Aisles.of(SHAPES["rectangle"])
    with pytest.raises(SettingError, match=r"plants, 0 to 107, and the gate, -1, but one is"):
        aisles.distance_m(wrong, 0)
    if np.ndim(wrong) == 0:
        with pytest.raises(SettingError, match="0 to 107"):
            aisles.path(0, wrong)


def test_compiled_loops_drive_as_far():
    aisles = Aisles.of(SHAPES["hole"])

    @nb.njit
    def one(travel, i, j):
        return drive_m(travel, i, j)

    for i, j in [(0, 100), (100, 0), (-1, 7), (7, -1), (3, 3), (3, 5), (-1, -1)]:
        assert one(aisles.travel, i, j) == aisles.distance_m(i, j)


def test_both_faces_of_an_aisle_are_inspected_from_one_lane():
    grid = SHAPES["two faces"]
    aisles = Aisles.of(grid)
    across = np.flatnonzero((grid.corridor[grid.row] == 2) & (grid.side[grid.row] > 0))[4]
    this = np.flatnonzero((grid.corridor[grid.row] == 2) & (grid.side[grid.row] < 0))[1]
    assert aisles.distance_m(this, across) == pytest.approx(9.0)
    assert aisles.path(this, across)[:, 1] == pytest.approx(grid.lane_y_m[grid.row[this]])


def test_the_other_face_of_a_vine_is_reached_round_the_row():
    grid = SHAPES["two faces"]
    aisles = Aisles.of(grid)
    twin = int(grid.twin[2])
    assert aisles.distance_m(2, twin) == pytest.approx((6 + 2) * 2 + 4, abs=1e-5)
    assert not crosses_rows(grid, aisles.path(2, twin))


@pytest.mark.parametrize("grid", SHAPES.values(), ids=SHAPES)
def test_paths_are_as_long_as_said_and_cross_no_row(grid):
    check_paths(Aisles.of(grid), some_plants(grid, 60))


@given(grid=crooked_grids(), seed=st.integers(0, 100))
def test_paths_on_crooked_plots_are_as_long_as_said_and_cross_no_row(grid, seed):
    check_paths(Aisles.of(grid), some_plants(grid, 10, seed))


@given(
    jitter_m=st.lists(st.floats(-0.3, 0.3), min_size=90, max_size=90),
    tilt_m=st.floats(-0.5, 0.5),
    n_rows=st.sampled_from((1, 5, 9)),
)
def test_paths_between_rows_measured_roughly_cross_none(jitter_m, tilt_m, n_rows):
    planting = Planting(row_spacing_m=2.5, plant_spacing_m=1.4, headland_m=2.0)
    grid = rectangle(n_rows, 90 // n_rows, planting)
    xy_m = grid.xy_m.copy()
    xy_m[:, 1] += np.array(jitter_m) + tilt_m * xy_m[:, 0] / np.abs(xy_m[:, 0]).max()
    rough = replace(grid, xy_m=xy_m)
    check_paths(Aisles.of(rough), some_plants(rough, 30))


@given(seed=st.integers(0, 10_000), row_spacing_m=st.floats(1.8, 5.0), skew=st.floats(-1.5, 1.5))
def test_paths_between_plants_taken_from_gps_cross_no_row(seed, row_spacing_m, skew):
    rng = np.random.default_rng(seed)
    row, place = np.nonzero(rng.random((12, 30)) < 0.85)
    x = place * 1.5 + skew * row_spacing_m * row + rng.normal(0.0, 0.05, len(row))
    y = row * row_spacing_m + rng.normal(0.0, 0.05, len(row))
    lonlat = Frame(8.0, 47.0, rng.uniform(0.0, 360.0)).lonlat(np.stack([x, y], axis=1))
    grid = grid_from_plants(lonlat, Planting(None, row_spacing_m, 1.5, headland_m=3.0))
    check_paths(Aisles.of(grid), some_plants(grid, 15, seed))


@given(grid=crooked_grids(), seed=st.integers(0, 100))
def test_paths_stay_on_the_plot_unless_parts_must_be_joined(grid, seed):
    aisles = Aisles.of(grid)
    plants = some_plants(grid, 8, seed)
    part = shapely.STRtree(shapely.get_parts(grid.drivable_m))
    home = part.nearest(shapely.points(np.append(aisles.stop_m, [aisles.gate_m], axis=0)))
    plot = shapely.buffer(grid.drivable_m, 0.01, join_style="mitre")
    for i, j in pairwise(plants):
        if home.max() == 0:
            assert shapely.covers(plot, shapely.linestrings(aisles.path(i, j)))


@given(crooked_grids(max_radius_m=60))
def test_no_detour_is_shorter_than_the_way(grid):
    between_m = Aisles.of(grid).travel.between_m
    assert (between_m == between_m.T).all()
    for via in range(len(between_m)):
        assert (between_m <= between_m[:, via, None] + between_m[None, via] + 1e-9).all()


def lane_ends(grid):
    """Return where the lanes end, ``(2 r, 2)``, numbered as in the table of travel."""
    ends = np.stack([grid.lane_x_m, np.stack([grid.lane_y_m] * 2, axis=1)], axis=2)
    return ends.reshape(-1, 2)


def least_m(grid, points):
    """Return what no way between points can be shorter than.

    On one part of the plot that is the shortest way on it, or else the way to another part and
    back; from part to part, where a robot may leave the plot, the straight line.
    """
    parts = shapely.get_parts(grid.drivable_m)
    home = shapely.STRtree(parts).nearest(shapely.points(points))
    others = np.array([shapely.union_all(np.delete(parts, k)) for k in range(len(parts))])
    away_m = np.nan_to_num(shapely.distance(shapely.points(points), others[home]), nan=np.inf)
    on_it_m = np.minimum(shortest_m(grid, points), away_m[:, None] + away_m)
    straight_m = np.hypot(*(points[:, None] - points).transpose(2, 0, 1))
    return np.where(home[:, None] == home, on_it_m, straight_m)


def notched_beside_another():
    """Return a plot with a notch, over which the straight ways to its other part lead."""
    whole = Polygon([(22.0, 0.0), (0.0, 5.5), (-11.124, -8.082), (19.602, -9.988)])
    notch = Polygon([(14.575, 3.3), (12.5125, 4.4908), (10.45, -1.4631)])
    other = Polygon([(46.75, 0.0), (42.625, 2.3816), (42.625, -2.3816)])
    planting = Planting(93.5491417517679, row_spacing_m=1.5, plant_spacing_m=1.0, headland_m=1.0)
    return laid(whole.difference(notch), other, planting=planting)


@given(crooked_grids(max_radius_m=40))
@example(notched_beside_another())
def test_lane_ends_are_never_nearer_than_the_shortest_way_there(grid):
    between_m = Aisles.of(grid).travel.between_m[:-1, :-1]
    assert (between_m >= least_m(grid, lane_ends(grid)) - 0.05).all()


def test_a_way_to_another_part_is_no_short_cut_over_a_notch():
    grid = notched_beside_another()
    aisles = Aisles.of(grid)
    left, right = (int(np.argmin(np.hypot(*(grid.xy_m - at).T))) for at in ((-9, 2.3), (-4, 2.3)))
    assert aisles.distance_m(left, right) > 8.0
    plot = shapely.buffer(grid.drivable_m, 0.01, join_style="mitre")
    assert shapely.covers(plot, shapely.linestrings(aisles.path(left, right)))


@pytest.mark.parametrize(
    ("name", "factor"), [("rectangle", 1.12), ("skew", 1.05), ("hole", 1.12), ("C", 1.12)]
)
def test_lane_ends_are_hardly_farther_than_the_shortest_way_there(name, factor):
    grid = SHAPES[name]
    between_m = Aisles.of(grid).travel.between_m[:-1, :-1]
    truth_m = shortest_m(grid, lane_ends(grid))
    # the truth touches the rows' last plants, the robot keeps clear of them
    assert between_m.sum() <= factor * truth_m.sum()
    assert (between_m <= 1.5 * truth_m + 1e-6).all()


CELL_M = 0.5
# to all cells that are a knight's move away or nearer: ways are up to 2.8 % too long
MOVES = [(1, 0), (0, 1), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (2, -1)]


def drawn(grid):
    """Draw a plot on squared paper: which cells ``(h, w)`` can be driven on, and its corner."""
    low = np.array(grid.drivable_m.bounds[:2]) - 1.0
    size = np.ceil((np.array(grid.drivable_m.bounds[2:]) + 1.0 - low) / CELL_M).astype(int)
    y, x = np.mgrid[: size[1], : size[0]]
    free = shapely.contains_xy(grid.drivable_m, low[0] + CELL_M * x, low[1] + CELL_M * y)
    for row in range(grid.n_rows):
        plants = grid.xy_m[grid.row_start[row] : grid.row_start[row + 1]]
        cells = np.round((plants[[0, -1]] - low) / CELL_M).astype(int)
        # two cells high, or a knight would jump over it
        free[cells[0, 1] : cells[0, 1] + 2, cells[0, 0] : cells[1, 0] + 1] = False
    return free, low


def on_paper_m(grid, points):
    """Return the shortest ways between points, cell by cell by Dijkstra's rule."""
    free, low = drawn(grid)
    number = np.full(free.shape, -1)
    number[free] = np.arange(free.sum())
    ways = []
    for dx, dy in MOVES:
        h, w = free.shape
        here = number[max(0, -dy) : h - max(0, dy), : w - dx]
        there = number[max(0, dy) : h - max(0, -dy), dx:]
        both = (here >= 0) & (there >= 0)
        ways.append((here[both], there[both], np.full(both.sum(), CELL_M * np.hypot(dx, dy))))
    a, b, far = (np.concatenate(column) for column in zip(*ways, strict=True))
    graph = csr_array((far, (a, b)), shape=(free.sum(),) * 2)
    y, x = np.nonzero(free)
    cells = low + CELL_M * np.stack([x, y], axis=1)
    at = np.array([np.argmin(np.hypot(*(cells - point).T)) for point in points])
    return dijkstra(graph, directed=False, indices=at)[:, at]


@pytest.mark.parametrize("name", ["rectangle", "skew", "hole", "C"])
def test_between_plants_one_drives_as_far_as_on_squared_paper_and_hardly_farther(name):
    grid = SHAPES[name]
    aisles, plants = Aisles.of(grid), some_plants(grid, 14)[1:]
    paper_m = on_paper_m(grid, aisles.stop_m[plants])
    told_m = aisles.distance_m(plants[:, None], plants)
    off_m = 4 * CELL_M + grid.row_spacing_m  # to the next cells, and to the lane's other side
    assert (told_m >= paper_m / 1.03 - off_m).all()
    assert (told_m <= 1.15 * paper_m + 2 * off_m).all()


def test_from_one_arm_of_a_c_to_the_other_one_drives_round_the_bay():
    grid = SHAPES["C"]
    aisles = Aisles.of(grid)
    y = np.round(grid.xy_m[:, 1])
    above, below = (np.flatnonzero((grid.xy_m[:, 0] > 50) & (y * side > 20)) for side in (1, -1))
    line = aisles.path(int(above[0]), int(below[0]))
    assert line[:, 0].min() < -20.0
    assert shapely.covers(shapely.buffer(grid.drivable_m, 0.01), shapely.linestrings(line))


def test_the_way_from_part_to_part_crosses_the_gap_squarely():
    grid = SHAPES["two parts"]
    aisles = Aisles.of(grid)
    k = int(np.flatnonzero(grid.row_line == 5)[0])
    i, j = int(grid.row_start[k + 1]) - 1, int(grid.row_start[k + 1])
    assert grid.xy_m[i, 0] < 0.0 < grid.xy_m[j, 0]
    assert aisles.distance_m(i, j) < 1.2 * (grid.xy_m[j, 0] - grid.xy_m[i, 0])


@given(st.floats(-60.0, 60.0), st.floats(-60.0, 60.0))
def test_work_can_start_anywhere(x, y):
    grid = SHAPES["hole"]
    aisles = Aisles.of(grid, tuple(grid.frame.xy_m(FRAME.lonlat([[x, y]]))[0].tolist()))
    check_paths(aisles, np.array([-1, 0, -1, len(grid) // 2, -1, len(grid) - 1]))


def test_a_line_across_a_row_is_noticed():
    grid = SHAPES["rectangle"]
    x, y = grid.xy_m[14]
    line = Aisles.of(grid).path(0, 40)
    assert not crosses_rows(grid, line)
    assert crosses_rows(grid, line + np.array([9.0, 0.0]))
    assert crosses_rows(grid, np.array([[x + 1, y - 1], [x + 1, y + 1]]))
    assert crosses_rows(grid, np.array([[x, y - 1], [x, y - 0.005]]))
    assert not crosses_rows(grid, np.array([[x, y - 1], [x, y - 0.02]]))


def test_a_line_through_a_row_of_one_plant_is_noticed():
    grid = SHAPES["one plant a row"]
    lane_x = grid.lane_x_m[0, 0]
    through, beside = (np.array([[x, -30.0], [x, 30.0]]) for x in (grid.xy_m[0, 0], lane_x))
    assert crosses_rows(grid, through)
    assert not crosses_rows(grid, beside)
    assert crosses_rows(grid, grid.xy_m[[5, 5]])


def test_a_line_through_a_bent_row_is_noticed_beside_its_chord():
    grid = rectangle(1, 3)
    xy_m = grid.xy_m.copy()
    xy_m[1, 1] += 0.5
    bent = replace(grid, xy_m=xy_m)
    x, y = xy_m[1]
    touch = np.array([[x, y + 1.0], [x, y]])
    assert crosses_rows(bent, touch)
    assert not crosses_rows(grid, touch)
    assert shapely.get_num_coordinates(row_lines(bent)) == 3


@pytest.mark.parametrize("line", [np.empty((0, 2)), np.zeros((1, 2))])
def test_no_line_crosses_no_row(line):
    assert not crosses_rows(SHAPES["rectangle"], line)


def test_what_aisles_hold_cannot_be_changed():
    aisles = Aisles.of(SHAPES["rectangle"])
    for values in (*aisles.travel, aisles.stop_m, aisles.roads.xy_m):
        assert not values.flags.writeable


def test_another_aisle_costs_a_row_change_the_other_face_a_turn_and_the_gate_neither():
    grid = rectangle(4, 3, Planting(faces=2))
    aisles, robot = Aisles.of(grid), Robot(row_change_s=7.0, turn_180_s=11.0)
    clock, aisle = robot_clock(robot, robot.day_s), grid.corridor[grid.row]
    face = grid.side[grid.row]
    kinds = set()
    for i in range(-1, len(grid)):
        for j in range(-1, len(grid)):
            took_s = driven_s(aisles.travel, clock, np.array([i, j]))
            charged_s = took_s - float(aisles.distance_m(i, j)) / robot.speed_m_s
            if min(i, j) < 0:
                wanted_s = 0.0
            elif aisle[i] != aisle[j]:
                wanted_s = 7.0
            else:
                wanted_s = 11.0 if face[i] != face[j] else 0.0
            kinds.add(wanted_s)
            assert charged_s == pytest.approx(wanted_s, abs=1e-9), (i, j)
    assert kinds == {0.0, 7.0, 11.0}


def test_only_where_plants_stand_in_no_rows_none_are_changed():
    grid, robot = rectangle(3, 3), Robot(row_change_s=7.0)
    straight, quick = Aisles.of(grid), Robot(row_change_s=0.0)
    assert straight.worked_by(robot) is robot
    among_trees = Aisles.of(trees_grid(grid.lonlat()))
    assert among_trees.worked_by(robot) == replace(robot, row_change_s=0.0)
    assert among_trees.worked_by(quick) is quick


@pytest.mark.parametrize("shape", ["rectangle", "skew", "hole", "C", "two faces", "one row"])
def test_the_way_on_is_that_to_the_nearest_row_of_all_that_lie_beyond(shape):
    """Between lane ends; of rows beyond which one shares the aisle nothing is promised."""
    aisles = Aisles.of(SHAPES[shape])
    between_m, corridor = aisles.travel.between_m, aisles.travel.corridor
    n_rows = aisles.grid.n_rows
    for own, row in np.argwhere(~np.eye(n_rows, dtype=bool)):
        beyond = np.arange(row, n_rows) if row > own else np.arange(row + 1)
        ends = 2 * beyond[:, None] + np.arange(2)
        least_m = between_m[[2 * own, 2 * own + 1]][:, ends.ravel()].min()
        told_m = aisles.onward_m[own, row]
        if (corridor[beyond] == corridor[own]).any():
            assert told_m == -np.inf
        else:
            assert told_m == pytest.approx(least_m, rel=1e-5)
            assert told_m <= least_m
