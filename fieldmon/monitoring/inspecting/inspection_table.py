"""Inspections as the season's file keeps them: into its table, once each."""

from __future__ import annotations

from hashlib import sha256
from itertools import repeat
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.compute.ranges import DETECTS
from fieldmon.compute.wording import worded
from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.inspection_columns import BESIDE, COUNT, IDENTIFYING
from fieldmon.infestation.inspections import FOUND, RESULT_CODES, RESULT_NAMES, Inspections
from fieldmon.io.writers.day_file import of_face
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import beside_plot, point_blobs, touch
from fieldmon.monitoring.file.rows_that_count import COUNTS, as_it_was
from fieldmon.plot.grid import plant_numbers

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Iterable, Sequence
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.grid import PlantGrid, PlantNumbers

_DAY_S = 86_400
# of a digest
_LENGTH = 24
#: what makes an inspection the same as another, by the names of the season's file
IDENTIFIED_BY = tuple(column.kept for column in IDENTIFYING)


def ever_recorded(db: sqlite3.Connection) -> set[tuple[int, str, int]]:
    """Return plant, day and result of all that was ever recorded, also of what was undone."""
    wanted = "SELECT DISTINCT plant, date, result FROM inspections WHERE batch IS NOT NULL"
    return {(plant, day, RESULT_CODES.get(said, -1)) for plant, day, said in db.execute(wanted)}


def rows(
    inspections: Inspections,
    grid: PlantGrid,
    numbered: PlantNumbers,
    settings: MonitoringSettings,
    batch: tuple[int, str],
) -> list[tuple[object, ...]]:
    """Return inspections as rows of their table; raise where they do not fit.

    `batch` is its number and whose inspections these are where they do not say. Who inspected,
    what was noted and what it finds of what is there is no part of what makes one the same as
    another: a file that comes back from somebody else, or with more notes, brings nothing new, but
    may say more beside what is known (`repeated_recordings`).
    """
    _check(inspections, grid)
    plants, dates = inspections.plant, inspections.date.tolist()
    number = {day: _day(day, dates, plants, grid, settings) for day in sorted(set(dates))}
    said = kept_columns(inspections)
    marks = [_digest(*one) for one in zip(*(said[name] for name in IDENTIFIED_BY), strict=True)]
    columns: dict[str, Iterable[object]] = said | {
        "geom": point_blobs(grid.lonlat(plants)),
        "line": numbered.line[plants].tolist(),
        "number": numbered.number[plants].tolist(),
        "day": [number[on] for on in dates],
        "who": [who or batch[1] for who in said["who"]],
        "batch": repeat(batch[0], len(plants)),
        "digest": marks,
        "undone": repeat(COUNTS, len(plants)),
    }
    return [*zip(*(columns[name] for name in schema.INSPECTIONS.names), strict=True)]


def kept_columns(inspections: Inspections) -> dict[str, Sequence[Any]]:
    """Return what inspections say as the season's file keeps it, by its names of columns."""
    said: dict[str, Sequence[Any]] = {
        "plant": inspections.plant.tolist(),
        "date": [on.isoformat() for on in inspections.date.tolist()],
        "time": [*map(time_text, inspections.second.tolist())],
        "result": [RESULT_NAMES[code] for code in inspections.result.tolist()],
        "count": COUNT.to_file(inspections.count),
    }
    return said | {one.kept: one.to_file(getattr(inspections, one.name)) for one in BESIDE}


def _day(
    on: date,
    dates: list[date],
    plants: NDArray[np.int32],
    grid: PlantGrid,
    settings: MonitoringSettings,
) -> int:
    """Return the number of a day; raise `SettingError` with its first plant if there is none."""
    try:
        return settings.day(on)
    except SettingError as error:
        (line,), (number,) = plant_numbers(grid, plants[[dates.index(on)]])
        said = worded(
            "Row {line}, plant {number}: {said}",
            line=grid.line_signs[int(line)], number=int(number), said=error.args[0],
        )  # fmt: skip
        raise SettingError(said) from None


def _check(inspections: Inspections, grid: PlantGrid) -> None:
    """Raise `ObservationError` with the first that does not fit."""
    plant, count, detects = inspections.plant, inspections.count, inspections.detects
    _refuse(
        (plant < 0) | (plant >= len(grid)),
        lambda k: worded(
            "A plant's number must be 0 to {value} on this plot, but "
            "result {found} is of plant {plant}. Is it from another "
            "plot?",
            value=len(grid) - 1, found=k + 1, plant=plant[k],
        ),
    )  # fmt: skip
    _refuse(
        np.isnat(inspections.date),
        lambda k: worded(
            "Every result must have a date, but result {value} has none. Give the day of the work.",
            value=k + 1,
        ),
    )
    _refuse(
        ~(np.isnan(count) | ((count >= 0) & np.isfinite(count))),
        lambda k: worded(
            "A count must be 0 or more, but result {value} says {found}.",
            value=k + 1, found=count[k],
        ),
    )  # fmt: skip
    _refuse(
        (inspections.result != FOUND) & (count > 0),
        lambda k: worded(
            "Only a find has a count of pests, but result {value} is {said} and counts "
            "{found:g}. Say found, or give no count.",
            value=k + 1, said=worded(RESULT_NAMES[int(inspections.result[k])]),
            found=count[k],
        ),
    )  # fmt: skip
    told = ~np.isnan(detects)
    told[told] = [bool(DETECTS.broken(each)) for each in detects[told].tolist()]
    _refuse(
        told,
        lambda k: worded(
            "The chance to see an infested plant (detects) must be {rule}, but result "
            "{value} says {found:g}.",
            rule=DETECTS.broken(float(detects[k])), value=k + 1, found=detects[k],
        ),
    )  # fmt: skip
    second = inspections.second
    _refuse(
        ~(np.isnan(second) | ((second >= 0) & (second < _DAY_S))),
        lambda k: worded(
            "A time must lie within its day, but result {value} is "
            "{found} seconds after midnight.",
            value=k + 1, found=second[k],
        ),
    )  # fmt: skip


def _refuse(wrong: NDArray[np.bool_], say: Callable[[int], Worded]) -> None:
    """Raise `ObservationError` if any is wrong, and say it of the first."""
    if wrong.any():
        raise ObservationError(say(int(wrong.argmax())))


def identity(inspections: Inspections, k: int) -> tuple[object, ...]:
    """Return what makes an inspection the same as another, as the season's file has it."""
    count = inspections.count[[k]]
    said = {
        "plant": int(inspections.plant[k]),
        "date": str(inspections.date[k]),
        "time": time_text(float(inspections.second[k])),
        "result": RESULT_NAMES[int(inspections.result[k])],
        "count": COUNT.to_file(count)[0],
    }
    return tuple(said[name] for name in IDENTIFIED_BY)


def mark_of(said: tuple[object, ...]) -> str:
    """Return the digest of what makes an inspection the same as another."""
    return _digest(*said)


def _digest(*parts: object) -> str:
    text = "|".join("" if part is None else str(part) for part in parts)
    return digest(text.encode(), length=_LENGTH, end=b"")


def time_text(second: float) -> str | None:
    """Return the time of an inspection as files have it, to the second; None: it has none."""
    if np.isnan(second):
        return None
    # what rounds up to midnight is of its own day's last second
    hour, rest = divmod(min(round(second), _DAY_S - 1), 3600)
    return f"{hour:02d}:{rest // 60:02d}:{rest % 60:02d}"


def store(db: sqlite3.Connection, made: list[tuple[object, ...]]) -> NDArray[np.bool_]:
    """Add inspections that are not there yet; return ``(k,)`` which were new."""
    names = schema.INSPECTIONS.names
    into = (
        f"INSERT OR IGNORE INTO inspections ({', '.join(names)}) "  # noqa: S608 - names of ours
        f"VALUES ({', '.join('?' * len(names))})"
    )
    # counted without what the file itself notes of them
    new = [db.execute(into, (beside_plot(db, row[0]), *row[1:])).rowcount > 0 for row in made]
    touch(db, schema.INSPECTIONS.name)
    return np.array(new, bool)


def in_words(inspections: Inspections, detects: list[float]) -> dict[str, object]:
    """Return what the season's log says of inspections: how many of each result, on which days.

    And which chances to see what is there were said with them, other than the season's own.
    """
    result, on = inspections.result, inspections.date
    counts = {name: int(np.count_nonzero(result == code)) for name, code in RESULT_CODES.items()}
    days = {"from": str(on.min()), "to": str(on.max())}
    return {**counts, **days, **({"detects": detects} if detects else {})}


def number_of(db: sqlite3.Connection, plant: object, number: int) -> str:
    """Return a plant's number in its row as people say it, with the face where it has two."""
    at = "SELECT line, number FROM plants WHERE plant = ?"
    same = f"SELECT plant FROM plants WHERE (line, number) = ({at}) ORDER BY plant"  # noqa: S608 - ours
    both = [one for (one,) in db.execute(same, (plant,))]
    return of_face(number, 1 + both.index(plant) if len(both) == 2 else 0)


def not_what_they_say(db: sqlite3.Connection) -> list[int]:
    """Return rows whose digest is not that of what they say.

    Of two that a phone told alike, the second has a digest with its finding's id in it, and keeps
    it where it was corrected.
    """
    # most are as SQLite writes them; of others, as of counts of sixteen digits, Python is asked
    # the same as `digest` gives: it is called half a million times
    db.create_function("said", 1, lambda text: sha256(text).hexdigest()[:_LENGTH])
    names = ", ".join(IDENTIFIED_BY)
    text = " || '|' || ".join(f"coalesce({name}, '')" for name in IDENTIFIED_BY)
    doubted = db.execute(
        f"SELECT fid, {names}, digest FROM inspections "  # noqa: S608 - names of ours
        f"WHERE digest NOTNULL AND digest <> said(CAST({text} AS BLOB))"
    )
    wrong = {fid: mark for fid, *said, mark in doubted if _digest(*said) != mark}
    # of a finding that came to two copies which were merged, only one of its rows is known
    told = [one for (one,) in db.execute("SELECT id FROM tellings")] if wrong else []
    said = f"SELECT {names} FROM inspections WHERE fid = ?"  # noqa: S608 - as above
    for fid, mark in list(wrong.items()):
        own = _digest(*db.execute(said, (fid,)).fetchone())
        if mark in {digest(own, one, length=_LENGTH) for one in told} or _was_corrected(db, fid):
            del wrong[fid]
    return sorted(wrong)


def _was_corrected(db: sqlite3.Connection, inspection: int) -> bool:
    """Tell whether a row is what the file itself kept of one before it was corrected."""
    names = "digest", *IDENTIFIED_BY
    says = db.execute(f"SELECT {', '.join(names)} FROM inspections WHERE fid = ?", (inspection,))  # noqa: S608 - ours
    row = says.fetchone()
    corrected = db.execute(
        "SELECT before FROM outside_changes WHERE before LIKE ?", (f'%"digest": "{row[0]}"%',)
    )
    return any(tuple(as_it_was(one).get(name) for name in names) == row for (one,) in corrected)
