"""What the thesis prints, and what its own listings gave when run again: facts to compare with.

The figures stand in the tables under ``data``, each with its source; here they are read.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from fieldmon.io.packaged import packaged_table

MEASURES = (
    "PVV_ED1",
    "PCD_ED1",
    "PVV_ED2",
    "PCD_ED2",
    "PVV_ED3",
    "PCD_ED3",
    "visited_all",
    "infected",
    "detected",
    "not_detected",
    "clear_pct",
)
DAYS = (1, 2, 3, 4)
THRESHOLDS = (30, 50, 80, 100)

_DATA = "fieldmon/studies/thesis/chapter4/data"


class Reference(NamedTuple):
    """A cell of the reference: mean, standard deviation and replicates with a value."""

    mean: float
    sd: float
    replicates: int


def thesis_cells() -> dict[tuple[str, str, str, str], float]:
    """Return what tables 2 to 5 print, by scenario, algorithm, N and measure (D30, ... : days)."""
    tables = (
        ("tables_2_to_4.csv", MEASURES),
        ("table_5.csv", tuple(f"D{threshold}" for threshold in THRESHOLDS)),
    )
    return {
        (*_strategy(row), measure): _number(row[measure])
        for name, measures in tables
        for row in packaged_table(f"{_DATA}/{name}")
        for measure in measures
    }


def reference_cells() -> dict[tuple[str, float, str, str, str], Reference]:
    """Return the reference, by scenario, severity, algorithm, N and measure."""
    cells = {}
    for row in packaged_table(f"{_DATA}/reference.csv"):
        scenario, algorithm, n = _strategy(row)
        key = (scenario, float(row["severity"]), algorithm, n, row["measure"])
        cells[key] = Reference(_number(row["mean"]), _number(row["sd"]), int(row["replicates"]))
    return cells


def reference_days() -> dict[tuple[str, str, str, str], tuple[float, float, float, float]]:
    """Return the share of replicates that reach D30, D50, ... on day 1, 2, 3 and never.

    By scenario, algorithm, N and measure; detected so far of those infested at the start or by
    earlier nights.
    """
    cells = {}
    for row in packaged_table(f"{_DATA}/reference_days.csv"):
        one, two, three, never = (float(row[k]) for k in ("day_1", "day_2", "day_3", "never"))
        cells[*_strategy(row), row["measure"]] = (one, two, three, never)
    return cells


def _misprints() -> dict[tuple[str, str, str, str | None], str]:
    rows = packaged_table(f"{_DATA}/misprints.csv")
    return {(*_strategy(row), row["measure"] or None): row["note"] for row in rows}


def _strategy(row: dict[str, str]) -> tuple[str, str, str]:
    return row["scenario"], row["algorithm"], row["n"]


def _number(text: str) -> float:
    return math.nan if text == "-" else float(text)


MISPRINTS = _misprints()
"""Cells known to be copies or misprints, by scenario, algorithm, N and measure (None: the row)."""
