"""What chapter 5 states and leaves open."""

from dataclasses import fields

import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.robot import Viewpoints
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.open_choices import OpenChoices, StartUp, side_of
from fieldmon.studies.thesis.chapter5.sites import square


def test_the_published_frame():
    assert [side_of(ha) ** 2 for ha in (1.0, 5.0, 10.0)] == [784, 4096, 8281]
    robot = OpenChoices().robot()
    assert (robot.hours, robot.look_s, robot.detects) == (12.0, 40.0, 0.84)
    assert robot.speed_m_s == pytest.approx(2.5 / 3.6)
    steps = {20.0: 0.5, 25.0: 0.6, 30.0: 0.69, 35.0: 0.77, 40.0: 0.84, 40.1: 0.9, 300.0: 0.9}
    assert {s: Viewpoints().detection(s) for s in steps} == steps
    grid = square(1.0).grid
    assert (grid.row_spacing_m, grid.plant_spacing_m) == (4.0, 3.0)


def test_every_choice_is_said_once_with_the_group_it_is_in():
    said = CALIBRATED.sentences()
    alone = [one.name for one in fields(OpenChoices) if one.name not in ("start", "spread", "pest")]
    assert len(said) == len(alone) + len(fields(StartUp)) + len(fields(Spread))
    assert len(set(said)) == len(said)
    assert {"start share: 0.005", "spread to: all", "sources: left", "stop_s: 30"} <= set(said)


def test_the_robot_has_the_times_that_were_chosen():
    robot = OpenChoices(stop_s=11.0, row_change_s=77.0).robot(look_s=20.0, detection=0.4)
    assert (robot.stop_s, robot.row_change_s) == (11.0, 77.0)
    assert (robot.look_s, robot.detects) == (20.0, 0.4)


@pytest.mark.parametrize("bad", [{"sources": "some"}, {"counts": "mites"}, {"ends": "never"}])
def test_unknown_choices_are_refused(bad):
    with pytest.raises(SettingError):
        OpenChoices(**bad)


@pytest.mark.parametrize(
    "bad",
    [
        {"share": 0.0},
        {"share": 0.6},
        {"margin_share": 1.1},
        {"depth_m": 0.0},
        {"cluster_size": 0.5},
    ],
)
def test_impossible_starts_are_refused(bad):
    with pytest.raises(SettingError):
        StartUp(**bad)
