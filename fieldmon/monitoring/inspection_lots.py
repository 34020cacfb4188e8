"""Inspections out of the season's file: those of a long season in pieces that are read at once.

A lot is the rows of as many row numbers, kept once more as columns. The file itself drops a lot
when one of its rows is changed, see `fieldmon.monitoring.schema`: whichever program changes it.
"""

from __future__ import annotations

import io
import json
import zipfile
import zlib
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.infestation.inspections import RESULT_NAMES, Inspections
from fieldmon.monitoring import schema
from fieldmon.monitoring.geopackage import insert

if TYPE_CHECKING:
    import sqlite3
    from datetime import date

    from numpy.typing import NDArray

    Columns = list[NDArray[Any]]

_CODES = {name: code for code, name in RESULT_NAMES.items()}
_DAY_S = 86_400
_LOT = 1 << schema.LOT_BITS
# in the order of `Inspections`, but with numbers of days
_NUMBERS, _TEXTS = ("plant", "result", "day", "second", "count"), ("who", "notes")


def load(db: sqlite3.Connection, begins: date) -> Inspections:
    """Return the inspections that count, by day; within a day by time, untimed ones last."""
    kept = {
        (lot, n): _unpacked(mark, packed)
        for lot, n, mark, packed in db.execute(
            "SELECT lot, rows, content, columns FROM inspection_lots"
        )
    }
    pieces = [kept.get(lot) or _read(db, lot[0]) for lot in _lots(db)]
    if not pieces:
        return Inspections.none()
    columns = [np.concatenate(column) for column in zip(*pieces, strict=True)]
    day, second = columns[2], columns[3]
    columns[2] = np.datetime64(begins, "D") + day
    return Inspections(*columns).take(np.lexsort((second, np.isnan(second), day)))


def keep(db: sqlite3.Connection) -> None:
    """Keep lots that are full and not kept yet, within the transaction that changes the file."""
    (last,) = db.execute("SELECT max(fid) FROM inspections").fetchone()
    kept = {lot for (lot,) in db.execute("SELECT lot FROM inspection_lots")}
    full = range((0 if last is None else last + 1) // _LOT)
    if kept.issuperset(full):
        return
    for lot, n in _lots(db):
        if lot in full and lot not in kept:
            packed = _packed(_read(db, lot))
            if packed is not None:
                insert(db, schema.INSPECTION_LOTS, [(lot, n, digest(packed), packed)])


def _lots(db: sqlite3.Connection) -> list[tuple[int, int]]:
    """Return the lots there are, in order, and how many rows each has."""
    return db.execute(
        "SELECT fid >> ?, count(*) FROM inspections GROUP BY 1 ORDER BY 1", (schema.LOT_BITS,)
    ).fetchall()


def _read(db: sqlite3.Connection, lot: int) -> Columns:
    """Return the inspections of a lot that count, as columns."""
    found = db.execute(
        "SELECT plant, day, result, time, count, coalesce(who, ''), coalesce(notes, '') "
        "FROM inspections "
        "WHERE fid >= ? AND fid < ? AND undone = 0 AND digest IS NOT NULL ORDER BY fid",
        (lot * _LOT, (lot + 1) * _LOT),
    ).fetchall()
    plant, day, result, time, count, *said = zip(*found, strict=True) if found else ((),) * 7
    texts: dict[str, str] = {}  # the same name stands in thousands of rows
    return [
        np.array(plant, np.int32),
        np.array([_CODES[name] for name in result], np.int8),
        np.array(day, np.int32),
        np.array([second_of(text) for text in time], np.float64),
        np.array(count, np.float64),
        *(np.array([texts.setdefault(t, t) for t in column], object) for column in said),
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
    arrays = dict(zip((*_NUMBERS, *_TEXTS), columns, strict=True))
    for name in _TEXTS:
        numbers: dict[object, int] = {}
        said = [numbers.setdefault(text, len(numbers)) for text in arrays[name]]
        if not all(isinstance(text, str) for text in numbers):
            return None
        arrays[name] = np.array(said, np.int32)
        arrays[f"{name}_said"] = np.frombuffer(json.dumps([*numbers]).encode(), np.uint8)
    file = io.BytesIO()
    np.savez(file, allow_pickle=False, **arrays)
    return zlib.compress(file.getvalue(), 1)


def _unpacked(mark: str, packed: bytes) -> Columns | None:
    """Return the columns that bytes hold, or None: they are damaged."""
    if digest(packed) != mark:
        return None
    try:
        with np.load(io.BytesIO(zlib.decompress(packed)), allow_pickle=False) as file:
            arrays = dict(file)
        said = [np.array(json.loads(arrays[f"{name}_said"].tobytes()), object) for name in _TEXTS]
        texts = [of[arrays[name]] for of, name in zip(said, _TEXTS, strict=True)]
        return [*(arrays[name] for name in _NUMBERS), *texts]
    except (zlib.error, zipfile.BadZipFile, ValueError, OSError, EOFError, KeyError):
        return None
