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


def test_a_lost_connection_a_pause_and_an_error_are_told(wire, watcher, monkeypatch):
    assert watcher.heard() == ("waiting", None, "", None)
    wire.put("state", state((0.0, 0.0)))
    wire.put("connection", {"connectionState": "CONNECTIONBROKEN"})
    watcher.take()
    assert watcher.heard().standing == "lost"
    wire.put("connection", {"connectionState": "ONLINE"})
    watcher.take()
    assert watcher.heard().standing == "live"
    assert watcher.heard().battery == STATE["batteryState"]["batteryCharge"]
    wire.put("connection", {"connectionState": "OFFLINE"})
    watcher.take()
    assert watcher.heard().standing == "off"
    wire.put("connection", {"connectionState": "ONLINE"})
    watcher.take()
    monkeypatch.setattr("fieldmon.drive.vda5050.watcher._SILENT_S", -1.0)
    assert watcher.heard().standing == "lost"  # though nobody said that its connection is broken
    monkeypatch.undo()
    wire.put("state", state((0.0, 0.0), paused=True))
    watcher.take()
    assert watcher.heard().standing == "paused"
    fatal = {"errorType": "motor", "errorLevel": "FATAL", "errorDescription": "left wheel"}
    wire.put("state", state((0.0, 0.0), errors=[fatal]))
    watcher.take()
    assert watcher.heard()[::2] == ("failed", "left wheel")


def test_who_waits_has_no_order_or_is_done_is_told_once_it_is_so_for_a_while(
    wire, watcher, monkeypatch
):
    node = {"nodeId": "n2", "sequenceId": 2, "released": False}
    stands = {"nodeStates": [node], "driving": False}
    for settles_s, told in ((1e9, ["live", "live"]), (-1.0, ["held", "done"])):
        monkeypatch.setattr("fieldmon.drive.vda5050.watcher._SETTLES_S", settles_s)
        for parts, standing in zip((stands, stands | {"nodeStates": []}), told, strict=True):
            wire.put("state", state((0.0, 0.0), orderId="day", driving=True))
            wire.put("state", state((0.0, 0.0), orderId="day", **parts))
            watcher.take()
            assert watcher.heard().standing == standing
    wire.put("state", state((0.0, 0.0), orderId="", nodeStates=[]))
    watcher.take()
    assert watcher.heard().standing == "idle"


def test_no_way_is_known_across_rows_or_after_a_lost_line(wire, watcher, plot):
    """Rows lie along x, 3 m apart; 0 is the plot's middle, between two of them."""
    frame, east_north = plot.grid.frame, plot.grid.frame.turned(90.0)
    at = lambda x, y: east_north.xy_m(frame.lonlat(np.array([[x, y]])))[0].tolist()  # noqa: E731
    rows_m = np.unique(plot.grid.xy_m[:, 1])
    aisle, next_aisle = rows_m[:-1] + np.diff(rows_m) / 2, rows_m[1:-1] + np.diff(rows_m)[1:] / 2
    x = float(np.median(plot.grid.xy_m[:, 0])) + 0.1
    put = lambda second, *place: wire.put("state", state(at(*place)), second)  # noqa: E731
    put(1.0, x, aisle[0])
    put(9.0, x + 5.0, aisle[0])  # along its aisle, however far
    put(10.0, x, next_aisle[0])
    put(11.0, x + 1.0, next_aisle[0])
    wire.put("connection", {"connectionState": "CONNECTIONBROKEN"})
    put(12.0, x + 2.0, next_aisle[0])  # what was sent meanwhile came after all
    wire.put("connection", {"connectionState": "CONNECTIONBROKEN"})
    put(40.0, x + 6.0, next_aisle[0])
    watcher.take()
    trace = watcher.trace()
    assert trace.poses[list(trace.unseen), 0].tolist() == [9.0, 39.0]
    assert trace.poses[[k - 1 for k in trace.unseen], 0].tolist() == [8.0, 11.0]


def test_a_robot_of_another_plot_is_neither_on_the_map_nor_do_its_finds_count(wire, watcher, plot):
    ordered(wire, plot)
    wire.put("state", state((4.0, 0.0), {"found": True}), 1.0)
    watcher.take()
    assert len(watcher.trace().stops) == 1
    east_north = plot.grid.frame.turned(90.0)
    places = lambda m: east_north.xy_m(plot.grid.frame.lonlat(m))  # noqa: E731
    errand, first = Errand(1, STOP, line((0, 0), (5, 0))), {"orderId": "x", "orderUpdateId": 0}
    known, its_plant = first | {"node": None, "strays_m": 0.3}, plot.grid.xy_m[STOP.plant]
    for off_m, standing, stops in ((7.0, "elsewhere", 0), (0.1, "live", 1)):
        stands = np.add(its_plant, (off_m, 0.0)), "left"
        wire.put("order", order_of(errand, places, known, "a1", stands)[0])
        wire.put("state", state((4.0, 0.0), {"found": True}), 2.0 + stops)
        watcher.take()
        assert watcher.heard().standing == standing
        assert (len(watcher.trace().stops), len(watcher.trace().poses)) == (stops, stops)
    wire.put("state", state((5000.0, 0.0)), 9.0)  # nor is one that is far away
    watcher.take()
    assert watcher.heard().standing == "elsewhere"
    assert (len(watcher.trace().poses), len(watcher.way[0])) == (0, 0)


def test_two_robots_under_one_serial_number_are_told(wire, watcher):
    other = Heard(wire.robot.version)
    other.header["headerId"] = 900
    for _ in range(4):
        for one in (wire, other):
            one.put("state", state((0.0, 0.0)))
        wire.heard.put(other.heard.get())
    watcher.take()
    assert watcher.heard().standing == "double"


def test_a_place_between_states_is_taken_and_one_that_is_not_known_is_not(wire, watcher):
    pose = state((2.0, 1.0))["agvPosition"]
    wire.put("visualization", {"agvPosition": pose}, 1.0)
    wire.put("visualization", {"agvPosition": pose | {"positionInitialized": False}}, 2.0)
    watcher.take()
    assert len(watcher.trace().poses) == 1
    assert watcher.heard().standing == "waiting"
    assert watcher.heard().lag_s is not None
