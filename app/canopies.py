"""A raster of this session that says where no plant stands: canopy height, or how green it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from . import cached, files, remembered, texts

if TYPE_CHECKING:
    from fieldmon.plot.plot import Plot

    from .files import Heard

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
    """Return the plot without the plants that are not there, what was said, and the longer key."""
    left, heard, key = files.read_kept(_FILE, key, _below, cached.without_missing, plot)
    return plot if left is None else left, heard, key


def _below() -> float:
    return float(remembered.value(_BELOW, 0.5))
