"""What can be wrong with a season's file, a sentence each: not there, held, full, damaged."""

from __future__ import annotations

import sqlite3
from contextlib import contextmanager
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.atomic_write import HELD, sqlite_code

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


#: the disk takes no more, though what it has is as it was
_NOT_WRITTEN = {
    sqlite3.SQLITE_IOERR_WRITE,
    sqlite3.SQLITE_IOERR_FSYNC,
    sqlite3.SQLITE_IOERR_DIR_FSYNC,
    sqlite3.SQLITE_IOERR_TRUNCATE,
}


class FileHeld(FileProblem):
    """Another program holds a season's file for longer than is waited for."""


@contextmanager
def sentences(path: Path, patience_s: float, into: Path | None = None) -> Iterator[None]:
    """Say what is wrong with a file that was waited for so long.

    Where one is read `into` another, it is that one's disk that is full.
    """
    try:
        yield
    except OverflowError as error:
        raise SettingError(
            worded(
                "A number must be small enough for {path}, but one is too "
                "large ({error}). Nothing was changed: give a smaller one.",
                path=path,
                error=error,
            )
        ) from error
    except sqlite3.Error as error:
        raise _problem(error, path, patience_s, into or path) from error


def _problem(error: sqlite3.Error, path: Path, patience_s: float, full: Path) -> FileProblem:
    """Return what SQLite's error means for somebody who has the file at `path`.

    `full` is what does not fit where the disk is full.
    """
    code = sqlite_code(error)
    if code == sqlite3.SQLITE_NOTADB:
        return FileProblem(
            worded(
                "{path} must be the file of a season (a GeoPackage), but "
                "it does not begin as one. Check the name; if it was a "
                "season, go back to a copy of it.",
                path=path,
            )
        )
    if code == sqlite3.SQLITE_INTERRUPT:
        return FileProblem(
            worded(
                "Work on a season must come to an end, but a view or a trigger in {path} "
                "does not. Open only seasons of people whom you know.",
                path=path,
            )
        )
    if code in HELD:
        return FileHeld(
            worded(
                "{path} must be free to be written, but another program "
                "has held it for {patience_s:.0f} seconds. Close that "
                "program (QGIS, a backup?) and try again; nothing was "
                "changed.",
                path=path,
                patience_s=patience_s,
            )
        )
    if (refused := _refused_by_disk(error, full)) is not None:
        return refused
    if code in {sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN}:
        return FileProblem(
            worded(
                "{path} must be a file that can be written, but it cannot "
                "({text}). Check its permissions and those of its folder; "
                "nothing was changed.",
                path=path,
                text=str(error),
            )
        )
    return damaged(path, str(error))


def _refused_by_disk(error: sqlite3.Error, path: Path) -> FileProblem | None:
    """Return that the disk takes no more of a file, if that is SQLite's error."""
    if sqlite_code(error) == sqlite3.SQLITE_FULL:
        return FileProblem(
            worded(
                "There must be room on the disk for {path}, but it is "
                "full. Nothing was changed: make room and try again.",
                path=path,
            )
        )
    if getattr(error, "sqlite_errorcode", 0) not in _NOT_WRITTEN:
        return None
    return FileProblem(
        worded(
            "The disk must take what is written to {path}, but it does not ({text}). Nothing "
            "was changed: is there room, or a limit on the size of files?",
            path=path,
            text=str(error),
        )
    )


def no_file(path: str | Path) -> FileProblem:
    """Return that there is no such file."""
    return FileProblem(
        worded(
            "{path} must be the file of a season, but there is none. "
            "Check the name, or begin one with: fieldmon init",
            path=path,
        )
    )


def damaged(path: Path, why: str) -> FileProblem:
    """Return that a file is damaged, and how what is left is saved."""
    return FileProblem(
        worded(
            "{path} is damaged ({why}). Save what can be saved into a new "
            'file with: fieldmon salvage "{path}" --output rescued.gpkg',
            path=path,
            why=" ".join(why.split()),
        )
    )
