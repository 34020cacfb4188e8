"""A day of a season driven: one batch, in the file before the next plant is asked for."""

import shutil
from contextlib import suppress
from dataclasses import replace
from datetime import date, time, timedelta

import numpy as np
import pytest

from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.day import drive_day
from fieldmon.drive.season_day import SeasonDay, as_inspection
from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.monitoring.settings.shift_work import made_by
from fieldmon.monitoring.treating.applications import Application
from fieldmon.plot.robot import Robot, scout

ON = date(2026, 4, 6)
SETTINGS = MonitoringSettings(ON, robot=Robot(hours=0.15))


def found_at(stop):
    return stop.plant % 6 == 0


@pytest.fixture(scope="module")
def begun(plot, tmp_path_factory):
    """Return the file of a season that has just begun."""
    return Season.create(tmp_path_factory.mktemp("begun") / "s.gpkg", plot, None, SETTINGS).path


@pytest.fixture
def season(begun, tmp_path):
    return Season(shutil.copy(begun, tmp_path / "season.gpkg"))


class CrashesAfter:
    """A robot whose program dies after some plants."""

    def __init__(self, n, found=found_at):
        self.left, self.asked, self.found = n, [], found

    def begin(self, aisles, at_m, gone_s):  # noqa: ARG002
        self.begun = at_m, gone_s

    def visit(self, errand):
        if not self.left:
            raise KeyboardInterrupt
        self.left -= 1
        self.asked.append(errand.stop.plant)
        return ChargedRobot(self.found).visit(errand)

    def home(self, line_m):  # noqa: ARG002
        return None


def driven(season, robot):
    day = SeasonDay(season, ON, "charged")
    return drive_day(day, season.plot.aisles, (season.settings.robot, robot)), day


@pytest.fixture(scope="module")
def whole(begun, tmp_path_factory):
    """Return a season whose day was driven in one go, how that went, and the day."""
    season = Season(shutil.copy(begun, tmp_path_factory.mktemp("whole") / "season.gpkg"))
    return season, *driven(season, ChargedRobot(found_at))


def driven_in_parts(season, on, ends, found=found_at):
    """Drive a day whose robot crashes after so many plants each time; return plants and day."""
    for n in (*ends, 10**6):
        day = SeasonDay(Season(season.path), on, "charged")
        with suppress(KeyboardInterrupt):
            robot = season.settings.robot, CrashesAfter(n, found)
            done = drive_day(day, season.plot.aisles, robot)
    assert done.stops
    assert day.goes_on
    assert day.gone_s <= season.settings.robot.day_s
    assert len(season.batches()) == 1
    return season.history.inspections.plant.tolist()


def test_a_day_is_one_batch_and_holds_every_plant(whole, tmp_path):
    season, done, day = whole
    (batch,) = season.batches()
    recorded = season.history.inspections
    assert (batch.number, batch.rows, batch.source) == (day.batch, len(done.stops), f"charged {ON}")
    assert recorded.plant.tolist() == [one.stop.plant for one in done.stops]
    assert (recorded.result == FOUND).tolist() == [found_at(one.stop) for one in done.stops]
    assert done.found > 0
    held = season.planned_and_done(ON)
    assert (held.planned, held.left, held.added) == (len(done.stops), 0, 0)
    undone = Season(shutil.copy(season.path, tmp_path / "undone.gpkg"))
    undone.undo()
    assert len(undone.history.inspections) == 0


def test_who_inspected_is_in_the_record_and_goes_on_as_one_who_is_not_named(season):
    day = SeasonDay(season, ON, "fieldmon/r2 ", name="r2")
    for _ in range(3):
        stop = day.ask()
        day.tell(found=False)
    assert season.history.inspections.who.tolist() == ["r2"] * 3
    again = SeasonDay(season, ON, "fieldmon/r2 ", name="r2")
    assert (again.goes_on, again.at) == (True, stop.plant)
    scouts.let_in(season, "R2", (1, 2))
    with pytest.raises(SettingError, match="but both are called r2"):
        SeasonDay(season, ON, "fieldmon/r2 ", name="r2")


def test_a_robot_enters_where_people_may_not_be_yet_and_who_walks_does_not(season):
    wait = Application("oil", reentry_hours=48.0, ended=time(5))
    season.treat(ON, 0.0, application=wait)
    assert len(season.plan(ON, keep=False).route) == 0
    robot, walks = season.settings, replace(season.settings, robot=scout())
    season.change(walks, robot)
    assert SeasonDay(season, ON).ask() is None
    season.change(robot, walks)
    day = SeasonDay(season, ON)
    assert day.ask() is not None
    day.tell(found=False)
    assert SeasonDay(season, ON).goes_on


def test_a_robot_is_not_sent_the_next_day_to_plants_that_it_could_not_inspect(season):
    asked, usual = [], season.settings
    season.change(replace(usual, robot=Robot(hours=0.08)), usual)
    for number in range(2):
        day = SeasonDay(season, ON + timedelta(days=number))
        while (stop := day.ask()) is not None:
            asked.append(stop.plant)
            day.tell(None)
        assert len(asked) > 2 * (number + 1)
        assert len(set(asked)) == len(asked)


def test_the_day_is_the_one_that_the_season_plans_as_long_as_nothing_is_found(season, tmp_path):
    planned = season.plan(ON, keep=False).route
    again = Season(shutil.copy(season.path, tmp_path / "again.gpkg"))
    done, _ = driven(season, ChargedRobot(lambda stop: False))  # noqa: ARG005
    assert [one.stop.plant for one in done.stops] == planned.plant.tolist()
    assert [one.stop.arrive_s for one in done.stops] == pytest.approx(planned.arrive_s.tolist())
    in_parts = driven_in_parts(again, ON, [3], found=lambda _: False)
    assert in_parts == planned.plant.tolist()


def test_after_a_crash_it_goes_on_from_the_plant_told_last(season):
    robot = CrashesAfter(5)
    with pytest.raises(KeyboardInterrupt):
        driven(season, robot)
    again = Season(season.path)
    assert again.history.inspections.plant.tolist() == robot.asked
    second = CrashesAfter(10**6)
    done, day = driven(again, second)
    stop_m = again.plot.aisles.stop_m[robot.asked[-1]]
    assert second.begun[0] == pytest.approx(stop_m)
    assert not set(second.asked) & set(robot.asked)
    assert len(again.batches()) == 1
    assert again.batches()[0].rows == 5 + len(done.stops)
    assert day.gone_s <= again.settings.robot.day_s
    times = again.history.inspections.second
    assert (np.diff(times) > 0).all()


def test_a_day_goes_on_in_its_own_batch_after_a_copy_was_merged_into_the_season(season, tmp_path):
    there = Season(shutil.copy(season.path, tmp_path / "other.gpkg"))
    there.record(Inspections.of([0], [FOUND], ON), "theirs")
    day = SeasonDay(season, ON, "charged")
    for n in range(2):
        assert day.ask() is not None
        day.tell(found=False)
        if not n:
            assert season.merge(there).moved
    assert {one.source: one.rows for one in season.batches()} == {f"charged {ON}": 2, "theirs": 1}


def test_a_day_stopped_and_gone_on_with_is_driven_as_if_nobody_had_stopped_it(season, whole):
    assert driven_in_parts(season, ON, [3, 4]) == plants_of(whole)
    held = season.planned_and_done(ON)
    assert (held.planned, held.left, held.added) == (len(plants_of(whole)), 0, 0)


def plants_of(whole):
    return whole[0].history.inspections.plant.tolist()


def test_a_day_is_planned_anew_where_the_last_plan_did_not_hear_of_a_find(season):
    with pytest.raises(KeyboardInterrupt):
        driven(season, CrashesAfter(3))
    plant = int(season.kept_route(ON)[0])
    season.undo()
    season.record(as_inspection(plant, True, (ON, 6 * 3600.0 + 40.0)), f"charged {ON}")
    day = SeasonDay(season, ON, "charged")
    assert not day.goes_on
    assert [day.ask().plant, *day.ahead(500)] == season.kept_route(ON).tolist()


def test_a_day_goes_on_past_midnight_as_it_would_by_day(plot, whole, tmp_path):
    """Also where it is begun again: what was found after midnight is known, dated the next day."""
    settings = replace(SETTINGS, starts=time(23, 55))
    season = Season.create(tmp_path / "night.gpkg", plot, None, settings)
    assert driven_in_parts(season, ON, [3, 5]) == plants_of(whole)
    held = season.history.inspections
    assert set(held.date.astype(str)) == {str(ON), str(ON + timedelta(days=1))}
    moments = held.date + np.round(held.second).astype("timedelta64[s]")
    assert (np.diff(moments) > np.timedelta64(0)).all()
    assert moments[-1] - moments[0] < np.timedelta64(12, "m")


def test_a_day_goes_on_over_clocks_put_forward_as_it_would_on_another(plot, whole, tmp_path):
    """No result has a time that does not exist."""
    on = date(2027, 3, 26)
    settings = replace(SETTINGS, begins=on, starts=time(1, 55))
    season = Season.create(tmp_path / "forward.gpkg", plot, None, settings)
    assert driven_in_parts(season, on, [3, 5]) == plants_of(whole)
    held = season.history.inspections
    assert {*(held.second // 3600).tolist()} == {1.0, 3.0}


def test_the_last_second_of_a_day_is_rounded_into_the_next():
    one = as_inspection(0, False, (ON, 86_399.7))
    assert (str(one.date[0]), one.second[0]) == ("2026-04-07", 0.0)


def noted(plants, second, who=""):
    n = len(plants)
    return Inspections.of(
        np.array(plants, np.int32), np.zeros(n, np.int8), np.datetime64(ON),
        second=np.linspace(second, second + 60.0 * (n - 1), n), who=np.full(n, who, object),
    )  # fmt: skip


def test_a_day_that_did_not_begin_at_the_seasons_hour_goes_on_at_its_own(season):
    season.record(noted([0, 1], 34_200.0), "by hand")  # half past nine
    next_s = season.plan(ON, keep=False).route.notes.start
    done, day = driven(season, ChargedRobot(found_at))
    seconds = season.history.on(0).second[2:]
    assert (np.diff(seconds) >= 1).all()
    assert 0 <= seconds[0] - (next_s.hour * 3600 + next_s.minute * 60 + next_s.second) < 120
    assert seconds[-1] == pytest.approx(day.begun_s + day.gone_s, abs=1.0)
    left_s = season.scene(ON).seconds_left
    assert left_s == pytest.approx(season.settings.robot.day_s - day.gone_s, abs=2.0)
    assert len(done.stops) > 5


def test_beside_scouts_it_keeps_its_own_place_and_time_and_leaves_their_rows(season):
    scouts.let_in(season, "Ann", (1, 3))
    line = season.plant_numbers.line
    season.record(noted(np.flatnonzero(line == 2)[:3], 40_000.0, "Ann"), "phone")
    first = CrashesAfter(4)
    with pytest.raises(KeyboardInterrupt):
        driven(season, first)
    season.record(noted(np.flatnonzero(line == 3)[:3], 50_000.0, "Ann"), "phone again")
    second = CrashesAfter(4)
    with pytest.raises(KeyboardInterrupt):
        driven(season, second)
    assert first.begun == (pytest.approx(season.plot.aisles.gate_m), 0.0)
    assert second.begun[0] == pytest.approx(season.plot.aisles.stop_m[first.asked[-1]])
    assert (line[first.asked + second.asked] > 3).all()
    seconds = made_by(season.history.on(0), "").second
    assert (np.diff(seconds) > 0).all()
    assert seconds[-1] < 6 * 3600.0 + season.settings.robot.day_s


def test_a_late_robot_is_planned_for_anew(season):
    day = SeasonDay(season, ON, "late")
    first = day.ask()
    assert day.ahead(2)
    day.tell(found=False, at_s=first.arrive_s + first.inspect_s + 300.0)
    assert day.replanned == 2
    second = day.ask()
    assert second.arrive_s >= first.arrive_s + first.inspect_s + 300.0 - 1.0


def test_nothing_is_told_of_a_plant_that_nobody_asked_for(season):
    with pytest.raises(ObservationError, match="asked for"):
        SeasonDay(season, ON).tell(found=False)


def test_what_is_no_result_or_a_clock_that_goes_back_is_refused_and_not_recorded(season):
    day = SeasonDay(season, ON)
    must_check_what_it_is_told(day)
    assert len(season.history.inspections) == 1


def must_check_what_it_is_told(day):
    """Tell a day of one plant, and then what makes no sense of the next."""
    first = day.ask()
    day.tell(found=False, at_s=first.done_s + 5.0)
    asked = day.ask()
    for found, at_s, said in (
        ("clean", None, "must be True, False"),
        (1, None, "must be True"),
        (True, first.done_s, "must go on"),
        (True, np.nan, "must go on"),
    ):
        with pytest.raises(ObservationError, match=said):
            day.tell(found, at_s)
    with pytest.raises(SettingError, match="must be in seconds"):
        day.tell(found=True, at_s="90")
    assert day.ask() == asked
