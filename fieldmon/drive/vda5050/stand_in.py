"""A simulated robot that speaks VDA 5050: the other side, for whoever has no robot at hand."""

from __future__ import annotations

import json
import math
import queue
import threading
import time
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from fieldmon.drive.vda5050.messages import FASTER, MAP, decoded, encoded, header_of
from fieldmon.drive.vda5050.mqtt import Wire
from fieldmon.drive.vda5050.versions import AT_ONCE
from fieldmon.errors import ObservationError

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.drive.vda5050.mqtt import Broker, RobotName

# the standard wants a state every 30 s at least
_STATE_EVERY_S = 5.0
# so long it waits until the broker has that it is there; who listens before hears of the last one
_RECEIPT_S = 5.0
# so many actions done at once are known, so that none is done twice
_KNOWN = 20


@dataclass
class _Self:
    """What the robot knows of itself."""

    order_id: str = ""
    update: int = 0
    node: str = ""
    sequence: int = 0
    place: tuple[float, float] | None = None
    theta: float = 0.0
    day_s: float = 0.0
    todo: list[dict[str, Any]] = field(default_factory=list)
    edges: list[dict[str, Any]] = field(default_factory=list)
    actions: dict[str, dict[str, Any]] = field(default_factory=dict)
    at_once: dict[str, dict[str, Any]] = field(default_factory=dict)
    errors: list[dict[str, Any]] = field(default_factory=list)
    refusals: list[dict[str, Any]] = field(default_factory=list)
    battery: float = 100.0
    paused: bool = False


class StandIn:
    """Drives what is released, looks at plants, and tells.

    Parameters
    ----------
    broker, robot
        Where, and under which name.
    look
        Told a plant; says whether it is found infested.
    speed_m_s
        Of driving.
    faster
        How many times faster than the clock, which it tells. Seconds told are those of its own
        day, which begins with each order.
    """

    def __init__(
        self,
        broker: Broker,
        robot: RobotName,
        look: Callable[[int], bool | None],
        speed_m_s: float = 2.5 / 3.6,
        faster: float = 1.0,
    ) -> None:
        self._headers = {kind: header_of(*robot) for kind in ("state", "connection")}
        self._look = look
        self.name, self._speed_m_s, self._faster = robot, speed_m_s, faster
        self._pace = [] if faster == 1.0 else [_told(FASTER, f"{faster:g}")]
        self.self = _Self()
        broken = encoded("connection", header_of(*robot), {"connectionState": "CONNECTIONBROKEN"})
        hears, name = ("order", "instantActions"), f"stand-in-{robot.serial}"
        self.wire = Wire(broker, name, robot, hears, ("connection", broken))
        self.wire.connected = lambda: self._connected("ONLINE")
        with suppress(RuntimeError):  # the connection was lost at once: it is said with the next
            self._connected("ONLINE").wait_for_publish(_RECEIPT_S)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self.run, daemon=True)

    def start(self) -> None:
        """Drive in a thread of its own."""
        self._thread.start()

    def stop(self) -> None:
        """Stop, and say so."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(timeout=10)
        self._connected("OFFLINE")
        self.wire.close()

    def run(self) -> None:
        """Take orders and drive, until it is stopped."""
        self.tell()
        told = time.monotonic()
        while not self._stop.is_set():
            self._hear()
            if self._drive_on() or time.monotonic() - told > _STATE_EVERY_S:
                self.tell()
                told = time.monotonic()

    def tell(self) -> None:
        """Send the robot's state."""
        me = self.self
        place = me.place or (0.0, 0.0)
        body = {
            "orderId": me.order_id,
            "orderUpdateId": me.update,
            "lastNodeId": me.node,
            "lastNodeSequenceId": me.sequence,
            "driving": False,
            "paused": me.paused,
            "nodeStates": [_part(one, "nodeId") for one in me.todo],
            "edgeStates": [_part(one, "edgeId") for one in me.edges],
            "actionStates": [*me.actions.values(), *me.at_once.values()],
            "agvPosition": {
                "x": place[0],
                "y": place[1],
                "theta": me.theta,
                "mapId": MAP,
                "positionInitialized": me.place is not None,
            },
            "batteryState": {"batteryCharge": me.battery, "charging": False},
            "operatingMode": "AUTOMATIC",
            "errors": [*me.errors, *me.refusals],
            "information": [_told("day_s", f"{me.day_s:.1f}"), *self._pace],
            "safetyState": {"eStop": "NONE", "fieldViolation": False},
        }
        self.wire.send("state", encoded("state", self._headers["state"], body))

    def drive_to(self, there: tuple[float, float]) -> None:
        """Drive to a place, metres east and north of the datum; a real robot does so here."""
        here = self.self.place or there
        self._pass(math.dist(here, there) / self._speed_m_s)

    def _hear(self) -> None:
        try:
            kind, data = self.wire.heard.get(timeout=0.005 if self.self.todo else 0.1)
            message = decoded(kind, data)
        except (queue.Empty, ObservationError):
            return
        if kind == "order":
            self._take(message)
        elif kind == "instantActions":
            for one in message["actions"]:
                self._do_at_once(one)
        self.tell()

    def _do_at_once(self, action: dict[str, Any]) -> None:
        """Do what cannot wait, once: pause, go on, end the order, or just tell."""
        me, name = self.self, action["actionType"]
        if action["actionId"] in me.at_once:
            return
        status = "FINISHED" if name in AT_ONCE else "FAILED"
        if name in {"startPause", "stopPause"}:
            me.paused = name == "startPause"
        elif name == "cancelOrder" and not me.todo:
            status = "FAILED"
            self._refuse("noOrderToCancel", "there is no order to cancel")
        elif name == "cancelOrder":
            me.todo, me.edges = [], []
            for one in me.actions.values():
                if one["actionStatus"] == "WAITING":
                    one["actionStatus"] = "FAILED"
        me.at_once[action["actionId"]] = _action(action, status)
        if len(me.at_once) > _KNOWN:
            del me.at_once[next(iter(me.at_once))]

    def _refuse(self, kind: str, why: str) -> None:
        """Say why something is not done, until the next order is taken."""
        one = {"errorType": kind, "errorLevel": "WARNING", "errorDescription": why}
        self.self.refusals = [one]

    def _take(self, order: dict[str, Any]) -> None:
        """Take an order or an update of it; one that came before, or twice, changes nothing.

        As the standard has it, another order is refused while there is something left of one.
        """
        me = self.self
        if order["orderId"] != me.order_id and me.todo:
            self._refuse("orderError", f"order {me.order_id} is not done yet")
            return
        if order["orderId"] != me.order_id:
            me.order_id, me.update, me.sequence, me.actions = order["orderId"], -1, -1, {}
            me.day_s = 0.0
        if order["orderUpdateId"] <= me.update:
            return
        me.update, me.refusals = order["orderUpdateId"], []
        me.todo = [one for one in order["nodes"] if one["sequenceId"] > me.sequence]
        me.edges = [one for one in order["edges"] if one["sequenceId"] > me.sequence]
        for node in me.todo:
            if node["released"]:
                for action in node["actions"]:
                    me.actions[action["actionId"]] = _action(action, "WAITING")

    def _drive_on(self) -> bool:
        """Drive to the next released node and do what is to be done there; return whether any."""
        me = self.self
        if me.paused or me.errors or not me.todo or not me.todo[0]["released"]:
            return False
        node = me.todo.pop(0)
        there = (node["nodePosition"]["x"], node["nodePosition"]["y"])
        if me.place is not None and there != me.place:
            me.theta = math.atan2(there[1] - me.place[1], there[0] - me.place[0])
            self.drive_to(there)
        me.place, me.node, me.sequence = there, node["nodeId"], node["sequenceId"]
        me.edges = [one for one in me.edges if one["sequenceId"] > me.sequence]
        if node["actions"]:
            self.tell()  # that it is there
        for action in node["actions"]:
            self._do(action)
        return True

    def _do(self, action: dict[str, Any]) -> None:
        told = {one["key"]: one["value"] for one in action.get("actionParameters", [])}
        self._pass(float(told.get("seconds", 0.0)))
        found = self._look(int(told["plant"]))
        done = _action(action, "FAILED" if found is None else "FINISHED")
        result = {"plant": told["plant"], "found": found, "day_s": round(self.self.day_s, 1)}
        done["resultDescription"] = json.dumps(result)
        self.self.actions[action["actionId"]] = done

    def _pass(self, seconds: float) -> None:
        self.self.day_s += seconds
        self._stop.wait(seconds / self._faster)

    def _connected(self, state: str) -> Any:  # noqa: ANN401 - paho's receipt
        data = encoded("connection", self._headers["connection"], {"connectionState": state})
        return self.wire.send("connection", data, kept=True)


def _action(action: dict[str, Any], status: str) -> dict[str, Any]:
    return {
        "actionId": action["actionId"],
        "actionType": action["actionType"],
        "actionStatus": status,
    }


def _told(kind: str, what: str) -> dict[str, Any]:
    return {"infoType": kind, "infoLevel": "INFO", "infoDescription": what}


def _part(one: dict[str, Any], name: str) -> dict[str, Any]:
    return {name: one[name], "sequenceId": one["sequenceId"], "released": one["released"]}
