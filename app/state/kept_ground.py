"""What a season has under its plants, kept beside its file: a picture or a map, and an agreement.

No Streamlit in here. The season's own file does not hold it: who gets that file has agreed to
nothing.
"""

from __future__ import annotations

import json
import shutil
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.errors import FieldmonError
from fieldmon.io.atomic_write import write_whole
from fieldmon.io.rasters.read import Backdrop
from fieldmon.io.rasters.tiles import Tileset, read_tiles

if TYPE_CHECKING:
    from pathlib import Path

_MANIFEST = "ground.json"
_ENDING = ".ground"


@dataclass(frozen=True, eq=False)
class GroundPicture:
    """A picture of the ground: as it was taken, or the relief that heights show."""

    name: str
    picture: Backdrop
    is_relief: bool = False
    said: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class GroundTiles:
    """A map in tiles that somebody brought."""

    name: str
    tiles: Tileset


@dataclass(frozen=True)
class Agreement:
    """That pictures may be asked of an address: which, whom to name, and since when (ISO)."""

    address: str
    credit: str
    on: str


Ground = GroundPicture | GroundTiles


def folder_of(season: Path) -> Path:
    """Return where the ground of a season is kept."""
    return season.with_suffix(_ENDING)


def ground(season: Path) -> Ground | None:
    """Return what a season has under its plants; None: nothing, or it is gone."""
    said, here = _manifest(season).get("ground"), folder_of(season)
    try:
        if said is None:
            return None
        if said["kind"] == "tiles":
            return GroundTiles(said["name"], read_tiles(here / said["file"]))
        corners = np.array(said["corners"], np.float64).reshape(4, 2)
        picture = Backdrop((here / said["file"]).read_bytes(), said["mime"], corners)
        return GroundPicture(said["name"], picture, said["kind"] == "relief", tuple(said["said"]))
    except (OSError, KeyError, TypeError, ValueError, FieldmonError):
        return None


def keep(season: Path, new: Ground) -> None:
    """Keep this under the plants of a season, in place of what there was."""
    before, here = _manifest(season).get("ground"), folder_of(season)
    here.mkdir(parents=True, exist_ok=True)
    if isinstance(new, GroundTiles):
        file = f"map{new.tiles.path.suffix}"
        # a copy first: a map half copied must not be taken for one
        shutil.copyfile(new.tiles.path, here / f"{file}.part")
        (here / f"{file}.part").replace(here / file)
        said: dict[str, Any] = {"kind": "tiles", "name": new.name, "file": file}
    else:
        file, picture = "picture", new.picture
        write_whole(here / file, picture.image)
        said = {
            "kind": "relief" if new.is_relief else "picture", "name": new.name, "file": file,
            "mime": picture.mime, "corners": picture.corners_lonlat.tolist(), "said": new.said,
        }  # fmt: skip
    _write(season, ground=said)
    if before and before.get("file") != file:
        with suppress(OSError, KeyError):
            (here / before["file"]).unlink()


def take_out(season: Path) -> None:
    """Keep nothing under the plants of a season."""
    before = _manifest(season).get("ground")
    if before is None:
        return
    _write(season, ground=None)
    with suppress(OSError, KeyError):
        (folder_of(season) / before["file"]).unlink()


def agreement(season: Path) -> Agreement | None:
    """Return what was agreed to for a season, if anything was."""
    said = _manifest(season).get("agreed")
    try:
        return None if said is None else Agreement(said["address"], said["credit"], said["on"])
    except (KeyError, TypeError):
        return None


def agree(season: Path, to: Agreement | None) -> None:
    """Keep what was agreed to for a season; None: take it back."""
    folder_of(season).mkdir(parents=True, exist_ok=True)
    _write(season, agreed=None if to is None else vars(to))


def _manifest(season: Path) -> dict[str, Any]:
    try:
        said = json.loads((folder_of(season) / _MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return said if isinstance(said, dict) else {}


def _write(season: Path, **change: Any) -> None:  # noqa: ANN401 - as JSON has it
    said = _manifest(season) | change
    write_whole(folder_of(season) / _MANIFEST, json.dumps(said, ensure_ascii=False).encode())
