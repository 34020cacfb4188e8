"""By which clock results of a day are timed: the plot's where a robot is live, else as planned."""

from dataclasses import replace
from datetime import date, datetime, time, timedelta

import pytest

from fieldmon.drive.day_clock import time_results
from fieldmon.drive.season_day import SeasonDay
from fieldmon.drive.team_season import TeamSeason
from fieldmon.drive.vda5050.fleet import Vda5050Robot
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.planning.members import team_of
from fieldmon.plot.local_clock import grid_clock
from fieldmon.plot.robot import Robot
from tests.drive.test_season_day import ON, SETTINGS
from tests.drive.vda5050.conftest import ROBOT


class Wire:
    """Of a robot that nobody hears."""

    robot = ROBOT


class Live(Vda5050Robot):
    """A robot that takes so many seconds a plant, by the plot's clock, which it puts on."""

    def __init__(self, clock, start, *, is_faster=False):
        super().__init__(Wire(), "day")
        self.is_faster, self.now = lambda: is_faster, clock.moment(start.date(), start.time())

    def works(self, day, n, each_s=60.0):
        """Tell of n plants."""
        for _ in range(n):
            self.now += timedelta(seconds=each_s)
            assert day.ask() is not None
            day.tell(found=False, at_s=self._day_clock.result_s("41.1"))


@pytest.fixture
def live(monkeypatch):
    def made(season, start, **how):
        robot = Live(grid_clock(season.plot.grid), start, **how)
        monkeypatch.setattr("fieldmon.drive.day_clock.utc_now", lambda: robot.now)
        return robot

    return made


def driven(season, robot, n, each_s=60.0):
    day = SeasonDay(season, ON, "live")
    said = time_results(day, grid_clock(season.plot.grid), robot)
    robot.begin(season.plot.aisles, season.plot.aisles.gate_m, day.gone_s)
    robot.works(day, n, each_s)
    return said, day


def times(season):
    """Return the local moments of what is recorded."""
    held = season.history.inspections
    midnights = [datetime.combine(one.item(), time()) for one in held.date]
    return [at + timedelta(seconds=s) for at, s in zip(midnights, held.second, strict=True)]


@pytest.mark.parametrize("at", [time(4, 10), time(9)])
def test_results_of_a_live_robot_have_the_time_at_which_they_come(plot, tmp_path, live, at):
    """Early and late, after a pause, and with hours left that count it."""
    settings = replace(SETTINGS, robot=Robot(hours=2))
    season = Season.create(tmp_path / "season.gpkg", plot, None, settings)
    start, pause = datetime.combine(ON, at), timedelta(minutes=30)
    said, day = driven(season, live(season, start), 3)
    assert said.startswith(f"The day was planned from 06:00 and begins at {at:%H:%M}: ")
    first = [start + timedelta(minutes=k) for k in (1, 2, 3)]
    assert times(season) == first
    assert day.left_s == pytest.approx(7200 - 180, abs=60)
    said, again = driven(Season(season.path), live(season, first[-1] + pause), 2)
    told = f"goes on at {first[-1] + pause:%H:%M} after its last result, of {first[-1]:%H:%M}: the"
    assert told in said
    assert "1.5 h are left" in said
    assert times(season) == first + [first[-1] + pause + timedelta(minutes=k) for k in (1, 2)]
    assert (again.goes_on, len(season.batches())) == (True, 1)
    assert season.work(ON).left_s() == pytest.approx(again.left_s, abs=2)
    now = times(season)[-1] + timedelta(minutes=3)
    assert season.plan(ON, now.time(), keep=False).route.notes.start == now


def test_what_is_driven_past_midnight_stays_in_its_shift(plot, tmp_path, live):
    settings = replace(SETTINGS, starts=time(22), robot=Robot(hours=4))
    season = Season.create(tmp_path / "season.gpkg", plot, None, settings)
    late = datetime.combine(ON + timedelta(days=1), time(0, 30))
    for n in range(2):
        said, day = driven(season, live(season, late + n * timedelta(hours=1)), 2)
        assert f"at 0{n}:30" in said
    assert [f"{one:%d %H:%M}" for one in times(season)] == [
        "07 00:31", "07 00:32", "07 01:31", "07 01:32"
    ]  # fmt: skip
    assert len(season.work(ON).inspections) == 4
    assert day.gone_s == pytest.approx(62 * 60, abs=60)
    # the next day's own work is not that of now
    nights = SeasonDay(season, ON + timedelta(days=1), "live")
    robot = live(season, late + timedelta(hours=2))
    said = time_results(nights, grid_clock(plot.grid), robot)
    assert said == f"Results are timed from 22:00 as planned, as the work of {ON} is not over."
    assert robot.clock is None


@pytest.mark.parametrize(
    ("on", "faster", "why"),
    [
        (ON, None, "the robot is simulated"),
        (ON, True, "the robot says that its clock is faster"),
        (ON + timedelta(days=2), False, "it is 2026-04-08 at the plot"),
        (ON - timedelta(days=1), False, "it is 2026-04-05 at the plot"),
    ],
)
def test_planned_times_are_kept_and_said(plot, tmp_path, live, on, faster, why):
    season = Season.create(tmp_path / "season.gpkg", plot, None, SETTINGS)
    robot = live(season, datetime.combine(on, time(9)), is_faster=faster)
    day, clock = SeasonDay(season, ON), grid_clock(plot.grid)
    said = time_results(day, clock, None if faster is None else robot)
    assert said == f"Results are timed from 06:00 as planned, as {why}."
    assert (robot.clock, day.begun_s) == (None, 6 * 3600.0)


def test_a_last_result_in_the_future_is_gone_on_from(plot, tmp_path, live):
    season = Season.create(tmp_path / "season.gpkg", plot, None, SETTINGS)
    season.record(Inspections.of([0], [FOUND], ON, second=[6.0 * 3600 + 600]), "planned")
    said, _ = driven(season, live(season, datetime.combine(ON, time(4, 30))), 0)
    assert said == (
        "Results are timed from 06:10 as planned, as the last result is later than now, 04:30."
    )


def test_each_of_a_team_begins_at_its_own_time(plot, tmp_path, live):
    robot = Robot(hours=0.5)
    settings = MonitoringSettings(ON, robot=robot, team=team_of(2, robot))
    season = Season.create(tmp_path / "season.gpkg", plot, None, settings)
    team, clock = TeamSeason(season, ON), grid_clock(plot.grid)
    for k, name in enumerate(("robot-1", "robot-2")):
        driver, own = live(season, datetime.combine(ON, time(9, 10 * k))), team.member(name)
        assert f"begins at 09:{k}0" in time_results(own, clock, driver)
        driver.begin(own.aisles, own.aisles.gate_m, own.gone_s)
        driver.works(own, 2)
        assert own.left_s == 1800 - 120
    assert [f"{one:%H:%M}" for one in times(season)] == ["09:01", "09:02", "09:11", "09:12"]
    again = TeamSeason(season, ON).member("robot-1")
    said = time_results(again, clock, live(season, datetime.combine(date(2026, 4, 6), time(9, 20))))
    assert "goes on at 09:20 after its last result, of 09:02" in said
    assert again.left_s == pytest.approx(600, abs=30)
