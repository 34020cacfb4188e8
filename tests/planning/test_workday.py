"""One working day: what an inspection would find, and when the day ends."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import coin_table
from fieldmon.planning.workday import draw_detections, plan_work, work_day
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import InspectionTimes, Sampler, Stops
from tests.scenes import GRIDS, charged_s, scene_on


def test_a_longer_inspection_finds_what_a_shorter_one_does_and_no_more_than_its_share():
    infested = np.ones(20_000, bool)
    detects = Adaptive(chooses_time=True).inspection_times(Robot()).detects
    first = draw_detections(infested, detects, np.uint64(5))
    for k, chance in enumerate(detects):
        assert np.mean((first > 0) & (first <= k + 1)) == pytest.approx(chance, abs=0.01)
    assert not draw_detections(~infested, detects, np.uint64(5)).any()


def test_what_is_found_follows_from_the_key_alone():
    infested = np.arange(500) % 3 == 0
    one, same, other = (
        draw_detections(infested, np.array([0.5]), np.uint64(key)) for key in (7, 7, 8)
    )
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)
    assert not one[~infested].any()


class Given(Sampler):
    """Goes where it is told, and looks there as long as it is told."""

    def __init__(self, plants, arrive_s, time):
        self.stops, self.seen = Stops(plants, arrive_s, time), []

    def inspection_times(self, robot):
        return InspectionTimes(robot.visit_s * np.array([0.5, 1.0, 3.0]), np.array([0.2, 0.5, 0.9]))

    def walk(self, scene, would_find):
        self.seen.append((scene, would_find))
        return self.stops


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("timed", [True, False])
def test_a_day_finds_what_each_look_was_long_enough_for_and_takes_what_all_looks_take(
    seed, returns, timed
):
    rng = np.random.default_rng(seed)
    scene = scene_on(GRIDS["rectangle"], seed=seed)
    scene = replace(scene, robot=replace(scene.robot, returns=returns))
    plants = rng.permutation(len(scene.grid))[:40].astype(np.int32)
    time = rng.integers(0, 3, 40).astype(np.uint8) if timed else None
    would_find = rng.integers(0, 4, len(scene.grid)).astype(np.uint8)
    day = Given(plants, np.cumsum(rng.uniform(60, 90, 40)), time)
    work = work_day(scene, day, would_find)
    looks = [int(k) for k in (np.zeros(40) if time is None else time)]
    # from its first look that finds on, counted from 1, every longer one does
    finds = [1 <= would_find[plant] <= look + 1 for plant, look in zip(plants, looks, strict=True)]
    assert work.found.tolist() == finds
    assert work.stop_s.tolist() == [(0.5, 1.0, 3.0)[k] * scene.robot.visit_s for k in looks]
    assert work.detects.tolist() == [(0.2, 0.5, 0.9)[k] for k in looks]
    assert (work.plant is plants, work.wait_s) == (True, None)
    home_s = charged_s(scene, int(plants[-1]), GATE) if returns else 0.0
    assert work.end_s == pytest.approx(work.arrive_s[-1] + work.stop_s[-1] + home_s)
    found = f"{sum(finds)} find" if sum(finds) == 1 else f"{sum(finds)} finds"
    assert repr(work) == f"<Workday: 40 plants inspected, {found}, {work.end_s / 3600:.2f} h>"


def test_a_day_without_stops_ends_as_it_begins():
    scene = scene_on(GRIDS["rectangle"], seed=1)
    nothing = Given(np.empty(0, np.int32), np.empty(0), None)
    work = work_day(scene, nothing, np.ones(len(scene.grid), bool))
    assert (len(work), work.end_s) == (0, 0.0)


def test_a_plan_supposes_that_nothing_is_found_and_says_so_to_who_decides():
    scene = scene_on(GRIDS["rectangle"], seed=1)
    day = Given(np.array([4], np.int32), np.array([50.0]), None)
    work = plan_work(scene, day)
    ((told, would_find),) = day.seen
    assert told.supposed
    assert not scene.supposed
    assert not would_find.any()
    assert len(would_find) == len(scene.grid)
    assert not work.found.any()
    assert all(getattr(told, name) is getattr(scene, name) for name in vars(scene)
               if name not in ("supposed", "clock"))  # fmt: skip


@pytest.mark.parametrize("key", [0, 3, 2**63])
def test_what_an_inspection_would_find_hangs_on_the_plant_s_own_coin(key):
    """The first look whose chance is above it finds what is there."""
    infested = np.random.default_rng(1).random(300) < 0.7
    detects = np.array([0.1, 0.45, 0.9])
    first = draw_detections(infested, detects, np.uint64(key))
    for plant, coin in enumerate(coin_table(np.uint64(key), 300).tolist()):
        looks = [k for k, chance in enumerate(detects, 1) if infested[plant] and coin < chance]
        assert first[plant] == (looks[0] if looks else 0)
