"""A robot's day as it is driven, listened to over a broker."""

import threading
import time

import pytest

from app.show import drive_play
from app.state import background_work
from app.state.live_drive import LiveDrive
from app.state.map_store import STORE
from fieldmon.drive.day import drive_day
from fieldmon.drive.vda5050.fleet import live_robot
from fieldmon.drive.vda5050.stand_in import StandIn
from fieldmon.monitoring.estimates.monitor import Monitor
from tests.app.driving import until
from tests.drive.conftest import plot, robot  # noqa: F401
from tests.drive.vda5050.conftest import ROBOT, _soon, broker, broker_program  # noqa: F401


@pytest.fixture
def scene(plot, robot):  # noqa: F811
    return Monitor(plot, robot=robot).plan().scene


def test_way_finds_and_chances_of_a_day_come_as_it_is_driven(broker, plot, robot, scene):  # noqa: F811
    live = LiveDrive(broker, ROBOT, scene)
    live.start()
    other = StandIn(broker, ROBOT, lambda plant: plant % 5 == 0, robot.speed_m_s, 1e4)
    other.start()
    until(lambda: live.heard().standing == "live")
    seen = []
    with Monitor(plot, robot=robot).day() as day, live_robot(broker, ROBOT, "d", print) as driver:
        drive_day(day, plot.aisles, (robot, driver), lambda *_: seen.append(live.seen()))
    until(lambda: len(live.seen()[0].trace.stops) == len(day.plants))
    shown, _, heard = live.seen()
    assert [one.plant for one in shown.trace.stops] == day.plants.tolist()
    assert [one.found for one in shown.trace.stops] == day.found.tolist()
    assert heard.standing == "live"
    # it grows, and what is believed with it
    grown = [len(one.trace.stops) for one, _, _ in seen]
    assert grown == sorted(grown)
    assert grown[0] < grown[-1]
    assert (shown.believed[-1][1] != scene.chance).any()
    seconds = [at_s for at_s, _ in shown.believed]
    assert seconds == sorted(set(seconds))
    data = drive_play.as_live(live)
    assert data["end"] > 0
    assert len(data["changes"]) == len(shown.believed)
    other.stop()
    until(lambda: live.heard().standing == "lost")
    live.stop()
    live.wait(180)
    assert drive_play.as_live(live)["heard"]["standing"] == "ended"


def test_it_goes_on_while_a_tab_is_open_though_nobody_asks_and_ends_once_none_is(
    broker, scene, monkeypatch  # noqa: F811
):  # fmt: skip
    monkeypatch.setattr(background_work, "UNSEEN_S", 0.3)
    live, asked, is_closed = LiveDrive(broker, ROBOT, scene), [], threading.Event()

    def is_open():
        asked.append(time.monotonic())
        return not is_closed.is_set()

    live.watch("a tab", is_open)
    live.start()
    until(lambda: asked and asked[-1] - asked[0] > 0.6)  # on another page of the app
    assert live.running
    is_closed.set()
    until(lambda: live.heard() and not live.running)  # a page that still asks keeps it no longer
    assert live.problem is None


def test_where_no_broker_is_it_is_said(scene):
    from fieldmon.drive.vda5050.mqtt import Broker

    live = LiveDrive(Broker("127.0.0.1", 1), ROBOT, scene)
    live.start()
    until(lambda: not live.running)
    assert "must answer" in str(live.problem)


def test_before_anything_is_heard_the_robot_stands_at_the_gate(scene):
    live = LiveDrive(None, ROBOT, scene)
    data = drive_play.as_live(live)
    assert data["at"] == [0, 0.1]
    assert len(set(data["lon"])) == 1
    assert data["heard"] == {"standing": "ended", "lag": None, "said": ""}


def test_what_changes_is_made_whenever_it_is_asked_for():
    count = iter(range(9))
    address = STORE.attach("a day", lambda: b"%d" % next(count))
    assert [STORE.changing(address)() for _ in range(2)] == [b"0", b"1"]
    assert STORE.attach("a day", lambda: b"") == address
    assert STORE.changing("/map_data/else") is None
