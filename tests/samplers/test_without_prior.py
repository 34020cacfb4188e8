"""The seven samplers without prior information, as the thesis describes them (SPEC 7.2)."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.planning.workday import plan_work
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.samplers.base import NEVER
from fieldmon.samplers.without_prior import (
    Neighbor,
    NeighborRandom,
    RandomShare,
    Snake,
    SnakeRandom,
)
from tests.scenes import charged_s, scene_on

# the thesis's vineyard in small: 4 vine rows, outer faces not inspected, so 6 sides of 8 plants
VINEYARD = rectangle(4, 8, Planting(faces=2, outer_faces=False))
P = 8


def day(sampler, hours=24.0, grid=VINEYARD, **changes):
    scene = scene_on(grid, hours=hours)
    robot = Robot(hours=hours, returns=False).with_times("thesis")
    scene = replace(scene, robot=robot, **changes)
    return scene, plan_work(scene, sampler)


def after(scene, work, day=1, **changes):
    """Return the next morning's scene."""
    last = scene.last_inspected.copy()
    last[work.plant] = scene.day
    tomorrow = replace(scene, last_inspected=last, day=day, trail=work.plant)
    return replace(tomorrow, **changes)


def side_by_side(plants):
    """Return (side, place) of each plant."""
    return [divmod(int(p), P) for p in plants]


def test_the_snake_goes_up_one_side_of_an_aisle_and_down_the_other():
    _, work = day(Snake())
    up, down = list(range(P)), list(range(P - 1, -1, -1))
    assert side_by_side(work.plant) == [
        (side, j) for side in range(6) for j in (up if side % 2 == 0 else down)
    ]


def test_in_an_aisle_the_snake_pays_one_turn_and_between_aisles_a_row_change():
    scene, work = day(Snake())
    legs = list(zip(work.plant[:-1], work.plant[1:], strict=True))
    robot = scene.robot
    assert charged_s(scene, *map(int, legs[P - 1])) == pytest.approx(robot.turn_180_s)
    assert charged_s(scene, *map(int, legs[2 * P - 1])) > robot.row_change_s
    assert charged_s(scene, *map(int, legs[0])) == pytest.approx(3.0 / robot.speed_m_s)


def test_a_skip_carries_over_from_side_to_side():
    _, work = day(Snake(every=3))
    first_pass = work.plant[: 6 * P // 3]
    order = VINEYARD.snake.tolist()
    assert [order.index(p) for p in first_pass] == list(range(0, 6 * P, 3))


def test_at_the_end_the_snake_turns_to_the_nearest_plant_not_yet_visited():
    _, work = day(Snake(every=3))
    order = VINEYARD.snake.tolist()
    places = [order.index(p) for p in work.plant]
    # 45 is the last of the pass; of the last three, 47 is nearest to the end and new
    assert places[15:18] == [45, 47, 44]
    assert sorted(places) == list(range(6 * P))


def test_the_neighbor_sampler_looks_at_both_sides_of_each_stop():
    scene, work = day(Neighbor())
    stops = work.plant.reshape(-1, 2)
    sides = np.sort(stops // P, axis=1)
    assert (stops[:, 0] % P == stops[:, 1] % P).all()
    assert (sides[:, 1] - sides[:, 0] == 1).all()
    assert (sides[:, 0] % 2 == 0).all()
    places = [int(s) % P for s in stops[:, 0]]
    assert places == [*range(P), *range(P - 1, -1, -1), *range(P)]
    turns = [charged_s(scene, int(a), int(b)) for a, b in stops]
    assert turns == pytest.approx([scene.robot.turn_180_s] * len(turns))
    onward = charged_s(scene, int(stops[0, 1]), int(stops[1, 0]))
    assert onward == pytest.approx(3.0 / scene.robot.speed_m_s), "one turn a stop, not two"


def test_every_second_stop_of_the_neighbor_sampler():
    _, work = day(Neighbor(every=2))
    assert [int(p) % P for p in work.plant[:8:2]] == [0, 2, 4, 6]


@pytest.mark.parametrize("sampler", [Snake(), Snake(2), Neighbor(), Neighbor(3)])
def test_the_next_day_goes_on_where_the_last_one_ended(sampler):
    _, whole = day(sampler)
    scene, first = day(sampler, hours=0.25)
    tomorrow = after(scene, first, seconds_left=24 * 3600.0)
    second = plan_work(tomorrow, sampler)
    k = len(first)
    assert 2 < k < 24
    ahead, expected = second.plant[:6], whole.plant[k : k + 6]
    if isinstance(sampler, Neighbor):  # which side of a stop comes first is no matter
        ahead, expected = np.sort(ahead.reshape(-1, 2)), np.sort(expected.reshape(-1, 2))
    assert (ahead == expected).all()


def test_a_sweep_on_its_way_back_goes_on_backwards():
    scene, first = day(Snake(every=2), hours=0.55)
    places = [VINEYARD.snake.tolist().index(p) for p in first.plant]
    assert places[-1] < places[-2], "the day must end on the way back for this test"
    second = plan_work(after(scene, first), Snake(every=2))
    assert VINEYARD.snake.tolist().index(second.plant[0]) == places[-1] - 2


@pytest.mark.parametrize("sampler", [SnakeRandom(), NeighborRandom()])
def test_online_random_steps_are_one_to_four_evenly(sampler):
    grid = rectangle(40, 50)
    _, work = day(sampler, grid=grid, key=np.uint64(5))
    places = [grid.snake.tolist().index(p) for p in work.plant[:300]]
    if isinstance(sampler, SnakeRandom):
        steps = np.diff(places)
        assert set(steps) == {1, 2, 3, 4}
        assert np.mean(steps) == pytest.approx(2.5, abs=0.25)
    other = day(sampler, grid=grid, key=np.uint64(6))[1]
    assert (other.plant[:50] != work.plant[:50]).any()


def test_the_random_share_is_drawn_anew_every_day_and_visited_in_order():
    scene, work = day(RandomShare(every=4))
    order = [VINEYARD.snake.tolist().index(p) for p in work.plant]
    assert len(order) == 6 * P // 4
    assert order == sorted(order)
    other = plan_work(after(scene, work, key=np.uint64(9)), RandomShare(every=4))
    assert set(other.plant.tolist()) != set(work.plant.tolist())


def test_on_one_face_the_neighbor_sampler_goes_row_by_row():
    grid = rectangle(3, 5)
    _, work = day(Neighbor(), grid=grid)
    assert (work.plant == grid.snake).all()


def test_a_plot_of_which_everything_was_visited_today_ends_the_day():
    last = np.zeros(len(VINEYARD), np.int32)
    _, work = day(Snake(), last_inspected=last)
    assert len(work) == 0


@pytest.mark.parametrize("sampler", [Snake, Neighbor, RandomShare])
def test_every_must_be_one_or_more(sampler):
    with pytest.raises(SettingError, match="1 or more"):
        sampler(every=0)


def test_never_is_no_day():
    assert NEVER < 0
