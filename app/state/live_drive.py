"""A day that robots drive now, listened to over VDA 5050. No Streamlit in here."""

from __future__ import annotations

import secrets
import threading
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.drive.trace import Trace
from fieldmon.drive.vda5050.mqtt import Ear
from fieldmon.drive.vda5050.team_watcher import TeamWatcher
from fieldmon.drive.vda5050.watcher import HEARS, WAITING, Heard
from fieldmon.monitoring.settings.belief_settings import BeliefSettings

from .background_work import BackgroundWork
from .class_changes import ClassChanges

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fieldmon.drive.errand import Float
    from fieldmon.drive.trace import TracedStop
    from fieldmon.drive.vda5050.mqtt import Broker, Watched
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Scene

    from .class_changes import ClassChange, Classes
    from .news_since import NewsSince

_EVERY_S = 0.25


class SeenRobot(NamedTuple):
    """A robot's day so far.

    Parameters
    ----------
    name
        Its serial number.
    trace
        Its way and its stops.
    way
        Lon/lat ``(k, 2)`` of the way ordered, and how many of its corners are released.
    heard
        How it stands.
    """

    name: str
    trace: Trace
    way: tuple[Float, int]
    heard: Heard


class LiveDrive(BackgroundWork):
    """What robots do now, for whoever looks; nothing is sent, whether anybody looks or not.

    Parameters
    ----------
    broker, watched
        Where they are heard, and whose.
    scene
        The plot, and what was believed before.
    robots
        How those of a team work, by name; others as the scene's does.
    """

    def __init__(
        self,
        broker: Broker,
        watched: Watched,
        scene: Scene,
        robots: Mapping[str, Robot] | None = None,
    ) -> None:
        super().__init__()
        self._where, self.scene, self._robots = (broker, watched), scene, robots or {}
        self._ear: Ear | None = None
        self._team: TeamWatcher | None = None
        self._changes: ClassChanges | None = None
        self._known = 0
        self._lock = threading.Lock()
        #: when days are planned to end, by name, as of when it was begun; None: nobody asked yet
        self.ends: dict[str, str] | None = None
        #: what browsers are told of it; None: none asked yet
        self.news: NewsSince | None = None

    def start(self) -> None:
        """Begin to listen."""
        if not self.running:
            self.problem, self._changes, self._known = None, None, 0
            self._ear = self._team = self.ends = None
            self.begin()

    def work(self) -> None:
        """Listen until it is stopped, or no tab that looks is open any more."""
        broker, watched = self._where
        # another name each time: what was missed by one who is gone is of no use
        ear = Ear(broker, f"fieldmon-seen-{secrets.token_hex(4)}", watched, HEARS)
        team = TeamWatcher(ear.inboxes, self.scene.grid)
        self._ear, self._team = ear, team
        try:
            while not self._is_over():  # what is told while no tab is open is heard all the same
                self._stop.wait(_EVERY_S)
                with self._lock:
                    team.take()
        finally:
            ear.end()

    @property
    def is_cut_off(self) -> bool:
        """Tell whether the broker is not reached any more; it is sought again."""
        return self.running and self._ear is not None and not self._ear.hears

    def works_as(self, name: str) -> Robot:
        """Return how a robot works."""
        return self._robots.get(name, self.scene.robot)

    def seen(self) -> tuple[SeenRobot, ...]:
        """Return each robot's day so far: those that are named, then those that are heard of."""
        if (team := self._team) is None:
            nothing = Trace(np.empty((0, 4)), ())
            return tuple(
                SeenRobot(name, nothing, (np.empty((0, 2)), 0), Heard(WAITING, None))
                for name in self._where[1].serials
            )
        with self._lock:
            team.take()
            return tuple(
                SeenRobot(name, one.trace(), one.way, one.heard())
                for name, one in team.robots.items()
            )

    def changes(
        self, seen: tuple[SeenRobot, ...], classes: Callable[[Float], Classes]
    ) -> list[ClassChange]:
        """Return how plants changed by what robots have told, as of each time that somebody asked.

        `classes` returns those of chances ``(n,)``; whoever asks has the same.
        """
        told = sorted(
            (stop, one.name) for one in seen for stop in one.trace.stops if stop.found is not None
        )
        with self._lock:
            changes = self._changes = self._changes or ClassChanges(classes(self.scene.chance))
            if len(told) != self._known:
                self._known = len(told)
                last_s = max([changes.last_s, *(one.done_s for one, _ in told)])
                changes.add(last_s, classes(self._learnt(told)))
            return changes.so_far

    def _learnt(self, told: list[tuple[TracedStop, str]]) -> Float:
        """Return the chances ``(n,)`` by what was told by now."""
        settings, morning = BeliefSettings(), self.scene
        before = settings.first_morning(morning.grid, morning.chance)
        plants = np.array([one.plant for one, _ in told], np.int32)
        found = np.array([one.found for one, _ in told], np.bool_)
        detects = np.array([self.works_as(name).detects for _, name in told])
        return settings.evening(before, plants, found, detects).chance
