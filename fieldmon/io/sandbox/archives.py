"""Archives, and those in them: what lies inside; what no honest one does is refused."""

from __future__ import annotations

import stat
import zipfile
from pathlib import PurePosixPath
from typing import IO, TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.signatures import is_open_workbook
from fieldmon.io.sandbox import limits
from fieldmon.io.sandbox.file_entries import DAMAGE, FileEntry

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from fieldmon.io.sandbox.workroom import Workroom

# what systems leave in folders
_DECOYS = frozenset({"thumbs.db", "desktop.ini", "__macosx"})
_OFFICE_PART = "[content_types].xml"


def _is_decoy(entry: FileEntry) -> bool:
    parts = [part.lower() for part in entry.path.parts]
    return any(part in _DECOYS or part.startswith(".") for part in parts)


def expand(entries: Iterable[FileEntry], workroom: Workroom, depth: int) -> Iterator[FileEntry]:
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
            yield from expand(inner, workroom, depth + 1)
        else:
            prefixed = (
                FileEntry(f"{entry.name}/{one.name}", one.n_bytes, one.open) for one in inner
            )
            yield from expand(prefixed, workroom, depth + 1)


def _is_archive(entry: FileEntry) -> bool:
    return entry.head()[:4] in {b"PK\x03\x04", b"PK\x05\x06"}


def _zip_entries(archive: FileEntry, workroom: Workroom) -> list[FileEntry]:
    try:
        packed = zipfile.ZipFile(workroom.unpack(archive))
        infos = packed.infolist()
    except (*DAMAGE, OSError) as bad:
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
        _check_packed(name, info)


def _check_packed(name: str, info: zipfile.ZipInfo) -> None:
    """Refuse a file of an archive that no honest one has: a link, one outside, a locked one."""
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
