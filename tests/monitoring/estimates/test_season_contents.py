"""What a season's file says at one moment, and the change of it within one transaction."""

from dataclasses import replace

import pytest

from fieldmon.monitoring.estimates.season_contents import SeasonChange, mean_told, newest_day
from fieldmon.planning.members import TeamMember
from tests.monitoring.seasons import BEGINS, ROBOT, on, some_results


def test_a_change_reaches_back_to_the_first_day_that_is_another():
    change = SeasonChange(None)
    assert change.since is None
    for day in (4, 2, 3):
        change.reaches(day)
    assert change.since == 2


def test_what_a_change_wrote_before_it_failed_is_not_kept(season):
    with pytest.raises(ValueError, match="nor the rest"), season.changing() as change:
        _empty_days_and_fail(change)
    with season.reading() as now:
        assert (newest_day(now.db), now.contents.settings) == (0, now.settings)


def _empty_days_and_fail(change):
    change.db.execute("DELETE FROM days")
    raise ValueError("nor the rest")


def test_what_is_read_is_of_its_moment_and_knows_the_day_recorded_before(season):
    season.record(some_results(season, n=2, day=1), "x")
    with season.reading() as now:
        contents = now.contents
    assert contents.recorded_before(on(0)) == []
    assert contents.recorded_before(on(3)) == [on(1)]
    assert (contents.morning(1).chance == season.morning(on(1))).all()
    assert contents.settings.begins == BEGINS


def test_a_team_that_finds_alike_is_told_exactly_that(season):
    robots = [replace(ROBOT, detection=0.7), replace(ROBOT, detection=0.9)]
    one, other = (TeamMember(name, robot) for name, robot in zip("ab", robots, strict=True))
    twin = replace(one, name="c")
    assert mean_told(replace(season.settings, team=(one, twin))) == 0.7
    assert mean_told(replace(season.settings, team=(one, other))) == pytest.approx(0.8)
