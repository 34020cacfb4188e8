"""A robot's day as it is driven, listened to over a broker."""

import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from app.show import drive_play
from app.show.maps import colours
from app.state import background_work
from app.state.live_drive import LiveDrive, SeenRobot
from app.state.map_store import STORE
from fieldmon.drive.day import drive_day
from fieldmon.drive.trace import Trace, TracedStop
from fieldmon.drive.vda5050.fleet import live_robot
from fieldmon.drive.vda5050.mqtt import RobotName, Watched
from fieldmon.drive.vda5050.stand_in import StandIn
from fieldmon.drive.vda5050.watcher import Heard
from fieldmon.monitoring.estimates.monitor import Monitor
from tests.app.driving import until
from tests.drive.conftest import plot, robot  # noqa: F401
from tests.drive.vda5050.conftest import ROBOT, _soon, broker, broker_program  # noqa: F401

WATCHED = Watched("fieldmon", ("robot1",))


@pytest.fixture
def scene(plot, robot):  # noqa: F811
    return Monitor(plot, robot=robot).plan().scene


def test_way_finds_and_chances_of_a_day_come_as_it_is_driven(broker, plot, robot, scene):  # noqa: F811
    # the other one of the team never comes
    live = LiveDrive(broker, Watched.of("fieldmon", "robot1, never"), scene)
    assert [one.name for one in live.seen()] == ["robot1", "never"]
    live.start()
    other = StandIn(broker, ROBOT, lambda plant: plant % 5 == 0, robot.speed_m_s, 1e4)
    other.start()
    until(lambda: live.seen()[0].heard.standing == "idle")
    seen = []

    def look(*_):
        seen.append(live.seen()[0])
        live.changes(live.seen(), colours.classes)

    with Monitor(plot, robot=robot).day() as day, live_robot(broker, ROBOT, "d", print) as driver:
        drive_day(day, plot.aisles, (robot, driver), look)
    until(lambda: len(live.seen()[0].trace.stops) == len(day.plants))
    shown, silent = live.seen()
    assert [one.plant for one in shown.trace.stops] == day.plants.tolist()
    assert [one.found for one in shown.trace.stops] == day.found.tolist()
    assert (shown.heard.standing, silent.heard.standing) == ("live", "waiting")
    # it grows, and what is believed with it
    grown = [len(one.trace.stops) for one in seen]
    assert grown == sorted(grown)
    assert grown[0] < grown[-1]
    changes = live.changes((shown, silent), colours.classes)
    assert sum(len(one.plants) for one in changes) > 0
    seconds = [one.at_s for one in changes]
    assert seconds == sorted(set(seconds))
    data = drive_play.as_live(live)
    assert data["end"] > 0
    assert data["link"] == "live"
    assert len(data["changes"]) == len(changes)
    assert [len(one["at"]) > 0 for one in data["robots"]] == [True, False]
    other.stop()
    until(lambda: live.seen()[0].heard.standing == "off")
    live.stop()
    live.wait(180)
    assert drive_play.as_live(live)["link"] == "ended"


def test_all_that_a_broker_announces_are_seen_and_a_broker_that_is_gone_is_sought_again(
    broker_program, scene  # noqa: F811
):  # fmt: skip
    with broker_program("allow_anonymous true\n") as first:
        live = LiveDrive(first, Watched("fieldmon"), scene)
        live.start()
        robots = [StandIn(first, RobotName("fieldmon", f"r{k}"), bool) for k in (2, 1)]
        until(lambda: {one.name for one in live.seen()} == {"r1", "r2"})
        robots[0].start()
        until(lambda: any(one.heard.lag_s is not None for one in live.seen()))
        assert not live.is_cut_off
    until(lambda: live.is_cut_off)
    assert drive_play.as_live(live)["link"] == "unheard"
    with broker_program("allow_anonymous true\n", first.port):
        until(lambda: not live.is_cut_off)
        live.stop()
        live.wait(180)
        assert live.problem is None
        for one in robots:
            one.stop()


def test_it_goes_on_while_a_tab_is_open_though_nobody_asks_and_ends_once_none_is(
    broker, scene, monkeypatch  # noqa: F811
):  # fmt: skip
    monkeypatch.setattr(background_work, "UNSEEN_S", 0.3)
    live, asked, is_closed = LiveDrive(broker, WATCHED, scene), [], threading.Event()

    def is_open():
        asked.append(time.monotonic())
        return not is_closed.is_set()

    live.watch("a tab", is_open)
    live.start()
    until(lambda: asked and asked[-1] - asked[0] > 0.6)  # on another page of the app
    assert live.running
    is_closed.set()
    until(lambda: live.seen() and not live.running)  # a page that still asks keeps it no longer
    assert live.problem is None


def test_where_no_broker_is_it_is_said(scene):
    from fieldmon.drive.vda5050.mqtt import Broker

    live = LiveDrive(Broker("127.0.0.1", 1), WATCHED, scene)
    live.start()
    until(lambda: not live.running)
    assert "must answer" in str(live.problem)


def test_before_anything_is_heard_nobody_knows_where_a_robot_is(scene):
    data = drive_play.as_live(LiveDrive(None, WATCHED, scene))
    (alone,) = data["robots"]
    assert (alone["at"], alone["way"], data["link"]) == ([], [], "ended")
    assert alone["heard"] == {"standing": "waiting", "lag": None, "said": ""}


def test_each_of_a_team_finds_as_it_does_and_what_comes_late_counts(scene):
    robots = {"b": replace(scene.robot, detection=0.2)}
    live = LiveDrive(None, Watched("fieldmon", ("a", "b")), scene, robots)
    trace = lambda *stops: Trace(np.empty((0, 4)), tuple(TracedStop(*one) for one in stops))  # noqa: E731
    way, heard = (np.empty((0, 2)), 0), Heard("live", 1.0)
    for plant, second in ((5, 60.0), (40, 30.0)):
        chances = []
        for name in "ab":
            seen = (SeenRobot(name, trace((second, plant, False)), way, heard),)
            # with chances for classes
            last = live.changes(seen, lambda chance: chance)[-1]
            at_s, chance = last.at_s, dict(zip(last.plants.tolist(), last.classes, strict=True))
            chances.append(chance[plant])
            live._known = 0
        assert at_s == 60.0
        assert chances[0] < chances[1] < scene.chance[plant]


def test_what_changes_is_made_whenever_it_is_asked_for():
    count = iter(range(9))
    address = STORE.attach("a day", lambda _: b"%d" % next(count))
    assert [STORE.changing(address)(None) for _ in range(2)] == [b"0", b"1"]
    assert STORE.attach("a day", lambda _: b"") == address
    assert STORE.changing("/map_data/else") is None
