"""One measure of one configuration: how its replicates lie, as a row of the tidy table."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import stdtrit

from fieldmon.studies.thesis.chapter4.listing_errors import (
    ALL_PUT_RIGHT,
    AS_PUBLISHED,
    NIGHT_CORRECTED,
    ListingErrors,
)
from fieldmon.studies.thesis.chapter4.trial import Prose
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.studies.thesis.chapter4.trial import Trial


@dataclass(frozen=True)
class Cell:
    """A row of the tidy table.

    Parameters
    ----------
    table, field, faces, algorithm, n, strategy, severity, viewpoints, rules
        Which configuration; `rules` says which slips were in force.
    measure
        See `runs.measures`.
    mean, low, high
        Mean over the replicates and its 95 % interval (Student).
    sd, q05, q95, replicates, aborted
        Spread of the single runs, how many have a value, and which share the listing aborted.
    thesis, thesis_verdict, reference, reference_sd, reference_verdict, note
        What others have, and how ours compares; NaN and empty where they have nothing.
    """

    table: str
    field: str
    faces: int
    algorithm: int
    n: str
    strategy: str
    severity: float
    viewpoints: int
    rules: str
    measure: str
    mean: float
    low: float
    high: float
    sd: float
    q05: float
    q95: float
    replicates: int
    aborted: float
    thesis: float = math.nan
    thesis_verdict: str = ""
    reference: float = math.nan
    reference_sd: float = math.nan
    reference_verdict: str = ""
    note: str = ""


@dataclass(frozen=True)
class Spread:
    """How the replicates of one measure lie."""

    mean: float
    low: float
    high: float
    sd: float
    q05: float
    q95: float
    replicates: int


def spread_of(values: NDArray[np.float64]) -> Spread:
    """Return mean, 95 % interval and spread of the values that are not NaN, ``(replicates,)``."""
    known = values[~np.isnan(values)]
    n = known.size
    if n == 0:
        return Spread(math.nan, math.nan, math.nan, math.nan, math.nan, math.nan, 0)
    mean = float(known.mean())
    q05, q95 = (float(q) for q in np.quantile(known, (0.05, 0.95)))
    if n == 1:
        return Spread(mean, math.nan, math.nan, math.nan, q05, q95, 1)
    if known.min() == known.max():
        exact = float(known[0])
        return Spread(exact, exact, exact, 0.0, exact, exact, n)
    sd = float(known.std(ddof=1))
    half = float(stdtrit(n - 1, 0.975)) * sd / math.sqrt(n)
    return Spread(mean, mean - half, mean + half, sd, q05, q95, n)


def rules_name(trial: Trial) -> str:
    """Return what rules a trial follows, in words."""
    rules = trial.rules
    if isinstance(rules, Prose):
        return "as described" if rules == Prose() else f"as described, {_changed(rules, Prose())}"
    if rules == AS_PUBLISHED:
        return "as published"
    if rules == NIGHT_CORRECTED:
        return "night corrected"
    if rules == ALL_PUT_RIGHT:
        return "all slips put right"
    return f"without {_changed(rules, AS_PUBLISHED)}"


def _changed(rules: ListingErrors | Prose, usual: ListingErrors | Prose) -> str:
    ours, theirs = asdict(rules), asdict(usual)
    return ", ".join(name for name in ours if ours[name] != theirs[name])


def field_name(trial: Trial) -> str:
    """Return a trial's field: its scenario's letter, or rows x vines."""
    for letter, vineyard in SCENARIOS.items():
        if vineyard == trial.vineyard:
            return letter
    field = trial.vineyard
    return f"{field.vine_rows} rows x {field.plants} vines, {field.between_plants_m:g} m"


def csv_text(cells: Iterable[Cell]) -> str:
    """Return the tidy table as CSV, one row a cell; empty where there is no value."""
    text = io.StringIO()
    names = [column.name for column in fields(Cell)]
    writer = csv.DictWriter(text, names, lineterminator="\n")
    writer.writeheader()
    for cell in cells:
        writer.writerow({name: _plain(value) for name, value in asdict(cell).items()})
    return text.getvalue()


def _plain(value: float | str) -> float | str:
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.6g}"
    return value
