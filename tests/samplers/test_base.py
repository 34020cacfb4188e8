"""All that a sampler may know, and what it answers."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE
from fieldmon.samplers.base import NEVER, InspectionTimes, Sampler, Stops, resting_place
from tests.scenes import GRIDS, scene_on

SCENE = scene_on(GRIDS["rectangle"], hours=2.0)
TRAIL = np.array([4, 9, 30], np.int32)


@pytest.mark.parametrize(
    ("returns", "trail", "place"),
    [(True, TRAIL, GATE), (True, TRAIL[:0], GATE), (False, TRAIL, 30), (False, TRAIL[:0], GATE)],
)
def test_a_robot_rests_at_the_gate_or_where_its_last_day_ended(returns, trail, place):
    assert resting_place(Robot(returns=returns), trail) == place


def test_a_sweep_goes_on_after_the_plant_it_stands_at_or_the_last_one_of_before():
    assert SCENE.resume == NEVER
    assert replace(SCENE, trail=TRAIL).resume == 30
    assert replace(SCENE, trail=TRAIL, at=7).resume == 7
    assert replace(SCENE, trail=TRAIL, at=GATE).resume == 30


@pytest.mark.parametrize("hours", [0.0, 0.01, 0.5, 2.0, 24.0])
@pytest.mark.parametrize("stop_s", [10.0, 40.0])
def test_there_is_room_for_every_stop_that_fits_and_no_more_than_there_are_plants(hours, stop_s):
    scene = replace(SCENE, seconds_left=3600 * hours)
    room = scene.room(stop_s)
    # the k-th stop begins when k - 1 are done: driving takes no time at best
    fitting = min(sum(k * stop_s <= scene.seconds_left for k in range(200)), len(scene.grid))
    assert len(room.plant) == len(room.arrive_s) == fitting
    assert (room.plant.dtype, room.arrive_s.dtype) == (np.int32, np.float64)


def test_a_walk_is_handed_the_plot_the_clock_its_own_arrays_and_room_and_its_stops_come_back():
    handed = []

    def walk(travel, clock, one, other, stops):
        handed.extend((travel, clock, one, other))
        stops.plant[:2], stops.arrive_s[:2] = (5, 6), (1.0, 2.0)
        return 2

    stops = SCENE.walked(walk, "one", "other")
    assert stops.plant.tolist() == [5, 6]
    assert stops.arrive_s.tolist() == [1.0, 2.0]
    assert stops.time is None
    assert handed[0] is SCENE.aisles.travel
    assert handed[1] == SCENE.clock
    assert handed[2:] == ["one", "other"]


def test_the_clock_has_what_is_left_of_the_day_and_not_the_hours():
    later = replace(SCENE, seconds_left=77.0)
    assert later.clock.seconds_left == 77.0
    assert later.clock.visit_s == SCENE.robot.visit_s
    assert SCENE.clock.seconds_left == 7200.0


class Idle(Sampler):
    """A sampler of one's own, which stays at home."""

    def walk(self, scene, would_find):  # noqa: ARG002
        return Stops(np.empty(0, np.int32), np.empty(0))


def test_a_sampler_of_ones_own_has_the_robots_inspection_time_and_hears_chances():
    robot = Robot(look_s=20, stop_s=3)
    times = Idle().inspection_times(robot)
    assert times.stop_s.tolist() == [robot.visit_s]
    assert times.detects.tolist() == [robot.detects]
    assert Idle.reads_chance


def test_what_a_sampler_meets_says_itself_in_a_line():
    stops = Idle().walk(SCENE, None)
    assert repr(stops) == "<Stops: 0 plants>"
    assert repr(SCENE) == "<Scene of day 0: 187 plants in 11 rows, 2.00 h left>"
    times = InspectionTimes(np.array([20.0, 40.0]), np.array([0.5, 0.84]))
    assert repr(times) == "<InspectionTimes: 20 s 50%, 40 s 84%>"


@pytest.mark.parametrize("wrong", [200, 10_000_000, -2, 1.0, None, np.arange(2), "7", True])
def test_travel_to_what_is_no_plant_is_a_sentence_with_the_plants_that_there_are(wrong):
    for legs in ((wrong, 0), (0, wrong)):
        with pytest.raises(SettingError, match=r"plants, 0 to 186, and the gate, -1, but one is"):
            SCENE.travel_s(*legs)
    assert SCENE.travel_s(np.int64(186), GATE) == SCENE.travel_s(np.int32(186), -1) > 0
