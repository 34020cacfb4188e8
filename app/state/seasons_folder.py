"""The seasons on this machine: one GeoPackage each, in the folder given at the start.

No Streamlit in here.
"""

from __future__ import annotations

import os
import re
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import SettingError
from fieldmon.monitoring import Store, is_season

from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Iterable

#: the folder within it of seasons that are listed no more
REMOVED = "removed"
#: names the folder; `fieldmon app --seasons` sets it
FOLDER = "FIELDMON_SEASONS"
_ENDING = ".gpkg"
_LONGEST = 80


def folder() -> Path:
    """Return the folder in which seasons live."""
    return Path(os.environ.get(FOLDER) or "seasons").absolute()


def names() -> list[str]:
    """Return the names of the seasons there, in order."""
    here = folder()
    files: Iterable[Path] = here.glob(f"*{_ENDING}") if here.is_dir() else ()
    return sorted(file.stem for file in files if _lies_there(file) and is_season(file))


def _lies_there(file: Path) -> bool:
    """Tell whether a file lies in the folder itself: a link may lead anywhere."""
    try:
        return file.resolve().parent == folder().resolve()
    except OSError:
        return False


def path_of(name: str) -> Path:
    """Return the file of a season; raise `SettingError` if the name leads out of the folder."""
    if not name or re.search(r'[\\/:*?"<>|\x00-\x1f]', name) or name.startswith("."):
        raise SettingError(texts.SEASON_NAMED.format(name=name))
    if len(name) > _LONGEST:
        raise SettingError(texts.SEASON_LONG.format(most=_LONGEST, n=len(name)))
    path = folder() / f"{name}{_ENDING}"
    if not _lies_there(path):
        raise SettingError(texts.SEASON_NAMED.format(name=name))
    return path


def new_path(name: str) -> Path:
    """Return where a new season goes; the folder is made if it is missing."""
    path = path_of(name.strip())
    path.parent.mkdir(parents=True, exist_ok=True)
    return path


def backup_of(path: Path) -> bytes:
    """Return a season's file as it is now, whoever works on it."""
    with working_folder() as here:
        copy = Path(here) / f"copy{_ENDING}"
        Store(path).back_up(copy)
        return copy.read_bytes()


def rename(name: str, new: str) -> None:
    """Give a season another name; raise if another season has it."""
    Store(path_of(name)).move(new_path(new))


def set_aside(name: str) -> Path:
    """Move a season to those that are listed no more; return where it lies, whole as it was."""
    path = path_of(name)
    aside = path.parent / REMOVED
    aside.mkdir(exist_ok=True)
    names = chain((name,), (f"{name} ({n})" for n in count(2)))
    free = next(to for one in names if not (to := aside / f"{one}{_ENDING}").exists())
    Store(path).move(free)
    return free
