"""A season's file as a database: its transactions, versions and copies; problems are sentences."""

from __future__ import annotations

import os
import secrets
import sqlite3
import tempfile
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.compute.arguments import must_be, must_be_name_of_file
from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.atomic_write import HELD, require_folder, sqlite_code
from fieldmon.monitoring.changes import outside_changes, season_log
from fieldmon.monitoring.file import connections, journals, qgis_project
from fieldmon.monitoring.file.file_problems import damaged, no_file
from fieldmon.monitoring.file.geopackage import APPLICATION_ID
from fieldmon.monitoring.file.migrations import MIGRATIONS
from fieldmon.monitoring.file.schema import (
    COMES,
    LIES,
    LOGS_SINCE,
    NEEDS,
    OPEN,
    TABLES,
    VERSION,
    WRITTEN,
    is_watched,
    lay_out,
    watch,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

KIND = "season"
# whether a file is a season at all is asked of many files in passing
_GLANCE_S = 0.5
#: how a file of SQLite begins
MAGIC = b"SQLite format 3\x00"


def is_season(path: str | Path) -> bool:
    """Tell whether a file is a season of fieldmon, by its content; never raises."""
    try:
        if not Path(path).is_file():  # opening a pipe waits until somebody writes into it
            return False
        # through SQLite: whoever else opens and closes a database takes away the locks that other
        # threads of the same program hold on it
        with closing(connections.connect(Path(path), _GLANCE_S)) as db:
            mark = db.execute("PRAGMA application_id").fetchone()[0]
            return mark == APPLICATION_ID and _version(db) is not None
    except sqlite3.Error as error:
        if sqlite_code(error) in HELD:  # whoever opens it waits for longer and says so
            return True
    except OSError:  # a name that is too long
        return False
    with suppress(OSError), Path(path).open("rb") as file:
        head = file.read(1 << 16)
        return head.startswith(MAGIC) and b"fieldmon" in head
    return False


def glance(path: Path, query: str, values: tuple[object, ...]) -> tuple[object, ...] | None:
    """Return a file's first answer to a query; None: there is none, or it cannot be read.

    The file is left as it is, of an older version too. It is not waited for: what another program
    holds is read as it stands on the disk.
    """
    for how in ("mode=ro", "mode=ro&immutable=1"):
        address = f"{path.absolute().as_uri()}?{how}"
        with suppress(sqlite3.Error, FileProblem), closing(connections.connect(address, 0.0)) as db:
            _refuse_views(db, path)
            row: tuple[object, ...] | None = db.execute(query, values).fetchone()
            return row
    return None


class Store:
    """The file of a season.

    Each piece of work opens the file, does one transaction and closes it: nothing is held between
    clicks, so any number of windows and programs can work on one file.
    """

    def __init__(self, path: str | Path) -> None:
        must_be("A season must be given by its path", path, (str, Path), 'Give "season.gpkg".')
        self.path = Path(path).absolute()
        if not self.path.is_file():
            raise no_file(path)
        has_more = journals.refuse_foreign_wal(self.path)
        journals.refuse_foreign_journal(self.path)
        with self.reading() as db:
            version = _version(db)
            refuse_newer(db, path)
            _refuse_views(db, self.path)
            is_parted = (
                not has_more
                and db.execute("PRAGMA journal_mode").fetchone()[0] == "wal"
                and (not version or get_meta(db, LIES) != journals.place_of(self.path))
            )
        self._checked: tuple[int, str] | None = None
        #: what is to be doubted of the file, in a sentence, or None
        self.doubt: str | None = None
        if is_parted:
            beside = journals.wal_of(self.path).name
            self.doubt = journals.PARTED.format(path=self.path, beside=beside)
        if version is None:
            raise FileProblem(
                worded(
                    "{path} must be the file of a season, but it was not made by fieldmon init.",
                    path=path,
                )
            )
        if version < VERSION:
            self._bring_up_to_date(version)

    def _bring_up_to_date(self, version: int) -> None:
        """Migrate the file; a copy of it as it was stays beside it."""
        copy = self.path.with_name(f"{self.path.name}.format-{version}")
        if not copy.exists():
            self.back_up(copy)
        with self.writing() as db:
            _migrate(db)

    def back_up(self, to: str | Path) -> None:
        """Copy the file as it is at this moment, whoever works on it; never over another file."""
        target = Path(to).absolute()
        _refuse_old(target, to)
        with _draft_folder(target) as folder:
            draft = Path(folder) / "copy.gpkg"
            copy_season(self.path, draft, target)
            _name_in_project(draft, target)
            _put(draft, target)

    def move(self, to: str | Path) -> None:
        """Give the file another name, while nobody else reads or writes it; never over a file.

        A season that another program (QGIS) keeps in several files is held by it: it stays.
        """
        target = Path(to).absolute()
        _refuse_old(target, to)
        connections.must_be_there(self.path)
        with (
            connections.sentences_of(self.path, target),
            connections.opened(self.path) as db,
        ):
            _into_one_file(db)
            if db.execute("PRAGMA journal_mode").fetchone()[0] == "wal":
                held = sqlite3.OperationalError("database is locked")
                held.sqlite_errorcode = sqlite3.SQLITE_BUSY
                raise held
            db.execute("BEGIN EXCLUSIVE")
            _put(self.path, target)
            self.path.unlink(missing_ok=True)
        _name_in_project(target, target)

    @classmethod
    @contextmanager
    def new(cls, path: str | Path) -> Iterator[sqlite3.Connection]:
        """Make a new file: it appears with all that is written inside this block, or not at all."""
        must_be_name_of_file("A season", path)
        target = Path(path).absolute()
        if target.suffix.casefold() != ".gpkg":
            raise FileProblem(
                worded(
                    "A season must be named as QGIS knows it, with .gpkg at the end, but it is "
                    "{name!r}. Name it {better!r}.",
                    name=target.name,
                    better=f"{target.stem or 'season'}.gpkg",
                )
            )
        _refuse_old(target, path)
        with _draft_folder(target) as folder:
            draft = Path(folder) / "season.gpkg"
            with connections.sentences_of(target), closing(connections.connect(draft)) as db:
                db.execute("BEGIN")
                lay_out(db)
                set_meta(db, "kind", KIND)
                _mark(db)
                yield db
                set_meta(db, OPEN, "0")
                set_meta(db, LIES, journals.place_of(draft))  # which stays when it gets its name
                db.execute("COMMIT")
            _put(draft, target)

    @contextmanager
    def reading(self, into: Path | None = None) -> Iterator[sqlite3.Connection]:
        """Give a consistent view of the file; what is read goes `into` another, if it is told."""
        still = connections.held_still().get(self.path)
        with connections.sentences_of(self.path, into):
            if still is not None:
                yield still
                return
            with connections.opened(self.path) as db:
                db.execute("BEGIN")
                yield db

    @contextmanager
    def one_moment(self) -> Iterator[None]:
        """Let all that this thread reads of the file within this block be of one moment.

        Whoever writes waits until it ends. What a thread does not write within it, it writes after.
        """
        still = connections.held_still()
        if self.path in still:
            yield
            return
        with self.reading() as db:
            get_meta(db, "version")  # the moment is that of the first thing read
            still[self.path] = db
            try:
                yield
            finally:
                del still[self.path]

    @contextmanager
    def writing(self, patience_s: float | None = None) -> Iterator[sqlite3.Connection]:
        """Give the file for one transaction, alone: all of it is kept, or nothing.

        `patience_s`: how long to wait for others; None: as long as for any command.
        """
        if self.path in connections.held_still():  # it would wait for itself
            raise RuntimeError("What is read as of one moment must not be written within it.")
        connections.must_be_there(self.path)
        with (
            connections.sentences_of(self.path),
            connections.opened(self.path, patience_s) as db,
        ):
            # EXTRA: once this returns, not even a power cut brings the old state back
            db.execute("PRAGMA synchronous = EXTRA")
            _into_one_file(db)
            db.execute("BEGIN IMMEDIATE")
            set_meta(db, OPEN, "1")  # what is changed from here on is changed by us
            set_meta(db, COMES, secrets.token_hex(8))
            set_meta(db, LIES, journals.place_of(self.path))
            if _version(db) == VERSION:
                self._checked = season_log.refuse_changed(db, self._checked)
                if not is_watched(db):  # somebody took away what would note changes
                    outside_changes.refuse_unlike_log(outside_changes.not_as_logged(db))
            yield db
            set_meta(db, OPEN, "0")
            db.execute("UPDATE fieldmon SET value = value + 1 WHERE key = 'revision'")
            set_meta(db, WRITTEN, get_meta(db, COMES) or "")
            db.execute("COMMIT")

    def check(self) -> None:
        """Read the whole file; raise `FileProblem` if it is damaged."""
        with self.reading() as db:
            said = [row[0] for row in db.execute("PRAGMA quick_check(5)")]
        if said != ["ok"]:
            raise damaged(self.path, said[0])


def copy_season(path: Path, to: Path, named: Path | None = None) -> None:
    """Copy a season as it is at this moment, by SQLite's own means; raise if it is damaged.

    `named`: what the copy will be called, for sentences.
    """
    connections.must_be_there(path)
    written = named or to
    with (
        connections.sentences_of(path, written),
        closing(connections.connect(path)) as db,
        closing(connections.connect(to)) as copy,
    ):
        db.backup(copy)
        copy.execute("PRAGMA journal_mode = DELETE")
        said = copy.execute("PRAGMA quick_check(1)").fetchone()[0]
        if said != "ok":
            raise damaged(path, said)


def _name_in_project(path: Path, named: Path) -> None:
    """Let QGIS open the file that it opens the project of, not the one that was copied."""
    with connections.sentences_of(path, named), closing(connections.connect(path)) as db:
        qgis_project.rename(db, named.name)


def _put(draft: Path, target: Path) -> None:
    """Give a draft its name, unless another file has it."""
    try:
        try:
            os.link(draft, target)  # unlike a rename it never replaces
        except FileExistsError:
            raise
        except OSError:  # a file system without links
            target.touch(exist_ok=False)
            draft.replace(target)
    except FileExistsError:
        raise FileProblem(
            worded("{path} was made by someone else just now.", path=target)
        ) from None


@contextmanager
def _draft_folder(target: Path) -> Iterator[str]:
    """Make a folder for a draft beside a file, so that it can take its place at once."""
    try:
        draft = tempfile.TemporaryDirectory(prefix=f".{target.name}.", dir=target.parent)
    except OSError as error:
        raise FileProblem(
            worded(
                "{parent} must be a folder that can be written to, but it is "
                "not ({strerror}). Choose another one.",
                parent=target.parent,
                strerror=error.strerror,
            )
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


def _refuse_views(db: sqlite3.Connection, path: Path) -> None:
    """Refuse a file in which what must be a table of the season is a view, which may be endless."""
    ours = {table.name for table in TABLES}
    # a virtual table may be as endless, and has no page of its own either
    others = db.execute("SELECT lower(name) FROM sqlite_master WHERE rootpage = 0")
    for name in sorted(ours & {name for (name,) in others}):
        raise FileProblem(
            worded(
                "Each layer of a season must be a table, but {name} is none in {path}: it was not "
                "made by fieldmon init. Open only seasons of people whom you know.",
                name=name,
                path=path,
            )
        )


def _into_one_file(db: sqlite3.Connection) -> None:
    """Let a season be one file again where another program (QGIS) let it be three.

    That program may still have it open: then it stays so until it is closed.
    """
    if db.execute("PRAGMA journal_mode").fetchone()[0] == "wal":
        with connections.patience(db, 0.0), suppress(sqlite3.OperationalError):
            db.execute("PRAGMA journal_mode = DELETE")


def refuse_newer(db: sqlite3.Connection, path: str | Path) -> None:
    """Raise `FileProblem` if a season's file is of a newer version than this one can read."""
    version = _version(db)
    if version is None or version <= VERSION:
        return
    needs = get_meta(db, "needs")
    raise FileProblem(
        worded(
            "{path} was made by a newer fieldmon (format {version}; this one reads up to "
            "{ours}): it needs fieldmon {needs}. Update fieldmon.",
            path=path,
            version=version,
            ours=VERSION,
            needs="?" if needs is None else f">= {needs}",
        )
    )


def _version(db: sqlite3.Connection) -> int | None:
    wanted = "SELECT 1 FROM sqlite_master WHERE name = 'fieldmon' AND rootpage > 0"  # no view
    known = db.execute(wanted).fetchone()
    if known is None or get_meta(db, "kind") != KIND:
        return None
    return int(get_meta(db, "version") or 0)


def _migrate(db: sqlite3.Connection) -> None:
    # asked again inside the transaction: another window may have been quicker
    begun = _version(db) or 0
    for version in range(begun, VERSION):
        MIGRATIONS[version](db)
    watch(db)
    _mark(db)
    if begun < LOGS_SINCE:
        season_log.begin(db, f"the file was of format {begun}; what stands in it is held to now")


def _mark(db: sqlite3.Connection) -> None:
    """Note which version the file is of, for those that come after and those from before."""
    set_meta(db, "version", str(VERSION))
    set_meta(db, "needs", NEEDS)


def _refuse_old(target: Path, path: str | Path) -> None:
    """Refuse to make a file where one is, or where no folder is."""
    if target.exists():
        raise FileProblem(
            worded(
                "{path} must be a new file, but it exists already. A "
                "season is never overwritten: choose another name, or "
                "move the old file away.",
                path=path,
            )
        )
    require_folder(target)
