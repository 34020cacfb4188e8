"""Published figures beside ours: interval, difference and verdict; how far a fit is off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.simulation.statistics import summary_statistics
from fieldmon.studies.thesis.chapter5.published import FIGURES, PARTS

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from fieldmon.studies.thesis.chapter5.open_choices import OpenChoices
    from fieldmon.studies.thesis.chapter5.published import Published
    from fieldmon.studies.thesis.chapter5.replicates import PriorRuns
    from fieldmon.studies.thesis.chapter5.seasons import PriorTrial

AGREES, NEAR, DIFFERS = "agrees", "near", "differs"
HOLDS, OPEN, FAILS = "holds", "open", "fails"
_FAR = 6.0


@dataclass(frozen=True)
class Compared:
    """A published figure beside ours.

    Parameters
    ----------
    part, what, published, fitted
        See `Published`; `published` says "90 or more" and the like.
    ours, low, high, seeds
        Our mean, its 95 % interval (Student) and the seeds it comes from.
    difference
        Ours less published; 0 where a bound is kept.
    verdict
        Of a figure: ``agrees`` within half a step (2.5 points, half a day), ``near`` within two
        steps, else ``differs``; whether it lies in our interval shows beside it. Of an ordering:
        ``holds`` or ``fails`` (equal or the other way round) beyond chance, else ``open``.
    """

    part: str
    what: str
    published: str
    fitted: bool
    ours: float
    low: float
    high: float
    seeds: int
    difference: float
    verdict: str


def compare(
    runs: Mapping[PriorTrial, PriorRuns], choices: OpenChoices, parts: Collection[str] = PARTS
) -> list[Compared]:
    """Return every published figure of some parts whose seasons were played, beside ours."""
    return [
        _compared(figure, values)
        for figure in FIGURES
        if figure.part in parts and (values := _values(figure, runs, choices)) is not None
    ]


def misfit(runs: Mapping[PriorTrial, PriorRuns], choices: OpenChoices) -> dict[str, float]:
    """Return how far off each part is: mean steps over its fitted figures, a figure 6 at most."""
    steps: dict[str, list[float]] = {}
    for figure in FIGURES:
        values = _values(figure, runs, choices) if figure.fitted else None
        if values is not None:
            off = abs(_difference(figure, float(np.mean(values)))) / figure.step
            steps.setdefault(figure.part, []).append(min(off, _FAR))
    return {part: sum(off) / len(off) for part, off in steps.items()}


def _values(
    figure: Published, runs: Mapping[PriorTrial, PriorRuns], choices: OpenChoices
) -> np.ndarray | None:
    trials = [case.trial(choices) for case in figure.cases]
    if not all(trial in runs for trial in trials):
        return None
    values: np.ndarray = figure.measure(*(runs[trial] for trial in trials))
    return values


def _difference(figure: Published, ours: float) -> float:
    off = ours - figure.value
    return min(off, 0.0) if figure.kind == "least" else off


def _compared(figure: Published, values: np.ndarray) -> Compared:
    ours = summary_statistics(values)
    off = _difference(figure, ours.mean)
    words = {"is": "", "least": " or more", "above": "more than "}[figure.kind]
    said = f"{figure.value:g}"
    return Compared(
        part=figure.part,
        what=figure.what,
        published=words + said if figure.kind == "above" else said + words,
        fitted=figure.fitted,
        ours=ours.mean,
        low=ours.low,
        high=ours.high,
        seeds=ours.replicates,
        difference=off,
        verdict=_verdict(figure, off, (ours.low, ours.high)),
    )


def _verdict(figure: Published, off: float, interval: tuple[float, float]) -> str:
    low, high = interval
    if figure.kind == "above":
        if low > figure.value:
            return HOLDS
        return FAILS if high <= figure.value else OPEN
    if abs(off) <= figure.step / 2:
        return AGREES
    return NEAR if abs(off) <= 2 * figure.step else DIFFERS
