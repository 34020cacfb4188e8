"""Every figure that the text of chapter 5 gives, and how ours is measured beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, NamedTuple, cast

import numpy as np

from fieldmon.io.packaged import packaged_table
from fieldmon.studies.thesis.chapter5.open_choices import (
    DETECTIONS,
    LOOKS_S,
    SAMPLERS,
    SCENARIOS,
    SIZES_HA,
    SPREAD_RATES,
    TIME_HA,
    OpenChoices,
)
from fieldmon.studies.thesis.chapter5.seasons import PriorTrial

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.studies.thesis.chapter5.replicates import PriorRuns

    Floats = NDArray[np.float64]

Kind = Literal["is", "least", "above"]

_TABLE = "fieldmon/studies/thesis/chapter5/data/published.csv"
_MANY = "/"


class Case(NamedTuple):
    """What a published figure is about; None: as the open choices say."""

    sampler: str
    hectares: float
    look_s: float = 40.0
    detection: float | None = None
    rate: float | None = None

    def trial(self, choices: OpenChoices) -> PriorTrial:
        """Return the trial under given open choices."""
        if self.rate is not None:
            choices = replace(choices, spread=replace(choices.spread, rate_per_day=self.rate))
        return PriorTrial(self.sampler, choices, self.hectares, self.look_s, self.detection)


@dataclass(frozen=True, eq=False)
class Published:
    """One figure of the text.

    Parameters
    ----------
    part
        The scenario or sweep it belongs to.
    what
        What it says, in words.
    kind
        ``is``: ours should be `value`. ``least``: `value` or more. ``above``: more than `value`
        (the orderings, on paired seeds).
    value, step
        The figure, and what the fit takes as one step off.
    cases
        The seasons it is measured on.
    measure
        From their runs to one value a seed, ``(seeds,)``.
    fitted
        Whether the calibration aims at it. Orderings and what contradicts another figure are
        looked at only.
    """

    part: str
    what: str
    kind: Kind
    value: float
    step: float
    cases: tuple[Case, ...]
    measure: Callable[..., Floats]
    fitted: bool = True


def cases_of(part: str) -> tuple[Case, ...]:
    """Return the seasons that a scenario or a sweep plays."""
    if part in SCENARIOS:
        return tuple(Case(name, SCENARIOS[part]) for name in SAMPLERS)
    if part == "size":
        return tuple(Case(name, size) for size in SIZES_HA for name in SAMPLERS)
    if part == "spread":
        return tuple(Case("dynamic", SCENARIOS["B"], rate=rate) for rate in SPREAD_RATES)
    if part == "time":
        return tuple(Case("dynamic", TIME_HA, look_s=look_s) for look_s in LOOKS_S)
    return tuple(Case("dynamic", SCENARIOS["B"], detection=rate) for rate in DETECTIONS)


PARTS = (*SCENARIOS, "size", "spread", "time", "detection")


def _end(runs: PriorRuns) -> Floats:
    return runs.end_pct


def _day_1(runs: PriorRuns) -> Floats:
    return runs.detection_pct[:, 0]


def _less(measure: Callable[[PriorRuns], Floats]) -> Callable[[PriorRuns, PriorRuns], Floats]:
    """Return the first's measure less the second's, seed by seed."""
    return lambda one, other: measure(one) - measure(other)


def _sooner(level_pct: float) -> Callable[[PriorRuns, PriorRuns], Floats]:
    """Return by how many days the first reaches a level before the second."""
    return lambda one, other: other.days_to(level_pct) - one.days_to(level_pct)


def _early(one: PriorRuns, other: PriorRuns) -> Floats:
    gap: Floats = (one.detection_pct - other.detection_pct)[:, :3].mean(axis=1)
    return gap


def _best_end(*runs: PriorRuns) -> Floats:
    return max((each.end_pct for each in runs), key=np.mean)


def _worst_end(*runs: PriorRuns) -> Floats:
    return min((each.end_pct for each in runs), key=np.mean)


def _fall(small: PriorRuns, middle: PriorRuns, big: PriorRuns, biggest: PriorRuns) -> Floats:
    """Return how much steeper detection falls between two sizes than between two bigger ones."""
    first = (small.end_pct - middle.end_pct) / (_ha(middle) - _ha(small))
    return first - (big.end_pct - biggest.end_pct) / (_ha(biggest) - _ha(big))


def _ha(runs: PriorRuns) -> float:
    return runs.trial.hectares or np.nan


MEASURES: dict[str, Callable[..., Floats]] = {
    "end": _end,
    "visited_a_day": lambda runs: runs.visited_a_day_pct,
    "cleared": lambda runs: runs.first_day(100.0),
    "day_1": _day_1,
    "end_less": _less(_end),
    "day_1_less": _less(_day_1),
    "first_3_days_less": _early,
    "sooner_50": _sooner(50.0),
    "sooner_80": _sooner(80.0),
    "sooner_100": _sooner(100.0),
    "best_end": _best_end,
    "worst_end": _worst_end,
    "fall": _fall,
}
"""From the runs of a figure's seasons, in their order, to one value a seed, by name."""


def _figure(row: dict[str, str]) -> Published:
    return Published(
        part=row["part"],
        what=row["what"],
        kind=cast("Kind", row["kind"]),
        value=float(row["value"]),
        step=float(row["step"]),
        cases=_cases(row),
        measure=MEASURES[row["measure"]],
        fitted=row["fitted"] == "yes",
    )


def _cases(row: dict[str, str]) -> tuple[Case, ...]:
    """Return a figure's seasons: one for each value of the columns that hold several."""
    columns = [row[name].split(_MANY) for name in Case._fields]
    n = max(len(values) for values in columns)
    seasons = zip(*(values * n if len(values) == 1 else values for values in columns), strict=True)
    return tuple(
        Case(
            sampler,
            **{k: float(v) for k, v in zip(Case._fields[1:], numbers, strict=True) if v},
        )
        for sampler, *numbers in seasons
    )


FIGURES = tuple(_figure(row) for row in packaged_table(_TABLE))
