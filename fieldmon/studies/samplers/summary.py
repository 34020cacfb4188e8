"""What the outcomes say: means, paired ratios with intervals, and sentences."""

from __future__ import annotations

import csv
import io
from dataclasses import astuple, dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import FileProblem
from fieldmon.studies.samplers.seasons import ADAPTIVE, MEASURES, NAMES, TUNED, WORDED, Outcome

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Table = dict[str, dict[str, NDArray[np.float64]]]

_RESAMPLES = 2000
_NEVER_WORSE = 1.05


@dataclass(frozen=True)
class Ratio:
    """A ratio of two means over the same seeds, with its 95 % interval (bootstrap over seeds)."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return the ratio as it is printed."""
        return f"{self.value:.2f} ({self.low:.2f}-{self.high:.2f})"


def csv_text(outcomes: Sequence[Outcome]) -> str:
    """Return outcomes as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([each.name for each in fields(Outcome)])
    writer.writerows(astuple(outcome) for outcome in outcomes)
    return text.getvalue()


def outcomes_from(text: str, name: str) -> list[Outcome]:
    """Read outcomes back from :func:`csv_text`; raise `FileProblem` if it is something else."""
    rows = list(csv.reader(io.StringIO(text)))
    if not rows or rows[0] != [each.name for each in fields(Outcome)]:
        raise FileProblem(
            f"{name} must be a table of this study to go on with, but its columns are others. "
            "Move it away, or name another folder."
        )
    return [Outcome(row[0], int(row[1]), row[2], *map(float, row[3:])) for row in rows[1:]]


def by_cell(outcomes: Sequence[Outcome], measure: str) -> Table:
    """Return one measure by cell and rival, ``(seeds,)`` each, seeds in order."""
    cells: dict[str, dict[str, dict[int, float]]] = {}
    for outcome in outcomes:
        rivals = cells.setdefault(outcome.cell, {name: {} for name in NAMES})
        rivals[outcome.who][outcome.seed] = getattr(outcome, measure)
    return {
        cell: {who: np.array([v[seed] for seed in sorted(v)]) for who, v in rivals.items()}
        for cell, rivals in cells.items()
    }


def ratio(one: NDArray[np.float64], other: NDArray[np.float64]) -> Ratio:
    """Return mean of one over mean of the other, ``(seeds,)`` paired."""
    draws = np.random.default_rng(0).integers(0, len(one), (_RESAMPLES, len(one)))
    ratios = one[draws].mean(axis=1) / np.maximum(other[draws].mean(axis=1), 1e-9)
    low, high = np.quantile(ratios, [0.025, 0.975])
    return Ratio(float(one.mean() / max(other.mean(), 1e-9)), float(low), float(high))


def sentences(outcomes: Sequence[Outcome]) -> list[str]:
    """Return what the study found, with the numbers, whichever way they fall."""
    loss = by_cell(outcomes, "infested_plant_days")
    said = []
    for other in (WORDED, TUNED):
        ratios = {cell: ratio(who[ADAPTIVE], who[other]).value for cell, who in loss.items()}
        half = sum(value <= 0.5 for value in ratios.values())
        below = sum(value < 1.0 for value in ratios.values())
        worst = max(ratios, key=ratios.__getitem__)
        said.append(
            f"Infested plant-days against {other}: at most half in {half} of {len(ratios)} cells, "
            f"fewer in {below}; geometric mean {_mean(ratios):.2f} x, "
            f"worst {ratios[worst]:.2f} x ({worst})."
        )
        worse = [cell for cell, value in ratios.items() if value > _NEVER_WORSE]
        if worse:
            said.append(f"More than 5 % worse than {other} in: {'; '.join(worse)}.")
    for measure, words in (("d50", "half"), ("d80", "80 %")):
        days = by_cell(outcomes, measure)
        later = [c for c, who in days.items() if who[ADAPTIVE].mean() > who[TUNED].mean() + 1e-9]
        said.append(
            f"Days until {words} of all infestations so far were found: no later than {TUNED} in "
            f"{len(days) - len(later)} of {len(days)} cells" + _but(later)
        )
    return [*said, _looks(outcomes)]


def _looks(outcomes: Sequence[Outcome]) -> str:
    inspected, found = by_cell(outcomes, "inspected"), by_cell(outcomes, "found")
    fewer = 0
    for cell, who in inspected.items():
        own, other = (who[name].sum() / found[cell][name].sum() for name in (ADAPTIVE, TUNED))
        fewer += own <= other
    return (
        f"Plants inspected per find over the whole season: fewer than {TUNED} in {fewer} of "
        f"{len(inspected)} cells (who stops the spread early has less left to find)."
    )


def _but(cells: Sequence[str]) -> str:
    return f"; later in {'; '.join(cells)}." if cells else "."


def _mean(ratios: dict[str, float]) -> float:
    return float(np.exp(np.mean(np.log(np.maximum(list(ratios.values()), 1e-9)))))


def means(outcomes: Sequence[Outcome]) -> dict[str, dict[str, dict[str, float]]]:
    """Return the mean of every measure by measure, cell and rival."""
    return {
        measure: {
            cell: {who: float(values.mean()) for who, values in rivals.items() if len(values)}
            for cell, rivals in by_cell(outcomes, measure).items()
        }
        for measure in MEASURES
    }
