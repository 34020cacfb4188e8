"""A raster of this session that says where no plant stands: canopy height, or how green it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.geodata.raster_values import RasterOptions

from . import cached, files, remembered, texts
from .files import Heard

if TYPE_CHECKING:
    from fieldmon.monitor import Plot

_FILE, _BELOW = "canopy", "canopy_below"


def bring() -> None:
    """Show the box for the raster, and below which value no plant is there."""
    with st.expander(texts.CANOPY, expanded=_FILE in st.session_state):
        st.caption(texts.CANOPY_NOTE)
        files.bring_one(texts.CANOPY_FILE, _FILE)
        remembered.show(st.number_input, texts.CANOPY_BELOW, -1000.0, 100_000.0, step=0.1,
                        key=_BELOW, default=0.5)  # fmt: skip
        files.kept_one(_FILE)


def of(plot: Plot, key: str) -> tuple[Plot, tuple[Heard, ...], str]:
    """Return the plot without the plants that are not there, what was said, and the longer key.

    A raster that cannot be used is left out; the page where it was brought says why.
    """
    file = st.session_state.get(_FILE)
    if file is None:
        return plot, (), key
    below = float(remembered.value(_BELOW, 0.5))
    try:
        options = files.settled(file, RasterOptions())
        key_of_rest = f"{key} canopy {file.key} {below} {options}"
        read = cached.without_missing(key_of_rest, options, below, file.source, plot)
    except FieldmonError as error:
        files.trouble(_FILE, error)
        return plot, (), key
    files.trouble(_FILE, None)
    return read.value, tuple(Heard(file.key, finding) for finding in read.findings), key_of_rest
