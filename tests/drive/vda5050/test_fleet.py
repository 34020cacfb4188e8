"""Asked and told over a broker: nothing lost, nothing twice, whatever the line does."""

import json
import queue
import re
import threading
from contextlib import nullcontext
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.day import drive_day
from fieldmon.drive.season_day import SeasonDay
from fieldmon.drive.vda5050.fleet import Vda5050Robot
from fieldmon.drive.vda5050.messages import encoded, header_of
from fieldmon.drive.vda5050.mqtt import RobotName, Wire
from fieldmon.drive.vda5050.stand_in import StandIn
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import SKIPPED
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.monitor import Monitor
from fieldmon.monitoring.settings.settings import MonitoringSettings
from tests.drive.test_season_day import ON
from tests.drive.vda5050.bodies import STATE
from tests.drive.vda5050.conftest import ROBOT

MOTOR = {"errorType": "motor", "errorLevel": "FATAL", "errorDescription": "left wheel"}


@pytest.fixture(scope="module")
def robot(robot):
    return replace(robot, hours=0.15)


def seen(plant):
    return plant % 5 == 0


def nothing(_other, _errand):
    pass


def of_orders(said):
    """Leave out that nothing was heard: who is held up is not for a while."""
    return [one for one in said if "order" in one]


def drive(broker, plot, robot, monitor, order_id, mishap=nothing, **fleet):
    """Drive a day with a stand-in; `before` happens before it, and `mishap` after each stop."""
    said, before = [], fleet.pop("before", lambda _other: None)
    kind = fleet.pop("kind", StandIn)
    other = kind(broker, ROBOT, fleet.pop("look", seen), robot.speed_m_s, faster=1e6)
    wire = Wire(broker, "fleet", ROBOT, ("state", "connection"))
    driver = Vda5050Robot(wire, order_id, said.append, **fleet)
    before(other)
    other.start()
    try:
        with monitor.day() as day:
            driven = drive_day(
                day,
                plot.aisles.for_robot(robot),
                (robot, driver),
                lambda _stop, errand: mishap(other, errand),
            )
    finally:
        other.stop()
        wire.close()
    return driven, day, said


def test_every_plant_asked_for_is_told_of_once(broker, plot, robot, monitor):
    driven, day, _ = drive(broker, plot, robot, monitor, "plain")
    assert len(driven.stops) > 5
    assert day.plants.tolist() == [one.stop.plant for one in driven.stops]
    assert day.found.tolist() == [seen(one.stop.plant) for one in driven.stops]
    # its day is driving and looking, and the seconds told are those
    assert driven.driven_s <= driven.charged_s
    assert driven.driven_s > 0.8 * driven.charged_s


def test_lost_connections_and_doubled_messages_change_nothing(broker, plot, robot, monitor):
    count = iter(range(10**6))

    def mishap(other, _errand):
        k = next(count)
        if k % 3 == 0:
            other.wire.client.socket().close()
        if k % 2 == 0:
            other.tell()
            other.tell()

    driven, day, _ = drive(broker, plot, robot, monitor, "rough", mishap)
    plain = Monitor(plot, robot=robot, chance=np.random.default_rng(3).uniform(0.005, 0.3, 96))
    assert len(set(day.plants.tolist())) == len(day.plants) == len(driven.stops)
    assert day.found.tolist() == [seen(plant) for plant in day.plants.tolist()]
    with plain.day() as quiet:
        drive_day(quiet, plot.aisles.for_robot(robot),
                  (robot, ChargedRobot(lambda stop: seen(stop.plant))))  # fmt: skip
    assert abs(len(quiet.plants) - len(day.plants)) <= 1


def test_a_plant_that_could_not_be_looked_at_stays_unknown(broker, plot, robot, monitor):
    blind = lambda plant: None if plant % 2 else False  # noqa: E731
    driven, day, _ = drive(broker, plot, robot, monitor, "blind", look=blind)
    skipped = [one for one in driven.stops if one.visit.found is None]
    assert skipped
    assert all(one.stop.plant % 2 for one in skipped)
    assert len(day.plants) == len(driven.stops) - len(skipped)


@pytest.mark.parametrize("is_wide", [True, False])
def test_a_robot_may_pass_as_far_from_a_node_as_its_ways_keep_off_plants(
    broker, plot, robot, is_wide
):
    """Ways of a robot whose width is known keep 0.1 m more off plants than it needs."""
    own = robot if is_wide else replace(robot, width_m=None, length_m=None)
    said = set()

    class Listens(StandIn):
        def _take(self, order):
            said.update(one["nodePosition"]["allowedDeviationXY"] for one in order["nodes"])
            super()._take(order)

    drive(broker, plot, own, Monitor(plot, robot=own), f"wide {is_wide}", kind=Listens)
    assert said == {0.1 if is_wide else 0.3}


@pytest.mark.parametrize(
    ("state", "what"),
    [
        ("CONNECTIONBROKEN", "The robot's connection is lost"),
        ("OFFLINE", "The robot has signed off"),
    ],
)
def test_at_a_stop_it_is_said_once_until_when_a_lost_robot_is_waited_for(
    state, what, plot, monkeypatch
):
    monkeypatch.setattr("fieldmon.drive.vda5050.fleet._POLL_S", 0.0)
    said, heard = [], queue.Queue()
    driver = Vda5050Robot(SimpleNamespace(robot=ROBOT, heard=heard, cut_off=0), "lost", said.append)
    driver.begin(plot.aisles, np.zeros(2), 0.0)
    driver._has_order, driver._state = True, {}
    heard.put(("connection", encoded("connection", header_of(*ROBOT), {"connectionState": state})))
    assert driver._wait() == ""
    assert said == [f"{what}; waiting for it."]
    driver.stops = lambda: 1
    assert [driver._wait() for _ in range(3)] == ["", "", ""]
    (told,) = said[1:]
    assert re.match(r"It is not heard, and is waited for until \d\d:\d\d:\d\d, as it may", told)


def test_orders_of_another_program_and_a_connection_that_it_takes_are_each_said_once(
    plot, monkeypatch
):
    for name, so_long in {"_POLL_S": 0.0, "_AGAIN_S": -1.0, "_MOST_TRIES": 6}.items():
        monkeypatch.setattr(f"fieldmon.drive.vda5050.fleet.{name}", so_long)
    said, heard = [], queue.Queue()
    wire = SimpleNamespace(robot=ROBOT, heard=heard, cut_off=2)
    driver = Vda5050Robot(wire, "day", said.append)
    driver.begin(plot.aisles, np.zeros(2), 0.0)

    header = header_of(*ROBOT)

    def report(order_id):
        state = STATE | {"orderId": order_id, "errors": []}
        heard.put(("state", encoded("state", header, state)))

    report("day")
    assert driver._wait() == ""
    assert said == []
    numbers = iter(range(100))
    why = driver._had(
        lambda _: report(f"other-{next(numbers)}"), "taken its order", lambda: False, lambda _: None
    )
    assert re.fullmatch(
        r"The robot has not taken its order: it has the order other-\d, which is not ours\.", why
    )
    wire.cut_off = 3
    driver._wait()
    driver._wait()
    assert [one.partition(":")[0] for one in said] == [
        "The robot had our order, but reports the order other-0 now",
        "The robot has not taken its order",
        "Our connection to the broker is lost as soon as it is made, again and again",
    ]


def test_a_low_battery_ends_the_day_after_the_plant_in_hand(broker, plot, robot, monitor):
    def drain(other, errand):
        other.self.battery = 10.0 if errand.number >= 3 else 90.0

    driven, _, _ = drive(broker, plot, robot, monitor, "low", drain)
    assert 4 <= len(driven.stops) <= 5
    assert driven.stops[-1].visit.found is not None
    assert "battery is at 10 %" in driven.stuck[0]


def test_a_fatal_error_ends_the_day_in_its_own_words(broker, plot, robot, monitor):
    def fail(other, errand):
        if errand.number == 2:
            other.self.errors = [MOTOR]

    driven, day, said = drive(broker, plot, robot, monitor, "fatal", fail)
    assert len(driven.stops) == 3
    assert "left wheel" in driven.stuck[0]
    number = driven.stops[1].stop.number
    where = rf"It stands near row \d, plant {number}, by its own word: latitude 30\.359"
    assert re.match(f"{driven.stuck[0]} {where}", said[0])
    assert len(day.plants) == 2


def test_what_a_robot_said_before_the_drive_began_does_not_end_it(broker, plot, robot, monitor):
    """It died yesterday behind a hill, was mended, and now sends what it had to say then."""

    def yesterday(other):
        send, then = other.wire.send, datetime.now(UTC) - timedelta(days=1)

        def of_then(kind, data):
            send(kind, json.dumps(json.loads(data) | {"timestamp": then.isoformat()}).encode())

        other.wire.send = of_then
        other.self.errors = [MOTOR]
        other.tell()
        other.self.errors, other.wire.send = [], send

    driven, day, _ = drive(broker, plot, robot, monitor, "next day", before=yesterday)
    assert driven.stuck == []
    assert len(day.plants) > 5


def put_back(other, hours, header=None):
    """Put a robot's clock back, and, if it is started anew, let it count its messages again."""
    send = other.wire.send

    def earlier(kind, data, **how):
        message = json.loads(data)
        at = datetime.fromisoformat(message["timestamp"]) - timedelta(hours=hours)
        send(kind, json.dumps(message | {"timestamp": at.isoformat()}).encode(), **how)

    other.wire.send = earlier
    if header is not None:
        other._headers["state"]["headerId"] = header


@pytest.mark.parametrize("header", [None, 0])
def test_a_robot_whose_clock_is_put_back_is_heard_on(broker, plot, robot, monitor, header):
    def mishap(other, errand):
        if errand.number == 3:
            put_back(other, 1, header)

    driven, day, said = drive(
        broker, plot, robot, monitor, f"clock back {header}", mishap, patience_s=2.0
    )
    assert driven.stuck == []
    assert len(day.plants) > 5
    # of one that was started anew, nobody knows how its clock was before
    of_clock = [one for one in said if "clock" in one]
    assert ["jumped back by 36" in one for one in of_clock] == ([True] if header is None else [])


def test_what_came_late_or_twice_is_passed_by():
    driver = Vda5050Robot(SimpleNamespace(robot=ROBOT), "late")
    at = datetime(2026, 6, 1, 6, tzinfo=UTC)
    message = lambda k, s: {  # noqa: E731
        "headerId": k,
        "timestamp": (at + timedelta(seconds=s)).isoformat(),
    }
    driver._state = message(10, 30)
    assert driver._late(message(10, 30))
    assert driver._late(message(8, 20))
    assert not driver._late(message(11, 30))
    assert not driver._late(message(1, 35))
    assert not driver._late(message(1, -3600))


def test_a_robot_that_is_broken_when_the_drive_begins_ends_it(broker, plot, robot, monitor):
    def die(other):
        other.self.errors = [MOTOR]

    driven, day, _ = drive(broker, plot, robot, monitor, "dead", before=die)
    assert "left wheel" in driven.stuck[0]
    assert len(day.plants) == 0


class CrashError(Exception):
    """The fleet control crashes."""


def test_a_robot_by_the_standard_is_driven_on_after_a_crash(broker, plot, robot):
    """It refuses another order while it has one: that one is ended first."""
    other = StandIn(broker, ROBOT, seen, robot.speed_m_s, faster=1e6)
    other.start()
    told, said = [], []

    def crash(_stop, _errand):
        told.append(1)
        if len(told) == 3:
            raise CrashError

    def run(order_id, watch):
        wire = Wire(broker, "fleet", ROBOT, ("state", "connection"))
        who = (robot, Vda5050Robot(wire, order_id, said.append))
        try:
            with Monitor(plot, robot=robot).day() as day:
                return drive_day(day, plot.aisles.for_robot(robot), who, watch)
        finally:
            wire.close()

    try:
        with pytest.raises(CrashError):
            run("monday", crash)
        driven = run("monday again", nothing)
    finally:
        other.stop()
    assert of_orders(said) == ["The robot still has an order of before; it is asked to end it."]
    assert driven.stuck == []
    assert len(driven.stops) > 5


class EndsByItself(StandIn):
    """Knows no cancelOrder, but has ended its order of before soon."""

    def _do_at_once(self, action):
        if action["actionType"] == "cancelOrder":
            self.self.todo, self.self.edges = [], []
        else:
            super()._do_at_once(action)


def test_a_robot_that_ends_its_order_of_before_by_itself_is_not_asked_on(
    broker, plot, robot, monitor, monkeypatch
):
    monkeypatch.setattr("fieldmon.drive.vda5050.fleet._AGAIN_S", 0.05)
    monkeypatch.setattr("fieldmon.drive.vda5050.fleet._MOST_TRIES", 4)

    def has_one(other):
        other.self.order_id = "of before"
        other.self.todo = [{"nodeId": "n2", "sequenceId": 2, "released": False}]

    driven, _, said = drive(
        broker, plot, robot, monitor, "by itself", kind=EndsByItself, before=has_one
    )
    assert driven.stuck == []
    assert of_orders(said) == ["The robot still has an order of before; it is asked to end it."]


class Refuses(StandIn):
    """Takes no order for a while, and says why."""

    most = 10**9

    def _take(self, order):
        self.most -= 1
        if self.most < 0:
            super()._take(order)
        else:
            self._refuse("validationError", "no map of this plot")


@pytest.mark.parametrize("most", [2, 10**9])
def test_an_order_that_is_refused_is_told_and_given_up_after_a_while(
    broker, plot, robot, monitor, monkeypatch, most
):
    monkeypatch.setattr("fieldmon.drive.vda5050.fleet._AGAIN_S", 0.05)
    monkeypatch.setattr("fieldmon.drive.vda5050.fleet._MOST_TRIES", 4)
    kind = type("Refuses", (Refuses,), {"most": most})
    driven, day, said = drive(broker, plot, robot, monitor, f"refused {most}", kind=kind)
    refusal = "The robot has not taken its order; it reports: no map of this plot."
    assert said.count(refusal) == 1
    assert driven.stuck == ([] if most == 2 else [refusal])
    assert (len(day.plants) > 5) == (most == 2)


class Mumbles(StandIn):
    """Says what it found in words of its own."""

    words: ClassVar = ["1", '"yes"', '"infested"', 'true, "plant": 9999']

    def _do(self, action):
        super()._do(action)
        if self.words:
            said = f'{{"found": {self.words.pop(0)}}}'
            self.self.actions[action["actionId"]]["resultDescription"] = said


def test_what_a_robot_says_plainly_is_read_and_the_rest_is_told(broker, plot, robot, monitor):
    driven, _, said = drive(broker, plot, robot, monitor, "mumbles", kind=Mumbles)
    assert [one.visit.found for one in driven.stops[:4]] == [True, True, None, None]
    odd, other = driven.stops[2].stop, driven.stops[3].stop
    wrong = ["true, false or null as found, but it is 'infested'", "but it names plant 9999"]
    assert [one in told for one, told in zip(wrong, said, strict=True)] == [True, True]
    for stop, told in zip((odd, other), said, strict=True):
        assert told.startswith(f"The robot's result of row {stop.row}, plant {stop.number} must ")
        assert told.endswith("the plant counts as not inspected.")


class Dies(StandIn):
    """Breaks down at the third plant; `after` or before it has looked there."""

    after, looks = True, 0

    def _do(self, action):
        super()._do(action)
        self.looks += 1
        if self.looks == 3:
            self.self.errors = [MOTOR]
            if not self.after:
                self.self.actions[action["actionId"]]["actionStatus"] = "FAILED"


def test_a_result_that_comes_with_a_fatal_error_is_kept(broker, plot, robot, monitor):
    driven, day, _ = drive(broker, plot, robot, monitor, "with it", kind=Dies)
    assert "left wheel" in driven.stuck[0]
    assert len(day.plants) == len(driven.stops) == 3
    assert day.found.tolist() == [seen(plant) for plant in day.plants.tolist()]


def test_a_plant_that_a_robot_broke_down_at_is_not_told_as_one_that_could_not_be_inspected(
    broker, plot, robot, monitor
):
    kind = type("DiesBefore", (Dies,), {"after": False})
    driven, _, _ = drive(broker, plot, robot, monitor, "before it", kind=kind)
    assert [one.visit.there for one in driven.stops] == [True, True, False]


def test_a_pause_is_waited_for_and_said(broker, plot, robot, monitor):
    def pause(other, errand):
        if errand.number == 2:
            other.self.paused = True
            other.tell()
            threading.Timer(0.5, lambda: setattr(other.self, "paused", False)).start()

    driven, _, said = drive(broker, plot, robot, monitor, "pause", pause)
    assert len(driven.stops) > 5
    assert any("paused" in sentence for sentence in said)


def test_a_robot_that_never_comes_is_waited_for_by_name_and_then_an_error(
    broker, plot, robot, monitor, monkeypatch
):
    monkeypatch.setattr("fieldmon.drive.vda5050.fleet._AGAIN_S", 0.1)
    nobody, said = RobotName("fieldmon", "absent"), []
    # what the broker keeps of another robot for a session of this name is not of this one
    Wire(broker, "fleet", ROBOT, ("state", "connection")).close()
    other = Wire(broker, "else", ROBOT, ())
    other.send("connection", b"{}")
    other.close()
    wire = Wire(broker, "fleet", nobody, ("state", "connection"))
    driver = Vda5050Robot(wire, "x", said.append, patience_s=1.0)
    with monitor.day() as day, pytest.raises(SettingError, match="called fieldmon/absent must be"):
        drive_day(day, plot.aisles.for_robot(robot), (robot, driver))
    wire.close()
    assert said == ["Waiting for the robot fieldmon/absent, which has not been heard yet."]
    assert len(day.plants) == 0


def test_of_a_plant_that_a_robot_did_not_get_to_nothing_is_told(broker, plot, robot, tmp_path):
    settings = MonitoringSettings(ON, robot=robot)
    season = Season.create(tmp_path / "season.gpkg", plot, None, settings)

    class Day:
        """A season's day that looks as a monitor's."""

        def day(self):
            return nullcontext(SeasonDay(season, ON))

    def fail(other, errand):
        if errand.number == 2:
            other.self.errors = [{"errorType": "motor", "errorLevel": "FATAL"}]

    driven, _, _ = drive(broker, plot, robot, Day(), "lost", fail)
    assert "motor" in driven.stuck[0]
    done = season.history.inspections
    assert done.plant.tolist() == [one.stop.plant for one in driven.stops[:2]]
    assert SKIPPED not in done.result.tolist()


@pytest.mark.parametrize("said", [b"{", b'{"headerId": 1}'])
def test_what_is_no_message_is_passed_by_and_said(broker, plot, robot, monitor, said):
    def noise(other, errand):
        if errand.number == 1:
            other.wire.send("state", said)

    driven, _, told = drive(broker, plot, robot, monitor, f"noise{len(said)}", noise)
    assert len(driven.stops) > 5
    assert any("must be" in sentence for sentence in told)


def test_the_first_stop_after_going_on_takes_as_long_as_by_the_robots_own_clock(plot):
    """Also of one that is faster than ours."""
    heard, header = queue.Queue(), header_of(*ROBOT)
    driver = Vda5050Robot(SimpleNamespace(robot=ROBOT, heard=heard, cut_off=0), "day")
    driver.begin(plot.aisles, np.zeros(2), 3600.0)
    information = [{"infoType": "day_s", "infoLevel": "INFO", "infoDescription": "12.5"}]
    heard.put(("state", encoded("state", header, STATE | {"information": information})))
    assert driver._hear()
    assert [driver._day_clock.result_s(told) for told in ("56.5", "100.5")] == [3644.0, 3688.0]
