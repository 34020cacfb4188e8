"""Who listens to a robot and its fleet control without a word: a day as it is driven."""

from __future__ import annotations

import math
import queue
import time
from datetime import timedelta
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.drive.trace import Trace, TracedStop, thinned
from fieldmon.drive.track import Track
from fieldmon.drive.vda5050.messages import ACTION, LATE_S, decoded, result_of, sent_at
from fieldmon.errors import ObservationError

if TYPE_CHECKING:
    from datetime import datetime

    from fieldmon.drive.errand import Float
    from fieldmon.drive.vda5050.mqtt import Wire
    from fieldmon.plot.grid import PlantGrid

#: what is listened to
HEARS = ("state", "visualization", "connection", "order")
WAITING, LIVE, PAUSED, FAILED, LOST = "waiting", "live", "paused", "failed", "lost"
_MOST = 2000


class Heard(NamedTuple):
    """What is known of a robot now.

    Parameters
    ----------
    standing
        ``"waiting"`` (not heard yet), ``"live"``, ``"paused"``, ``"failed"`` or ``"lost"``.
    lag_s
        Seconds since it was heard; None: it was not.
    said
        What it says of an error; "" if there is none.
    """

    standing: str
    lag_s: float | None
    said: str = ""


class RobotWatcher:
    """Follows a day from the messages of both sides; sends nothing.

    Parameters
    ----------
    wire
        One that hears `HEARS` of a robot.
    grid
        The plants; what is told of others is passed by.
    """

    def __init__(self, wire: Wire, grid: PlantGrid) -> None:
        self._wire, self._grid = wire, grid
        self._east_north = grid.frame.turned(90.0)
        self._track, self._placed_s = Track(), -1.0
        self._begun: datetime | None = None
        self._last_s = 0.0
        self._plants: dict[str, int] = {}
        self._told: dict[str, TracedStop] = {}
        self._standing, self._said = WAITING, ""
        #: lon/lat ``(k, 2)`` of the way ordered, and how many of its corners are released
        self.way: tuple[Float, int] = np.empty((0, 2)), 0

    def __repr__(self) -> str:
        """Say whom it listens to."""
        return f"<RobotWatcher to {self._wire.robot.serial}: {len(self._told)} stops>"

    def take(self) -> bool:
        """Take in what was heard since; return whether there was anything."""
        for k in range(_MOST):
            try:
                kind, data = self._wire.heard.get_nowait()
            except queue.Empty:
                return k > 0
            try:
                message = decoded(kind, data)
            except ObservationError:
                continue  # whoever gives the orders says so
            self._take(kind, message)
        return True

    def heard(self) -> Heard:
        """Return what is known of the robot now."""
        at_s = [self._wire.heard_at[kind] for kind in ("state", "visualization")
                if kind in self._wire.heard_at]  # fmt: skip
        lag_s = time.monotonic() - max(at_s) if at_s else None
        return Heard(self._standing, lag_s, self._said)

    def trace(self) -> Trace:
        """Return the day so far; seconds are those since the robot was heard first."""
        poses = thinned(self._track.poses)
        heading = (90.0 - np.degrees(poses[:, 3])) % 360.0
        lonlat = self._east_north.lonlat(poses[:, 1:3])
        traced = np.column_stack([poses[:, 0], lonlat, heading])
        return Trace(traced, tuple(sorted(self._told.values())))

    def _take(self, kind: str, message: dict[str, Any]) -> None:
        if kind == "order":
            self._take_order(message)
        elif kind == "connection":
            if message["connectionState"] != "ONLINE":
                self._standing = LOST
            elif self._standing == LOST:
                self._standing = LIVE if self._begun is not None else WAITING
        else:
            at_s = self._second(sent_at(message))
            self._take_place(message.get("agvPosition"), at_s)
            if kind == "state":
                self._take_state(message, at_s)

    def _second(self, at: datetime) -> float:
        if self._begun is None:
            self._begun = at
        at_s = (at - self._begun).total_seconds()
        if at_s < self._last_s - LATE_S:  # its clock was put back
            self._begun -= timedelta(seconds=self._last_s - at_s)
            at_s = self._last_s
        self._last_s = max(at_s, self._last_s)
        return at_s

    def _take_place(self, place: dict[str, Any] | None, at_s: float) -> None:
        if place is not None and place["positionInitialized"] and at_s > self._placed_s:
            self._placed_s = at_s
            theta = math.remainder(place["theta"], math.tau)
            self._track.add(at_s, float(place["x"]), float(place["y"]), theta)

    def _take_state(self, state: dict[str, Any], at_s: float) -> None:
        stands = state.get("paused") or state["operatingMode"] != "AUTOMATIC"
        fatal = [one for one in state["errors"] if one["errorLevel"] in {"FATAL", "CRITICAL"}]
        self._standing = FAILED if fatal else PAUSED if stands else LIVE
        self._said = fatal[0].get("errorDescription") or fatal[0]["errorType"] if fatal else ""
        for one in state["actionStates"]:
            name = one["actionId"]
            plant = self._plants.get(name, -1)
            over = one["actionStatus"] in {"FINISHED", "FAILED"}
            if over and name not in self._told and 0 <= plant < len(self._grid):
                seen = one["actionStatus"] == "FINISHED"
                found = result_of(one, plant).found if seen else None
                self._told[name] = TracedStop(at_s, plant, found)

    def _take_order(self, order: dict[str, Any]) -> None:
        corners = [one["nodePosition"] for one in order["nodes"] if "nodePosition" in one]
        way = np.array([(one["x"], one["y"]) for one in corners], float).reshape(-1, 2)
        released = sum(one["released"] for one in order["nodes"] if "nodePosition" in one)
        self.way = self._east_north.lonlat(way), released
        for node in order["nodes"]:
            for action in node["actions"]:
                told = {p["key"]: p["value"] for p in action.get("actionParameters", [])}
                if action["actionType"] == ACTION and isinstance(told.get("plant"), int):
                    self._plants[action["actionId"]] = told["plant"]
