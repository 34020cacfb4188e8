"""Who listens sees the way, the finds and how the robot stands, whatever the order of messages."""

import json
import queue
import time

import numpy as np
import pytest

from fieldmon.drive.errand import Errand
from fieldmon.drive.vda5050.messages import encoded, header_of, order_of
from fieldmon.drive.vda5050.mqtt import RobotName
from fieldmon.drive.vda5050.watcher import RobotWatcher
from tests.drive.vda5050.bodies import STATE
from tests.drive.vda5050.test_messages import STOP, line


class Heard:
    """A wire on which messages are put by hand."""

    def __init__(self, version="2.1"):
        self.robot = RobotName("fieldmon", "r1", version)
        self.heard, self.heard_at = queue.Queue(), {}
        self.header = header_of(*self.robot)

    def put(self, kind, body, at=None):
        message = encoded(kind, self.header, body)
        if at is not None:
            at = at if isinstance(at, str) else f"00:{at:06.3f}"
            said = json.loads(message) | {"timestamp": f"2026-04-06T06:{at}Z"}
            message = json.dumps(said).encode()
        self.heard.put((kind, message))
        self.heard_at[kind] = time.monotonic()


def state(place, result=None, **more):
    x, y = place
    pose = {"x": x, "y": y, "theta": 0.0, "mapId": "map", "positionInitialized": True}
    done = {"actionId": "a1", "actionStatus": "FINISHED", "resultDescription": json.dumps(result)}
    actions = {"actionStates": [done] if result is not None else []}
    return STATE | {"agvPosition": pose, "errors": []} | actions | more


@pytest.fixture(params=["2.1", "3.0"])
def wire(request):
    return Heard(request.param)


@pytest.fixture
def watcher(wire, plot):
    return RobotWatcher(wire, plot.grid)


def ordered(wire, plot):
    east_north = plot.grid.frame.turned(90.0)
    places = lambda m: east_north.xy_m(plot.grid.frame.lonlat(m))  # noqa: E731
    errand = Errand(1, STOP, line((0, 0), (5, 0)), ((9, line((5, 0), (5, 8))),))
    first = {"orderId": "day", "orderUpdateId": 0, "node": None, "strays_m": 0.3}
    wire.put("order", order_of(errand, places, first, "a1")[0])


def test_the_day_is_as_it_is_told(wire, watcher, plot):
    ordered(wire, plot)
    for at, place in ((1.0, (0.0, 0.0)), (3.0, (4.0, 0.0)), (4.0, (4.0, 3.0))):
        wire.put("state", state(place), at)
    wire.put("state", state((4.0, 3.0), {"found": True}), 9.5)
    assert watcher.take()
    trace = watcher.trace()
    assert [(one.done_s, one.plant, one.found) for one in trace.stops] == [(8.5, STOP.plant, True)]
    frame = plot.grid.frame.turned(90.0)
    np.testing.assert_allclose(frame.xy_m(trace.poses[[0, -1], 1:3]), [(0, 0), (4, 3)], atol=1e-6)
    np.testing.assert_allclose(trace.poses[:, 3], 90.0)  # theta 0 is east
    way, released = watcher.way
    assert (len(way), released) == (3, 2)
    assert watcher.heard().standing == "live"
    assert watcher.heard().lag_s < 5.0


def test_what_comes_late_or_twice_changes_nothing(wire, watcher, plot):
    ordered(wire, plot)
    wire.put("state", state((0.0, 0.0)), 1.0)
    wire.put("state", state((4.0, 0.0), {"found": False}), 3.0)
    watcher.take()
    before = watcher.trace()
    wire.put("state", state((4.0, 0.0), {"found": False}), 3.0)
    wire.put("state", state((0.0, 0.0), {"found": True}), 1.0)
    wire.heard.put(("state", b"{"))
    watcher.take()
    assert watcher.trace().stops == before.stops
    np.testing.assert_array_equal(watcher.trace().poses, before.poses)


def test_a_robot_whose_clock_is_put_back_is_seen_to_go_on(wire, watcher):
    for at, place in ((1800.0, (0.0, 0.0)), (1802.0, (1.0, 0.0)), (4.0, (2.0, 0.0)), (7, (3, 0))):
        wire.put("state", state(place), f"{int(at // 60):02}:{at % 60:06.3f}")
    watcher.take()
    # the second at which it was put back is not known
    np.testing.assert_allclose(watcher.trace().poses[:, 0], [0.0, 2.0, 5.0])


def test_a_lost_connection_a_pause_and_an_error_are_told(wire, watcher):
    assert watcher.heard() == ("waiting", None, "")
    wire.put("state", state((0.0, 0.0)))
    wire.put("connection", {"connectionState": "CONNECTIONBROKEN"})
    watcher.take()
    assert watcher.heard().standing == "lost"
    wire.put("connection", {"connectionState": "ONLINE"})
    watcher.take()
    assert watcher.heard().standing == "live"
    wire.put("state", state((0.0, 0.0), paused=True))
    watcher.take()
    assert watcher.heard().standing == "paused"
    fatal = {"errorType": "motor", "errorLevel": "FATAL", "errorDescription": "left wheel"}
    wire.put("state", state((0.0, 0.0), errors=[fatal]))
    watcher.take()
    assert watcher.heard()[::2] == ("failed", "left wheel")


def test_a_place_between_states_is_taken_and_one_that_is_not_known_is_not(wire, watcher):
    pose = state((2.0, 1.0))["agvPosition"]
    wire.put("visualization", {"agvPosition": pose}, 1.0)
    wire.put("visualization", {"agvPosition": pose | {"positionInitialized": False}}, 2.0)
    watcher.take()
    assert len(watcher.trace().poses) == 1
    assert watcher.heard().standing == "waiting"
    assert watcher.heard().lag_s is not None
