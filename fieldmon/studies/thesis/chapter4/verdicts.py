"""Our cells beside those of the thesis and of the reference, each with a plain verdict."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.studies.thesis.chapter4 import published

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.studies.thesis.chapter4.measures import NoPriorMeasure

EQUAL, NEAR, DIFFERS, MISPRINT = "equal", "near", "differs", "misprint"
"""Verdicts on the thesis's cell: equal to our mean as printed; near it (one unit of the last digit
where nothing is random, else two standard deviations, for the thesis prints a single run)."""
AGREES = "agrees"
"""Verdict on the reference: the two means are within three standard errors of their difference."""

_HALF_DIGIT = 0.05 + 1e-9

_THESIS = published.thesis_cells()
_REFERENCE = published.reference_cells()
_DAYS = published.reference_days()


def judged_by_tables_2_to_4(cell: NoPriorMeasure) -> NoPriorMeasure:
    """Return the cell with what the thesis (severity 0.3) and the reference have, and verdicts."""
    key = (cell.field, str(cell.algorithm), cell.n, cell.measure)
    reference = _REFERENCE.get((key[0], cell.severity, *key[1:]))
    if reference is None:
        return cell
    cell = replace(
        cell,
        reference=reference.mean,
        reference_sd=reference.sd,
        reference_verdict=reference_verdict(cell, reference),
    )
    if cell.severity != 0.3:
        return cell
    note = published.MISPRINTS.get(key) or published.MISPRINTS.get((*key[:3], None), "")
    verdict = thesis_verdict(cell, _THESIS[key], misprinted=bool(note))
    return replace(cell, thesis=_THESIS[key], thesis_verdict=verdict, note=note)


def judged_by_table_5(cell: NoPriorMeasure, days: NDArray[np.float64]) -> NoPriorMeasure:
    """Return the cell with the shares of days; the verdict goes by the most likely day.

    `days` ``(replicates,)`` is the day of each replicate, 4 for never, NaN where aborted.
    """
    key = (cell.field, str(cell.algorithm), cell.n, cell.measure)
    known = days[~np.isnan(days)]
    ours = np.array([(known == day).mean() for day in published.DAYS])
    theirs = np.array(_DAYS[key])
    mean = float(theirs @ published.DAYS)
    variance = max(0.0, float(theirs @ np.square(published.DAYS)) - mean**2)
    replicates = _REFERENCE[key[0], 0.3, *key[1:3], "PVV_ED1"].replicates
    # shares are kept to three digits
    loose = math.sqrt(variance + 1e-6 * replicates)
    printed_day = int(_THESIS[key])
    near = NEAR if ours[printed_day - 1] >= 0.05 else DIFFERS
    return replace(
        cell,
        thesis=float(printed_day),
        thesis_verdict=EQUAL if int(ours.argmax()) + 1 == printed_day else near,
        reference=mean,
        reference_sd=math.sqrt(variance),
        reference_verdict=reference_verdict(cell, published.Reference(mean, loose, replicates)),
        note=", ".join(
            f"{'never' if day == published.DAYS[-1] else f'day {day}'} {share:.0%}"
            for day, share in zip(published.DAYS, ours, strict=True)
            if share > 0
        ),
    )


def thesis_verdict(cell: NoPriorMeasure, value: float, *, misprinted: bool) -> str:
    """Return how a printed value (a single run) compares with our mean."""
    if cell.replicates == 0 or math.isnan(value):
        return ""
    off = abs(cell.mean - value)
    # the thesis rounds some numbers and cuts others
    cut = cell.sd == 0 and math.floor(10 * cell.mean + 1e-9) / 10 == value
    if off <= _HALF_DIGIT or cut:
        return EQUAL
    if off <= max(2 * cell.sd, 2 * _HALF_DIGIT):
        return NEAR
    return MISPRINT if misprinted else DIFFERS


def reference_verdict(cell: NoPriorMeasure, reference: published.Reference) -> str:
    """Return whether our mean and the reference's are within three standard errors."""
    if cell.replicates < 2 or reference.replicates < 2 or math.isnan(reference.mean):
        return ""
    # the reference is kept to six digits
    rounding = 5e-6 * max(1.0, abs(reference.mean))
    error = math.hypot(
        cell.sd / math.sqrt(cell.replicates), reference.sd / math.sqrt(reference.replicates)
    )
    return AGREES if abs(cell.mean - reference.mean) <= 3 * error + rounding else DIFFERS
