"""Two in one aisle at once are seen on their lines, one after the other are not."""

import numpy as np
import pytest
import shapely

from fieldmon.planning.meetings import _presences, meetings
from fieldmon.planning.plan import plan_in
from fieldmon.plot.bent_layout import bent_grid
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.robot import Robot
from fieldmon.plot.row_lines import Ground, RowLines
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.base import NEVER, Sampler, Scene, Stops
from tests.bent import FRAME
from tests.second_by_second import in_aisles

AISLES = Aisles.of(rectangle(4, 10))


class Fixed(Sampler):
    """Visits the plants that it is told, as if each took a second."""

    def __init__(self, *plants):
        self.plants = plants

    def walk(self, scene, would_find):  # noqa: ARG002 - as every sampler is asked
        plants = np.array(self.plants, np.int32)
        times, now, at = [], 0.0, scene.at
        for plant in plants:
            now += float(scene.aisles.distance_m(at, plant)) / scene.robot.speed_m_s
            times.append(now)
            now, at = now + scene.robot.visit_s, plant
        return Stops(plants, np.array(times))


def route(*plants):
    robot = Robot(row_change_s=0.0, turn_180_s=0.0)
    never = np.full(40, NEVER, np.int32)
    scene = Scene(AISLES, robot, np.full(40, 0.1), never, seconds_left=robot.day_s)
    return plan_in(scene, Fixed(*plants)).route


def test_two_with_stops_in_one_aisle_at_one_time_meet_there():
    (met,) = meetings([route(13), route(16)], np.zeros(2))
    assert met.who == (0, 1)
    assert met.aisle == AISLES.grid.corridor[AISLES.grid.row[13]]
    assert met.since_s < met.until_s


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("plant", [11, 17])
def test_one_is_in_an_aisle_from_its_end_on_until_it_is_left_or_the_day_ends_there(plant, returns):
    robot = Robot(row_change_s=0.0, turn_180_s=0.0, returns=returns)
    never = np.full(40, NEVER, np.int32)
    scene = Scene(AISLES, robot, np.full(40, 0.1), never, seconds_left=robot.day_s)
    day, grid = plan_in(scene, Fixed(plant)).route, AISLES.grid
    (one,) = [each for each in _presences(day, 100.0) if each.aisle == grid.corridor[1]]
    # the gate is at the low end
    deep_s = (grid.along_m[plant] - grid.lane_x_m[1, 0]) / robot.speed_m_s
    assert one.since_s == pytest.approx(100.0 + day.arrive_s[0] - deep_s)
    assert one.until_s == pytest.approx(100.0 + day.leave_s[0] + (deep_s if returns else 0.0))


def test_two_in_different_aisles_do_not_meet():
    assert meetings([route(13), route(23)], np.zeros(2)) == []


def test_one_after_the_other_in_one_aisle_do_not_meet():
    first = route(13)
    assert meetings([first, route(16)], np.array([0.0, first.end_s])) == []


def test_who_only_drives_through_is_met_too():
    crossing = route(19, 20)
    assert [met.aisle for met in meetings([route(15), crossing], np.zeros(2))] == [
        AISLES.grid.corridor[1]
    ]


def test_a_day_without_stops_meets_nobody():
    assert meetings([route(13), route()], np.zeros(2)) == []


@pytest.mark.parametrize("seed", range(6))
def test_meetings_are_when_two_stand_in_one_aisle_second_by_second(seed):
    rng = np.random.default_rng(seed)
    routes = [route(*rng.permutation(40)[: rng.integers(1, 7)].tolist()) for _ in range(3)]
    starts_s, step_s = rng.uniform(0.0, 120.0, 3), 0.5
    there = in_aisles(routes, starts_s, step_s)
    told = np.zeros((3, 3, there.shape[1]), bool)
    clear = told.copy()
    clear[:] = True
    clock = np.arange(there.shape[1]) * step_s
    for met in meetings(routes, starts_s):
        at = (clock > met.since_s) & (clock < met.until_s)
        told[met.who] |= at
        here = at & (there[met.who[0]] >= 0)
        assert (there[met.who[0]][here] == met.aisle).mean() > 0.9
        for edge in (met.since_s, met.until_s):  # half a metre from an aisle's end
            clear[met.who] &= np.abs(clock - edge) > 2.0
    for a, b in ((0, 1), (0, 2), (1, 2)):
        together = (there[a] == there[b]) & (there[a] >= 0)
        np.testing.assert_array_equal(told[a, b][clear[a, b]], together[clear[a, b]])


def test_where_rows_bend_who_drives_through_is_met_and_all_that_start_later_as_much_later():
    turn, far_m = np.meshgrid(np.linspace(0.0, 0.4, 12), 60.0 + 3.0 * np.arange(5))
    arcs = [
        np.stack([far_m * np.sin(turn + block / 2), far_m * np.cos(turn + block / 2)], axis=2)
        for block in range(3)
    ]
    lines = np.concatenate(arcs)
    rows = RowLines(Polylines.each(list(lines)), np.repeat(np.arange(3), 5))
    plants = lines.reshape(-1, 2), np.repeat(np.arange(15), 12)
    ground = Ground(None, shapely.MultiPolygon())
    planting = Planting(row_spacing_m=3.0, plant_spacing_m=2.5)
    aisles = Aisles.of(bent_grid(FRAME, rows, plants, ground, planting))
    robot, n = Robot(row_change_s=0.0, turn_180_s=0.0), len(aisles.grid)
    never = np.full(n, NEVER, np.int32)
    scene = Scene(aisles, robot, np.full(n, 0.1), never, seconds_left=robot.day_s)
    # both from the first block to the third, through the second
    across = [plan_in(scene, Fixed(0, n - 1)).route] * 2
    begun_s = np.array([0.0, 10.0])
    now, later = meetings(across, begun_s), meetings(across, begun_s + 1000.0)
    between = set(aisles.grid.corridor[5:10].tolist())
    passing = [met for met in now if met.aisle in between]
    assert passing
    left_s, came_s = across[0].leave_s[0], across[0].arrive_s[1]
    for met in passing:  # the whole way counts: while both are on it
        assert (met.since_s, met.until_s) == pytest.approx((10.0 + left_s, came_s))
    for one, other in zip(now, later, strict=True):
        assert (one.who, one.aisle) == (other.who, other.aisle)
        moved_s = np.subtract(other[2:], one[2:])
        assert moved_s == pytest.approx([1000.0, 1000.0])
