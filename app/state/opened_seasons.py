"""Seasons that are open, one of each file for all who ask: pages and phones.

No Streamlit in here.
"""

from __future__ import annotations

import threading
from contextlib import suppress
from typing import TYPE_CHECKING

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season

if TYPE_CHECKING:
    from pathlib import Path

_FEW = 24
_LOCK = threading.Lock()
# by path and inode: another file of the same name is another season; who was asked last is last
_OPEN: dict[tuple[Path, int], Season] = {}


def is_open(path: Path) -> bool:
    """Return whether a season is open, so that asking for it takes no time."""
    return _file(path) in _OPEN


def opened(path: Path) -> Season:
    """Return a season that all share; each call of it reads what is new in its file."""
    file = _file(path)
    with _LOCK:  # two who ask at once get the same
        season = _OPEN.pop(file, None)
        was_open = season is not None
        _OPEN[file] = season = Season(path) if season is None else season
        while len(_OPEN) > _FEW:
            del _OPEN[next(iter(_OPEN))]
    if was_open:
        # what was added in QGIS since; a file in trouble says so to what is asked of it next
        with suppress(FileProblem):
            season.drafts = season.take_drafts()
    return season


def _file(path: Path) -> tuple[Path, int]:
    return path, path.stat().st_ino if path.is_file() else 0
