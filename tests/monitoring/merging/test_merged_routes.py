"""Routes of two copies keep their order, and the last one given out counts."""

import shutil
from dataclasses import replace
from datetime import timedelta

import numpy as np

from fieldmon.infestation.inspections import CLEAN, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.days.day_ahead import WHOLE, DayAhead
from fieldmon.monitoring.settings.shift_work import ScoutCrew
from tests.monitoring.seasons import BEGINS


def test_routes_planned_in_both_copies_keep_their_order_and_the_last_one_counts(path, other):
    for file, plant in ((path, 40), (path, 41), (other, 50)):
        season = Season(file)
        season.record(Inspections.of(np.array([plant]), np.array([CLEAN]), np.datetime64(BEGINS)))
        season.plan(BEGINS)
    last = season.kept_route(BEGINS)
    plan = DayAhead.of(season, BEGINS).plan_of(WHOLE)
    merged, again = Season(path), Season(other)
    merged.merge(Season(other))
    again.merge(Season(path))
    with merged.store.reading() as db:
        routes = db.execute("SELECT day, revision, fid, stops FROM routes ORDER BY fid").fetchall()
        stops = dict(db.execute("SELECT route, count(*) FROM stops GROUP BY route").fetchall())
    assert [row[1] for row in routes] == [1, 2, 3, 4]  # of before, and of each copy
    assert all(stops[fid] == n for _, _, fid, n in routes)
    for one in (merged, again):
        np.testing.assert_array_equal(one.kept_route(BEGINS), last)
        assert DayAhead.of(one, BEGINS).plan_of(WHOLE) == plan  # a phone goes on by it


def test_a_copy_that_brings_nothing_leaves_the_routes_of_a_day_as_they_are(path, tmp_path):
    season = Season(path)
    first, on = season.settings, BEGINS + timedelta(days=4)
    for hours in (0.5, 1.0, 0.5):  # the first route is given out again after another
        before = season.settings
        season.change(replace(first, robot=first.robot.with_hours(hours)), before)
        season.plan(on)
    season.plan_each(BEGINS, crew=ScoutCrew(("Ann",)))  # after routes of a later day
    wanted = "SELECT fid, day, who, revision, digest FROM routes ORDER BY fid"
    with season.store.reading() as db:
        routes = db.execute(wanted).fetchall()
    kept = season.kept_route(on).tolist()
    season.merge(Season(shutil.copy(path, tmp_path / "same.gpkg")))
    with season.store.reading() as db:
        assert db.execute(wanted).fetchall() == routes
    assert season.kept_route(on).tolist() == kept
