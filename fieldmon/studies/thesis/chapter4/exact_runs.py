"""Is our simulator equal, run for run, to the thesis's listings? Files of exact runs tell."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass

import numpy as np

from fieldmon.errors import FileProblem, SettingError
from fieldmon.studies.thesis.chapter4 import listings, nights
from fieldmon.studies.thesis.chapter4.draws import portable
from fieldmon.studies.thesis.chapter4.listing_errors import (
    AS_PUBLISHED,
    NIGHT_CORRECTED,
    ListingErrors,
)
from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial, ThesisStrategy, night_of, walk_of
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS, infest

_KEY = ("func", "scenario", "n", "vp", "severity", "seed", "crash")
_DAILY = {
    "PVV": listings.VISITED,
    "det": listings.FOUND,
    "tot": listings.INFESTED,
    "newCounted": listings.NEW_COUNTED,
    "newTrue": listings.NEW_TRUE,
}
_LAST = {"endPos": listings.END, "endTime": listings.LEFT_S}
_FUNCTIONS = ("snake", "neighbor", "randomsnake", "neighborrandom")
_ROW = "_row"

# half a unit of the digits that the files print: 10 significant for percentages, 6 decimals of s
_TOLERANCE = 5.1e-9
_TOLERANCE_S = 5.1e-7


@dataclass(frozen=True)
class Difference:
    """One row of a file that our run does not repeat."""

    line: int
    run: str
    column: str
    expected: str
    found: str

    def __str__(self) -> str:
        return (
            f"line {self.line} ({self.run}): {self.column} must be {self.expected}, "
            f"but is {self.found}"
        )


@dataclass(frozen=True)
class ExactRunsCheck:
    """What a file of exact runs said."""

    name: str
    rows: int
    night: str
    differences: tuple[Difference, ...]

    @property
    def equal(self) -> bool:
        """Whether every row is repeated."""
        return not self.differences

    def __str__(self) -> str:
        how = f"{self.name}, night {self.night}"
        if self.equal:
            return f"All {self.rows} rows of {how} are equal."
        return f"{len(self.differences)} of the {self.rows} rows of {how} differ."


def golden_columns(days: int = 3) -> tuple[str, ...]:
    """Return the columns that a file of exact runs has, in order."""
    daily = tuple(f"{name}{day}" for name in _DAILY for day in range(1, days + 1))
    last = tuple(f"{name}{day}" for name in _LAST for day in range(1, days + 1))
    totals = ("visitedAll", "detected", "notDetected", "SumOfBugs")
    return (*_KEY, *daily, *totals, *last, "curvelen", "curvelast")


def compare_golden(text: str, name: str, night: str | None = None) -> ExactRunsCheck:
    """Run every row of a file of exact runs and return the rows that differ.

    Parameters
    ----------
    text
        The file: CSV with the columns of `golden_columns`, in any order.
    name
        What the file is called.
    night
        "published", or "corrected" (the two night slips put right); the file's columns do not say
        which, so that None goes by its name: corrected where that holds "fix".

    Raises
    ------
    FileProblem
        If the file has other columns or values, or no rows.
    """
    if night is None:
        night = "corrected" if "fix" in name.lower() else "published"
    if night not in ("published", "corrected"):
        raise SettingError(f"The night must be published or corrected, but it is {night!r}.")
    slips = NIGHT_CORRECTED if night == "corrected" else AS_PUBLISHED
    rows = _read(text, name)
    differences = [
        found for line, row in rows if (found := _difference(line, row, slips, name)) is not None
    ]
    return ExactRunsCheck(name, len(rows), night, tuple(differences))


def _read(text: str, name: str) -> list[tuple[int, dict[str, str]]]:
    """Return the file's rows with their line numbers."""
    reader = csv.DictReader(io.StringIO(text.lstrip("\ufeff")))
    columns = reader.fieldnames or ()
    missing = [column for column in golden_columns() if column not in columns]
    if missing:
        raise FileProblem(
            f"A file of exact runs must have the columns {', '.join(golden_columns())}, but "
            f"{name} lacks {', '.join(missing)}."
        )
    rows = [(reader.line_num, row) for row in reader]
    if not rows:
        raise FileProblem(f"A file of exact runs must have rows, but {name} has none.")
    for line, row in rows:
        if any(row[column] is None for column in golden_columns()) or None in row:
            raise FileProblem(
                f"Every row must have a value for each column, but line {line} of {name} has "
                f"{'too many' if None in row else 'too few'}."
            )
    return rows


def _trial(
    row: dict[str, str], slips: ListingErrors, where: str
) -> tuple[NoPriorTrial, ListingErrors, int]:
    """Return the trial, its slips and its seed that a row names."""
    function = row["func"].removesuffix(_ROW)
    by_pass = row["func"].endswith(_ROW)
    online = function in ("randomsnake", "neighborrandom")
    if function not in _FUNCTIONS or (by_pass and not online):
        raise FileProblem(
            f"func must be one of {', '.join(_FUNCTIONS)} (the random ones also with {_ROW!r} "
            f"behind), but it is {row['func']!r} in {where}."
        )
    if row["scenario"] not in SCENARIOS:
        raise FileProblem(f"scenario must be A, B or C, but it is {row['scenario']!r} in {where}.")
    if row["crash"] not in ("0", "1"):
        raise FileProblem(f"crash must be 0 or 1, but it is {row['crash']!r} in {where}.")
    try:
        every, viewpoints, seed = int(row["n"]), int(row["vp"]), int(row["seed"])
        severity = float(row["severity"])
    except ValueError:
        raise FileProblem(f"n, vp, severity and seed must be numbers in {where}.") from None
    if online:
        strategy = ThesisStrategy(3 if function == "randomsnake" else 5)
    else:
        strategy = ThesisStrategy(2 if function == "snake" else 4, every)
    if by_pass:
        slips = slips.without("draw_every_stop")
    trial = NoPriorTrial(SCENARIOS[row["scenario"]], strategy, viewpoints, severity, slips)
    return trial, slips, seed


def portable_run(trial: NoPriorTrial, slips: ListingErrors, seed: int) -> dict[str, float] | None:
    """Return a run on portable random numbers by the files' columns; None where it is aborted."""
    field, days = trial.vineyard, trial.hours.days
    walk, night = walk_of(trial, slips), night_of(trial, slips)
    start = infest(field.plants, field.sides, portable(seed, 0, field.vines), trial.START)
    coins = portable(seed, 1, days * field.faces).reshape(days, field.faces)
    steps = portable(seed, 2, listings.most_draws(walk))
    # the random snake's listing draws no curve
    room = 0 if walk.listing == nights.RANDOM_SNAKE else listings.most_points(walk)
    trace = np.zeros((room, 2))
    table, points, aborted = listings.run(walk, night, start, coins, steps, trace)
    if aborted:
        return None
    values = {
        f"{name}{day + 1}": table[day, column]
        for name, column in (_DAILY | _LAST).items()
        for day in range(days)
    }
    for day in range(days):
        values[f"PVV{day + 1}"] *= 100 / field.faces
    missed = table[-1, listings.INFESTED] - table[-1, listings.FOUND]
    return values | {
        "visitedAll": 100 * table[-1, listings.EVER] / field.faces,
        "detected": table[:, listings.FOUND].sum(),
        "notDetected": missed + table[-1, listings.NEW_TRUE],
        "SumOfBugs": table[0, listings.INFESTED] + table[:-1, listings.NEW_COUNTED].sum(),
        "curvelen": float(points),
        "curvelast": trace[points - 1, 1] if points else math.nan,
    }


def _difference(
    line: int, row: dict[str, str], slips: ListingErrors, name: str
) -> Difference | None:
    """Return the first column in which our run differs from a row; None if it is equal."""
    trial, slips, seed = _trial(row, slips, f"line {line} of {name}")
    label = " ".join(row[key] for key in _KEY[:-1])
    values = portable_run(trial, slips, seed)
    crash = "0" if values is not None else "1"
    if crash != row["crash"]:
        return Difference(line, label, "crash", row["crash"], crash)
    if values is None:
        return None
    for column, value in values.items():
        if not _same(row[column], float(value), column):
            return Difference(line, label, column, row[column] or "empty", f"{value:.10g}")
    return None


def _same(printed: str, value: float, column: str) -> bool:
    """Return whether a printed number is ours to the digits printed."""
    try:
        expected = float(printed)
    except ValueError:
        return False
    if math.isnan(expected) or math.isnan(value):
        return math.isnan(expected) and math.isnan(value)
    tolerance = (
        _TOLERANCE_S if column.startswith("endTime") else _TOLERANCE * max(1.0, expected / 100)
    )
    return abs(expected - value) <= tolerance
