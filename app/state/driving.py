"""A planned day, driven by a simulated robot in a thread of its own. No Streamlit in here."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldmon.drive.day import drive_day
from fieldmon.drive.recording import Recording
from fieldmon.drive.simulated_robots import simulated_robot
from fieldmon.drive.trace import Trace, believed_on_the_way, trace_of, trace_of_bag, trace_of_stops
from fieldmon.errors import FieldmonError
from fieldmon.monitoring.estimates.monitor import Monitor
from fieldmon.monitoring.settings.belief_settings import BeliefSettings

from .background_work import BackgroundWork

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.drive.day import DrivenStop
    from fieldmon.drive.errand import Errand
    from fieldmon.drive.simulated_robots import MadeUp
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Sampler, Scene

    Floats = NDArray[np.float64]

#: what every file of MCAP begins with
_MCAP = b"\x89MCAP"


@dataclass(frozen=True, eq=False)
class DayInTime:
    """A driven day and what is believed on the way: seconds, and chances ``(n,)``."""

    trace: Trace
    believed: list[tuple[float, Floats]]

    @classmethod
    def of(cls, trace: Trace, plot: Plot, chance: Floats, robot: Robot) -> DayInTime:
        """Return it with what is believed, from the morning's chances on."""
        morning = BeliefSettings().first_morning(plot.grid, chance)
        return cls(trace, believed_on_the_way(trace, morning, robot.detects))

    @classmethod
    def of_file(cls, data: bytes, plot: Plot, scene: Scene) -> DayInTime:
        """Return the day of a file of `fieldmon drive`: a bag, or a table of stops."""
        read = trace_of_bag if data.startswith(_MCAP) else trace_of_stops
        trace = read(data, scene.aisles, scene.robot)
        return cls.of(trace, plot, scene.chance, scene.robot)


class _StoppedError(FieldmonError):
    """Nobody wants the day any more."""


class DriveRun(BackgroundWork):
    """A day that is being driven, and can be watched and stopped.

    Parameters
    ----------
    kind
        ``charged`` or ``mujoco``.
    plot, scene
        The plot, and the day as it was planned.
    sampler, made_up
        Who decides, and what is drawn.
    """

    def __init__(
        self, kind: str, plot: Plot, scene: Scene, sampler: Sampler, made_up: MadeUp
    ) -> None:
        super().__init__()
        self._kind, self._plot, self._scene = kind, plot, scene
        self._sampler, self._made_up = sampler, made_up
        self.day: DayInTime | None = None
        self.gone_s, self.said = 0.0, ""
        self.thrown_away = False

    @property
    def share(self) -> float:
        """Return how much of the day is driven, 0 to 1."""
        return min(self.gone_s / max(self._scene.seconds_left, 1.0), 1.0)

    def start(self) -> None:
        """Begin, from the morning."""
        if not self.running and self.day is None:
            self.problem, self.gone_s, self.thrown_away = None, 0.0, False
            self.begin()

    def work(self) -> None:
        """Drive the day; stopped after a stop, nothing is kept."""
        try:
            self.day = self._driven()
        except _StoppedError:
            self.gone_s, self.thrown_away = 0.0, True

    def _driven(self) -> DayInTime:
        scene = self._scene
        # what is left of a day that was begun is the whole day of this robot
        robot = replace(scene.robot, hours=scene.seconds_left / 3600)
        recording = Recording(scene.aisles, robot, scene.chance)
        driver = simulated_robot(self._kind, recording, self._sampler, self._made_up)

        def watch(stop: DrivenStop, errand: Errand) -> None:
            if self._is_over_here():
                raise _StoppedError
            recording.note(stop, errand)
            self.gone_s = recording.stops[-1].at_s

        monitor = Monitor(self._plot, self._sampler, robot, scene.chance)
        with monitor.day_in(scene) as day:
            driven = drive_day(day, scene.aisles, (robot, driver), watch)
        self.said = " ".join(driven.stuck)
        return DayInTime.of(trace_of(recording), self._plot, scene.chance, robot)
