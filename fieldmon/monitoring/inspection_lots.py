"""Inspections out of the season's file: those of a long season in pieces that are read at once.

A lot is the rows of as many row numbers, kept once more as columns. The file itself drops a lot
when one of its rows is changed, see `fieldmon.monitoring.schema`: whichever program changes it.
"""

from __future__ import annotations

import json
import sqlite3
import zlib
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.infestation.inspections import RESULT_NAMES, Inspections
from fieldmon.monitoring import schema
from fieldmon.monitoring.geopackage import insert, unpacked

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from datetime import date

    from numpy.typing import NDArray

    Columns = list[NDArray[Any]]

_CODES = {name: code for code, name in RESULT_NAMES.items()}
_DAY_S = 86_400
# the row numbers that SQLite knows
_LEAST, _MOST = -(1 << 63), (1 << 63) - 1
# in the order of `Inspections`, but with numbers of days
_NUMBERS = {"plant": "<i4", "result": "<i1", "day": "<i4", "second": "<f8", "count": "<f8"}
_TEXTS = ("who", "notes")
# stands last
_DETECTS = "<f8"
# what all lots may unpack to: notes of 500 letters for each of a million rows
_MOST_BYTES = 1 << 29


def load(db: sqlite3.Connection, begins: date) -> Inspections:
    """Return the inspections that count, by day; within a day by time, untimed ones last."""
    kept, left = {}, _MOST_BYTES
    lots = "SELECT lot, content, columns FROM inspection_lots ORDER BY lot"
    for lot, mark, packed in db.execute(lots):
        if digest(packed) == mark:  # else it is not what was kept
            try:
                data = unpacked(packed, left)
            except sqlite3.DatabaseError:
                continue
            left -= len(data)
            kept[lot] = _columns(data)
    pieces = []
    for rows, lot in _between(kept):
        pieces.append(_read(db, rows))
        if lot is not None:
            pieces.append(kept[lot])
    columns = [np.concatenate(column) for column in zip(*pieces, strict=True)]
    day, second = columns[2], columns[3]
    columns[2] = np.datetime64(begins, "D") + day
    return Inspections(*columns).take(np.lexsort((second, np.isnan(second), day)))


def keep(db: sqlite3.Connection) -> None:
    """Keep lots that are full and not kept yet, within the transaction that changes the file."""
    (last,) = db.execute("SELECT max(fid) FROM inspections").fetchone()
    kept = [lot for (lot,) in db.execute("SELECT lot FROM inspection_lots ORDER BY lot")]
    there = "SELECT DISTINCT fid >> ? FROM inspections WHERE fid >= ? AND fid <= ?"
    for rows, _ in [*_between(kept)]:
        for (lot,) in db.execute(there, (schema.LOT_BITS, *rows)).fetchall():
            first, end = _rows_of(lot)
            packed = _packed(_read(db, (first, end))) if end <= last else None
            if packed is not None:
                insert(db, schema.INSPECTION_LOTS, [(lot, digest(packed), packed)])


def _rows_of(lot: int) -> tuple[int, int]:
    """Return the first and the last row number of a lot."""
    return lot << schema.LOT_BITS, ((lot + 1) << schema.LOT_BITS) - 1


def _between(kept: Iterable[int]) -> Iterator[tuple[tuple[int, int], int | None]]:
    """Yield the first and last row numbers before each lot kept, with the lot; then of the rest."""
    first = _LEAST
    for lot in kept:
        own, last = _rows_of(lot)
        yield (first, own - 1), lot
        first = last + 1
    yield (first, _MOST), None


def _read(db: sqlite3.Connection, rows: tuple[int, int]) -> Columns:
    """Return the inspections among some row numbers that count, as columns."""
    found = db.execute(
        "SELECT plant, day, result, time, count, detects, coalesce(who, ''), coalesce(notes, '') "
        "FROM inspections "
        "WHERE fid >= ? AND fid <= ? AND undone = 0 AND digest IS NOT NULL ORDER BY fid",
        rows,
    ).fetchall()
    columns = zip(*found, strict=True) if found else ((),) * 8
    plant, day, result, time, count, detects, *said = columns
    texts: dict[str, str] = {}  # the same name stands in thousands of rows
    numbers = (
        plant,
        [_CODES[name] for name in result],
        day,
        [second_of(text) for text in time],
        [np.nan if value is None else value for value in count],
    )
    return [
        *(np.array(*one) for one in zip(numbers, _NUMBERS.values(), strict=True)),
        *(np.array([texts.setdefault(t, t) for t in column], object) for column in said),
        np.array([np.nan if value is None else value for value in detects], _DETECTS),
    ]


@lru_cache(maxsize=_DAY_S)
def second_of(text: str | None) -> float:
    """Return the seconds since midnight that a clock shows; NaN for none."""
    if text is None:
        return np.nan
    hour, minute, second = (float(part) for part in text.split(":"))
    return hour * 3600.0 + minute * 60.0 + second


def _packed(columns: Columns) -> bytes | None:
    """Return columns as bytes; None: they hold what is no text where texts belong."""
    texts, said = columns[len(_NUMBERS) : -1], []
    codes = []
    for column in texts:
        numbers: dict[object, int] = {}
        codes.append(np.array([numbers.setdefault(text, len(numbers)) for text in column], "<i4"))
        if not all(isinstance(text, str) for text in numbers):
            return None
        said.append([*numbers])
    head = json.dumps([len(columns[0]), *said]).encode()  # one line: JSON knows no other
    arrays = (*columns[: len(_NUMBERS)], *codes, columns[-1])
    return zlib.compress(head + b"\n" + b"".join(array.tobytes() for array in arrays), 1)


def _columns(data: bytes) -> Columns:
    """Return the columns that bytes hold."""
    at = data.index(b"\n") + 1
    n, *said = json.loads(data[:at])
    columns: Columns = []
    for kind in (*_NUMBERS.values(), *("<i4" for _ in _TEXTS), _DETECTS):
        columns.append(np.frombuffer(data, kind, n, at))
        at += columns[-1].nbytes
    texts = [
        np.array([*of, None], object)[codes]  # None: an array even of one text, or of none
        for of, codes in zip(said, columns[len(_NUMBERS) : -1], strict=True)
    ]
    return [*columns[: len(_NUMBERS)], *texts, columns[-1]]
