"""A season's file is read anew whenever it changed, whoever changed it."""

import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace

import pytest

from fieldmon.infestation.insects.spread import Spread
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.plot.robot import Robot
from tests.monitoring.seasons import BEGINS, a_season, a_small_plot, on, some_results, three_results

#: the first of some plants of the small plot that none of its routes came to
NOBODYS = 50
#: the last day of the season of two weeks
LAST = 12


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


def layers(season):
    """Return what follows from the causes, as the file says it, without the numbers of rows."""
    wanted = {
        "days": "day, date, inspected, found, expected_left, low, high, chance_clean, digest, "
        "causes",
        "plant_state": "fid, chance, state, last_inspected, hot_spot",
        "hot_spots": "geom, spot, found, inspected, plants, expected, p, q",
        "learnt": "name, value, low, high",
        "mornings": "day, causes, content, chances",
    }
    with season.store.reading() as db:
        return {
            table: db.execute(f"SELECT {names} FROM {table} ORDER BY 1").fetchall()  # noqa: S608
            for table, names in wanted.items()
        }


@pytest.fixture(scope="module")
def long_season(tmp_path_factory):
    """Make a season of two weeks, once; return its file."""
    season = a_season(tmp_path_factory.mktemp("two_weeks") / "season.gpkg", a_small_plot())
    for day in range(0, LAST + 1, 3):
        season.record(some_results(season, day=day, found=[day % 5]), f"day {day}")
    return season.path


@pytest.fixture
def two_weeks(long_season, tmp_path):
    """Return a season of two weeks that is open, as whoever recorded it has it."""
    season = Season(shutil.copy(long_season, tmp_path / "season.gpkg"))
    season.status(on(LAST + 1))
    return season


@pytest.fixture
def nights(monkeypatch):
    """Count the nights that are worked out."""
    worked, night = [], History.night_after
    monkeypatch.setattr(
        History, "night_after", lambda *given: (worked.append(given[-1]), night(*given))[1]
    )
    return worked


def as_if_all_was_worked_out_again(season):
    made = layers(season)
    with season.store.writing() as db:  # nor is any morning taken from the file
        db.execute("DELETE FROM mornings")
    season = Season(season.path)
    season.rebuild()
    return layers(season) == made


def test_hours_and_samplers_change_no_morning_and_none_is_worked_out(two_weeks, nights):
    season = Season(two_weeks.path)
    seen = season.settings
    season.change(replace(seen, robot=Robot(hours=3), sampler="naive"), seen)
    season.undo_change()
    assert nights == []
    assert as_if_all_was_worked_out_again(season)


def test_another_spread_changes_all_mornings(two_weeks, nights):
    season = Season(two_weeks.path)
    seen = season.settings
    faster = BeliefSettings(Spread(rate_per_day=0.05))
    season.change(replace(seen, belief=faster), seen)
    assert set(nights) == set(range(LAST))
    assert as_if_all_was_worked_out_again(season)


def test_a_copy_with_results_of_the_last_day_changes_only_that_one(two_weeks, nights, tmp_path):
    copy = Season(shutil.copy(two_weeks.path, tmp_path / "copy.gpkg"))
    copy.record(three_results(LAST, NOBODYS), "the copy's")
    nights.clear()
    season = Season(two_weeks.path)
    assert season.merge(copy).new == 3
    assert nights == []
    assert as_if_all_was_worked_out_again(season)


@pytest.mark.parametrize("day", [0, 7])
def test_a_copy_with_earlier_results_changes_every_day_after_them(two_weeks, tmp_path, day):
    copy = Season(shutil.copy(two_weeks.path, tmp_path / "copy.gpkg"))
    copy.record(three_results(day, NOBODYS), "the copy's")
    two_weeks.merge(copy)
    assert as_if_all_was_worked_out_again(two_weeks)


@pytest.mark.parametrize("treated", [False, True])
def test_planning_changes_no_morning_of_a_season_treated_or_not(two_weeks, nights, treated):
    if treated:
        two_weeks.treat(on(7), 0.5)
    season = Season(two_weeks.path)
    for day in range(LAST + 1):
        season.morning(on(day))
    nights.clear()
    assert len(season.plan(on(10)).route)  # a new one, which is kept
    season.morning(on(LAST))
    assert nights == []


def test_a_day_that_was_only_planned_in_a_copy_has_its_figures(two_weeks, tmp_path):
    copy = Season(shutil.copy(two_weeks.path, tmp_path / "copy.gpkg"))
    copy.plan(on(7))
    two_weeks.merge(copy)
    assert on(7) in [one.on for one in two_weeks.days()]
    assert as_if_all_was_worked_out_again(two_weeks)


@pytest.mark.parametrize("row", [1, 22])
def test_a_correction_changes_every_day_from_its_own_on(two_weeks, row):
    before = layers(two_weeks)
    with closing(sqlite3.connect(two_weeks.path)) as db:
        other = "CASE result WHEN 'found' THEN 'clean' ELSE 'found' END"
        db.execute(f"UPDATE inspections SET result = {other} WHERE fid = ?", (row,))  # noqa: S608
        db.commit()
    season = Season(two_weeks.path)
    assert season.correct("Ann") == 1
    assert layers(season) != before
    assert as_if_all_was_worked_out_again(season)
    season.undo()
    assert layers(season) == before


def test_a_correction_of_the_last_days_work_begins_at_its_morning(two_weeks, nights):
    """Though the next day is planned already: the days before it are not worked out again."""
    two_weeks.plan(on(LAST + 1))
    with closing(sqlite3.connect(two_weeks.path)) as db:
        last = "(SELECT max(fid) FROM inspections)"
        db.execute(f"UPDATE inspections SET count = 7, result = 'found' WHERE fid = {last}")  # noqa: S608
        db.commit()
    season = Season(two_weeks.path)
    nights.clear()
    assert season.correct("Ann") == 1
    assert nights == [LAST]
    assert as_if_all_was_worked_out_again(season)


def test_the_first_evening_is_worked_out_again_only_where_it_changed(two_weeks, monkeypatch):
    two_weeks.record(three_results(LAST, NOBODYS), "the layers are written")
    worked, evening = [], History._evening
    monkeypatch.setattr(
        History, "_evening", lambda *given: (worked.append(given[2]), evening(*given))[1]
    )
    two_weeks.record(three_results(LAST, NOBODYS + 3), "once more")
    assert set(worked) == {LAST}
    two_weeks.record(three_results(0, NOBODYS + 6), "of the first day")
    assert 0 in worked
    assert as_if_all_was_worked_out_again(two_weeks)


def test_inspections_alone_are_those_of_the_history_whoever_asks_first(two_weeks):
    first = Season(two_weeks.path)
    alone, known = first.inspections, first.history.inspections
    for one in (alone, first.inspections):
        for name in ("plant", "result", "date", "second", "count", "who", "notes"):
            assert getattr(one, name).tolist() == pytest.approx(
                getattr(known, name).tolist(), nan_ok=True
            )
    Season(two_weeks.path).record(three_results(LAST, NOBODYS), "another window")
    assert len(first.inspections) == len(known) + 3
