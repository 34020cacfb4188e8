"""A season's file as a database: opened, migrated, locked; every problem a sentence."""

from __future__ import annotations

import os
import sqlite3
import tempfile
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.errors import FileProblem, SettingError
from fieldmon.monitoring.geopackage import APPLICATION_ID
from fieldmon.monitoring.schema import MIGRATIONS, VERSION, lay_out

if TYPE_CHECKING:
    from collections.abc import Iterator

KIND = "season"
# another window's transaction takes well under a second; a backup program may hold the file longer
_PATIENCE_S = 30.0
_MAGIC, _APPLICATION_AT = b"SQLite format 3\x00", 68


def is_season(path: str | Path) -> bool:
    """Tell whether a file is a season of fieldmon, by its content; never raises."""
    try:
        if not Path(path).is_file():  # opening a pipe waits until somebody writes into it
            return False
        with Path(path).open("rb") as file:
            head = file.read(100)
    except OSError:
        return False
    mark = head[_APPLICATION_AT : _APPLICATION_AT + 4]
    if not head.startswith(_MAGIC) or int.from_bytes(mark) != APPLICATION_ID:
        return False
    try:
        with closing(_connect(Path(path))) as db:
            return _version(db) is not None
    except sqlite3.Error:
        return b"fieldmon" in Path(path).read_bytes()[: 1 << 16]


class Store:
    """The file of a season.

    Each piece of work opens the file, does one transaction and closes it: nothing is held between
    clicks, so any number of windows and programs can work on one file.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path).absolute()
        if not self.path.is_file():
            raise FileProblem(
                f"{path} must be the file of a season, but there is none. "
                "Check the name, or begin one with: fieldmon init"
            )
        if not _begins_as_database(self.path):
            raise FileProblem(
                f"{path} must be the file of a season (a GeoPackage), but it does not begin as "
                "one. Check the name; if it was a season, go back to a copy of it."
            )
        with self.reading() as db:
            version = _version(db)
        if version is None:
            raise FileProblem(
                f"{path} must be the file of a season, but it was not made by fieldmon init."
            )
        if version > VERSION:
            raise FileProblem(
                f"{path} was made by a newer fieldmon (format {version}; this one reads up to "
                f"{VERSION}). Update fieldmon."
            )
        if version < VERSION:
            with self.writing() as db:
                _migrate(db)

    @classmethod
    @contextmanager
    def new(cls, path: str | Path) -> Iterator[sqlite3.Connection]:
        """Make a new file: it appears with all that is written inside this block, or not at all."""
        target = Path(path).absolute()
        if target.exists():
            raise FileProblem(
                f"{path} must be a new file, but it exists already. A season is never overwritten: "
                "choose another name, or move the old file away."
            )
        if not target.parent.is_dir():
            raise FileProblem(
                f"The folder {target.parent} must exist before {target.name} can be made in it. "
                "Make it, or choose another one."
            )
        with _beside(target) as folder:
            draft = Path(folder) / "season.gpkg"
            with _sentences(target), closing(_connect(draft)) as db:
                db.execute("BEGIN")
                lay_out(db)
                set_meta(db, "kind", KIND)
                set_meta(db, "version", str(VERSION))
                yield db
                db.execute("COMMIT")
            try:
                os.link(draft, target)  # unlike a rename it never replaces
            except FileExistsError:
                raise FileProblem(f"{path} was made by someone else just now.") from None
            except OSError:
                draft.replace(target)  # a file system without links

    @contextmanager
    def reading(self) -> Iterator[sqlite3.Connection]:
        """Give a consistent view of the file."""
        with _sentences(self.path), closing(_connect(self.path)) as db:
            db.execute("BEGIN")
            yield db

    @contextmanager
    def writing(self) -> Iterator[sqlite3.Connection]:
        """Give the file for one transaction, alone: all of it is kept, or nothing."""
        with _sentences(self.path), closing(_connect(self.path)) as db:
            # EXTRA: once this returns, not even a power cut brings the old state back
            db.execute("PRAGMA synchronous = EXTRA")
            db.execute("BEGIN IMMEDIATE")
            yield db
            db.execute("UPDATE fieldmon SET value = value + 1 WHERE key = 'revision'")
            db.execute("COMMIT")

    def check(self) -> None:
        """Read the whole file; raise `FileProblem` if it is damaged."""
        with self.reading() as db:
            said = [row[0] for row in db.execute("PRAGMA quick_check(5)")]
        if said != ["ok"]:
            raise _damaged(self.path, said[0])


@contextmanager
def _beside(target: Path) -> Iterator[str]:
    """Make a folder for a draft beside a file, so that it can take its place at once."""
    try:
        draft = tempfile.TemporaryDirectory(prefix=f".{target.name}.", dir=target.parent)
    except OSError as error:
        raise FileProblem(
            f"{target.parent} must be a folder that can be written to, but it is not "
            f"({error.strerror}). Choose another one."
        ) from error
    with draft as folder:
        yield folder


def set_meta(db: sqlite3.Connection, key: str, value: str) -> None:
    """Note something about the file."""
    db.execute("INSERT OR REPLACE INTO fieldmon (key, value) VALUES (?, ?)", (key, value))


def get_meta(db: sqlite3.Connection, key: str) -> str | None:
    """Return what was noted about the file, or None."""
    row = db.execute("SELECT value FROM fieldmon WHERE key = ?", (key,)).fetchone()
    return None if row is None else str(row[0])


def _begins_as_database(path: Path) -> bool:
    """Tell whether SQLite would open a file; it takes an empty one for an empty database."""
    try:
        if path.stat().st_size == 0:  # also what only pretends to be a file, and never ends
            return True
        with path.open("rb") as file:
            head = file.read(len(_MAGIC))
    except OSError as error:
        raise FileProblem(
            f"{path} must be readable, but it is not ({error.strerror}). Check its permissions."
        ) from error
    return not head or head == _MAGIC


def _connect(path: Path) -> sqlite3.Connection:
    # autocommit: transactions begin and end where the code says so
    db = sqlite3.connect(path, timeout=_PATIENCE_S, isolation_level=None)
    db.execute("PRAGMA trusted_schema = OFF")
    return db


def _version(db: sqlite3.Connection) -> int | None:
    known = db.execute("SELECT 1 FROM sqlite_master WHERE name = 'fieldmon'").fetchone()
    if known is None or get_meta(db, "kind") != KIND:
        return None
    return int(get_meta(db, "version") or 0)


def _migrate(db: sqlite3.Connection) -> None:
    # asked again inside the transaction: another window may have been quicker
    for version in range(_version(db) or 0, VERSION):
        MIGRATIONS[version](db)
    set_meta(db, "version", str(VERSION))


@contextmanager
def _sentences(path: Path) -> Iterator[None]:
    try:
        yield
    except OverflowError as error:
        raise SettingError(
            f"A number must be small enough for {path}, but one is too large ({error}). "
            "Nothing was changed: give a smaller one."
        ) from error
    except sqlite3.Error as error:
        text = str(error)
        if "locked" in text:
            raise FileProblem(
                f"{path} must be free to be written, but another program has held it for "
                f"{_PATIENCE_S:.0f} seconds. Close that program (QGIS, a backup?) and try again; "
                "nothing was changed."
            ) from error
        if "full" in text:
            raise FileProblem(
                f"There must be room on the disk for {path}, but it is full. Nothing was changed: "
                "make room and try again."
            ) from error
        if "readonly" in text or "unable to open" in text:
            raise FileProblem(
                f"{path} must be a file that can be written, but it cannot ({text}). "
                "Check its permissions and those of its folder; nothing was changed."
            ) from error
        raise _damaged(path, text) from error


def _damaged(path: Path, why: str) -> FileProblem:
    return FileProblem(
        f"{path} is damaged ({why}). Save what can be saved into a new file with: "
        f'fieldmon salvage "{path}" --output rescued.gpkg'
    )
