"""What was chosen for a season earlier: by what its days were worked, what counted before."""

from dataclasses import replace
from datetime import time, timedelta

import pytest

from fieldmon.monitoring import Season
from fieldmon.monitoring.changes.earlier_settings import settings_on, was_changed
from tests.monitoring.seasons import BEGINS, some_results


def test_a_day_worked_before_a_change_keeps_who_worked_when_and_who_chose(season):
    first = season.settings
    season.plan(BEGINS)
    season.record(some_results(season))
    later = first.robot.with_hours(6.0)
    season.change(
        replace(first, robot=later, starts=time(9), sampler="naive", harvest=BEGINS), first
    )
    assert was_changed(season)
    then = settings_on(season, BEGINS)
    assert then == replace(first, harvest=BEGINS)  # what is not of the work is of now
    tomorrow = BEGINS + timedelta(days=1)
    assert settings_on(season, tomorrow) == season.settings  # neither planned nor recorded
    season.plan(BEGINS)  # once more, of a day that is past
    season.record(some_results(season, n=2))
    assert settings_on(season, BEGINS).robot == first.robot


@pytest.mark.parametrize("planned", [True, False])
def test_a_day_worked_in_one_copy_was_not_worked_by_what_another_chose(season, tmp_path, planned):
    first = season.settings
    season.store.back_up(tmp_path / "copy.gpkg")
    other = Season(tmp_path / "copy.gpkg")
    other.change(replace(first, robot=first.robot.with_hours(4.0)), first)
    if planned:
        season.plan(BEGINS)
    season.record(some_results(season))
    for one, copy in ((season, other), (other, season)):
        one.merge(copy)
        assert one.settings.robot.hours == 4.0
        assert settings_on(one, BEGINS).robot == first.robot


def test_a_day_recorded_without_a_plan_was_worked_by_what_counted_at_first(season):
    first = season.settings
    season.record(some_results(season, n=2))
    season.change(replace(first, starts=time(9)), first)
    season.record(some_results(season, n=4))
    assert settings_on(season, BEGINS).starts == first.starts
