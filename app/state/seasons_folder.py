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
from fieldmon.io.options import Upload
from fieldmon.monitoring import Store, is_season
from fieldmon.monitoring.season.inspection_import import season_copied

from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Iterable

#: the folder within it of seasons that are listed no more
REMOVED = "removed"
#: names the folder; `fieldmon app --seasons` sets it
FOLDER = "FIELDMON_SEASONS"
_ENDING = ".gpkg"
_LONGEST = 80
# a quotation mark within a Hebrew word, and signs around words
_GERSHAYIM, _AROUND = re.compile('(?<=[א-ת])"(?=[א-ת])'), re.compile('["<>]')
# what no name of a file may hold
_NO_LETTERS = re.compile(r'[\\/:*?"<>|\x00-\x1f]')


def folder() -> Path:
    """Return the folder in which seasons live."""
    return Path(os.environ.get(FOLDER) or "seasons").absolute()


def names() -> list[str]:
    """Return the names of the seasons there, in order."""
    here = folder()
    files: Iterable[Path] = here.glob(f"*{_ENDING}") if here.is_dir() else ()
    return sorted(file.stem for file in files if _lies_in(here, file) and is_season(file))


def _lies_in(here: Path, file: Path) -> bool:
    """Tell whether a file lies in the folder itself: a link may lead anywhere."""
    if file.parent == here and not os.path.islink(file):  # noqa: PTH114 - no name is too long for it
        return True
    try:
        return file.resolve().parent == here.resolve()
    except OSError:
        return False


def path_of(name: str) -> Path:
    """Return the file of a season; raise `SettingError` if the name leads out of the folder."""
    if not name or _NO_LETTERS.search(name) or name.startswith("."):
        raise SettingError(texts.SEASON_NAMED.format(name=name))
    if len(name) > _LONGEST:
        raise SettingError(texts.SEASON_LONG.format(most=_LONGEST, n=len(name)))
    path = _file(folder(), name)
    if not _lies_in(folder(), path):
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
        copy = Path(here) / path.name  # as the download is called
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
    free = _free(aside, name)
    Store(path).move(free)
    return free


def removed() -> list[str]:
    """Return the names of the seasons that are listed no more, in order."""
    aside = folder() / REMOVED
    files: Iterable[Path] = aside.glob(f"*{_ENDING}") if aside.is_dir() else ()
    return sorted(file.stem for file in files if not file.is_symlink() and is_season(file))


def bring_back(name: str) -> str:
    """List a season again that is listed no more; return its name, another if that is taken."""
    path_of(name)  # or raise
    free = _free(folder(), name)
    Store(_file(folder() / REMOVED, name)).move(free)
    return free.stem


def is_of_season(data: bytes) -> bool:
    """Tell whether these bytes are the file of a season."""
    with working_folder() as here:
        return season_copied(Upload(f"season{_ENDING}", data), Path(here)) is not None


def take_in(data: bytes, name: str) -> str:
    """Keep the file of a season, such as a backup; return its name, another if that is taken."""
    plain = plain_name(name)
    free = _free(new_path(plain).parent, plain)
    with working_folder() as here:
        copy = Path(here) / f"copy{_ENDING}"
        copy.write_bytes(data)
        Store(copy).back_up(free)
    return free.stem


def plain_name(name: str, behind: str = "") -> str:
    """Return a name that a season can have, and what stands `behind` it, from any other.

    Gershayim stay what they are; other quotation marks and brackets go, and signs between words
    are dashes.

    Examples
    --------
    >>> plain_name('חב"ל ב/3 "ליד"', " 2026")
    'חב״ל ב-3 ליד 2026'
    """
    plain = _GERSHAYIM.sub("\N{HEBREW PUNCTUATION GERSHAYIM}", name)
    plain = _NO_LETTERS.sub("-", _AROUND.sub("", plain))
    plain = " ".join(plain.split()).strip(". ")
    plain = plain[: _LONGEST - len(f"{behind} (99)")].rstrip(". ")
    return f"{plain or 'season'}{behind}"


def free_name(name: str, where: Path | None = None) -> str:
    """Return a name that no season in a folder has yet: this one, or it with a number behind it.

    None: the folder in which seasons live.
    """
    names = chain((name,), (f"{name} ({n})" for n in count(2)))
    return next(one for one in names if not _file(where or folder(), one).exists())


def _free(where: Path, name: str) -> Path:
    """Return the file of a season in a folder, by a name that none there has yet."""
    return _file(where, free_name(name, where))


def _file(where: Path, name: str) -> Path:
    return where / f"{name}{_ENDING}"
