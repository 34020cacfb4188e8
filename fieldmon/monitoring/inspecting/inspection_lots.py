"""Inspections out of the season's file: those of a long season in pieces that are read at once.

A lot is the rows of as many row numbers, kept once more as columns. The file itself drops a lot
when one of its rows is changed, whichever program changes it: see
`fieldmon.monitoring.file.schema`.
"""

from __future__ import annotations

import json
import sqlite3
import zlib
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.infestation.inspection_columns import BESIDE, COLUMNS, COUNT
from fieldmon.infestation.inspections import RESULT_CODES, Inspections
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import insert, unpacked
from fieldmon.monitoring.inspecting import repeated_recordings

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.inspection_columns import InspectionColumn

    #: by the names of `Inspections`; dates as the season numbers its days
    Columns = dict[str, NDArray[Any]]

_DAY_S = 86_400
# the row numbers that SQLite knows
_LEAST, _MOST = -(1 << 63), (1 << 63) - 1
# of each as it is kept; a text is the number of it among those of its lot
_DTYPES = {
    one.name: "<i4" if one.is_text else np.dtype(one.dtype).newbyteorder("<") for one in COLUMNS
} | {"date": "<i4"}
_TEXTS = tuple(one.name for one in COLUMNS if one.is_text)
# columns of the table that say it, by the names of `Inspections`
_FROM = {one.name: one.kept for one in COLUMNS} | {"date": "day"}
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
            if (columns := _columns(data)) is not None:
                kept[lot] = columns
    pieces, others = [], repeated_recordings.of_others(db)
    for rows, lot in _between(kept):
        pieces.append(_read(db, rows, others))
        if lot is not None:
            pieces.append(kept[lot])
    every = {name: np.concatenate([piece[name] for piece in pieces]) for name in _DTYPES}
    day, second = every["date"], every["second"]
    every["date"] = np.datetime64(begins, "D") + day
    return Inspections(**every).take(_in_order(day, second))


def digests(db: sqlite3.Connection) -> list[str]:
    """Return by which digest the file knows each inspection that `load` returns, as ordered."""
    found = db.execute(
        "SELECT digest, day, time FROM inspections WHERE undone = 0 AND digest IS NOT NULL "
        "ORDER BY fid"
    ).fetchall()
    day = np.array([of for _, of, _ in found], np.int64)
    second = np.array([second_of(at) for _, _, at in found], np.float64)
    return [found[k][0] for k in _in_order(day, second).tolist()]


def _in_order(day: NDArray[Any], second: NDArray[Any]) -> NDArray[np.intp]:
    """Return by day; within a day by time, untimed ones last."""
    return np.lexsort((second, np.isnan(second), day))


def keep(db: sqlite3.Connection) -> None:
    """Keep lots that are full and not kept yet, within the transaction that changes the file."""
    (last,) = db.execute("SELECT max(fid) FROM inspections").fetchone()
    kept = [lot for (lot,) in db.execute("SELECT lot FROM inspection_lots ORDER BY lot")]
    others = repeated_recordings.of_others(db)
    there = "SELECT DISTINCT fid >> ? FROM inspections WHERE fid >= ? AND fid <= ?"
    for rows, _ in [*_between(kept)]:
        for (lot,) in db.execute(there, (schema.LOT_BITS, *rows)).fetchall():
            first, end = _rows_of(lot)
            packed = _packed(_read(db, (first, end), others)) if end <= last else None
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


def _read(
    db: sqlite3.Connection,
    rows: tuple[int, int],
    others: dict[str, list[repeated_recordings.Beside]],
) -> Columns:
    """Return the inspections among some row numbers that count, as columns.

    `others` is what is said beside them in other rows, see `repeated_recordings.of_others`.
    """
    found = db.execute(
        f"SELECT digest, {', '.join(_FROM.values())} FROM inspections "  # noqa: S608 - names of ours
        "WHERE fid >= ? AND fid <= ? AND undone = 0 AND digest IS NOT NULL ORDER BY fid",
        rows,
    ).fetchall()
    marks, *values = zip(*found, strict=True) if found else ((),) * (len(_FROM) + 1)
    said: dict[str, list[Any]] = {one: [*column] for one, column in zip(_FROM, values, strict=True)}
    for k, mark in enumerate(marks) if others else ():
        if mark in others:
            own = {one.kept: said[one.name][k] for one in BESIDE}
            whole = repeated_recordings.together(own, others[mark])
            for one in BESIDE:
                said[one.name][k] = whole[one.kept]
    said["result"] = [RESULT_CODES[name] for name in said["result"]]
    said["second"] = [second_of(text) for text in said["second"]]
    for one in (COUNT, *BESIDE):
        said[one.name] = _each(one, said[one.name])
    return {
        name: np.array(column, object if name in _TEXTS else _DTYPES[name])
        for name, column in said.items()
    }


def _each(column: InspectionColumn, kept: list[Any]) -> list[Any]:
    """Return what a column of the table says, as inspections hold it."""
    if not column.is_text:
        return [np.nan if value is None else value for value in kept]
    texts: dict[str, str] = {}  # the same name stands in thousands of rows
    return [texts.setdefault(text, text) for text in ("" if one is None else one for one in kept)]


@lru_cache(maxsize=_DAY_S)
def second_of(text: str | None) -> float:
    """Return the seconds since midnight that a clock shows; NaN for none."""
    if text is None:
        return np.nan
    hour, minute, second = (float(part) for part in text.split(":"))
    return hour * 3600.0 + minute * 60.0 + second


def _packed(columns: Columns) -> bytes | None:
    """Return columns as bytes; None: they hold what is no text where texts belong."""
    said: dict[str, list[str]] = {}
    arrays = []
    for name, kind in _DTYPES.items():
        if name not in _TEXTS:
            arrays.append(columns[name])
            continue
        numbers: dict[Any, int] = {}
        codes = [numbers.setdefault(text, len(numbers)) for text in columns[name]]
        if not all(isinstance(text, str) for text in numbers):
            return None
        arrays.append(np.array(codes, kind))
        said[name] = [*numbers]
    # one line: JSON knows no other
    head = json.dumps([len(columns["plant"]), [*_DTYPES], said]).encode()
    return zlib.compress(head + b"\n" + b"".join(array.tobytes() for array in arrays), 1)


def _columns(data: bytes) -> Columns | None:
    """Return the columns that bytes hold; None: another version kept others."""
    at = data.index(b"\n") + 1
    n, names, *said = json.loads(data[:at])
    if names != [*_DTYPES]:
        return None
    columns: Columns = {}
    for name, kind in _DTYPES.items():
        columns[name] = np.frombuffer(data, kind, n, at)
        at += columns[name].nbytes
    for name, of in said[0].items():
        # None: an array even of one text, or of none
        columns[name] = np.array([*of, None], object)[columns[name]]
    return columns
