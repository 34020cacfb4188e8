"""Who inspects is as it is said, and else as usual."""

import pytest

from fieldmon.cli.worker_options import TeamworkOptions, WorkerOptions
from fieldmon.errors import SettingError
from fieldmon.planning.members import Teamwork
from fieldmon.plot.robot import Robot, scout


def test_a_worker_is_the_robot_or_the_scout_but_for_what_is_said():
    assert WorkerOptions().robot() == Robot()
    assert WorkerOptions(scout=True).robot() == scout()
    said = WorkerOptions(hours=3.0, speed=7.2, turn=0.0).robot()
    assert (said.hours, said.speed_m_s, said.turn_180_s) == (3.0, 2.0, 0.0)
    assert said.look_s == Robot().look_s


def test_nobody_is_a_scout_and_a_rover():
    with pytest.raises(SettingError, match="one of --scout and --rover"):
        WorkerOptions(scout=True, rover=True).robot()


def test_how_a_team_works_together_is_not_said_of_one_alone():
    with pytest.raises(SettingError, match="--least-gain goes with a team"):
        TeamworkOptions(least_gain=1.0).said_of(Teamwork(), ())
