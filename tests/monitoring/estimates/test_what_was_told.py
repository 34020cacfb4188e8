"""What a season is told: what inspections detect, and what an earlier season knew."""

from dataclasses import replace

from fieldmon.monitoring.estimates.what_was_told import detection_of, earlier_season_note
from fieldmon.planning.members import TeamMember
from tests.monitoring.seasons import BEGINS, ROBOT


def test_each_of_a_team_detects_what_is_said_of_them_and_others_what_the_robot_does(season):
    assert earlier_season_note(season) is None
    assert detection_of(season, BEGINS) == ROBOT.detects
    first, dull = season.settings, TeamMember("Ann", replace(ROBOT, detection=0.5))
    season.change(replace(first, team=(dull,)), first)
    assert detection_of(season, BEGINS, "ann") == 0.5
    assert detection_of(season, BEGINS, "Zoë") == ROBOT.detects
