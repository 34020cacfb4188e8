"""Robots and scouts: the numbers that cost time and find insects."""

from dataclasses import replace

import pytest

from fieldmon.errors import SettingError
from fieldmon.plot.robot import Robot, Viewpoints, rover, scout


@pytest.mark.parametrize(
    ("seconds", "chance"),
    [
        *[(0, 0), (19.9, 0), (20, 0.5), (24, 0.5), (25, 0.6), (30, 0.69), (35, 0.77), (40, 0.84)],
        *[(40.1, 0.9), (90, 0.9)],
    ],
)
def test_viewpoints_follow_the_table_of_the_thesis(seconds, chance):
    assert Viewpoints().detection(seconds) == chance


def test_the_default_robot_is_that_of_the_thesis_charged_as_simulated_drives_took():
    robot = Robot()
    assert (robot.row_change_s, robot.turn_180_s, robot.stop_s) == (9.0, 0.0, 1.13)
    assert (robot.speed_m_s * 3.6, robot.hours, robot.look_s) == (2.5, 12, 40)
    assert robot.detects == 0.84
    assert robot.day_s == 43_200


def test_a_detection_given_by_hand_wins_over_the_table():
    assert Robot(detection=0.4).detects == 0.4


def test_a_scout_is_a_robot_with_other_numbers():
    assert isinstance(scout(), Robot)
    assert scout().speed_m_s > Robot().speed_m_s
    assert scout(hours=2, look_s=60) == replace(scout(), hours=2, look_s=60)
    assert rover(hours=2) == replace(rover(), hours=2)
    with pytest.raises(SettingError, match="hours"):
        scout(hours=25)


def test_a_scout_walks_whatever_the_numbers_and_is_charged_no_robot_s():
    assert replace(scout(stop_s=8, turn_180_s=0).with_hours(7), look_s=50.0).on_foot
    assert not Robot().on_foot
    assert not Robot(row_change_s=3, turn_180_s=2, stop_s=5).on_foot
    with pytest.raises(SettingError, match="A scout has times of its own"):
        scout().with_times("thesis")


@pytest.mark.parametrize(
    ("setting", "value"),
    [
        ("speed_m_s", 0),
        ("look_s", -1),
        ("hours", 0),
        ("hours", 25),
        ("speed_m_s", 30.1),
        ("speed_m_s", 200),
        ("row_change_s", -1),
        ("turn_180_s", float("nan")),
        ("stop_s", float("inf")),
        ("detection", 1.5),
    ],
)
def test_an_impossible_number_is_refused_by_name(setting, value):
    with pytest.raises(SettingError, match=f"{setting} must be .*(not|it is) {value}"):
        Robot(**{setting: value})


@pytest.mark.parametrize(
    "steps", [(), ((20, 0.5), (20, 0.6)), ((20, 0.5), (30, 0.4)), ((0, 0.5),), ((20, -0.1),)]
)
def test_viewpoints_must_rise(steps):
    with pytest.raises(SettingError, match="both rising"):
        Viewpoints(steps)


def test_steps_given_as_a_list_are_not_changed_later_and_have_a_hash_as_all_settings():
    steps = [(10.0, 0.4), (20.0, 0.7)]
    seen_by = Viewpoints(steps)
    steps[1] = (20.0, 3.0)
    assert seen_by == Viewpoints(((10.0, 0.4), (20.0, 0.7)))
    assert len({Robot(viewpoints=seen_by), Robot(viewpoints=seen_by)}) == 1


def test_no_chance_is_above_one():
    with pytest.raises(SettingError, match=r"in 0\.\.1"):
        Viewpoints(longer=1.2)


def test_times_have_names_and_others_have_none():
    assert Robot().times == rover().times == "measured"
    thesis = Robot().with_times("thesis")
    assert (thesis.row_change_s, thesis.turn_180_s, thesis.stop_s) == (25.0, 23.0, 0.0)
    assert thesis.times == "thesis"
    assert thesis.with_times("measured") == Robot()
    assert Robot(row_change_s=12.0).times is None
    with pytest.raises(SettingError, match="measured or thesis, but they are 'quick'"):
        Robot().with_times("quick")
