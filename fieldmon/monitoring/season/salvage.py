"""Save what can be saved from a damaged season into a new file."""

from __future__ import annotations

import os
import shutil
import sqlite3
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldmon.compute.wording import worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import FieldmonError, FileProblem
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.changes.transactions import Store, refuse_newer
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import insert
from fieldmon.monitoring.season.season_file import Season

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.monitoring.file.geopackage import GeoPackageTable

_MOST_ROWS = 50_000_000
_MOST_BYTES = 2**34
# what the damaged file is called beside the new one
_OLD = "damaged"
_IS_ATTACHED = f"SELECT 1 FROM pragma_database_list WHERE name = '{_OLD}'"  # noqa: S608 - ours
_TEXTS = {"TEXT", "DATE"}
#: what is saved: a new file has its own revision and head of the log
_SAVED = tuple(table for table in schema.CAUSES if table is not schema.META)
#: what need not be worked out again as far as it follows from what was saved
_WORKED_OUT = (schema.DAYS, schema.MORNINGS)


@dataclass(frozen=True)
class Salvaged:
    """What came over.

    Parameters
    ----------
    rows
        Rows of each table that are in the new file.
    lost
        Tables of which at least one row could not be saved.
    whole
        Whether the new file works as a season again.
    why
        Why not, in a sentence; empty where it does.
    gone
        What is known to be missing, batch by batch and layer by layer, as the log notes it.
    """

    rows: dict[str, int]
    lost: tuple[str, ...]
    whole: bool
    why: str = ""
    gone: tuple[str, ...] = ()


def salvage(damaged: str | Path, to: str | Path) -> Salvaged:
    """Copy every row that can still be read from a damaged season into a new file.

    Raise `FileProblem` if nothing can be read, if a newer fieldmon wrote it, whose columns this one
    would leave out, or if the new file exists already.
    """
    source = Path(damaged)
    if not source.is_file():
        raise FileProblem(
            worded(
                "{damaged} must be a file, but there is none. Check the name.",
                damaged=damaged,
            )
        )
    with working_folder() as folder:
        copy = _padded_copy(source, Path(folder))
        with closing(sqlite3.connect(copy)) as db, suppress(sqlite3.Error, ValueError):
            refuse_newer(db, source)
        with closing(sqlite3.connect(copy)) as db, Store.new(to) as new:
            new.execute("INSERT OR REPLACE INTO fieldmon (key, value) VALUES ('revision', '0')")
            _attach(db, new, copy)
            with _written_at_once(new):
                lost = [table.name for table in _SAVED if not _taken(db, new, table)]
            rows = {table.name: _n_rows(new, table) for table in _SAVED}
            if not any(rows.values()):
                raise FileProblem(
                    worded(
                        "Something must be readable in {damaged}, but nothing is. Was it a season "
                        "of fieldmon? Take the last copy you have of it.",
                        damaged=damaged,
                    )
                )
            _take_wishes(db, new)
            gone = season_log.go_on_saved(new, lost)
            for table in _WORKED_OUT:
                _taken(db, new, table)
            # a file without derived layers still says on which day it stands
            first = (0, None, 0, 0, None, None, None, None, "", None)
            if new.execute("SELECT 1 FROM days").fetchone() is None:
                insert(new, schema.DAYS, [first])
    why = ""
    try:
        Season(to).rebuild(whole=False)
    except FieldmonError as problem:
        why = str(problem)
    return Salvaged(rows, tuple(lost), not why, why, gone)


def _take_wishes(db: sqlite3.Connection, new: sqlite3.Connection) -> None:
    """Copy what is wanted of days besides, if it can be read: routes keep their numbers."""
    with suppress(sqlite3.Error):
        kept = db.execute("SELECT key, value FROM fieldmon WHERE key LIKE 'wishes %'").fetchall()
        new.executemany("INSERT OR REPLACE INTO fieldmon (key, value) VALUES (?, ?)", kept)


def _padded_copy(source: Path, folder: Path) -> Path:
    """Return a copy as long as the file once was: SQLite reads nothing of one cut short.

    Its header holds the page size at byte 16 and the number of pages at byte 28.
    """
    copy = folder / "copy.gpkg"
    try:
        shutil.copyfile(source, copy)
    except OSError as error:
        raise FileProblem(
            worded(
                "{source} must be readable to the disk's own means, but it is not "
                "({strerror}), or there is no room for a copy of it in {parent}. Take the last "
                "copy you have of it.",
                source=source,
                strerror=error.strerror,
                parent=folder.parent,
            )
        ) from error
    with copy.open("rb") as file:
        head = file.read(32)
    pages, size = int.from_bytes(head[28:32]), int.from_bytes(head[16:18])
    whole = min(pages * (size if size > 1 else 65536), _MOST_BYTES)
    if copy.stat().st_size < whole:
        os.truncate(copy, whole)
    return copy


@contextmanager
def _written_at_once(new: sqlite3.Connection) -> Iterator[None]:
    """Let a file that nobody else has yet neither note nor sort row by row what comes in."""
    later = new.execute(
        "SELECT type, name, sql FROM sqlite_master WHERE type = 'trigger' "
        "OR type = 'index' AND tbl_name = 'inspections' ORDER BY type"
    ).fetchall()
    for kind, name, _ in later:
        new.execute(f"DROP {kind} {name}")
    yield
    for _, _, sql in later:
        try:
            new.execute(sql)
        except sqlite3.IntegrityError:  # of inspections that stand there twice the first counts
            new.execute(
                "DELETE FROM inspections WHERE undone = 0 AND digest NOTNULL AND fid NOT IN "
                "(SELECT min(fid) FROM inspections WHERE undone = 0 GROUP BY digest)"
            )
            new.execute(sql)


def _columns(db: sqlite3.Connection, table: GeoPackageTable) -> tuple[str, ...]:
    """Return which columns of a table are there: a file of an earlier version lacks some."""
    names = (table.key, *table.names)
    try:
        there = {row[1] for row in db.execute(f"PRAGMA table_info({table.name})")}
    except sqlite3.Error:
        return names
    return tuple(name for name in names if name in there) or names


def _n_rows(db: sqlite3.Connection, table: GeoPackageTable) -> int:
    (n,) = db.execute(f"SELECT count(*) FROM {table.name}").fetchone()  # noqa: S608 - ours
    return int(n)


def _taken(db: sqlite3.Connection, new: sqlite3.Connection, table: GeoPackageTable) -> bool:
    """Copy the rows of a table that can be read; return whether those are all."""
    with suppress(sqlite3.Error):  # an earlier version had no such table
        known = "SELECT 1 FROM sqlite_master WHERE name = ?"
        if db.execute(known, (table.name,)).fetchone() is None:
            return True
    names = _columns(db, table)
    if (whole := _taken_whole(db, new, table, names)) is not None:
        return whole
    found, complete = _rows(db, table, names)
    marks = ", ".join("?" * len(names))
    into = f"INSERT OR IGNORE INTO {table.name} ({', '.join(names)}) VALUES ({marks})"  # noqa: S608 - ours
    return new.executemany(into, found).rowcount == len(found) and complete


def _attach(db: sqlite3.Connection, new: sqlite3.Connection, copy: Path) -> None:
    """Let SQLite read a damaged file beside the new one, if it knows its tables at all."""
    with suppress(sqlite3.Error):
        db.execute("SELECT count(*) FROM sqlite_master").fetchone()
        new.execute(f"ATTACH ? AS {_OLD}", (str(copy),))


def _taken_whole(
    db: sqlite3.Connection, new: sqlite3.Connection, table: GeoPackageTable, names: tuple[str, ...]
) -> bool | None:
    """Copy a table of which every row can be read, within SQLite; return whether each was taken.

    None, and nothing is copied, where some cannot: those that can are looked for one by one then.
    """
    old, columns = f"{_OLD}.{table.name}", ", ".join(names)
    try:  # not by the new file's connection: what it cannot read would undo what it has written
        n, elsewhere, *_ = db.execute(_all_read(table, names)).fetchone()
    except sqlite3.Error:
        return None
    if elsewhere or n > _MOST_ROWS or not new.execute(_IS_ATTACHED).fetchone():
        return None
    into = (
        f"INSERT OR IGNORE INTO main.{table.name} ({columns}) "  # noqa: S608 - names of ours
        f"SELECT {columns} FROM {old} ORDER BY {table.key}"
    )
    return not n or bool(new.execute(into).rowcount == n)


def _all_read(table: GeoPackageTable, names: tuple[str, ...]) -> str:
    """Return a query that reads all of a table: how many rows, texts where none belong, the rest.

    SQLite itself would hand on what is no text; of those together Python says so.
    """
    kinds = {kind[0]: kind[1] for kind in map(str.split, table.columns)}
    texts = [name for name in names if kinds.get(name) in _TEXTS]
    others = [name for name in names if name not in texts]
    elsewhere = " + ".join(f"(typeof({name}) = 'text')" for name in others)
    each = (
        *("count(*)", f"sum({elsewhere})"),
        *(f"group_concat({name})" for name in texts),
        *(f"max({name})" for name in others),
    )
    return f"SELECT {', '.join(each)} FROM {table.name} NOT INDEXED"  # noqa: S608 - names of ours


def _rows(
    db: sqlite3.Connection, table: GeoPackageTable, names: tuple[str, ...]
) -> tuple[list[tuple[object, ...]], bool]:
    """Return the rows that can be read, and whether those are all.

    Read forwards up to the damage, then backwards down to it.
    """
    wanted = f"SELECT {', '.join(names)} FROM {table.name} ORDER BY {table.key}"  # noqa: S608 - ours
    forwards: list[tuple[Any, ...]] = []
    backwards: list[tuple[Any, ...]] = []
    try:
        forwards.extend(db.execute(f"{wanted} ASC LIMIT {_MOST_ROWS}"))
    except sqlite3.Error:
        pass
    else:
        return forwards, True
    with suppress(sqlite3.Error):
        for row in db.execute(f"{wanted} DESC LIMIT {_MOST_ROWS}"):
            if forwards and row[0] <= forwards[-1][0]:
                break
            backwards.append(row)
    return forwards + backwards[::-1], False
