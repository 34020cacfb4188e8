"""Trials run again and again, on all cores, and what they come to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import RandomStreams, coin_table
from fieldmon.errors import SettingError
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Experiment, Memory, in_settings, run
from fieldmon.studies.thesis.chapter4 import draws, listings, prose_model
from fieldmon.studies.thesis.chapter4.listing_errors import ListingErrors
from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial, night_of, prose_walk_of, walk_of
from fieldmon.studies.thesis.chapter4.vineyard import infest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.simulation.experiment import Progress

THRESHOLDS = (30, 50, 80, 100)
NEVER = 4
"""What the reference writes for a threshold that is not reached in three days."""


@dataclass(frozen=True, eq=False)
class NoPriorRuns:
    """The replicates of a trial.

    Parameters
    ----------
    trial
        What was tried.
    days
        ``(replicates, days, 8)``, columns as in `listings`.
    aborted
        ``(replicates,)``: the night in which the listing stopped with an error, from 1; 0 if not.
    """

    trial: NoPriorTrial
    days: NDArray[np.float64]
    aborted: NDArray[np.int64]


def run_trials(
    trials: Sequence[NoPriorTrial],
    replicates: int,
    seed: int,
    progress: Progress | None = None,
    threads: int | None = None,
) -> list[NoPriorRuns]:
    """Run every trial `replicates` times; the same replicate meets the same insects in all of them.

    The answer does not depend on `threads` (default: one a core). `progress` is called with the
    number of trials done and their total.
    """
    if replicates < 2:
        raise SettingError(f"There must be at least 2 replicates, but there are {replicates}.")
    if not trials:
        return []
    most_days = max(trial.hours.days for trial in trials)
    keys = draws.keys(RandomStreams(seed), replicates, most_days)

    def simulate(trial: NoPriorTrial, seeds: range) -> NoPriorRuns:
        return _repeat(trial, keys[seeds.start : seeds.stop])

    experiment = Experiment(trials, range(replicates), simulate)
    made: Memory[NoPriorRuns] = Memory()
    with executor.threads(threads) as workers:
        run(experiment, workers, made, in_settings(progress, replicates))
    return [made[chunk.key] for chunk in experiment.chunks()]


def _repeat(trial: NoPriorTrial, keys: NDArray[np.uint64]) -> NoPriorRuns:
    if isinstance(trial.rules, ListingErrors):
        walk, night = walk_of(trial, trial.rules), night_of(trial, trial.rules)
        days, aborted = listings.repeat(walk, night, trial.START, listings.most_draws(walk), keys)
        return NoPriorRuns(trial, days, aborted)
    prose = prose_walk_of(trial, trial.rules)
    days = prose_model.repeat(prose, trial.START, prose_model.most_draws(prose), keys)
    return NoPriorRuns(trial, days, np.zeros(len(keys), np.int64))


def measures(runs: NoPriorRuns) -> dict[str, NDArray[np.float64]]:
    """Return every measure of the thesis for each replicate, ``(replicates,)`` each.

    NaN where a measure has no value: aborted runs, and 0/0. Percentages are 0..100; names are those
    of the reference. ``PVV_ED1``: faces visited on day 1 of all faces. ``PCD_ED1``: detected on day
    1 of those infested that morning. ``PCD_ALL``: detected so far of those at the start and those
    new in earlier nights. ``MD_before``, ``MD_after`` (``not_detected``): infested faces missed,
    before and after the last night. ``D30_true``: the first day at whose end that share reaches
    30 % (``listed``: with new insects as the listing counts them; ``pcd``: of that day's `PCD_ED`);
    4 where none does.
    """
    table, faces = runs.days, runs.trial.vineyard.faces
    n_days = table.shape[1]
    found = np.cumsum(table[:, :, listings.FOUND], axis=1)
    at_start = table[:, 0, listings.INFESTED]
    missed = table[:, -1, listings.INFESTED] - table[:, -1, listings.FOUND]
    after = missed + table[:, -1, listings.NEW_TRUE]
    of_today = (table[:, :, listings.FOUND], table[:, :, listings.INFESTED])
    so_far = {
        "listed": (found, _known(table, listings.NEW_COUNTED)),
        "true": (found, _known(table, listings.NEW_TRUE)),
    }
    values = {
        "visited_all": 100 * table[:, -1, listings.EVER] / faces,
        "infected": found[:, -1] + after,
        "detected": found[:, -1],
        "not_detected": after,
        "clear_pct": 100 * (faces - after) / faces,
        "MD_before": missed,
        "MD_after": after,
        "SumOfBugs_listed": so_far["listed"][1][:, -1],
        "initial_infected": at_start,
        "PCD_ALL": _percent(found[:, -1], so_far["true"][1][:, -1]),
    }
    for day in range(n_days):
        k = day + 1
        values[f"PVV_ED{k}"] = 100 * table[:, day, listings.VISITED] / faces
        values[f"PCD_ED{k}"] = _percent(of_today[0][:, day], of_today[1][:, day])
        values[f"new_true_{k}"] = table[:, day, listings.NEW_TRUE]
        values[f"new_counted_{k}"] = table[:, day, listings.NEW_COUNTED]
        values[f"time_left_{k}"] = table[:, day, listings.LEFT_S]
        for name, (part, whole) in so_far.items():
            values[f"curve_{name}_day{k}"] = _percent(part[:, day], whole[:, day])
    for threshold in THRESHOLDS:
        for name, (part, whole) in (so_far | {"pcd": of_today}).items():
            values[f"D{threshold}_{name}"] = _first_day(part, whole, threshold)
    whole_runs = runs.aborted == 0
    values = {name: np.where(whole_runs, value, np.nan) for name, value in values.items()}
    return values | {"crash_share": (~whole_runs).astype(float)}


def _known(table: NDArray[np.float64], column: int) -> NDArray[np.float64]:
    """Return the insects known of on each day: those at the start and of earlier nights."""
    new = np.cumsum(table[:, :-1, column], axis=1)
    start = table[:, :1, listings.INFESTED]
    return np.concatenate([start, start + new], axis=1)


def _percent(part: NDArray[np.float64], whole: NDArray[np.float64]) -> NDArray[np.float64]:
    percent = np.full(part.shape, np.nan)
    np.divide(100 * part, whole, out=percent, where=whole > 0)
    return percent


def _first_day(
    part: NDArray[np.float64], whole: NDArray[np.float64], threshold: int
) -> NDArray[np.float64]:
    """Return the first day, from 1, when ``part / whole`` reaches a percentage, else `NEVER`."""
    reached = (100 * part >= threshold * whole) & (whole > 0)
    return np.where(reached.any(axis=1), reached.argmax(axis=1) + 1, NEVER)


def detection_curve(
    trial: NoPriorTrial, replicates: int, seed: int, per_day: int = 24
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return working hours ``(m,)`` and the mean percentage of known insects found by then.

    As the listings draw it: of the insects known that day, with new ones as they are counted.
    """
    slips = trial.rules
    if not isinstance(slips, ListingErrors):
        raise SettingError(
            "A detection curve is drawn by the listings: choose ListingErrors, not Prose."
        )
    field, days = trial.vineyard, trial.hours.days
    walk, night = walk_of(trial, slips), night_of(trial, slips)
    at_days = np.arange(days * per_day + 1) / per_day
    trace = np.zeros((listings.most_points(walk), 2))
    total, n = np.zeros(at_days.size), 0
    for row in draws.keys(RandomStreams(seed), replicates, days):
        start = infest(field.plants, field.sides, coin_table(row[0], field.vines), trial.START)
        coins = np.stack([coin_table(key, field.faces) for key in row[2:]])
        steps = coin_table(row[1], listings.most_draws(walk))
        _, points, aborted = listings.run(walk, night, start, coins, steps, trace)
        if not aborted:
            total += listings.curve(trace, points, at_days)
            n += 1
    hours = at_days * trial.hours.day_s / 3600
    return hours, total / n if n else np.full(at_days.size, np.nan)
