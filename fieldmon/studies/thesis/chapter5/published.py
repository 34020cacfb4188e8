"""Every figure that the text of chapter 5 gives, and how ours is measured beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

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

PERCENT, DAYS = 5.0, 1.0
"""What a fit takes as one step off: 5 points, or 1 day."""


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
    kind: Literal["is", "least", "above"]
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


def _visited(runs: PriorRuns) -> Floats:
    return runs.visited_a_day_pct


def _cleared(runs: PriorRuns) -> Floats:
    return runs.first_day(100.0)


def _day_1(runs: PriorRuns) -> Floats:
    return runs.detection_pct[:, 0]


def _less(measure: Callable[[PriorRuns], Floats]) -> Callable[[PriorRuns, PriorRuns], Floats]:
    """Return the first's measure less the second's, seed by seed."""
    return lambda one, other: measure(one) - measure(other)


def _sooner(level_pct: float) -> Callable[[PriorRuns, PriorRuns], Floats]:
    return lambda one, other: other.days_to(level_pct) - one.days_to(level_pct)


def _fall(small: PriorRuns, middle: PriorRuns, big: PriorRuns, biggest: PriorRuns) -> Floats:
    """Return how much steeper detection falls between two sizes than between two bigger ones."""
    first = (small.end_pct - middle.end_pct) / (_ha(middle) - _ha(small))
    return first - (big.end_pct - biggest.end_pct) / (_ha(biggest) - _ha(big))


def _ha(runs: PriorRuns) -> float:
    return runs.trial.hectares or np.nan


def _scenarios() -> list[Published]:
    said = []
    for part, name, measure, value, step in (
        *(("A", name, _end, 100.0, PERCENT) for name in SAMPLERS),
        ("A", "naive", _cleared, 2.0, DAYS),
        ("A", "dynamic", _cleared, 2.0, DAYS),
        ("A", "bouncy", _cleared, 4.0, DAYS),
        ("A", "naive", _visited, 67.0, PERCENT),
        ("A", "dynamic", _visited, 53.0, PERCENT),
        ("A", "bouncy", _visited, 47.0, PERCENT),
        ("B", "dynamic", _end, 84.0, PERCENT),
        ("B", "naive", _end, 68.0, PERCENT),
        ("B", "bouncy", _end, 46.0, PERCENT),
        ("B", "naive", _visited, 15.0, PERCENT),
        ("B", "dynamic", _visited, 12.0, PERCENT),
        ("C", "dynamic", _end, 49.0, PERCENT),
        ("C", "naive", _end, 34.0, PERCENT),
        ("C", "bouncy", _end, 22.0, PERCENT),
    ):
        words = {_end: "detection at the end, %", _visited: "visited a day, %"}
        what = f"{name.capitalize()}: {words.get(measure, 'day on which 100 % are found')}"
        case = Case(name, SCENARIOS[part])
        said.append(Published(part, what, "is", value, step, (case,), measure))
    return said


def _orderings() -> list[Published]:
    said = []
    for part, one, other in (
        (part, *pair) for part in ("B", "C") for pair in (("dynamic", "naive"), ("naive", "bouncy"))
    ):
        what = f"{one.capitalize()} finds more than {other} by the end, points"
        cases = tuple(Case(name, SCENARIOS[part]) for name in (one, other))
        said.append(_looked_at(part, what, cases, _less(_end)))
    for level in (50.0, 80.0, 100.0):
        for other in ("naive", "bouncy"):
            cases = tuple(Case(name, SCENARIOS["A"]) for name in ("dynamic", other))
            what = f"Dynamic reaches {level:g} % sooner than {other}, days"
            said.append(_looked_at("A", what, cases, _sooner(level)))
    for small, big in pairwise(SIZES_HA):
        cases = (Case("dynamic", small), Case("dynamic", big))
        what = f"Dynamic finds more on {small:g} ha than on {big:g} ha, points"
        said.append(_looked_at("size", what, cases, _less(_end)))
    cases = tuple(Case("dynamic", size) for size in (7.0, 14.0, 14.0, 20.0))
    what = "The fall between 7 and 14 ha is steeper than beyond, points a ha"
    said.append(_looked_at("size", what, cases, _fall))
    return said


def _looked_at(
    part: str, what: str, cases: tuple[Case, ...], measure: Callable[..., Floats]
) -> Published:
    return Published(part, what, "above", 0.0, PERCENT, cases, measure, fitted=False)


def _aim(
    part: str, what: str, value: float, cases: tuple[Case, ...], measure: Callable[..., Floats]
) -> Published:
    return Published(part, what, "is", value, PERCENT, cases, measure)


def _sweeps() -> list[Published]:
    size = {ha: Case("dynamic", ha) for ha in SIZES_HA}
    spread = {case.rate: case for case in cases_of("spread")}
    time = {case.look_s: case for case in cases_of("time")}
    detection = {case.detection: case for case in cases_of("detection")}
    slow, fast, sure, unsure = spread[0.3], spread[0.8], detection[0.9], detection[0.4]

    def early(one: PriorRuns, other: PriorRuns) -> Floats:
        gap: Floats = (one.detection_pct - other.detection_pct)[:, :3].mean(axis=1)
        return gap

    def of_best(*runs: PriorRuns) -> Floats:
        best = max(runs, key=lambda each: float(each.end_pct.mean()))
        return best.end_pct

    def of_worst(*runs: PriorRuns) -> Floats:
        worst = min(runs, key=lambda each: float(each.end_pct.mean()))
        return worst.end_pct

    return [
        _aim("size", "1 ha: detection at the end, %", 100.0, (size[1.0],), _end),
        Published(
            part="size",
            what="1 ha: day on which 100 % are found (about a week)",
            kind="is",
            value=7.0,
            step=DAYS,
            cases=(size[1.0],),
            measure=_cleared,
            fitted=False,
        ),
        _aim(
            "size",
            "2 to 5 ha: best detection at the end (up to 90 %)",
            90.0,
            (size[2.0], size[3.0], size[5.0]),
            of_best,
        ),
        _aim(
            "spread",
            "30 less 80 % a day: detection at the end, points",
            0.0,
            (slow, fast),
            _less(_end),
        ),
        _aim(
            "spread",
            "30 less 80 % a day: detection on days 1 to 3, points",
            5.0,
            (slow, fast),
            early,
        ),
        _aim("time", "20 s: detection on day 1, %", 21.0, (time[20.0],), _day_1),
        _aim("time", "40 s: detection on day 1, %", 32.0, (time[40.0],), _day_1),
        Published(
            part="time",
            what="least detection at the end at any time, %",
            kind="least",
            value=90.0,
            step=PERCENT,
            cases=tuple(time.values()),
            measure=of_worst,
        ),
        _looked_at(
            "time", "Day 1 at 40 s less at 20 s, points", (time[40.0], time[20.0]), _less(_day_1)
        ),
        _aim(
            "detection",
            "90 less 40 %: detection on day 1, points",
            30.0,
            (sure, unsure),
            _less(_day_1),
        ),
        _aim(
            "detection",
            "90 less 40 %: detection at the end, points",
            10.0,
            (sure, unsure),
            _less(_end),
        ),
        _aim("detection", "40 %: detection at the end, %", 75.0, (unsure,), _end),
    ]


def _abstract() -> list[Published]:
    """Return what the abstract says where the chapter says otherwise."""
    a = {name: Case(name, SCENARIOS["A"]) for name in SAMPLERS}
    return [
        Published(
            "A", "abstract: Dynamic clears 1 ha 3-5 days sooner (than bouncy), days", "is", 4.0,
            DAYS, (a["dynamic"], a["bouncy"]), _sooner(100.0), fitted=False,
        ),
        Published(
            "C", "abstract: Dynamic: detection at the end, 10 ha, %", "is", 80.0, PERCENT,
            (Case("dynamic", SCENARIOS["C"]),), _end, fitted=False,
        ),
    ]  # fmt: skip


FIGURES: tuple[Published, ...] = (*_scenarios(), *_sweeps(), *_orderings(), *_abstract())
