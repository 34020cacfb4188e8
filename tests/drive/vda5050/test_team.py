"""Several robots in one day: each its own order, one season, and nobody in another's aisle."""

import threading
import time

import numpy as np
import pytest

from fieldmon.drive.team_season import MemberDay, TeamSeason
from fieldmon.drive.vda5050 import team
from fieldmon.drive.vda5050.fleet import Vda5050Robot
from fieldmon.drive.vda5050.mqtt import RobotName
from fieldmon.drive.vda5050.stand_in import StandIn
from fieldmon.drive.vda5050.team import drive_team
from fieldmon.errors import ObservationError
from fieldmon.infestation.inspections import FOUND
from fieldmon.monitoring import Season
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.planning.members import TeamMember, Teamwork, team_of
from fieldmon.plot.robot import Robot, scout
from tests.drive.test_season_day import ON
from tests.drive.vda5050.conftest import ROBOT

NAMES = ("robot-1", "robot-2", "robot-3")


@pytest.fixture
def hours():
    """Return so many that each finds enough; others need a few plants only."""
    return 0.12


@pytest.fixture
def season(plot, tmp_path, hours):
    robot = Robot(hours=hours)
    # aisles are given out anew for any gain, so that ways cross
    settings = MonitoringSettings(
        ON, robot=robot, team=team_of(3, robot), teamwork=Teamwork(least_gain=0.0)
    )
    return Season.create(tmp_path / "season.gpkg", plot, None, settings)


class Watched(StandIn):
    """A robot that says in which aisles it is while it drives; two in one are noted."""

    def __init__(self, broker, name, look, ground):
        super().__init__(broker, RobotName(ROBOT.manufacturer, name), look, 0.7, faster=2000.0)
        self.ground = ground

    def _drive_on(self):
        me = self.self
        if me.paused or me.errors or not me.todo or not me.todo[0]["released"]:
            return False
        place = me.todo[0]["nodePosition"]
        there = (place["x"], place["y"])
        self.ground.moves(self.name.serial, me.place or there, there)
        done = super()._drive_on()
        self.ground.moves(self.name.serial, there, there)
        return done


class Ground:
    """Which aisles lie between two places, and who is in them."""

    def __init__(self, grid):
        self.grid, self.lock = grid, threading.Lock()
        self.inside, self.met, self.visited = {}, [], set()

    def aisles(self, a, b):
        frame = self.grid.frame
        ends = frame.xy_m(frame.turned(90.0).lonlat(np.array([a, b])))
        grid, found = self.grid, set()
        for x, y in np.linspace(*ends, 50):
            near = np.abs(grid.lane_y_m - y) < 0.3
            near &= (grid.lane_x_m[:, 0] + 0.05 < x) & (x < grid.lane_x_m[:, 1] - 0.05)
            found |= set(grid.corridor[near].tolist())
        return found

    def moves(self, name, a, b):
        now = self.aisles(a, b)
        with self.lock:
            for other, held in self.inside.items():
                if other != name and held & now:
                    self.met.append((name, other, held & now))
            self.inside[name] = now
            self.visited |= now


def seen(plant):
    return plant % 4 == 0


@pytest.mark.parametrize("hours", [0.2], ids=[""])
def test_a_teams_day_is_driven_once_by_all_and_nobody_is_in_anothers_aisle(broker, season):
    ground, said = Ground(season.plot.grid), []
    robots = [Watched(broker, name, seen, ground) for name in NAMES]
    for one in robots:
        one.start()
    day = TeamSeason(season, ON)
    driven = drive_team(day, broker, ROBOT, said.append)
    for one in robots:
        one.stop()
    told = season.history.inspections.on(ON)
    assert ground.met == []
    assert len(ground.visited) > 3
    plants = [stop.stop.plant for name in NAMES for stop in driven[name].stops]
    assert len(plants) == len(set(plants)) > 10
    assert sorted(told.plant.tolist()) == sorted(plants)
    assert (told.result == FOUND).tolist() == [seen(plant) for plant in told.plant.tolist()]
    assert {*told.who.tolist()} == {*NAMES}
    for name in NAMES:
        assert driven[name].stuck == []
        own = told.plant[told.who == name].tolist()
        assert own == [stop.stop.plant for stop in driven[name].stops]
    assert [one.who for one in season.batches()] == [", ".join(NAMES)]
    # every find is planned for by all
    assert day.replanned > sum(one.found for one in driven.values()) > 0


def test_scouts_do_not_drive_and_a_robot_that_never_comes_takes_nothing(
    broker, plot, tmp_path, monkeypatch
):
    monkeypatch.setattr(Vda5050Robot.__init__, "__kwdefaults__",
                        {**Vda5050Robot.__init__.__kwdefaults__, "patience_s": 3.0})  # fmt: skip
    robot = Robot(hours=0.1)
    team = (TeamMember("Ann", scout().with_hours(0.1)), *team_of(2, robot))
    settings = MonitoringSettings(ON, robot=robot, team=team)
    season = Season.create(tmp_path / "mixed.gpkg", plot, None, settings)
    other = StandIn(broker, RobotName(ROBOT.manufacturer, "robot-1"), seen, 0.7, 1e6)
    other.start()
    day = TeamSeason(season, ON)
    driven = drive_team(day, broker, ROBOT)
    other.stop()
    assert [*driven] == ["robot-1", "robot-2"]
    assert "called fieldmon/robot-2 must be at the broker" in driven["robot-2"].broken
    assert len(driven["robot-1"].stops) > 3
    assert {*season.history.inspections.who.tolist()} == {"robot-1"}
    assert not day.errands
    assert day.keeper.enter("anybody", day.aisle[[*day.done]].tolist())


def test_a_day_that_breaks_off_takes_nothing_from_the_others(broker, season, monkeypatch):
    tell = MemberDay.tell

    def refused(day, found, at_s=None):
        if repr(day).startswith(f"<MemberDay of {NAMES[0]}:"):
            raise ObservationError("The file is full.")
        tell(day, found, at_s)

    monkeypatch.setattr(MemberDay, "tell", refused)
    robots = [StandIn(broker, RobotName(ROBOT.manufacturer, name), seen, 0.7, 1e6)
              for name in NAMES]  # fmt: skip
    for one in robots:
        one.start()
    driven = drive_team(TeamSeason(season, ON), broker, ROBOT)
    for one in robots:
        one.stop()
    assert (driven[NAMES[0]].broken, driven[NAMES[0]].stops) == ("The file is full.", [])
    assert all(len(driven[name].stops) > 3 for name in NAMES[1:])


def test_a_robot_that_breaks_down_blocks_its_aisle_and_the_others_go_on(broker, season):
    robots = [StandIn(broker, RobotName(ROBOT.manufacturer, name), seen, 0.7, 1e6)
              for name in NAMES]  # fmt: skip
    robots[0].self.errors = [
        {"errorType": "motor", "errorLevel": "FATAL", "errorDescription": "left wheel"}
    ]
    for one in robots:
        one.start()
    day, said = TeamSeason(season, ON), {}
    driven = drive_team(day, broker, ROBOT, lambda told: said.setdefault(told, len(day.done)))
    for one in robots:
        one.stop()
    assert "left wheel" in driven[NAMES[0]].stuck[0]
    # at once, not when all are home
    told = f"{NAMES[0]}: {driven[NAMES[0]].stuck[0]} It does not say where it stands."
    assert said[told] < len(day.done)
    for name in NAMES[1:]:
        assert len(driven[name].stops) > 3
        assert driven[name].stuck == []


def stop_when(monkeypatch, *whens):
    """Let somebody press Ctrl-C as soon as each of these holds, in turn."""
    results, left = team._results, [*whens]

    def interrupted(running):
        if not left:
            return results(running)
        is_time, until = left.pop(0), time.monotonic() + 60
        while not is_time():
            assert time.monotonic() < until
            time.sleep(0.01)
        raise KeyboardInterrupt

    monkeypatch.setattr(team, "_results", interrupted)


def patient(monkeypatch, seconds):
    told = {**Vda5050Robot.__init__.__kwdefaults__, "patience_s": seconds}
    monkeypatch.setattr(Vda5050Robot.__init__, "__kwdefaults__", told)


def test_at_a_stop_nobody_waits_for_a_robot_that_has_no_order(broker, season, monkeypatch):
    patient(monkeypatch, 20.0)
    monkeypatch.setattr("fieldmon.drive.vda5050.fleet._AGAIN_S", 0.1)
    other = StandIn(broker, RobotName(ROBOT.manufacturer, NAMES[0]), seen, 0.7, 1e6)
    other.start()
    day, said = TeamSeason(season, ON), []
    waits = [f"{name}: Waiting for the robot fieldmon/{name}, which has not been heard yet."
             for name in NAMES[1:]]  # fmt: skip
    stop_when(monkeypatch, lambda: day.done and {*waits} <= {*said})
    driven = drive_team(day, broker, ROBOT, said.append)
    other.stop()
    assert driven[NAMES[0]].stops
    assert driven[NAMES[0]].home is not None
    for name in NAMES[1:]:
        assert driven[name].broken == "It has no order and is not waited for."


def test_at_a_second_stop_nobody_is_waited_for_and_what_was_driven_is_kept(
    broker, season, monkeypatch
):
    class Pauses(StandIn):
        """Is paused for ever after its second plant."""

        def drive_to(self, there):
            super().drive_to(there)
            self.self.paused = sum(one["actionStatus"] == "FINISHED"
                                   for one in self.self.actions.values()) > 0  # fmt: skip

    patient(monkeypatch, 3.0)
    robots = [Pauses(broker, RobotName(ROBOT.manufacturer, name), seen, 0.7, 1e6)
              for name in NAMES]  # fmt: skip
    for one in robots:
        one.start()
    day, said = TeamSeason(season, ON), []
    stop_when(monkeypatch, lambda: len(day.done) == 6, lambda: day.stops)
    driven = drive_team(day, broker, ROBOT, said.append)
    for one in robots:
        one.stop()
    assert "Ending at once: what is recorded is kept." in said
    assert any(f"Waited for: {', '.join(NAMES)}." in told for told in said)
    plants = [stop.stop.plant for one in driven.values() for stop in one.stops]
    assert len(plants) == 6
    assert sorted(season.history.inspections.plant.tolist()) == sorted(plants)
    assert all(one.broken.startswith("It is not waited for") for one in driven.values())
