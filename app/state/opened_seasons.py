"""Seasons that are open, one of each file for all who ask: pages and phones.

No Streamlit in here.
"""

from __future__ import annotations

import threading
from contextlib import suppress
from functools import lru_cache
from typing import TYPE_CHECKING

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season

if TYPE_CHECKING:
    from pathlib import Path

_FEW = 24
_LOCK = threading.Lock()


def opened(path: Path) -> Season:
    """Return a season that all share; each call of it reads what is new in its file."""
    inode = path.stat().st_ino if path.is_file() else 0
    with _LOCK:  # two who ask at once get the same
        season = _opened(path, inode)
        # what was added in QGIS since; a file in trouble says so to what is asked of it next
        with suppress(FileProblem):
            season.drafts = season.take_drafts()
        return season


@lru_cache(maxsize=_FEW)
def _opened(path: Path, inode: int) -> Season:  # noqa: ARG001 - another file of the same name
    return Season(path)
