"""A team as a table states it, and back."""

from dataclasses import replace
from datetime import time

import pytest

import fieldmon as fm
from fieldmon.io.readers.team import team_of_table
from fieldmon.io.writers.team import team_csv
from fieldmon.planning.stated_team import stated_team, team_stated

TEAM = (
    fm.TeamMember("Ann", fm.scout(hours=2.5, detection=0.4), (35.15, 30.36), 5400.0),
    fm.TeamMember("wide", fm.Robot(width_m=0.6, length_m=0.9, turning_radius_m=1.2)),
    fm.TeamMember("slow", replace(fm.Robot().with_times("thesis"), speed_m_s=0.123)),
)


def back(team, starts=time(6, 5)):
    """Return the team that the table of a team states, and when its day begins."""
    written = team_csv(stated_team(team, starts))
    return team_stated(team_of_table(written, "team.csv"), time(9))


def test_a_team_is_the_same_after_its_table():
    assert back(TEAM) == (TEAM, time(6, 5))


def test_who_sees_by_seconds_of_their_own_finds_as_much_after_the_table():
    eyes = fm.Viewpoints(steps=((10.0, 0.3),), longer=0.5)
    ((read,), _) = back([fm.TeamMember("Ann", fm.scout(viewpoints=eyes))])
    assert read.robot.detects == 0.5


@pytest.mark.parametrize(
    ("robot", "starts_s"),
    [(fm.Robot(returns=False), 0.0), (fm.Robot(), 30.0), (fm.Robot(), 20 * 3600.0)],
)
def test_what_a_table_has_no_column_for_is_refused(robot, starts_s):
    with pytest.raises(fm.SettingError, match="cannot say all of Bo"):
        stated_team([fm.TeamMember("Bo", robot, starts_s=starts_s)], time(6))


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("Ann,\nann ,\n", "line 3: members of a team must have names of their own.*line 2 too"),
        ("Ann,25:00\n", "line 2: start must be a time as HH:MM, but it is '25:00'"),
        (
            "".join(f"r{k},\n" for k in range(1001)),
            "1000 members at most, but their number is 1001",
        ),
    ],
)
def test_a_table_of_no_team_says_where(lines, said):
    stated = team_of_table(f"name,start\n{lines}".encode(), "team.csv")
    with pytest.raises(fm.SettingError, match=said):
        team_stated(stated, time(6))
