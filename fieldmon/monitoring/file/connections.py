"""A season's file opened: waited for while others hold it, kept open, never at work without end."""

from __future__ import annotations

import os
import sqlite3
import stat
import threading
import time
from contextlib import closing, contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

from fieldmon.io.atomic_write import HELD, sqlite_code
from fieldmon.monitoring.file.file_problems import no_file, sentences

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager
    from pathlib import Path

# another window's transaction takes well under a second; a backup program may hold the file longer
_PATIENCE_S = 30.0
# whoever waits for a file asks again so often, and is told so once it takes longer than a moment
_ASK_AGAIN_S, _MOMENT_S = 0.25, 1.0
# to merge a million inspections takes half of so many steps of SQLite, which last a minute; a
# stranger's view or trigger may never end
_MOST_STEPS, _STEPS = 3_000_000_000, 1_000_000
# the files that a thread keeps open within `kept_open`, by path, inode and process, which must not
# use those of one that it was forked from; None: outside of it
_KEPT = threading.local()
# how long is waited for others at most within `waiting_at_most`, in its threads, too
_MOST_S: ContextVar[float] = ContextVar("most_s")
# the files that a thread reads as of one moment within `Store.one_moment`, by path
_STILL = threading.local()


@contextmanager
def kept_open() -> Iterator[None]:
    """Let this thread open each season's file once for all that it does within this block.

    Opening it costs many times what is mostly read. Each reading still sees what the file says at
    that moment, and between transactions nothing is locked.
    """
    if _kept() is not None:
        yield
        return
    _KEPT.files = {}
    try:
        yield
    finally:
        files, _KEPT.files = _KEPT.files, None
        for db in files.values():
            db.close()


@contextmanager
def waiting_at_most(seconds: float) -> Iterator[None]:
    """Let nobody wait longer for another program that holds a season's file, within this block."""
    before = _MOST_S.set(seconds)
    try:
        yield
    finally:
        _MOST_S.reset(before)


def _patience_s() -> float:
    return min(_PATIENCE_S, _MOST_S.get(_PATIENCE_S))


def wait_until_free(
    path: Path,
    tell: Callable[[float], None],
    *,
    to_write: bool = False,
    patience_s: float | None = None,
) -> bool:
    """Wait while another program holds a season's file; return whether it is free in the end.

    `tell` hears again and again for how many seconds that has been; `patience_s`: how long to wait,
    None: as long as for any command. What else is wrong with a file is said when it is opened.
    """
    patience_s = _patience_s() if patience_s is None else patience_s
    if path in held_still() or not path.is_file():
        return True
    began = time.monotonic()
    with (
        sentences_of(path),
        opened(path) as db,
        patience(db, min(_ASK_AGAIN_S, patience_s)),
    ):
        while not _is_free(db, to_write=to_write):
            waited_s = time.monotonic() - began
            if waited_s >= patience_s:
                return False
            if waited_s >= _MOMENT_S:
                tell(waited_s)
    return True


@contextmanager
def patience(db: sqlite3.Connection, seconds: float) -> Iterator[None]:
    """Let a connection wait for others so long within this block."""
    (usual_ms,) = db.execute("PRAGMA busy_timeout").fetchone()
    db.execute(f"PRAGMA busy_timeout = {round(1000 * seconds)}")
    try:
        yield
    finally:
        db.execute(f"PRAGMA busy_timeout = {usual_ms}")


def _is_free(db: sqlite3.Connection, *, to_write: bool) -> bool:
    try:
        db.execute("BEGIN IMMEDIATE" if to_write else "BEGIN")
        db.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchone()
    except sqlite3.DatabaseError as error:
        return sqlite_code(error) not in HELD
    finally:
        if db.in_transaction:
            db.execute("ROLLBACK")
    return True


def held_still() -> dict[Path, sqlite3.Connection]:
    """Return the files that this thread reads as of one moment, by path; see `Store.one_moment`."""
    if not hasattr(_STILL, "files"):
        _STILL.files = {}
    files: dict[Path, sqlite3.Connection] = _STILL.files
    return files


def _kept() -> dict[tuple[Path, int, int], sqlite3.Connection] | None:
    return getattr(_KEPT, "files", None)


@contextmanager
def opened(path: Path, patience_s: float | None = None) -> Iterator[sqlite3.Connection]:
    """Give a connection for one transaction: one that this thread keeps, if it may."""
    inode = must_be_there(path)
    patience_s = _patience_s() if patience_s is None else patience_s
    files = _kept()
    if files is None:
        with closing(connect(path, patience_s)) as db:
            yield db
        return
    # another file of the same name is another season
    of_file = path, inode, os.getpid()
    # one that is at work belongs to whoever reads around this
    if of_file in files:
        db = files.pop(of_file)
        db.execute(f"PRAGMA busy_timeout = {round(1000 * patience_s)}")
        _limit(db)
    else:
        db = connect(path, patience_s)
    try:
        yield db
        if db.in_transaction:
            db.execute("ROLLBACK")
    except BaseException:
        db.close()  # whatever it was at is taken back
        raise
    if of_file in files:
        db.close()
    else:
        files[of_file] = db


def must_be_there(path: Path) -> int:
    """Refuse a file that is away, if for a moment: SQLite would put an empty one in its place.

    Returns its inode.
    """
    try:
        there = path.stat()
    except OSError:
        raise no_file(path) from None
    if not stat.S_ISREG(there.st_mode):
        raise no_file(path)
    return there.st_ino


def sentences_of(path: Path, into: Path | None = None) -> AbstractContextManager[None]:
    """Say what is wrong with a file, as `sentences` does of one that is waited for as usual."""
    return sentences(path, _patience_s(), into)


def connect(path: Path | str, patience_s: float | None = None) -> sqlite3.Connection:
    """Open a file that may be a stranger's: whatever it makes SQLite do comes to an end.

    A text is its address, as SQLite takes it.
    """
    # autocommit: transactions begin and end where the code says so
    patience_s = _patience_s() if patience_s is None else patience_s
    is_address = isinstance(path, str)
    db = sqlite3.connect(path, timeout=patience_s, isolation_level=None, uri=is_address)
    db.execute("PRAGMA trusted_schema = OFF")
    _limit(db)
    return db


def _limit(db: sqlite3.Connection) -> None:
    """Let what is done with a file from now on, until its next transaction, come to an end."""
    left = iter(range(_MOST_STEPS // _STEPS))
    db.set_progress_handler(lambda: next(left, None) is None, _STEPS)
