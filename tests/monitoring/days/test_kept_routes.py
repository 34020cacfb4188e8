"""Routes in a season's file: a revision a change, and the stops of the last one."""

from datetime import date, datetime, time, timedelta

import numpy as np
import pyogrio
import pytest
import shapely

from fieldmon.monitoring import Season
from fieldmon.monitoring.days import kept_routes
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.planning.members import TeamMember
from fieldmon.plot.robot import Robot
from tests.monitoring.seasons import BEGINS, ROBOT, a_plot, a_season, some_results


@pytest.fixture
def season(path):
    return Season(path)


def rows(season, sql):
    with season.store.reading() as db:
        return db.execute(sql).fetchall()


def test_a_route_begins_with_the_work_or_half_way(season):
    fresh = season.plan(BEGINS + timedelta(days=1), keep=False)
    assert fresh.route.notes.start == datetime.fromisoformat("2026-04-07T06:00")
    rest = season.plan(BEGINS + timedelta(days=1), time(7, 20), keep=False)
    assert rest.route.notes.start == datetime.fromisoformat("2026-04-07T07:20")


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
    begin = today.route.notes.start
    at = begin + timedelta(seconds=round(arrive_s[3]))
    assert datetime.fromisoformat(arrive[3]) == at


def test_stops_after_clocks_are_put_forward_are_kept_and_reported_as_they_show(tmp_path):
    on = date(2027, 3, 26)
    settings = MonitoringSettings(on, robot=Robot(hours=1.0), starts=time(1, 30))
    season = Season.create(tmp_path / "spring.gpkg", a_plot(), None, settings)
    route = season.plan(on).route
    begin = route.notes.start
    assert {at[11:13] for (at,) in rows(season, "SELECT arrive FROM stops")} == {"01", "03"}
    rest = season.plan(on, time(3, 10), keep=False)
    assert (rest.scene.seconds_left, rest.route.notes.start) == (
        1200.0,
        begin.replace(hour=3, minute=10),
    )


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


def test_each_field_of_a_kept_route_and_of_its_stops_is_what_the_route_says(season):
    season.plan(BEGINS)
    today = season.plan(BEGINS)
    route, grid, numbered = today.route, season.plot.grid, season.plant_numbers
    kept = season.path.with_name("read.gpkg")
    season.store.back_up(kept)
    frame = pyogrio.read_dataframe(kept, layer="routes").set_index("revision").loc[2]
    begin = today.route.notes.start
    assert frame.drop("geometry").to_dict() == {
        "day": 0, "date": frame["date"], "sampler": season.settings.sampler,
        "starts": begin.isoformat(), "seconds": route.end_s, "drive_m": route.drive_m,
        "stops": len(route), "expected": route.expected_visible, "at_plant": today.scene.at,
        "seconds_left": today.scene.seconds_left, "digest": frame["digest"], "who": "",
    }  # fmt: skip
    assert str(frame["date"])[:10] == str(BEGINS)
    assert shapely.get_coordinates(frame["geometry"]) == pytest.approx(route.line_lonlat())
    assert today.scene.at >= 0
    assert today.scene.seconds_left < season.settings.robot.day_s
    stops = pyogrio.read_dataframe(kept, layer="stops")
    stops = stops[stops["route"] == 2]
    plants = route.plant
    assert stops.get_coordinates().to_numpy() == pytest.approx(grid.lonlat()[plants])
    for name, values in (
        ("stop", range(1, len(route) + 1)), ("plant", plants), ("line", numbered.line[plants]),
        ("number", numbered.number[plants]), ("arrive_s", route.arrive_s), ("chance", route.chance),
    ):  # fmt: skip
        assert stops[name].tolist() == list(values), name
    clock = [(begin + timedelta(seconds=round(s))).isoformat() for s in route.arrive_s.tolist()]
    assert stops["arrive"].tolist() == clock


def test_the_route_of_one_of_a_team_begins_when_that_one_does(tmp_path):
    team = (TeamMember("Ann", ROBOT), TeamMember("Ben", ROBOT, None, 1800.0))
    season = a_season(tmp_path / "team.gpkg", team=team)
    days = season.plan_each(BEGINS)
    starts = dict(rows(season, "SELECT who, starts FROM routes"))
    assert starts == {"Ann": "2026-04-06T06:00:00", "Ben": "2026-04-06T06:30:00"}
    for today, name in zip(days, ("Ann", "Ben"), strict=True):
        assert season.kept_route(BEGINS, name).tolist() == today.route.plant.tolist()
        with season.store.reading() as db:
            assert kept_routes.is_kept(db, today, name)
            assert not kept_routes.is_kept(db, today, "")


def test_all_plans_of_a_day_are_told_with_the_last_apart(season):
    rest = season.plan(BEGINS)
    with season.store.reading() as db:
        (kept,) = kept_routes.of_day(db, 0)
        assert kept_routes.of_day(db, 1) == []
    assert kept.last.tolist() == rest.route.plant.tolist()
    assert {*kept.last} < {*kept.of_all}
    assert kept.hours() <= ROBOT.hours
