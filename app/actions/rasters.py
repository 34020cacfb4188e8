"""Boxes for rasters of this session: missing plants, risk."""

from __future__ import annotations

import streamlit as st

from fieldmon.infestation.prior.raster_risk import RELATIVE

from ..state import rasters, widget_memory
from ..state.brought_files import brought
from ..state.folds import fold
from ..words import texts
from . import bringing_files


def show() -> None:
    """Show the boxes for rasters: missing plants, and risk."""
    show_missing()
    show_risk()


def show_missing() -> None:
    """Show the box for a raster of missing plants, and below which value no plant is there."""
    with fold(texts.MISSING, rasters.MISSING, is_open=rasters.MISSING in brought()):
        st.caption(texts.MISSING_NOTE)
        bringing_files.show_raster(texts.MISSING_FILE, rasters.MISSING)
        widget_memory.show(st.number_input, texts.MISSING_BELOW, -1000.0, 100_000.0, step=0.1,
                           key=rasters.MISSING_BELOW, default=0.5)  # fmt: skip
        bringing_files.show_kept_raster(rasters.MISSING)


def show_risk() -> None:
    """Show the box for a raster of risk, and what its numbers mean."""
    with fold(texts.RISK, rasters.RISK, is_open=rasters.RISK in brought()):
        st.caption(texts.RISK_NOTE)
        bringing_files.show_raster(texts.RISK_FILE, rasters.RISK)
        widget_memory.show(st.selectbox, texts.RISK_MEANS, [None, *texts.RISK_MEANINGS],
                           key=rasters.RISK_MEANING, filter_mode=None,
                           format_func=_meaning)  # fmt: skip
        if widget_memory.value(rasters.RISK_MEANING) in RELATIVE:
            widget_memory.show(st.number_input, texts.RISK_SHARE, 0.1, 50.0, step=0.5,
                               key=rasters.RISK_SHARE, default=2.0)  # fmt: skip
            widget_memory.show(st.toggle, texts.RISK_LOW, key=rasters.RISK_LOW, default=False)
        bringing_files.show_kept_raster(rasters.RISK)


def _meaning(meaning: str | None) -> str:
    return texts.RISK_AS_FILE if meaning is None else texts.RISK_MEANINGS[meaning]
