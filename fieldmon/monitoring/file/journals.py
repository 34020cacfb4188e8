"""Changes that another program keeps in a file beside a season while it has it open.

QGIS does so: what it changed stands in ``season.gpkg-wal`` until the last program closes the
season. In a folder that is synchronised the two files come one by one, and not always both.
Source: the SQLite file format, section 4, "The Write-Ahead Log".
"""

from __future__ import annotations

import hashlib
import platform
import shutil
import sqlite3
import time
from contextlib import closing
from pathlib import Path

from fieldmon.compute.wording import worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import FileProblem

#: where a file says that changes may lie beside it, and how it says so
_AT, _WAL_MODE = 18, b"\x02\x02"
_HEADER, _FRAME_HEADER = 32, 24
#: of a season that was open elsewhere, and that may be a copy without the file beside it
PARTED = (
    "{path} was open in another program (QGIS?) that keeps changes in a file beside it until it is "
    "closed, and whether it was closed before this file came here cannot be told. If it was, "
    "nothing is missing. If not, look here for what was done last: if it is not there, bring "
    "{beside} too, or copy the season again. The next recording or plan ends this question."
)


#: how the journal of a broken transaction begins, and where in it stands what
_JOURNAL, _JOURNAL_HEADER, _SECTOR_AT = bytes.fromhex("d9d505f920a163d7"), 28, 20
#: where a file counts its transactions, and says how large its pages are
_COUNTER_AT, _PAGE_SIZE_AT = 24, 16
# another program's transaction is over, or goes on, by then
_LOOKS, _LOOK_AGAIN_S = 4, 0.25


def wal_of(path: Path) -> Path:
    """Return where such changes lie."""
    return path.with_name(f"{path.name}-wal")


def place_of(path: Path) -> str:
    """Return a mark of the place of a file on this machine's disk: a copy has another.

    A file that lies where it was written lost nothing with a missing file beside it: programs
    take that away once all of it is in the season.
    """
    place = f"{platform.node()} {path.stat().st_ino}"
    return hashlib.blake2b(place.encode(), digest_size=8).hexdigest()


def refuse_foreign_wal(path: Path) -> bool:
    """Return whether changes lie beside a season; raise `FileProblem` if they are not its own.

    SQLite would take them for its own and write them into the season.
    """
    more = wal_of(path)
    if not more.is_file():
        return False
    try:
        with path.open("rb") as file:
            may = file.read(100)[_AT : _AT + 2] == _WAL_MODE
        # twice: another program may write while the one is copied and then the other
        if not more.stat().st_size or (may and (_fit(path, more) or _fit(path, more))):
            return True
    except OSError as error:
        raise FileProblem(
            worded(
                "{path} must be readable, but it is not ({strerror}). Check its permissions.",
                path=path,
                strerror=error.strerror,
            )
        ) from error
    raise FileProblem(
        worded(
            "{path} and {beside} beside it must belong together, but they do not: they are of "
            "different moments, as when a folder was synchronised while a program had the season "
            "open. Close the season everywhere and let both synchronise; or move that file away "
            "to go on without what is in it. Nothing was changed.",
            path=path,
            beside=more.name,
        )
    )


def refuse_foreign_journal(path: Path) -> None:
    """Raise `FileProblem` if the journal beside a season is not that of its broken transaction.

    SQLite would write the pages in it into the season, whosesoever they are. Source: the SQLite
    file format, section 3, "The Rollback Journal".
    """
    journal = path.with_name(f"{path.name}-journal")
    for _ in range(_LOOKS):
        if not _is_of_a_broken_transaction(journal) or _undoes(path, journal):
            return
        time.sleep(_LOOK_AGAIN_S)
    raise FileProblem(
        worded(
            "{path} and {beside} beside it must belong together, but they do not: that file is of "
            "another moment or of another season, as when a folder was synchronised while a "
            "program was writing. Move it away to go on without it, or go back to a copy. Nothing "
            "was changed.",
            path=path,
            beside=journal.name,
        )
    )


def _is_of_a_broken_transaction(journal: Path) -> bool:
    try:
        with journal.open("rb") as file:
            head = file.read(_JOURNAL_HEADER)
    except OSError:  # there is none, or it is gone again
        return False
    return len(head) == _JOURNAL_HEADER and head.startswith(_JOURNAL)


def _undoes(path: Path, journal: Path) -> bool:
    """Tell whether a journal leads back to the season's state before it, whole; in a copy."""
    with working_folder() as folder:
        copy = Path(folder) / "season.gpkg"
        try:
            shutil.copyfile(journal, copy.with_name("season.gpkg-journal"))
            shutil.copyfile(path, copy)
        except OSError:
            return not journal.exists()
        data = copy.with_name("season.gpkg-journal").read_bytes()
        with copy.open("rb") as file:
            head = file.read(100)
        if not _is_of_the_last_transaction(head, data):
            return False
        try:
            with closing(sqlite3.connect(copy)) as db:
                said = db.execute("PRAGMA integrity_check(1)").fetchone()[0]
                return said == "ok" and _revision(db) is not None
        except sqlite3.Error:
            return False


def _is_of_the_last_transaction(head: bytes, journal: bytes) -> bool:
    """Tell whether the first page in a journal is the season's own, but for one transaction."""
    size = int.from_bytes(head[_PAGE_SIZE_AT : _PAGE_SIZE_AT + 2], "big")
    size = 1 << 16 if size == 1 else size
    sector = int.from_bytes(journal[_SECTOR_AT : _SECTOR_AT + 4], "big")
    for at in range(sector, len(journal) - size, 4 + size + 4):
        if int.from_bytes(journal[at : at + 4], "big") == 1:
            before = journal[at + 4 + _COUNTER_AT :][:4]
            here = head[_COUNTER_AT : _COUNTER_AT + 4]
            return 0 <= int.from_bytes(here, "big") - int.from_bytes(before, "big") <= 1
    return True  # nothing of the first page was changed yet


def _fit(path: Path, more: Path) -> bool:
    """Tell whether a season is whole with the changes beside it, and no older; in a copy."""
    with working_folder() as folder:
        copy = Path(folder) / "season.gpkg"
        shutil.copyfile(path, copy)
        shutil.copyfile(more, wal_of(copy))
        try:
            alone = f"{copy.as_uri()}?immutable=1"
            with closing(sqlite3.connect(alone, uri=True)) as db:
                before = _revision(db)
                (n_pages,) = db.execute("PRAGMA page_count").fetchone()
            if not _reaches(wal_of(copy).read_bytes(), n_pages):
                return False
            with closing(sqlite3.connect(copy)) as db:
                (said,) = db.execute("PRAGMA integrity_check(1)").fetchone()
                return said == "ok" and _revision(db) >= before
        except sqlite3.Error:
            return False


def _revision(db: sqlite3.Connection) -> int:
    kind = db.execute("SELECT rootpage FROM sqlite_master WHERE name = 'fieldmon'").fetchone()
    if kind == (0,):
        raise sqlite3.DatabaseError("what says what the file is must not be a view")  # of no end
    row = db.execute("SELECT value FROM fieldmon WHERE key = 'revision'").fetchone()
    return 0 if row is None else int(row[0])


def _reaches(log: bytes, n_pages: int) -> bool:
    """Tell whether every page behind the file's last is there, and none of the file's is cut off.

    A season never shrinks. Each frame holds a page: its number, the pages of the file if the frame
    ends a transaction, and two numbers that are the same in all that count.
    """
    size, salts = int.from_bytes(log[8:12]), log[16:24]
    after = n_pages
    pages: set[int] = set()
    told: set[int] = set()
    for at in range(_HEADER, len(log) - size - _FRAME_HEADER + 1, size + _FRAME_HEADER):
        if log[at + 8 : at + 16] != salts:
            break
        told.add(int.from_bytes(log[at : at + 4]))
        if ends := int.from_bytes(log[at + 4 : at + 8]):
            after, pages = ends, pages | told
    return after >= n_pages and pages >= set(range(n_pages + 1, after + 1))
