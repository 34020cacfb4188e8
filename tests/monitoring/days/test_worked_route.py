"""The route of a day as it was worked: in the order of the times noted, else as recorded."""

from dataclasses import replace
from datetime import datetime, time, timedelta

import numpy as np
import pytest

from fieldmon.infestation.inspections import Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring.days.worked_route import day_was_worked, worked_route
from fieldmon.monitoring.settings.settings import seconds
from fieldmon.planning.members import TeamMember
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, driven_s
from tests.monitoring.seasons import BEGINS, a_season, clock_on, on

PLANTS = np.array([90, 5, 40])


def worked(path, second):
    season = a_season(path / "s.gpkg")
    on, clean = np.datetime64(BEGINS), np.zeros(len(PLANTS), np.int8)
    season.record(Inspections.of(PLANTS, clean, on, second=np.array(second)), "test")
    return season, worked_route(season, BEGINS)


def test_times_noted_set_the_order_and_the_clock(tmp_path):
    season, route = worked(tmp_path, [25_200.0, 21_660.0, 28_800.0])
    assert route.plant.tolist() == [5, 90, 40]
    begins = seconds(season.settings.starts)
    assert route.leave_s.tolist() == [21_660.0 - begins, 25_200.0 - begins, 28_800.0 - begins]
    assert route.line_m[route.line_stop] == pytest.approx(route.aisles.stop_m[route.plant])


def test_one_time_missing_leaves_the_order_of_recording_and_what_the_work_costs(tmp_path):
    season, route = worked(tmp_path, [25_200.0, np.nan, 28_800.0])
    recorded = season.history.on(0).plant
    assert route.plant.tolist() == recorded.tolist()
    assert sorted(recorded.tolist()) == sorted(PLANTS.tolist())
    scene = season.plan(BEGINS, keep=False).scene
    places = np.concatenate([[GATE], recorded]).astype(np.int64)
    travel = season.plot.aisles.travel
    legs = [driven_s(travel, scene.clock, places[k : k + 2]) for k in range(3)]
    gone = np.cumsum(np.array(legs) + season.settings.robot.visit_s)
    assert route.leave_s == pytest.approx(gone)
    assert route.end_s > route.leave_s[-1]


def test_of_a_team_each_ones_clock_begins_when_it_starts(tmp_path):
    robot, late_s = Robot(hours=1.0), 1800.0
    team = (TeamMember("Ana", robot), TeamMember("Ben", robot, starts_s=late_s))
    season = a_season(tmp_path / "s.gpkg", team=team)
    begins = seconds(season.settings.starts)
    second = begins + late_s + np.array([300.0, 600.0])
    for who in ("Ana", "Ben"):
        plants = PLANTS[:2] if who == "Ana" else PLANTS[1:] + 1
        names, clean = np.full(2, who, object), np.zeros(2, np.int8)
        noted = Inspections.of(plants, clean, np.datetime64(BEGINS), second=second, who=names)
        season.record(noted, who)
    ana, ben = (worked_route(season, BEGINS, who) for who in ("Ana", "Ben"))
    assert ben.notes.start.time() == time(6, 30)
    assert ben.leave_s.tolist() == [300.0, 600.0]
    assert ana.notes.start > ben.notes.start, "she came half an hour late"
    assert np.diff(ana.leave_s).tolist() == [300.0]


def test_who_began_before_the_seasons_hour_has_all_its_times(tmp_path):
    season, route = worked(tmp_path, [16_200.0, 16_800.0, 17_400.0])
    begun_s = season.work(BEGINS).begun_s
    assert begun_s < 16_200.0 < seconds(season.settings.starts)
    assert route.leave_s == pytest.approx(np.array([16_200.0, 16_800.0, 17_400.0]) - begun_s)
    midnight = datetime.combine(BEGINS, time())
    assert route.notes.start == midnight + timedelta(seconds=round(begun_s))


def test_a_day_of_which_nothing_was_recorded_has_no_route(tmp_path):
    season, _ = worked(tmp_path, [25_200.0] * 3)
    assert len(worked_route(season, BEGINS.replace(day=BEGINS.day + 1))) == 0


def test_a_day_is_over_when_nothing_is_left_or_a_later_one_was_worked_and_never_before_it_began(
    tmp_path, monkeypatch
):
    season, _ = worked(tmp_path, [21_700.0, 21_660.0, 21_800.0])
    ahead, nothing = season.plan(BEGINS, keep=False).route, worked_route(season, on(3))
    assert (len(ahead) > 0, len(nothing)) == (True, 0)
    assert day_was_worked(season, BEGINS, nothing)
    assert not day_was_worked(season, BEGINS, ahead)
    assert not day_was_worked(season, on(1), nothing)
    assert not day_was_worked(season, BEGINS, ahead, today=BEGINS)
    assert day_was_worked(season, BEGINS, ahead, today=on(1))
    assert not day_was_worked(season, on(1), ahead, today=on(2))
    clock_on(monkeypatch, 0)
    season.plan(on(2))
    assert not day_was_worked(season, BEGINS, ahead), "a later day is planned only"
    clock_on(monkeypatch, 2)
    season.record(Inspections.of(PLANTS, np.ones(3, np.int8), np.datetime64(on(2))), "later")
    assert day_was_worked(season, BEGINS, ahead)
    assert not day_was_worked(season, on(1), ahead)
    assert not day_was_worked(season, on(2), ahead)
    assert day_was_worked(season, on(2), nothing)


@pytest.mark.parametrize("pest", [None, "spider-mite"])
def test_a_day_worked_as_planned_has_the_plans_times_and_chances(tmp_path, pest):
    chosen = {} if pest is None else {"pest": shipped_pest(pest)}
    season = a_season(tmp_path / "s.gpkg", **chosen)
    route = season.plan(BEGINS).route
    clean = np.zeros(len(route), np.int8)
    season.record(Inspections.of(route.plant, clean, np.datetime64(BEGINS)), "test")
    done = worked_route(season, BEGINS)
    assert done.plant.tolist() == route.plant.tolist()
    for name in ("arrive_s", "leave_s", "chance", "end_s"):
        assert getattr(done, name) == pytest.approx(getattr(route, name)), name


def test_a_start_that_was_changed_later_moves_no_time_of_a_day_worked_before(tmp_path):
    season, route = worked(tmp_path, [25_200.0, 21_660.0, 28_800.0])
    season.change(replace(season.settings, starts=time(9)), season.settings)
    assert worked_route(season, BEGINS).leave_s.tolist() == route.leave_s.tolist()
