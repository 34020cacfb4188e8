"""Who listens to a robot and its fleet control without a word: a day as it is driven."""

from __future__ import annotations

import math
import queue
import time
from datetime import timedelta
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely

from fieldmon.drive.trace import Trace, TracedStop, thinned
from fieldmon.drive.track import Track
from fieldmon.drive.vda5050.header_count import HeaderCount
from fieldmon.drive.vda5050.messages import (
    ACTION,
    LATE_S,
    OVER,
    decoded,
    is_stopped,
    result_of,
    sent_at,
)
from fieldmon.errors import ObservationError

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import datetime

    from fieldmon.drive.errand import Float
    from fieldmon.drive.vda5050.mqtt import Inbox, Wire
    from fieldmon.plot.grid import PlantGrid

#: what is listened to
HEARS = ("state", "visualization", "connection", "order")
WAITING, LIVE, PAUSED, FAILED, LOST = "waiting", "live", "paused", "failed", "lost"
#: no order yet; it waits for more of its order; its order is done; it signed off
IDLE, HELD, DONE, OFF = "idle", "held", "done", "off"
#: it drives another plot; two speak under one serial number
ELSEWHERE, DOUBLE = "elsewhere", "double"
_MOST = 2000
# so long a robot waits, or has nothing left of its order, before that is said: between two plants
# it is so for a moment
_SETTLES_S = 3.0
# the standard wants a state every 30 s at least
_SILENT_S = 60.0
# who was not heard in between and is so much further on went a way that nobody knows; who moved
# less did not change rows
_JUMP_M, _MOVED_M = 2.0, 0.5
# an order is of this plot if its plants stand so near to where they do; if it does not say where
# they stand, the robot looks from so near
_SAME_PLANT_M, _LOOKS_FROM_M = 0.5, 15.0
# who is so far from all plants is on another plot
_FAR_M = 300.0


class Heard(NamedTuple):
    """What is known of a robot now.

    Parameters
    ----------
    standing
        ``"waiting"`` (not heard yet), ``"idle"`` (no order yet), ``"live"``, ``"held"`` (it waits
        for more of its order), ``"done"`` (its order), ``"paused"``, ``"failed"``, ``"lost"``,
        ``"off"`` (it signed off), ``"elsewhere"`` (it drives another plot) or ``"double"`` (two
        speak under its serial number).
    lag_s
        Seconds since it was heard; None: it was not.
    said
        What it says of an error; "" if there is none.
    battery
        Charge in percent; None: it did not say.
    """

    standing: str
    lag_s: float | None
    said: str = ""
    battery: float | None = None


class RowsOfPlants:
    """The rows of a plot as lines that nobody drives across.

    Parameters
    ----------
    grid
        The plants.
    """

    def __init__(self, grid: PlantGrid) -> None:
        self._east_north = grid.frame.turned(90.0)
        #: ``(n, 2)`` plants, metres east and north of the plot's centre
        self.plants_m = self._east_north.xy_m(grid.lonlat())
        rows = [self.plants_m[a:b] for a, b in pairwise(grid.row_start.tolist()) if b - a > 1]
        self._lines = shapely.STRtree([shapely.LineString(row) for row in rows])
        self._all = shapely.box(*self.plants_m.min(axis=0), *self.plants_m.max(axis=0))

    def lie_between(self, a: tuple[float, float], b: tuple[float, float]) -> bool:
        """Tell whether a straight way from one place to another crosses a row."""
        way = shapely.LineString([a, b])
        return bool(len(self._lines.query(way, predicate="intersects")))

    def are_far(self, place: tuple[float, float]) -> bool:
        """Tell whether a place is far from all plants."""
        return bool(shapely.distance(self._all, shapely.Point(place)) > _FAR_M)

    def lonlat(self, places_m: Float) -> Float:
        """Return metres east and north ``(k, 2)`` as lon/lat."""
        return self._east_north.lonlat(places_m)


class RobotWatcher:
    """Follows a day from the messages of both sides; sends nothing.

    Parameters
    ----------
    wire
        One that hears `HEARS` of a robot.
    grid
        The plants; what is told of others is passed by.
    clock
        Seconds that are gone by the clock of whoever watches several; None: the day begins when
        the robot is heard first.
    rows
        Those of the grid, where several watch it.
    """

    def __init__(
        self,
        wire: Wire | Inbox,
        grid: PlantGrid,
        clock: Callable[[], float] | None = None,
        rows: RowsOfPlants | None = None,
    ) -> None:
        self._wire, self._grid, self._clock = wire, grid, clock
        self._rows = RowsOfPlants(grid) if rows is None else rows
        self._begun: datetime | None = None
        self._last_s = 0.0
        self._plants: dict[str, int] = {}
        self._told: dict[str, TracedStop] = {}
        self._headers = HeaderCount()
        self._link, self._standing, self._said = "", WAITING, ""
        self._settles_at, self._battery = 0.0, None
        self._is_elsewhere = False
        self._forget_way()

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
        return Heard(self._stands(lag_s), lag_s, self._said, self._battery)

    def trace(self) -> Trace:
        """Return the day so far; seconds are those since the robot was heard first."""
        poses = self._track.poses
        begins = np.searchsorted(poses[:, 0], self._unseen_s)
        parts = [thinned(part) for part in np.split(poses, np.unique(begins[begins > 0]))]
        poses = np.concatenate(parts)
        heading = (90.0 - np.degrees(poses[:, 3])) % 360.0
        traced = np.column_stack([poses[:, 0], self._rows.lonlat(poses[:, 1:3]), heading])
        unseen = np.cumsum([len(part) for part in parts[:-1]], dtype=int)
        return Trace(
            traced,
            tuple(sorted(self._told.values(), key=lambda one: one[:2])),
            tuple(unseen.tolist()),
        )

    def _stands(self, lag_s: float | None) -> str:
        if self._link:
            return self._link
        if self._headers.are_two:
            return DOUBLE
        if self._is_elsewhere:
            return ELSEWHERE
        if lag_s is not None and lag_s > _SILENT_S:
            return LOST
        if self._standing in {HELD, DONE} and time.monotonic() < self._settles_at:
            return LIVE
        return self._standing

    def _forget_way(self) -> None:
        """Begin a way anew: what was known of it is of another plot."""
        self._track, self._placed_s = Track(_MOVED_M), -1.0
        self._place: tuple[float, float] | None = None
        #: since the last place the connection was lost; seconds of places that are come to unseen
        self._was_lost, self._unseen_s = False, list[float]()
        #: lon/lat ``(k, 2)`` of the way ordered, and how many of its corners are released
        self.way: tuple[Float, int] = np.empty((0, 2)), 0

    def _take(self, kind: str, message: dict[str, Any]) -> None:
        if kind == "order":
            self._take_order(message)
        elif kind == "connection":
            said = message["connectionState"]
            self._link = "" if said == "ONLINE" else LOST if said == "CONNECTIONBROKEN" else OFF
            self._was_lost |= self._link != ""
        else:
            at_s = self._second(sent_at(message))
            self._take_place(message.get("agvPosition"), at_s)
            if kind == "state":
                self._take_state(message, at_s)

    def _second(self, at: datetime) -> float:
        now_s = None if self._clock is None else self._clock()
        if self._begun is None:
            self._last_s = now_s or 0.0
            self._begun = at - timedelta(seconds=self._last_s)
        at_s = (at - self._begun).total_seconds()
        # its clock was put back, or to a time that has not come yet
        is_ahead = now_s is not None and at_s > now_s + LATE_S
        if at_s < self._last_s - LATE_S or is_ahead:
            is_s = now_s if is_ahead and now_s is not None else self._last_s
            self._begun += timedelta(seconds=at_s - is_s)
            at_s = is_s
        self._last_s = max(at_s, self._last_s)
        return at_s

    def _take_place(self, place: dict[str, Any] | None, at_s: float) -> None:
        if place is None or not place["positionInitialized"] or at_s <= self._placed_s:
            return
        here = float(place["x"]), float(place["y"])
        if self._rows.are_far(here):
            self._is_of_another_plot()
        if self._is_elsewhere:
            return
        if self._place is not None:
            moved_m = math.dist(self._place, here)
            is_jump = self._was_lost and moved_m > _JUMP_M
            if is_jump or (moved_m > _MOVED_M and self._rows.lie_between(self._place, here)):
                self._unseen_s.append(at_s)
        self._placed_s, self._place, self._was_lost = at_s, here, False
        self._track.add(at_s, *here, math.remainder(place["theta"], math.tau))

    def _is_of_another_plot(self) -> None:
        self._is_elsewhere = True
        self._forget_way()
        self._told, self._plants = {}, {}

    def _take_state(self, state: dict[str, Any], at_s: float) -> None:
        self._headers.take(state["headerId"])
        self._battery, self._link = state["batteryState"]["batteryCharge"], ""
        fatal = [one for one in state["errors"] if one["errorLevel"] in {"FATAL", "CRITICAL"}]
        self._said = fatal[0].get("errorDescription") or fatal[0]["errorType"] if fatal else ""
        now = FAILED if fatal else _does(state)
        if now != self._standing:
            self._standing, self._settles_at = now, time.monotonic() + _SETTLES_S
        for one in state["actionStates"]:
            name = one["actionId"]
            plant = self._plants.get(name, -1)
            if (
                one["actionStatus"] in OVER
                and name not in self._told
                and 0 <= plant < len(self._grid)
            ):
                seen = one["actionStatus"] == "FINISHED"
                found = result_of(one, plant).found if seen else None
                self._told[name] = TracedStop(at_s, plant, found)

    def _take_order(self, order: dict[str, Any]) -> None:
        nodes = [one for one in order["nodes"] if "nodePosition" in one]
        asked = {}
        for node in order["nodes"]:
            for action in node["actions"]:
                told = {p["key"]: p["value"] for p in action.get("actionParameters", [])}
                if action["actionType"] == ACTION and isinstance(told.get("plant"), int):
                    asked[action["actionId"]] = told["plant"]
                    if not self._is_here(told, node.get("nodePosition")):
                        self._is_of_another_plot()
                        return
        if asked:
            self._is_elsewhere = False
        if self._is_elsewhere:
            return
        corners = [one["nodePosition"] for one in nodes]
        way = np.array([(one["x"], one["y"]) for one in corners], float).reshape(-1, 2)
        self.way = self._rows.lonlat(way), sum(one["released"] for one in nodes)
        self._plants |= asked

    def _is_here(self, told: dict[str, Any], node: dict[str, Any] | None) -> bool:
        """Tell whether a plant of an order stands on this plot where the order has it."""
        if not 0 <= (plant := told["plant"]) < len(self._grid):
            return False
        says = all(isinstance(told.get(name), int | float) for name in ("x", "y"))
        if (where := told if says else node) is None:
            return True
        off_m = math.dist((where["x"], where["y"]), self._rows.plants_m[plant])
        return off_m <= (_SAME_PLANT_M if says else _LOOKS_FROM_M)


def _does(state: dict[str, Any]) -> str:
    """Return what a robot does by a state without a fatal error."""
    if is_stopped(state):
        return PAUSED
    if not state["orderId"]:
        return IDLE
    nodes = state["nodeStates"]
    acts = any(one["actionStatus"] not in OVER for one in state["actionStates"])
    if acts or state["driving"] or (nodes and nodes[0]["released"]):
        return LIVE
    return HELD if nodes else DONE
