"""Samplers, hours and looking times against each other, in the background. No Streamlit in here.

Every arm meets the same insects: a seed's start, its nights and its luck in looking are drawn from
streams that know nothing of the arm. So differences are taken seed by seed (paired).
"""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import stdtrit

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import FieldmonError
from fieldmon.infestation.prior import start_infested
from fieldmon.infestation.spread import Spread
from fieldmon.samplers import sampler
from fieldmon.simulation.metrics import SeasonFigures, figures
from fieldmon.simulation.season import SeasonSettings, Start, days

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot

    Floats = NDArray[np.float64]

_SURE = 0.975


@dataclass(frozen=True, order=True)
class Arm:
    """One way of working.

    Parameters
    ----------
    sampler
        Who chooses the plants.
    hours
        Working day.
    look_s
        Seconds at a plant; more of them find more of what is there (the thesis's viewpoints).
    """

    sampler: str
    hours: float
    look_s: float


@dataclass(frozen=True)
class Asked:
    """What is compared, and on how many seasons."""

    arms: tuple[Arm, ...]
    n_days: int
    share: float
    rate: float
    seeds: int


@dataclass(frozen=True)
class Estimate:
    """A mean over seeds with its 95 % interval (Student's t)."""

    mean: float
    low: float
    high: float


@dataclass(frozen=True)
class Outcome:
    """What an arm came to.

    Parameters
    ----------
    arm
        The way of working.
    loss
        Infested plant-days: the grower's loss, less is better.
    detection_pct
        Detection at the end of the season.
    visited_pct
        Plants inspected a day.
    half_day
        First day with half of all infestations found; the median over seeds, None if it is never.
    behind
        Loss beyond that of the best arm, seed by seed; None for the best.
    """

    arm: Arm
    loss: Estimate
    detection_pct: Estimate
    visited_pct: float
    half_day: float | None
    behind: Estimate | None


class Comparison:
    """A comparison that runs in a thread of its own and can be looked at and stopped."""

    def __init__(self, asked: Asked, plot: Plot, chance: Floats, robot: Robot) -> None:
        self.asked = asked
        self.problem: FieldmonError | None = None
        self._plot, self._chance, self._robot = plot, chance, robot
        self._seasons: dict[Arm, list[SeasonFigures]] = {arm: [] for arm in asked.arms}
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def total(self) -> int:
        """Return the number of seasons to simulate."""
        return len(self.asked.arms) * self.asked.seeds

    @property
    def done(self) -> int:
        """Return the number of seasons simulated."""
        return sum(len(walked) for walked in list(self._seasons.values()))

    @property
    def running(self) -> bool:
        """Tell whether it is at work."""
        return self._thread is not None and self._thread.is_alive()

    def start(self) -> None:
        """Begin, or go on where it was stopped."""
        if not self.running and self.done < self.total:
            self._stop.clear()
            self._thread = threading.Thread(target=self._work, daemon=True)
            self._thread.start()

    def stop(self) -> None:
        """End after the season that is being simulated; what is there is kept."""
        self._stop.set()

    def wait(self, timeout_s: float) -> None:
        """Wait for the end."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def seasons(self) -> dict[Arm, list[SeasonFigures]]:
        """Return the seasons of all seeds that every arm has been through."""
        full = min(len(walked) for walked in self._seasons.values())
        return {arm: walked[:full] for arm, walked in self._seasons.items()}

    def _work(self) -> None:
        try:
            for seed in range(1, self.asked.seeds + 1):
                for arm, walked in self._seasons.items():
                    if self._stop.is_set():
                        return
                    if len(walked) < seed:
                        walked.append(self._season(arm, seed))
        except FieldmonError as error:
            self.problem = error

    def _season(self, arm: Arm, seed: int) -> SeasonFigures:
        asked, chance = self.asked, RandomStreams(seed)
        drawn = start_infested(self._chance, asked.share, chance.of("start"))
        begin = Start(drawn[self._plot.grid.vine], self._chance)
        settings = SeasonSettings(n_days=asked.n_days, spread=Spread(asked.rate))
        robot = replace(self._robot, hours=arm.hours, look_s=arm.look_s)
        walk = days(self._plot.aisles, robot, sampler(arm.sampler), begin, settings, chance)
        return figures(walk)


def estimate(values: Floats) -> Estimate:
    """Return the mean of values ``(s,)`` and its interval; one value has no interval (NaN)."""
    mean, n = float(np.mean(values)), len(values)
    if n < 2:
        return Estimate(mean, np.nan, np.nan)
    half = float(stdtrit(n - 1, _SURE) * np.std(values, ddof=1) / np.sqrt(n))
    return Estimate(mean, mean - half, mean + half)


def outcomes(seasons: dict[Arm, list[SeasonFigures]]) -> list[Outcome]:
    """Return what each arm came to, the best first; empty while no seed is complete."""
    if not all(seasons.values()):
        return []
    losses = {
        arm: np.array([s.infested_plant_days for s in walked], float)
        for arm, walked in seasons.items()
    }
    ranked = sorted(losses, key=lambda arm: losses[arm].mean())
    best = losses[ranked[0]]
    return [
        Outcome(
            arm,
            estimate(losses[arm]),
            estimate(np.array([s.detection_pct[-1] for s in seasons[arm]])),
            float(np.mean([s.visited_pct.mean() for s in seasons[arm]])),
            _half_day(seasons[arm]),
            None if arm == ranked[0] else estimate(losses[arm] - best),
        )
        for arm in ranked
    ]


def curve(walked: list[SeasonFigures]) -> tuple[Floats, Floats, Floats]:
    """Return detection by day over the seeds, ``(d,)`` each: mean, and ends of its interval."""
    percent = np.stack([s.detection_pct for s in walked])
    mean, n = percent.mean(axis=0), len(percent)
    if n < 2:
        return mean, mean, mean
    half = stdtrit(n - 1, _SURE) * percent.std(axis=0, ddof=1) / np.sqrt(n)
    return mean, np.maximum(mean - half, 0.0), np.minimum(mean + half, 100.0)


def _half_day(walked: list[SeasonFigures]) -> float | None:
    reached = [np.inf if (day := s.first_day(50.0)) is None else day for s in walked]
    middle = float(np.median(reached))
    return middle if np.isfinite(middle) else None
