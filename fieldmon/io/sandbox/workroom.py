"""A folder of one's own, into which is copied what is to be read.

Nothing is opened where it lies, and no name from outside ever becomes part of a path: what is to be
read is copied under a name made here, counted byte by byte.
"""

from __future__ import annotations

import re
import sqlite3
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from typing import IO, TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.signatures import FileKind
from fieldmon.io.sandbox import limits
from fieldmon.io.sandbox.file_entries import opened, reading

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fieldmon.io.sandbox.file_entries import FileEntry, Member

_GEODATABASE_FILE = re.compile(r"[A-Za-z0-9_]{1,40}(\.[A-Za-z0-9_]{1,20}){0,3}")


@dataclass
class Workroom:
    """A folder of one's own, and how much may still be unpacked into it."""

    folder: Path
    bytes_left: int = limits.UNPACKED_BYTES
    n_staged: int = field(default=0, init=False)

    def stage(self, member: Member) -> Path:
        """Copy a data set under names of our own and return its main path."""
        self.n_staged += 1
        room = self.folder / f"{self.n_staged:03d}"
        room.mkdir()
        if member.kind is FileKind.GEODATABASE:
            inside = room / "data.gdb"
            inside.mkdir()
            for entry in member.entries:
                if _GEODATABASE_FILE.fullmatch(entry.path.name):
                    self._copy(entry, inside / entry.path.name)
            return inside
        if member.kind is FileKind.ISOXML:
            return self._stage_tasks(member, room)
        main = room / f"data{member.kind.value}"
        self._copy(member.entries[0], main)
        for entry in member.entries[1:]:
            self._copy(entry, room / f"data{entry.path.suffix.lower()}")
        if member.kind is FileKind.GEOPACKAGE and not _is_geopackage(main):
            return main.rename(main.with_suffix(".sqlite"))
        return main

    def _stage_tasks(self, member: Member, room: Path) -> Path:
        """Copy the files of an ISOXML, which name each other."""
        main = room / "TASKDATA.XML"
        self._copy(member.entries[0], main)
        for entry in member.entries[1:]:
            self._copy(entry, room / entry.path.name.upper())
        return main

    def unpack(self, entry: FileEntry) -> Path:
        """Copy an archive, which may lie in another, to where it can be sought in."""
        self.n_staged += 1
        path = self.folder / f"{self.n_staged:03d}.zip"
        self._copy(entry, path)
        return path

    def _copy(self, entry: FileEntry, to: Path) -> None:
        with opened(entry) as source, self._kept(to) as target:
            while piece := self._piece(entry, source):
                target.write(piece)

    def _piece(self, entry: FileEntry, source: IO[bytes]) -> bytes:
        """Return what comes next of a file; raise `FileProblem` where it is too much."""
        with reading(entry):
            piece = source.read(1 << 20)
        self.bytes_left -= len(piece)
        if self.bytes_left < 0:
            raise FileProblem(
                worded(
                    "A file may unpack to {size} at most, but {name} "
                    "brings it to more. Pack less into it.",
                    size=limits.size(limits.UNPACKED_BYTES),
                    name=entry.name,
                )
            )
        return piece

    @contextmanager
    def _kept(self, copy: Path) -> Iterator[IO[bytes]]:
        """Open a copy to write to; raise `FileProblem` where there is no room for it."""
        try:
            with copy.open("wb") as file:
                yield file
        except OSError as bad:
            raise FileProblem(
                worded(
                    "A file is copied before it is read, but the temporary folder {folder} takes "
                    "no copy ({value}). Make room there, or name another folder in TMPDIR.",
                    folder=self.folder,
                    value=bad.strerror or bad,
                )
            ) from bad


def _is_geopackage(path: Path) -> bool:
    """Return whether a database keeps a GeoPackage's list of contents; SpatiaLite has its own."""
    try:
        with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as db:
            known = "SELECT 1 FROM sqlite_master WHERE lower(name) = 'gpkg_contents'"
            return db.execute(known).fetchone() is not None
    except (sqlite3.Error, UnicodeDecodeError):  # the latter from names that are no text
        return True  # whoever opens it says what is wrong
