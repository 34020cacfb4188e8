"""Folders of a process for what it copies, and the end of those whose process was killed."""

from __future__ import annotations

import os
import shutil
import tempfile
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

try:
    import fcntl
except ImportError:  # Windows: what a killed process leaves stays
    fcntl = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from collections.abc import Iterator

_PREFIX = "fieldmon-"
# held for as long as its process lives, whatever ends it; who can take it may clear the folder
_HELD, _NOT_YET = "held", "not held yet"
_INSIDE = "work"


@contextmanager
def working_folder() -> Iterator[str]:
    """Give an empty folder, which is removed in the end; the first one clears what was left.

    A process that is killed cannot remove its own.

    Examples
    --------
    >>> with working_folder() as folder:
    ...     (Path(folder) / "copy.gpkg").touch()
    >>> Path(folder).exists()
    False
    """
    _clear_once(tempfile.gettempdir())
    outer = Path(tempfile.mkdtemp(prefix=_PREFIX))
    holding = -1
    try:
        holding = _hold(outer)
        inner = outer / _INSIDE
        inner.mkdir()
        yield str(inner)
    finally:
        shutil.rmtree(outer, ignore_errors=True)
        if holding >= 0:
            os.close(holding)


def _hold(folder: Path) -> int:
    """Hold a folder; it can be found to be held only once it is."""
    if fcntl is None:
        return -1
    holding = os.open(folder / _NOT_YET, os.O_CREAT | os.O_RDWR, 0o600)
    with suppress(OSError):  # where nothing can be held, nothing is cleared
        fcntl.flock(holding, fcntl.LOCK_EX | fcntl.LOCK_NB)
        (folder / _NOT_YET).rename(folder / _HELD)
    return holding


@cache
def _clear_once(parent: str) -> None:
    with suppress(OSError):
        clear(Path(parent))


def clear(parent: Path) -> int:
    """Remove the working folders of processes that are no more; return how many there were.

    Only those of this user, made here, whose process the system says is gone: of another machine or
    container too, as far as they share the folder.
    """
    if fcntl is None:
        return 0
    cleared = 0
    for folder in parent.glob(f"{_PREFIX}*"):
        with suppress(OSError):
            if folder.is_symlink() or folder.stat().st_uid != os.getuid():
                continue
            holding = os.open(folder / _HELD, os.O_RDWR | os.O_NOFOLLOW)
            try:
                fcntl.flock(holding, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(folder)
                cleared += 1
            finally:
                os.close(holding)
    return cleared
