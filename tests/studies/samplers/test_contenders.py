"""Who takes part, and the bounds."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.samplers.sweeps import Naive
from fieldmon.studies.samplers.contenders import (
    CLAIRVOYANT,
    CONTENDERS,
    NAMES,
    Misinformed,
    Oracle,
    added,
)

AISLES = Aisles.of(rectangle(12, 12))
N = 144


def scene(robot, chance=0.01):
    robot = robot.with_times("thesis")  # as studies charge
    return Scene(
        AISLES, robot, np.full(N, chance), np.full(N, NEVER, np.int32), seconds_left=robot.day_s
    )


def test_names_are_unique_and_end_with_the_clairvoyant():
    assert len(set(NAMES)) == len(NAMES) == len(CONTENDERS) + 1
    assert NAMES[-1] == CLAIRVOYANT


def test_a_sampler_of_ones_own_is_added_under_a_name_that_is_free(tmp_path):
    file = tmp_path / "own.py"
    file.write_text("from fieldmon.samplers.sweeps import Naive\nnaive = Mine = Naive\n")
    own = f"{file}:Mine"
    assert [one.label for one in added(["naive", "snake", "snake"])] == ["snake"]
    (mine,) = added([own])
    assert mine.label == "Mine"
    assert mine.make() is not mine.make()
    file.write_text(f"{file.read_text()}# changed\n")
    assert added([own])[0].called != mine.called
    with pytest.raises(SettingError, match=r"than those compared, but .*:naive is called naive"):
        added([f"{file}:naive"])
    with pytest.raises(SettingError, match="must have different names, but they are Mine, Mine"):
        added([own, f"{tmp_path / 'other.py'}:Mine"])


def test_the_oracle_reaches_all_infested_plants_in_a_day_that_is_far_too_short_for_all():
    truth = np.zeros(N, np.bool_)
    truth[[17, 60, 61, 140]] = True
    robot = Robot(hours=0.5)
    stops = Oracle(truth).walk(scene(robot), truth)
    assert len(stops.plant) < N / 3
    assert set(np.flatnonzero(truth)) <= set(stops.plant.tolist())
    assert truth[Naive().walk(scene(robot), truth).plant].sum() < 4


def test_the_oracle_hears_of_a_new_morning():
    oracle = Oracle(np.zeros(N, np.bool_))
    oracle.truth = np.arange(N) == 100
    stops = oracle.walk(scene(Robot(hours=0.2)), oracle.truth)
    assert len(stops.plant) < N / 10
    assert 100 in stops.plant


def test_the_misinformed_choose_among_times_as_who_is_not():
    robot, own = Robot(hours=1.0), sampler("adaptive-looks")
    times = Misinformed(own).inspection_times(robot)
    assert len(times.stop_s) == len(own.inspection_times(robot).stop_s) > 1


def test_the_misinformed_decide_as_if_the_robot_saw_as_the_thesiss_does():
    seen = []

    class Listens:
        def walk(self, scene, would_find):
            seen.append(scene.robot)
            return Naive().walk(scene, would_find)

    poor, nothing = Robot(hours=1.0, detection=0.5).with_times("thesis"), np.zeros(N, np.bool_)
    told = Misinformed(Listens()).walk(scene(poor), nothing)
    assert seen == [replace(poor, detection=Robot().detects)]
    assert (told.plant == Naive().walk(scene(poor), nothing).plant).all()
    wrong = Misinformed(Adaptive()).walk(scene(poor), nothing)
    right = Adaptive().walk(scene(replace(poor, detection=Robot().detects)), nothing)
    assert (wrong.plant[: len(right.plant)] == right.plant[: len(wrong.plant)]).all()
