"""From a path, an upload, a folder or an archive to one data set on its own in a work folder.

Nothing is opened where it lies, and no name from outside ever becomes part of a path: what is to be
read is copied under a name made here, counted byte by byte.
"""

from __future__ import annotations

import io
import lzma
import os
import re
import sqlite3
import stat
import zipfile
import zlib
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import IO, TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.signatures import (
    HEAD_BYTES,
    READABLE,
    FileKind,
    is_open_workbook,
    kind_of,
    workbook_kind,
)
from fieldmon.io.options import Source, Upload, source_name
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

#: what belongs to a main file, by that one's ending and by its kind
_PARTS = {
    ".shp": (".dbf", ".shx", ".prj", ".cpg"),
    ".tif": (".tfw", ".tifw", ".wld", ".prj"),
    ".tab": (".dat", ".map", ".id", ".ind", ".dbf"),
    ".mif": (".mid",),
    ".csv": (".prj", ".csvt"),
}
_PARTS[".tiff"] = _PARTS[".tif"]
#: the other files of an ISOXML, and those of a file geodatabase
_TASK_FILE = re.compile(r"[A-Za-z]{3}[0-9]{5}\.(xml|bin)", re.IGNORECASE)
_GEODATABASE_FILE = re.compile(r"[A-Za-z0-9_]{1,40}(\.[A-Za-z0-9_]{1,20}){0,3}")
#: files, folders, pipes and devices that are looked at in a folder
_MOST_SEEN = 20_000
_DECOYS = frozenset({"thumbs.db", "desktop.ini", "__macosx"})
_OFFICE_PART = "[content_types].xml"
_DAMAGE = (zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, RuntimeError, ValueError)


@dataclass(frozen=True)
class FileEntry:
    """One file that could be read: its name with folders, its size, and how to open it."""

    name: str
    n_bytes: int
    open: Callable[[], IO[bytes]]

    @property
    def path(self) -> PurePosixPath:
        """Return the name as a path to look at, never to open."""
        return PurePosixPath(self.name)

    def head(self) -> bytes:
        """Return the first bytes; none of a file that says it has none, and may never end."""
        if not self.n_bytes:
            return b""
        with _opened(self) as file:
            return file.read(HEAD_BYTES)


@dataclass(frozen=True)
class Member:
    """One data set: its main file first, then the files that belong to it."""

    name: str
    kind: FileKind
    entries: tuple[FileEntry, ...]

    @property
    def stem(self) -> str:
        """Return the name without folders and ending, as a layer would be called."""
        return PurePosixPath(self.name).stem


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
        with _opened(entry) as source, to.open("wb") as target:
            while piece := source.read(1 << 20):
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
                target.write(piece)


def _is_geopackage(path: Path) -> bool:
    """Return whether a database keeps a GeoPackage's list of contents; SpatiaLite has its own."""
    try:
        with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as db:
            known = "SELECT 1 FROM sqlite_master WHERE lower(name) = 'gpkg_contents'"
            return db.execute(known).fetchone() is not None
    except (sqlite3.Error, UnicodeDecodeError):  # the latter from names that are no text
        return True  # whoever opens it says what is wrong


@contextmanager
def _opened(entry: FileEntry) -> Iterator[IO[bytes]]:
    """Open an entry; whatever reading it may raise becomes a `FileProblem`."""
    try:
        with entry.open() as file:
            yield file
    except _DAMAGE as bad:
        raise FileProblem(
            worded(
                "{name} is damaged ({bad}). Pack or download it again.", name=entry.name, bad=bad
            )
        ) from bad
    except OSError as bad:
        raise FileProblem(
            worded("{name} cannot be read: {value}.", name=entry.name, value=bad.strerror or bad)
        ) from bad


def members(source: Source, workroom: Workroom) -> tuple[Member, ...]:
    """Return the data sets that a source holds; raise `FileProblem` where there is none."""
    entries = list(_expand(_entries(source), workroom, depth=0))
    found, problems = _group(entries)
    if found:
        return tuple(found)
    if len(problems) == 1:
        raise problems[0]
    raise FileProblem(
        worded(
            "{source_name} must hold {readable}, but nothing of the kind is "
            "in it. Choose another file.",
            source_name=source_name(source),
            readable=READABLE,
        )
    )


def choose_member(found: tuple[Member, ...], wanted: str | None, name: str) -> Member:
    """Return the one member, or the named one; raise `ChoiceNeeded` where several could be."""
    if wanted is not None:
        fitting = [m for m in found if m.name == wanted] or [
            m for m in found if m.name.lower().endswith(wanted.lower())
        ]
        if len(fitting) == 1:
            return fitting[0]
    elif len(found) == 1:
        return found[0]
    names = tuple(m.name for m in found)
    missing = "" if wanted is None else f", but none alone is called {wanted!r}"
    raise ChoiceNeeded(
        worded(
            "{name} holds {n} files that can be read{missing}. Choose one of: {names}.",
            name=name,
            n=len(found),
            missing=missing,
            names=", ".join(names[:20]),
        ),
        "member",
        names,
    )


def _entries(source: Source) -> list[FileEntry]:
    if isinstance(source, Upload):
        source = (source,)
    if isinstance(source, tuple):
        return [_of_upload(upload) for upload in source]
    path = Path(source)
    if not path.exists():
        raise FileProblem(
            worded(
                "{path} must be a file or a folder, but there is none. Check the name.", path=path
            )
        )
    if path.is_dir():
        return _of_folder(path)
    if not path.is_file():
        raise FileProblem(
            worded(
                "{path} must be a file or a folder, but it is a pipe, a "
                "device or the like. Save what comes out of it in a file, and "
                "choose that.",
                path=path,
            )
        )
    return [_of_path(p, p.name) for p in (path, *_belongings(path))]


def _belongings(path: Path) -> list[Path]:
    """Return the other files that lie beside a data set's main file and belong to it."""
    if path.name.lower() == "taskdata.xml":
        return [other for other in _siblings(path) if _TASK_FILE.fullmatch(other.name)]
    wanted = _PARTS.get(path.suffix.lower(), ())
    if not wanted:
        return []
    return [
        other
        for other in _siblings(path)
        if other.stem == path.stem and other.suffix.lower() in wanted
    ]


def _siblings(path: Path) -> list[Path]:
    try:
        return sorted(other for other in path.parent.iterdir() if other != path)
    except OSError:
        return []  # a folder that one may pass through, but not look at


def _of_upload(upload: Upload) -> FileEntry:
    name = PurePosixPath(upload.name.replace("\\", "/")).name or "upload"
    _check_size(name, len(upload.data))
    return FileEntry(name, len(upload.data), lambda: io.BytesIO(upload.data))


def _of_path(path: Path, name: str) -> FileEntry:
    try:
        n_bytes = path.stat().st_size
    except OSError as bad:
        raise FileProblem(
            worded("{name} cannot be read: {value}.", name=name, value=bad.strerror or bad)
        ) from bad
    _check_size(name, n_bytes)
    return FileEntry(name, n_bytes, lambda: path.open("rb"))


def _check_size(name: str, n_bytes: int) -> None:
    if n_bytes > limits.FILE_BYTES:
        raise FileProblem(
            worded(
                "A file may have {size} at most, but {name} has {has}. Cut "
                "it to the plots that matter.",
                size=limits.size(limits.FILE_BYTES),
                name=name,
                has=limits.size(n_bytes),
            )
        )


def _of_folder(folder: Path) -> list[FileEntry]:
    base = folder.parent if folder.suffix.lower() == ".gdb" else folder
    entries: list[FileEntry] = []
    for n_seen, path in enumerate(_walked(folder)):
        with suppress(OSError):  # gone since it was listed, or not to be looked at
            if path.is_file() and not path.is_symlink():
                entries.append(_of_path(path, path.relative_to(base).as_posix()))
        if len(entries) > limits.ARCHIVE_ENTRIES or n_seen > _MOST_SEEN:
            raise FileProblem(
                worded(
                    "A folder may hold {archive_entries} files at most, but "
                    "{folder} holds more. Choose one file in it.",
                    archive_entries=limits.ARCHIVE_ENTRIES,
                    folder=folder,
                )
            )
    return entries


def _walked(folder: Path) -> Iterator[Path]:
    """Yield what lies in a folder and those in it, name by name, without listing all before."""
    for root, folders, files in os.walk(folder):
        folders.sort()
        yield from (Path(root, name) for name in sorted(files))
        yield Path(root)


def _is_decoy(entry: FileEntry) -> bool:
    parts = [part.lower() for part in entry.path.parts]
    return any(part in _DECOYS or part.startswith(".") for part in parts)


def _expand(entries: Iterable[FileEntry], workroom: Workroom, depth: int) -> Iterator[FileEntry]:
    """Yield the entries, those of archives in their place."""
    for entry in entries:
        if _is_decoy(entry):
            continue
        if not _is_archive(entry):
            yield entry
            continue
        if depth >= limits.ARCHIVE_DEPTH:
            raise FileProblem(
                worded(
                    "Archives may lie {archive_depth} deep inside each other "
                    "at most, but {name} is one more. Unpack the outer ones.",
                    archive_depth=limits.ARCHIVE_DEPTH,
                    name=entry.name,
                )
            )
        inner = _zip_entries(entry, workroom)
        if is_open_workbook(entry.head()) or any(
            one.name.lower().endswith(_OFFICE_PART) for one in inner
        ):
            yield entry  # a workbook is an archive as well
        elif depth == 0:
            yield from _expand(inner, workroom, depth + 1)
        else:
            prefixed = (
                FileEntry(f"{entry.name}/{one.name}", one.n_bytes, one.open) for one in inner
            )
            yield from _expand(prefixed, workroom, depth + 1)


def _is_archive(entry: FileEntry) -> bool:
    return entry.head()[:4] in {b"PK\x03\x04", b"PK\x05\x06"}


def _zip_entries(archive: FileEntry, workroom: Workroom) -> list[FileEntry]:
    try:
        packed = zipfile.ZipFile(workroom.unpack(archive))
        infos = packed.infolist()
    except (*_DAMAGE, OSError) as bad:
        raise FileProblem(
            worded(
                "{name} must be a whole zip archive, but it is damaged "
                "({bad}). Pack or download it again.",
                name=archive.name,
                bad=bad,
            )
        ) from bad
    _check_archive(archive, infos)
    return [
        FileEntry(
            info.filename.replace("\\", "/").lstrip("/"), info.file_size, _opener(packed, info)
        )
        for info in infos
        if not info.is_dir()
    ]


def _opener(packed: zipfile.ZipFile, info: zipfile.ZipInfo) -> Callable[[], IO[bytes]]:
    return lambda: packed.open(info)


def _check_archive(archive: FileEntry, infos: list[zipfile.ZipInfo]) -> None:
    """Refuse what no honest archive does, before anything is unpacked."""
    name = archive.name
    if len(infos) > limits.ARCHIVE_ENTRIES:
        raise FileProblem(
            worded(
                "An archive may hold {archive_entries} files at most, but "
                "{name} holds {n}. Pack only the plots.",
                archive_entries=limits.ARCHIVE_ENTRIES,
                name=name,
                n=len(infos),
            )
        )
    total = sum(info.file_size for info in infos)
    if total > limits.UNPACKED_BYTES:
        raise FileProblem(
            worded(
                "An archive may unpack to {size} at most, but {name} says "
                "{has}. Pack less into it.",
                size=limits.size(limits.UNPACKED_BYTES),
                name=name,
                has=limits.size(total),
            )
        )
    if total > limits.RATIO_FROM_BYTES and total > limits.COMPRESSION_RATIO * archive.n_bytes:
        raise FileProblem(
            worded(
                "An archive of more than {size} may unpack to "
                "{compression_ratio} times its size at most, but {name} "
                "unpacks to {value:.0f} times. Pack it again, or choose the "
                "file itself.",
                size=limits.size(limits.RATIO_FROM_BYTES),
                compression_ratio=limits.COMPRESSION_RATIO,
                name=name,
                value=total / archive.n_bytes,
            )
        )
    for info in infos:
        if stat.S_ISLNK(info.external_attr >> 16):
            raise FileProblem(
                worded(
                    "An archive must hold files only, but {filename} in "
                    "{name} is a link to another file. Pack the file itself.",
                    filename=info.filename,
                    name=name,
                )
            )
        if ".." in PurePosixPath(info.filename.replace("\\", "/")).parts:
            raise FileProblem(
                worded(
                    "Files in an archive must lie inside it, but {filename} "
                    "in {name} points outside. Do not trust this file.",
                    filename=info.filename,
                    name=name,
                )
            )
        if info.flag_bits & 0x1:
            raise FileProblem(
                worded("{name} is locked with a password. Pack it again without one.", name=name)
            )


def _group(entries: list[FileEntry]) -> tuple[list[Member], list[FileProblem]]:
    """Put together what belongs together; keep the reasons why the rest cannot be read."""
    found = _geodatabases(entries)
    taken = {entry.name for member in found for entry in member.entries}
    rest = [entry for entry in entries if entry.name not in taken]
    by_place: dict[tuple[str, str], dict[str, FileEntry]] = {}
    for entry in rest:
        place = (str(entry.path.parent), entry.path.stem.lower())
        by_place.setdefault(place, {})[entry.path.suffix.lower()] = entry
    problems = []
    for entry in rest:
        beside = by_place[str(entry.path.parent), entry.path.stem.lower()]
        if any(entry.path.suffix.lower() in _PARTS.get(main, ()) for main in beside):
            continue
        try:
            kind = kind_of(entry.head(), entry.name)
        except FileProblem as problem:
            problems.append(problem)
            continue
        if kind is FileKind.ARCHIVE:
            kind = workbook_kind(entry.head())
        belongings = [beside[part] for part in _PARTS.get(kind.value, ()) if part in beside]
        if kind is FileKind.ISOXML:
            belongings = [
                other
                for other in rest
                if other.path.parent == entry.path.parent and _TASK_FILE.fullmatch(other.path.name)
            ]
        found.append(Member(entry.name, kind, (entry, *belongings)))
    return found, problems


def _geodatabases(entries: list[FileEntry]) -> list[Member]:
    folders: dict[str, list[FileEntry]] = {}
    for entry in entries:
        if entry.path.parent.suffix.lower() == ".gdb":
            folders.setdefault(str(entry.path.parent), []).append(entry)
    return [
        Member(name, FileKind.GEODATABASE, tuple(files))
        for name, files in folders.items()
        if any(f.path.suffix.lower() == ".gdbtable" for f in files)
    ]
