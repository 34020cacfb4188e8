"""The last days of a season, and which day is meant where none is named."""

from fieldmon.monitoring.estimates.last_days import (
    default_date,
    last_date,
    last_recorded,
    recorded_ahead,
)
from tests.monitoring.seasons import BEGINS, clock_on, on, some_results


def test_the_day_that_is_meant_is_the_last_one_but_today_at_most(season, monkeypatch):
    clock_on(monkeypatch, 3)
    assert last_date(season) == last_recorded(season) == default_date(season) == BEGINS
    season.record(some_results(season, n=2, day=1), "x")
    season.plan(on(2))
    assert (last_date(season), last_recorded(season)) == (on(2), on(1))
    assert (default_date(season), recorded_ahead(season)) == (on(2), None)
    season.record(some_results(season, n=2, day=5), "a slip in the date")
    assert (last_date(season), default_date(season)) == (on(5), on(3))
    assert recorded_ahead(season) == last_recorded(season) == on(5)
    clock_on(monkeypatch, -4)  # before the season began
    assert default_date(season) == on(5)
