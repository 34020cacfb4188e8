"""The seven samplers without prior information, as the thesis describes them (SPEC 7.2)."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given

from fieldmon.errors import PlotError, SettingError
from fieldmon.planning.workday import plan_work
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import travel_s
from fieldmon.samplers.base import NEVER
from fieldmon.samplers.without_prior import (
    Neighbor,
    NeighborRandom,
    RandomShare,
    Snake,
    SnakeRandom,
    _face_to_face,
)
from tests.crooked import crooked_fields
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


def stations_told(grid, *, both_sides):
    """Return the stations of a plot without gaps, each as its plants, in the order of a sweep."""
    if not both_sides:
        return [[plant] for plant in grid.snake.tolist()]
    stations = {}
    for plant, row in enumerate(grid.row.tolist()):
        aisle = int(np.searchsorted(np.unique(grid.lane_y_m), grid.lane_y_m[row]))
        place = grid.along_m[plant] if aisle % 2 == 0 else -grid.along_m[plant]
        stations.setdefault((aisle, round(float(place), 3)), []).append((grid.side[row], plant))
    return [[plant for _, plant in sorted(stations[at])] for at in sorted(stations)]


def sweep_told(scene, stations, every):
    """Return the stops of a day as algorithms 1, 2, 4 and 6 have them: plants and arrivals."""
    travel, robot, stops = scene.aisles.travel, scene.robot, []
    last, side = scene.last_inspected.tolist(), scene.grid.side[scene.grid.row]
    of = {plant: k for k, station in enumerate(stations) for plant in station}
    position, ahead, at, now_s, skipped = 0, 1, scene.at, 0.0, 0
    if scene.resume >= 0:
        here = of[scene.resume]
        passed = [of[plant] for plant in scene.trail.tolist() if of[plant] != here]
        ahead = -1 if passed and passed[-1] > here else 1
        position = here + ahead * every
    while skipped < 4 * len(stations):
        if not 0 <= position < len(stations):
            # of the last N the least recently visited, else the nearest to the end
            places = range(len(stations))[::-1] if ahead > 0 else range(len(stations))
            position = min(places[:every], key=lambda place: last[stations[place][0]])
            ahead = -ahead
        wanted = [plant for plant in stations[position] if last[plant] != scene.day]
        skipped = 0 if wanted else skipped + 1
        while wanted:  # who stands on the robot's side first
            plant = min(wanted, key=lambda one: at < 0 or side[one] != side[at])
            wanted.remove(plant)
            arrive_s = now_s + travel_s(travel, scene.clock, at, plant)
            home_s = travel_s(travel, scene.clock, plant, -1) if robot.returns else 0.0
            if arrive_s + robot.visit_s + home_s > scene.seconds_left:
                return stops
            stops.append((plant, arrive_s))
            last[plant], at, now_s = scene.day, plant, arrive_s + robot.visit_s
        position += ahead * every
    return stops


@pytest.mark.parametrize("sampler", [Snake, Neighbor])
@pytest.mark.parametrize("every", [1, 2, 3, 11])
@pytest.mark.parametrize("seed", range(8))
def test_every_stop_of_a_sweep_follows_from_its_words(sampler, every, seed):
    """Begun anew or resumed either way, some inspected today, with too little time or enough."""
    rng = np.random.default_rng([seed, every])
    grid = rectangle(2 + seed % 2, 3, Planting(faces=2, outer_faces=seed % 3 > 0))
    n = len(grid)
    scene = scene_on(grid, hours=float(rng.choice([0.06, 0.15, 2.0])), seed=seed)
    last = rng.choice([NEVER, 0, 1, 2, 3], n).astype(np.int32)
    trail = rng.permutation(n)[: rng.integers(0, 4)].astype(np.int32)
    at = int(rng.choice([-1, rng.integers(n)]))
    scene = replace(scene, last_inspected=last, day=3, trail=trail, at=at)
    work = plan_work(scene, sampler(every))
    stations = stations_told(grid, both_sides=sampler is Neighbor)
    stops = sweep_told(scene, stations, every)
    assert work.plant.tolist() == [plant for plant, _ in stops]
    assert work.arrive_s == pytest.approx([arrive_s for _, arrive_s in stops])


@pytest.mark.parametrize("sampler", [SnakeRandom(), NeighborRandom()])
def test_steps_drawn_go_ahead_to_the_end_of_the_plot_and_back(sampler):
    """Each station is one to four beyond the last in the direction of the sweep, until it turns."""
    grid = rectangle(3, 6, Planting(faces=2))
    stations = stations_told(grid, both_sides=isinstance(sampler, NeighborRandom))
    of = {plant: k for k, station in enumerate(stations) for plant in station}
    taken = set()
    for key in range(20):
        _, work = day(sampler, hours=0.3, grid=grid, key=np.uint64(key))
        places = list(dict.fromkeys(of[plant] for plant in work.plant.tolist()))
        steps = np.diff(places)
        ahead = steps[: np.argmax(steps < 0)] if (steps < 0).any() else steps
        assert places[0] == 0
        assert set(ahead.tolist()) <= {1, 2, 3, 4}
        taken |= set(ahead.tolist())
    assert taken == {1, 2, 3, 4}


def test_the_share_drawn_is_one_nth_and_ends_with_the_plot():
    grid = rectangle(3, 5)
    for every, n_drawn in ((1, 15), (4, 3), (40, 1)):
        scene, work = day(RandomShare(every), grid=grid, key=np.uint64(every))
        assert len(work) == n_drawn
        places = [grid.snake.tolist().index(plant) for plant in work.plant]
        assert places == sorted(places)
        # what was drawn and seen already is not replaced, and what begins late begins anew
        last = scene.last_inspected.copy()
        last[work.plant[:1]] = scene.day
        later = replace(scene, last_inspected=last, at=int(work.plant[0]), trail=work.plant[:1])
        assert plan_work(later, RandomShare(every)).plant.tolist() == work.plant[1:].tolist()


@given(field=crooked_fields())
def test_a_station_is_who_faces_one_place_of_an_aisle_and_aisles_go_up_and_down_in_turn(field):
    try:
        grid = lay(field, Planting(faces=2))
    except PlotError:
        assume(False)
    lanes = np.unique(np.round(grid.lane_y_m, 3)).tolist()
    stations = {}
    for plant in np.argsort(grid.side[grid.row], kind="stable").tolist():
        row = grid.row[plant]
        aisle = lanes.index(round(float(grid.lane_y_m[row]), 3))
        way = -1 if aisle % 2 else 1
        nth = np.floor((grid.along_m[plant] - grid.along_m.min()) / grid.plant_spacing_m + 0.5)
        begins_m = grid.lane_x_m[grid.corridor == grid.corridor[row], 0].min()
        at = aisle, way * begins_m, grid.corridor[row], way * nth
        stations.setdefault(at, []).append(plant)
    told = [stations[at] for at in sorted(stations)]
    found = _face_to_face(grid)
    parts = np.split(found.plant, found.start[1:-1])
    assert [sorted(one.tolist()) for one in parts] == [sorted(one) for one in told]
    assert found.of[found.plant].tolist() == np.repeat(range(len(told)), [*map(len, told)]).tolist()


@pytest.mark.parametrize("every", [10**30, 10_000_001, 0, 1.5, "2", True, None])
def test_a_step_that_no_plot_has_is_refused(every):
    with pytest.raises(SettingError, match="'every' must be"):
        Snake(every)
