"""A day that a robot drives now, listened to over VDA 5050. No Streamlit in here."""

from __future__ import annotations

import secrets
import threading
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.drive.trace import Trace
from fieldmon.drive.vda5050.mqtt import Wire
from fieldmon.drive.vda5050.watcher import HEARS, WAITING, Heard, RobotWatcher
from fieldmon.monitoring.settings.belief_settings import BeliefSettings

from .background_work import BackgroundWork
from .driving import DayInTime

if TYPE_CHECKING:
    from fieldmon.drive.errand import Float
    from fieldmon.drive.vda5050.mqtt import Broker, RobotName
    from fieldmon.samplers.base import Scene

_EVERY_S = 0.25


class LiveDrive(BackgroundWork):
    """What a robot does now, for whoever looks; nothing is sent, whether anybody looks or not.

    Parameters
    ----------
    broker, robot
        Where it is heard, and which one.
    scene
        The plot, and what was believed before.
    """

    def __init__(self, broker: Broker, robot: RobotName, scene: Scene) -> None:
        super().__init__()
        self._where, self.scene = (broker, robot), scene
        self._watcher: RobotWatcher | None = None
        self._believed: list[tuple[float, Float]] = []
        self._lock = threading.Lock()

    def start(self) -> None:
        """Begin to listen."""
        if not self.running:
            self.problem, self._believed, self._watcher = None, [], None
            self.begin()

    def work(self) -> None:
        """Listen until it is stopped, or no tab that looks is open any more."""
        broker, robot = self._where
        # another name each time: what was missed by one who is gone is of no use
        wire = Wire(broker, f"fieldmon-seen-{secrets.token_hex(4)}", robot, HEARS)
        watcher = RobotWatcher(wire, self.scene.grid)
        self._watcher = watcher
        try:
            while not self._is_over():  # what is told while no tab is open is heard all the same
                self._stop.wait(_EVERY_S)
                with self._lock:
                    watcher.take()
        finally:
            wire.close()

    def heard(self) -> Heard:
        """Return how the robot stands."""
        if (watcher := self._watcher) is None:
            return _NOT_YET
        with self._lock:
            watcher.take()
            return watcher.heard()

    def seen(self) -> tuple[DayInTime, tuple[Float, int], Heard]:
        """Return the day so far with what is believed, the way ordered, and how it stands."""
        watcher = self._watcher
        if watcher is None:
            return DayInTime(Trace(np.empty((0, 4)), ()), []), (np.empty((0, 2)), 0), _NOT_YET
        with self._lock:
            watcher.take()
            trace = watcher.trace()
            self._learn(trace)
            return DayInTime(trace, [*self._believed]), watcher.way, watcher.heard()

    def _learn(self, trace: Trace) -> None:
        """Believe what was told since it was looked at last."""
        told = [one for one in trace.stops if one.found is not None]
        if told and (not self._believed or self._believed[-1][0] < told[-1].done_s):
            scene, settings = self.scene, BeliefSettings()
            morning = settings.first_morning(scene.grid, scene.chance)
            plants = np.array([one.plant for one in told], np.int32)
            found = np.array([one.found for one in told], np.bool_)
            now = settings.evening(morning, plants, found, scene.robot.detects)
            self._believed.append((told[-1].done_s, now.chance))


_NOT_YET = Heard(WAITING, None)
