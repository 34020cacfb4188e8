"""A plot in figures: how large it is, how it is planted and where it lies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.io.parse.geometry import area_m2

from ..words import texts
from ..words.language import number
from . import plot_place
from .assumed import mark

if TYPE_CHECKING:
    from fieldmon.plot.plot import Plot

    from ..words.units import UnitsInLanguage


def show(plot: Plot, units: UnitsInLanguage) -> None:
    """Show the figures side by side, and where the plot lies."""
    grid = plot.grid
    apart = f"{units.metres(grid.row_spacing_m, 1)} / {units.metres(grid.plant_spacing_m, 1)}"
    rows = ("row_spacing_m", "plant_spacing_m")
    plants, spacing = (
        mark(name, plot.assumed, rows) for name in (texts.PLANTS_ARE, texts.SPACING_IS)
    )
    with st.container(horizontal=True):
        st.metric(texts.AREA_IS, units.square(area_m2(plot.field.boundary)), width="content")
        st.metric(plants, number(len(grid), ","), width="content")
        st.metric(texts.ROWS_ARE, grid.n_lines, width="content")
        if grid.aisles_m is None:  # rows that bend, or blocks that turn, have no one direction
            bearing = number(grid.frame.bearing_deg % 180, ".1f")
            st.metric(texts.BEARING_IS, f"{bearing}°", width="content")
        st.metric(spacing, apart, width="content")
    st.caption(plot_place.sentence(plot))
