"""Routes in a season's file: a revision a change, and the stops of the last one."""

from datetime import datetime, time, timedelta

import numpy as np
import pytest

from fieldmon.monitoring import Season, routes
from tests.monitoring.seasons import BEGINS, some_results


@pytest.fixture
def season(path):
    return Season(path)


def rows(season, sql):
    with season.store.reading() as db:
        return db.execute(sql).fetchall()


def test_a_route_begins_with_the_work_or_half_way(season):
    fresh = season.plan(BEGINS + timedelta(days=1), keep=False)
    assert routes.begins(season.settings, fresh) == datetime.fromisoformat("2026-04-07T06:00")
    rest = season.plan(BEGINS + timedelta(days=1), time(7, 20), keep=False)
    assert routes.begins(season.settings, rest) == datetime.fromisoformat("2026-04-07T07:20")


def test_a_route_is_kept_once_and_any_other_as_the_next_revision(season):
    before = rows(season, "SELECT revision FROM routes WHERE day = 0")
    season.plan(BEGINS)
    after_work = rows(season, "SELECT revision FROM routes WHERE day = 0 ORDER BY fid")
    assert (before, after_work) == ([(1,)], [(1,), (2,)])
    season.plan(BEGINS)
    assert rows(season, "SELECT count(*) FROM routes") == [(2,)]
    assert season.store.path.is_file()


def test_stops_are_kept_in_order_with_their_times(season):
    today = season.plan(BEGINS)
    kept = rows(
        season,
        "SELECT stop, plant, arrive_s, arrive FROM stops WHERE route = 2 ORDER BY stop",
    )
    stop, plant, arrive_s, arrive = zip(*kept, strict=True)
    assert stop == tuple(range(1, len(today.route) + 1))
    assert list(plant) == today.route.plant.tolist()
    assert list(arrive_s) == today.route.arrive_s.tolist()
    begin = routes.begins(season.settings, today)
    at = begin + timedelta(seconds=round(arrive_s[3]))
    assert datetime.fromisoformat(arrive[3]) == at


def test_the_plants_of_the_latest_revision_are_given(season):
    assert season.kept_route(BEGINS + timedelta(days=9)).tolist() == []
    first = season.kept_route(BEGINS)
    second = season.plan(BEGINS).route.plant
    assert np.array_equal(season.kept_route(BEGINS), second)
    assert not np.array_equal(first, second)


def test_planning_without_keeping_leaves_the_file_alone(season):
    before = rows(season, "SELECT count(*) FROM routes"), season.revision
    season.plan(BEGINS, keep=False)
    assert (rows(season, "SELECT count(*) FROM routes"), season.revision) == before


def test_a_route_has_the_digest_that_season_files_hold(season):
    today = season.plan(BEGINS + timedelta(days=1))
    (again,) = rows(season, "SELECT digest FROM routes WHERE day = 1")
    season.record(some_results(season, n=2, day=1), "x")
    season.undo()
    assert np.array_equal(season.plan(BEGINS + timedelta(days=1)).route.plant, today.route.plant)
    assert rows(season, "SELECT digest FROM routes WHERE day = 1") == [again]
    assert len(again[0]) == 24
