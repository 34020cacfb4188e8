"""A season's file is read anew whenever it changed, whoever changed it."""

from fieldmon.monitoring import Season
from tests.monitoring.seasons import (
    BEGINS,
    on,
    some_results,
)


def test_two_windows_see_each_others_work(season):
    other = Season(season.path)
    other.record(some_results(other, found=[0]), "other")
    assert season.status(BEGINS).found == 1
    season.record(some_results(season), "mine")
    assert len(other.history.inspections) == 10


def test_findings_that_come_late_change_every_day_after_them(season):
    for day in (0, 2, 4):
        season.record(some_results(season, day=day), f"day {day}")
    late = some_results(season, n=3, day=1, found=[0])
    season.record(late, "found in a drawer")
    assert season.verify() == ()
    with season.store.reading() as db:
        rows = db.execute("SELECT day, inspected, found FROM days ORDER BY day").fetchall()
    assert rows == [(0, 5, 0), (1, 3, 1), (2, 5, 0), (4, 5, 0)]


def test_nights_pass_on_days_on_which_nobody_works(season):
    season.record(some_results(season, found=[0]), "x")
    assert season.morning(on(5)).sum() > season.morning(on(1)).sum()
