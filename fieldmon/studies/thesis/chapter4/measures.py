"""One measure of one configuration: how its replicates lie, as a row of the tidy table."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

from fieldmon.studies.thesis.chapter4.listing_errors import (
    ALL_PUT_RIGHT,
    AS_PUBLISHED,
    NIGHT_CORRECTED,
    ListingErrors,
)
from fieldmon.studies.thesis.chapter4.trial import Prose
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS

if TYPE_CHECKING:
    from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial


@dataclass(frozen=True)
class NoPriorMeasure:
    """A row of the tidy table.

    Parameters
    ----------
    table, field, faces, algorithm, n, strategy, severity, viewpoints, rules
        Which configuration; `rules` says which slips were in force.
    measure
        See `replicates.measures`.
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


def rules_name(trial: NoPriorTrial) -> str:
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


def field_name(trial: NoPriorTrial) -> str:
    """Return a trial's field: its scenario's letter, or rows x vines."""
    for letter, vineyard in SCENARIOS.items():
        if vineyard == trial.vineyard:
            return letter
    field = trial.vineyard
    return f"{field.vine_rows} rows x {field.plants} vines, {field.between_plants_m:g} m"
