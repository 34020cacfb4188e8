"""Seasons of chapter 5 over many paired seeds, on all cores, stoppable."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Experiment, Memory, in_settings, run
from fieldmon.studies.thesis.chapter5.open_choices import N_DAYS
from fieldmon.studies.thesis.chapter5.seasons import (
    AT_LEVEL,
    FOUND,
    INFESTED,
    LEVELS_PCT,
    NEW,
    VISITED,
    PriorTrial,
    SeedKeys,
    detection_pct,
    play,
)
from fieldmon.studies.thesis.chapter5.sites import square

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from fieldmon.simulation.experiment import Progress
    from fieldmon.studies.thesis.chapter5.sites import Site

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PriorRuns:
    """The seasons of one trial.

    Parameters
    ----------
    trial
        What was tried.
    n_plants
        Plants of the plot.
    tables
        ``(seeds, days, 9)``, see `seasons.N_COLUMNS`.
    """

    trial: PriorTrial
    n_plants: int
    tables: Floats

    @cached_property
    def detection_pct(self) -> Floats:
        """All finds so far in percent of all ever infested, ``(seeds, days)``."""
        return detection_pct(self.tables, self.trial.choices)

    @cached_property
    def visited_pct(self) -> Floats:
        """Plants inspected a day in percent, ``(seeds, days)``; NaN after the end of work."""
        return 100.0 * self.tables[..., VISITED] / self.n_plants

    @property
    def end_pct(self) -> Floats:
        """Detection on the last day, ``(seeds,)``."""
        end: Floats = self.detection_pct[:, -1]
        return end

    @property
    def visited_a_day_pct(self) -> Floats:
        """Mean share of plants inspected on a day worked, ``(seeds,)``."""
        mean: Floats = np.nanmean(self.visited_pct, axis=1)
        return mean

    @cached_property
    def left(self) -> Floats:
        """Infested plants after each day's work, ``(seeds, days)``."""
        left: Floats = self.tables[..., INFESTED] - self.tables[..., FOUND]
        return left

    def first_day(self, level_pct: float) -> Floats:
        """Return the first day, from 1, at whose end a share was found, ``(seeds,)``.

        One more than the days of the season where it never is.
        """
        reached = self.detection_pct >= level_pct - 1e-9
        never = reached.shape[1] + 1
        first: Floats = np.where(reached.any(axis=1), reached.argmax(axis=1) + 1.0, never)
        return first

    def days_to(self, level_pct: float) -> Floats:
        """Return the days of work, parts of days included, until a share was found, ``(seeds,)``.

        One of `seasons.LEVELS_PCT`; the length of the season where it never is.
        """
        when = self.tables[..., AT_LEVEL + LEVELS_PCT.index(level_pct)]
        reached = ~np.isnan(when)
        first = reached.argmax(axis=1)
        part = np.take_along_axis(when, first[:, None], axis=1)[:, 0]
        days: Floats = np.where(reached.any(axis=1), first + part, when.shape[1])
        return days

    def measures(self) -> dict[str, Floats]:
        """Return every measure of a season by name, ``(seeds,)`` each.

        ``infested_plant_days``, the grower's loss: the sum over all evenings of the plants still
        infested. ``new_infestations``: those of all nights.
        """
        return {
            "detection_end_pct": self.end_pct,
            "visited_a_day_pct": self.visited_a_day_pct,
            **{f"D{level:g}": self.first_day(level) for level in LEVELS_PCT},
            **{f"days_to_{level:g}": self.days_to(level) for level in LEVELS_PCT},
            "infested_plant_days": self.left.sum(axis=1),
            "new_infestations": self.tables[:, 1:, NEW].sum(axis=1),
            "left": self.left[:, -1],
        }


class FinishedTrials(NamedTuple):
    """What was run: by trial, and whether somebody stopped it before the end."""

    runs: dict[PriorTrial, PriorRuns]
    stopped: bool


def seed_keys(seeds: int, seed: int = 1, n_days: int = N_DAYS) -> list[SeedKeys]:
    """Return the keys of so many paired seeds."""
    if seeds < 2:
        raise SettingError(
            f"There must be at least 2 seeds for an interval, but there are {seeds}."
        )
    return [SeedKeys.of(RandomStreams(seed + k), n_days) for k in range(seeds)]


def run_trials(
    trials: Iterable[PriorTrial],
    keys: Sequence[SeedKeys],
    progress: Progress | None = None,
    site: Site | None = None,
    threads: int | None = None,
) -> FinishedTrials:
    """Play every trial once a seed; the same seed meets the same insects in all of them.

    The answer does not depend on `threads`. `progress` is called with trials done and their total.
    Ctrl-C stops the work and keeps the trials that are done. On `site` if given, else on the
    square plot that each trial names.
    """
    wanted = list(dict.fromkeys(trials))

    def simulate(trial: PriorTrial, seeds: range) -> PriorRuns:
        where = site or square(trial.hectares or 1.0)
        tables = np.stack([play(where, trial, keys[k]) for k in seeds])
        return PriorRuns(trial, len(where.grid), tables)

    # the longest first, so that no core waits for the last one
    order = sorted(wanted, key=lambda trial: -(trial.hectares or 0.0))
    experiment = Experiment(order, range(len(keys)), simulate, key=lambda trial, _: trial)
    made: Memory[PriorRuns] = Memory()
    stopped = False
    try:
        with executor.threads(threads) as workers:
            run(experiment, workers, made, in_settings(progress, len(keys)))
    except KeyboardInterrupt:
        stopped = True
    return FinishedTrials({trial: made[trial] for trial in wanted if trial in made}, stopped)
