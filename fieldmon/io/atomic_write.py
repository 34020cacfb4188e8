"""Files appear whole or not at all."""

from __future__ import annotations

import os
import secrets
import sqlite3
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem

try:
    import fcntl
except ImportError:  # Windows: nobody waits
    fcntl = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from collections.abc import Iterator

#: SQLite's codes where another connection holds a database
HELD = frozenset({sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED})
# a database that another program holds for longer is taken for a season: nothing is risked
_GLANCE_S = 0.5


def require_place(target: Path) -> None:
    """Raise `FileProblem` unless a file of this name may be written.

    Into a folder that exists; over a plain file, but never over a season.
    """
    if target.exists() and not target.is_file():
        what = "a folder" if target.is_dir() else "not a plain file"
        raise FileProblem(
            worded(
                "{target} must be a file to write to, but it is {what}.", target=target, what=what
            )
        )
    if target.exists() and _may_be_season(target):
        raise FileProblem(
            worded(
                "{path} must be a file to write to, but it holds a season. A season is never "
                "overwritten: choose another name, or move the old file away.",
                path=target,
            )
        )
    require_folder(target)


def require_folder(target: Path) -> None:
    """Raise `FileProblem` unless the folder that a file is written into exists."""
    if not target.parent.is_dir():
        raise FileProblem(
            worded(
                "The folder {parent} must exist before {name} can be written "
                "into it. Make it, or choose another one.",
                parent=target.parent,
                name=target.name,
            )
        )


def write_whole(path: str | Path, data: bytes) -> None:
    """Write a file so that nobody ever sees half of it; raise `FileProblem` if it cannot be.

    The bytes go into a temporary file in the same folder, which then takes the name: a full disk
    or a killed process leaves what was there before.
    """
    target = Path(path)
    require_place(target)
    half = target.with_name(f".{target.name}.{secrets.token_urlsafe(6)}")
    try:
        # the system applies the umask: to read it is to set it, for all threads
        with half.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        half.replace(target)
    except OSError as error:
        raise FileProblem(
            worded(
                "{target} could not be written ({value}). Make room or choose another place.",
                target=target,
                value=why_not_written(error),
            )
        ) from error
    finally:
        with suppress(OSError):
            half.unlink(missing_ok=True)


@contextmanager
def others_waiting(folder: Path) -> Iterator[None]:
    """Have whoever calls this for the same folder wait: to read a file, and write it with more."""
    holding = -1
    try:
        if fcntl is not None:
            with suppress(OSError):  # some file systems hold nothing
                holding = os.open(folder, os.O_RDONLY)
                fcntl.flock(holding, fcntl.LOCK_EX)
        yield
    finally:
        if holding >= 0:
            os.close(holding)


def why_not_written(error: Exception) -> str:
    """Return why something could not be written, in the system's words if it has any."""
    said = error.strerror if isinstance(error, OSError) else None
    return said or worded("no room, or no leave to write")


def sqlite_code(error: sqlite3.Error) -> int:
    """Return SQLite's primary code of an error; 0: it comes from Python."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


def _may_be_season(file: Path) -> bool:
    """Return whether a file holds what every season has, be it damaged or held by a program."""
    try:
        # through SQLite: whoever else opens and closes a database takes away the locks that other
        # threads of the same program hold on it
        with closing(sqlite3.connect(file, timeout=_GLANCE_S)) as db:
            known = db.execute("SELECT 1 FROM sqlite_master WHERE name = 'fieldmon'")
            return known.fetchone() is not None
    except sqlite3.Error as error:
        if sqlite_code(error) in HELD:
            return True
    with suppress(OSError), file.open("rb") as damaged:
        head = damaged.read(1 << 16)
        return head.startswith(b"SQLite format 3\x00") and b"fieldmon" in head
    return False
