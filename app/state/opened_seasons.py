"""Seasons that are open, one of each file for all who ask: pages and phones.

No Streamlit in here.
"""

from __future__ import annotations

import threading
from concurrent.futures import Future
from contextlib import suppress
from typing import TYPE_CHECKING

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season
from fieldmon.monitoring.merging.other_seasons import is_another_now

if TYPE_CHECKING:
    from pathlib import Path

    Opening = Future[Season]

_FEW = 24
# held for a moment only: while one file is opened others are asked for
_LOCK = threading.Lock()
# by path and inode: another file of the same name is another season; who was asked last is last
_OPEN: dict[tuple[Path, int], Opening] = {}


def is_open(path: Path) -> bool:
    """Return whether a season is open, so that asking for it takes no time."""
    opening = _OPEN.get(_file(path))
    return opening is not None and opening.done()


def called_now(path: Path) -> str | None:
    """Return the name that the file of a season has now that was open here as `path`, if any.

    A file keeps its inode where it is renamed within its folder.
    """
    with _LOCK:
        inodes = [inode for known, inode in _OPEN if known == path and inode]
    for file in path.parent.glob(f"*{path.suffix}") if inodes else ():
        with suppress(OSError):
            if file.stat().st_ino == inodes[-1]:
                return file.stem
    return None


def opened(path: Path) -> Season:
    """Return a season that all share; each call of it reads what is new in its file."""
    file = _file(path)
    with _LOCK:
        known = _OPEN.pop(file, None)
        _OPEN[file] = opening = known or Future()
        while len(_OPEN) > _FEW:
            del _OPEN[next(iter(_OPEN))]
    if known is None:
        _open(file, opening)
    season = opening.result()  # two who ask at once get the same
    if known is not None:
        if _is_another(season):
            _forget(file, opening)
            return opened(path)
        # what was added in QGIS since; a file in trouble says so to what is asked of it next
        with suppress(FileProblem):
            season.drafts = season.take_drafts()
    return season


def _open(file: tuple[Path, int], opening: Opening) -> None:
    """Open a season for all who wait for it; who asks after a failure tries again."""
    try:
        opening.set_result(Season(file[0]))
    except BaseException as error:  # noqa: BLE001 - raised by all who wait
        _forget(file, opening)
        opening.set_exception(error)


def _forget(file: tuple[Path, int], opening: Opening) -> None:
    with _LOCK:
        if _OPEN.get(file) is opening:
            del _OPEN[file]


def _is_another(season: Season) -> bool:
    """Return whether another season was copied into the file, which keeps its inode then."""
    try:
        return is_another_now(season)
    except FileProblem:  # it says so to what is asked of it next
        return False


def _file(path: Path) -> tuple[Path, int]:
    return path, path.stat().st_ino if path.is_file() else 0
