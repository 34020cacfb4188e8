"""The ground under the plot: of a file that was brought, or of a map that was agreed to."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.io.rasters.tiles import is_tiles, read_tiles
from fieldmon.io.rasters.values import RasterOptions

from . import cached_files, kept_files, kept_ground, widget_memory
from .brought_files import brought, messages_of, settled, take_out
from .kept_ground import Agreement, Ground, GroundPicture, GroundTiles

if TYPE_CHECKING:
    from fieldmon.io.options import Upload
    from fieldmon.monitoring import Season

    from .brought_files import File, FileMessage
    from .choices import Choices

#: what the file is kept as, and the box that says what it shows
GROUND, SHOWS = "ground", "ground_shows"
#: what a raster may show
PICTURE, HEIGHTS = "picture", "heights"
_PROBLEM, _SAID, _AGREED = "ground problem", "ground said", "ground agreed"
_ENDINGS = {b"PMTiles": ".pmtiles"}


def of(choices: Choices) -> Ground | None:
    """Return what lies under the plot; what was brought is kept with the season from then on."""
    file = brought().get(GROUND)
    st.session_state[_PROBLEM], st.session_state[_SAID] = None, ()
    if file is not None:
        try:
            made = _read(file, choices)
        except FieldmonError as error:
            st.session_state[_PROBLEM] = error
            return None
        if choices.season is None:
            return made
        kept_ground.keep(choices.season.path, made)
        take_out(GROUND)
    return None if choices.season is None else kept_ground.ground(choices.season.path)


def problem() -> FieldmonError | None:
    """Return why the file that was brought could not be used when it was last read."""
    found: FieldmonError | None = st.session_state.get(_PROBLEM)
    return found


def said() -> tuple[FileMessage, ...]:
    """Return what reading the file had to say."""
    messages: tuple[FileMessage, ...] = st.session_state.get(_SAID, ())
    return messages


def forget(choices: Choices) -> None:
    """Let nothing of a file lie under the plot any more (for callbacks)."""
    take_out(GROUND)
    if choices.season is not None:
        kept_ground.take_out(choices.season.path)


def is_raster(file: File) -> bool:
    """Return whether a file is a raster, of which must be known what it shows."""
    return not is_tiles(_head(file))


def shows(file: File) -> str:
    """Return what a raster shows: as it was said, else as it looks."""
    chosen: str | None = widget_memory.value(f"{SHOWS} {file.key}")
    if chosen is not None:
        return chosen
    options = settled(file, RasterOptions())
    looks = cached_files.looks_like_heights(f"{file.key} {options}", options, file.source)
    return HEIGHTS if looks else PICTURE


# -- maps on the internet


def agreement(season: Season | None) -> Agreement | None:
    """Return what was agreed to for the season, or for this session where there is none."""
    if season is not None:
        return kept_ground.agreement(season.path)
    agreed: Agreement | None = st.session_state.get(_AGREED)
    return agreed


def agree(season: Season | None, to: Agreement | None) -> None:
    """Agree to a map for the season, or for this session; None: take it back (for callbacks)."""
    if season is not None:
        kept_ground.agree(season.path, to)
    else:
        st.session_state[_AGREED] = to


# -- files


def _read(file: File, choices: Choices) -> Ground:
    if not is_raster(file):
        path = _on_disk(file)
        return GroundTiles(file.name, read_tiles(path, choices.plot.field))
    options = settled(file, RasterOptions())
    key = f"{file.key} {options} {choices.key}"
    is_relief = shows(file) == HEIGHTS
    read = cached_files.relief if is_relief else cached_files.backdrop
    imported = read(key, options, file.source, choices.plot.field)
    st.session_state[_SAID] = messages_of(file, imported)
    told = tuple(str(message.sentence) for message in imported.messages)
    return GroundPicture(file.name, imported.value, is_relief, told)


def _head(file: File) -> bytes:
    source = file.source
    if isinstance(source, Path):
        with source.open("rb") as opened:
            return opened.read(16)
    first = source[0] if isinstance(source, tuple) else source
    return first.data[:16]


def _on_disk(file: File) -> Path:
    """Return where a map in tiles lies: one that was uploaded is written once, for this person."""
    if isinstance(file.source, Path):
        return file.source
    upload: Upload = file.source[0] if isinstance(file.source, tuple) else file.source
    return kept_files.written(f"ground-{file.key}", f"map{_ending(upload)}", upload.data)


def _ending(upload: Upload) -> str:
    return next((e for head, e in _ENDINGS.items() if upload.data.startswith(head)), ".mbtiles")
