"""The files that a path, uploads or a folder bring, and which of them belong together.

Nothing is opened here but to look at its first bytes.
"""

from __future__ import annotations

import io
import lzma
import os
import re
import zipfile
import zlib
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import IO, TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.signatures import HEAD_BYTES, FileKind
from fieldmon.io.options import Source, Upload
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: what belongs to a main file, by that one's ending and by its kind
FILES_BESIDE = {
    ".shp": (".dbf", ".shx", ".prj", ".cpg"),
    ".tif": (".tfw", ".tifw", ".wld", ".prj"),
    ".tab": (".dat", ".map", ".id", ".ind", ".dbf"),
    ".mif": (".mid",),
    ".csv": (".prj", ".csvt"),
}
FILES_BESIDE[".tiff"] = FILES_BESIDE[".tif"]
#: the other files of an ISOXML
TASK_FILE = re.compile(r"[A-Za-z]{3}[0-9]{5}\.(xml|bin)", re.IGNORECASE)
#: what reading a damaged file raises
DAMAGE = (zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, RuntimeError, ValueError)
# files, folders, pipes and devices that are looked at in a folder
_MOST_SEEN = 20_000


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
        with opened(self) as file:
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


@contextmanager
def opened(entry: FileEntry) -> Iterator[IO[bytes]]:
    """Open an entry; whatever reading it may raise becomes a `FileProblem`."""
    with reading(entry), entry.open() as file:
        yield file


@contextmanager
def reading(entry: FileEntry) -> Iterator[None]:
    """Make a `FileProblem` of whatever reading an entry may raise."""
    try:
        yield
    except DAMAGE as bad:
        raise FileProblem(
            worded(
                "{name} is damaged ({bad}). Pack or download it again.", name=entry.name, bad=bad
            )
        ) from bad
    except OSError as bad:
        raise FileProblem(
            worded("{name} cannot be read: {value}.", name=entry.name, value=bad.strerror or bad)
        ) from bad


def entries_of(source: Source) -> list[FileEntry]:
    """Return the files that a source brings; raise `FileProblem` where there is none."""
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
        return [other for other in _siblings(path) if TASK_FILE.fullmatch(other.name)]
    wanted = FILES_BESIDE.get(path.suffix.lower(), ())
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
