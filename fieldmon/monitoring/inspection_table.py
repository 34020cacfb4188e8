"""Results of inspections as they come in, and as the season's file keeps them."""

from __future__ import annotations

import hashlib
import shutil
import sqlite3
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import ObservationError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.infestation.observations import ABSENT, PRESENT
from fieldmon.monitoring import schema
from fieldmon.monitoring.geopackage import point_blobs, touch

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.io.readers.inspections import Findings
    from fieldmon.monitoring.settings import SeasonSetup
    from fieldmon.plot.grid import PlantGrid, RowLabel

NAMES = {CLEAN: "clean", FOUND: "found", SKIPPED: "skipped"}
RESULTS = {name: code for code, name in NAMES.items()}
_DAY_S = 86_400


@dataclass(frozen=True, eq=False)
class Results:
    """What was found at which plants, one array entry an inspection.

    Parameters
    ----------
    plant
        ``(k,)`` int.
    result
        ``(k,)`` int8: `CLEAN`, `FOUND` or `SKIPPED` (could not be inspected).
    day
        ``(k,)`` datetime64[D], the local date.
    second
        ``(k,)`` seconds since local midnight; NaN where no time was noted.
    count
        ``(k,)`` pests counted; NaN where none were.
    who, notes
        ``(k,)`` text; empty where nothing was noted.
    """

    plant: NDArray[np.integer]
    result: NDArray[np.int8]
    day: NDArray[np.datetime64]
    second: NDArray[np.float64]
    count: NDArray[np.float64]
    who: NDArray[np.str_]
    notes: NDArray[np.str_]

    def __post_init__(self) -> None:
        k = len(self.plant)
        for name, values in vars(self).items():
            if len(values) != k:
                raise ObservationError(
                    f"All columns of the results must have {k} entries, "
                    f"but {name} has {len(values)}."
                )

    def __len__(self) -> int:
        """Return the number of inspections."""
        return len(self.plant)

    @classmethod
    def of(
        cls,
        plant: NDArray[np.integer],
        result: NDArray[np.integer],
        on: np.datetime64,
        **columns: NDArray[np.generic],
    ) -> Results:
        """Return results of one date, with every column that is not given unknown."""
        k = len(plant)
        unknown: dict[str, NDArray[np.generic]] = {
            "second": np.full(k, np.nan),
            "count": np.full(k, np.nan),
            "who": np.full(k, "", np.str_),
            "notes": np.full(k, "", np.str_),
        }
        day = np.full(k, on.astype("datetime64[D]"))
        return cls(
            np.asarray(plant),
            np.asarray(result, np.int8),
            day,
            **(unknown | columns),  # type: ignore[arg-type]
        )


def results_from(findings: Findings) -> Results:
    """Return findings that were read from a file as results."""
    second = (findings.when - findings.when.astype("datetime64[D]")) / np.timedelta64(1, "s")
    code = np.full(len(findings), SKIPPED, np.int8)
    code[findings.result == PRESENT] = FOUND
    code[findings.result == ABSENT] = CLEAN
    return Results(
        findings.plant,
        code,
        findings.day.astype("datetime64[D]"),
        np.where(np.isnat(findings.when), np.nan, second),
        findings.count,
        findings.who,
        findings.notes,
    )


def counting_copy(season: Path, folder: Path) -> Path:
    """Return a copy of a season that holds only the inspections that were not undone there."""
    copy = folder / season.name
    shutil.copyfile(season, copy)
    with closing(sqlite3.connect(copy)) as db:
        db.execute("DELETE FROM inspections WHERE undone = 1")
        db.commit()
    return copy


def rows(
    results: Results, grid: PlantGrid, label: RowLabel, setup: SeasonSetup, batch: tuple[int, str]
) -> list[tuple[object, ...]]:
    """Return results as rows of the table of inspections; raise where they do not fit.

    `batch` is its number and whose results these are where they do not say. Who looked, and what
    was noted, is no part of what makes a result the same as another: a file that comes back from
    somebody else, or with more notes, brings nothing new.
    """
    _check(results, grid)
    dates = {day: day.item() for day in np.unique(results.day)}
    number = {day: setup.day(date) for day, date in dates.items()}
    places = point_blobs(grid.lonlat(results.plant))
    made: list[tuple[object, ...]] = []
    for k, (plant, code) in enumerate(
        zip(results.plant.tolist(), results.result.tolist(), strict=True)
    ):
        day = results.day[k]
        second, count = float(results.second[k]), float(results.count[k])
        at = None if np.isnan(second) else _clock(second)
        told = None if np.isnan(count) else count
        who, notes = str(results.who[k]), str(results.notes[k])
        date = dates[day].isoformat()
        mark = _digest(plant, date, at, NAMES[code], told)
        made.append(
            (
                *(places[k], plant, int(label.line[plant]), int(label.number[plant])),
                *(number[day], date, at, NAMES[code], told, who or batch[1], notes),
                *(batch[0], mark, 0),
            )
        )
    return made


def _check(results: Results, grid: PlantGrid) -> None:
    plant = results.plant
    wrong = np.flatnonzero((plant < 0) | (plant >= len(grid)))
    if wrong.size:
        raise ObservationError(
            f"A plant's number must be 0 to {len(grid) - 1} on this plot, but result "
            f"{wrong[0] + 1} is of plant {plant[wrong[0]]}. Is it from another plot?"
        )
    if np.isnat(results.day).any():
        first = int(np.flatnonzero(np.isnat(results.day))[0])
        raise ObservationError(
            f"Every result must have a date, but result {first + 1} has none. "
            "Give the day of the work."
        )
    if not np.isin(results.result, list(NAMES)).all():
        raise ObservationError(f"A result must be one of {', '.join(RESULTS)}.")
    bad = np.flatnonzero(~(np.isnan(results.count) | (results.count >= 0)))
    if bad.size:
        raise ObservationError(
            f"A count must be 0 or more, but result {bad[0] + 1} says {results.count[bad[0]]}."
        )
    late = np.flatnonzero(~(np.isnan(results.second) | (results.second < _DAY_S)))
    if late.size:
        raise ObservationError(
            f"A time must lie within its day, but result {late[0] + 1} is "
            f"{results.second[late[0]]} seconds after midnight."
        )


def _digest(*parts: object) -> str:
    text = "|".join("" if part is None else str(part) for part in parts)
    return hashlib.sha256(text.encode()).hexdigest()[:24]


def _clock(second: float) -> str:
    hour, rest = divmod(round(second) % _DAY_S, 3600)
    return f"{hour:02d}:{rest // 60:02d}:{rest % 60:02d}"


def store(db: sqlite3.Connection, made: list[tuple[object, ...]]) -> int:
    """Add inspections that are not there yet; return how many were new."""
    before = db.total_changes
    names = schema.INSPECTIONS.names
    into = (
        f"INSERT OR IGNORE INTO inspections ({', '.join(names)}) "  # noqa: S608 - names of ours
        f"VALUES ({', '.join('?' * len(names))})"
    )
    db.executemany(into, made)
    new = db.total_changes - before
    touch(db, schema.INSPECTIONS.name)
    return new


def load(db: sqlite3.Connection) -> Inspections:
    """Return the inspections that count, by day; within a day by time, untimed ones last."""
    found = db.execute(
        "SELECT plant, day, result, time FROM inspections "
        "WHERE undone = 0 AND digest IS NOT NULL "
        "ORDER BY day, time IS NULL, time, fid"
    ).fetchall()
    if not found:
        return Inspections.none()
    plant, day, result, time = zip(*found, strict=True)
    return Inspections(
        np.array(plant, np.int32),
        np.array(day, np.int32),
        np.array([RESULTS[name] for name in result], np.int8),
        np.array([_second(text) for text in time], np.float64),
    )


def _second(text: str | None) -> float:
    if text is None:
        return np.nan
    hour, minute, second = (float(part) for part in text.split(":"))
    return hour * 3600.0 + minute * 60.0 + second
