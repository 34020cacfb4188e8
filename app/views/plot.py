"""Plot and records: what was brought, what the import found, rows, gate, paths and no-go areas."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
import streamlit as st

from app import canopies, drawing, files, maps, panels, risks, texts
from app.choices import row_settings
from fieldmon.errors import PlotError

if TYPE_CHECKING:
    from app.choices import Choices
    from fieldmon.errors import FieldmonError


def bring(problem: FieldmonError | None) -> None:
    """Show the boxes for files while there is no plot to show, and what is wrong with them."""
    if problem is None:
        st.title(texts.TITLE)
        st.markdown(texts.EMPTY)
    if st.session_state.get("season") == texts.UPLOAD:
        files.bring()
    if problem is not None:
        files.say(problem)
        laying = st.session_state.get("laying", "")
        # what was set by hand may be what is wrong: it must stay within reach
        if isinstance(problem, PlotError) and any(row_settings(laying).values()):
            drawing.rows(laying)


def show(choices: Choices) -> None:
    """Show the plot as it was understood, and change what was not."""
    if st.session_state.get("season") == texts.UPLOAD:
        files.bring()
    st.subheader(f"{choices.name}: {texts.PLOT}")
    left, right = st.columns([3, 2])
    with right:
        if choices.project is None:
            drawing.rows(choices.plot_key)
            drawing.tools(choices)
            canopies.bring()
            risks.bring()
        else:
            st.info(texts.FIXED)
        with st.expander(texts.FINDINGS, expanded=True):
            files.show_findings(choices.heard)
            for remark in panels.remarks_on_records(choices):
                st.markdown(f"- {remark}")
    with left:
        _figures(choices)
        _map(choices)


def _figures(choices: Choices) -> None:
    grid, units = choices.plot.grid, choices.units
    area_m2 = shapely.area(grid.frame.geometry_m(choices.plot.field.drivable()))
    apart = f"{units.metres(grid.row_spacing_m, 1)} / {units.metres(grid.plant_spacing_m, 1)}"
    with st.container(horizontal=True):
        st.metric(texts.AREA_IS, units.square(float(area_m2)), width="content")
        st.metric(texts.PLANTS_ARE, f"{len(grid):,}", width="content")
        st.metric(texts.ROWS_ARE, int(grid.row_line.max()) + 1, width="content")
        st.metric(texts.BEARING_IS, f"{grid.frame.bearing_deg % 180:.1f}°", width="content")
        st.metric(texts.SPACING_IS, apart, width="content")


def _map(choices: Choices) -> None:
    records, said = panels.records_until(choices)
    layers = [
        *drawing.plain_plants(choices),
        *maps.records(records, dark=choices.dark),
        *drawing.layers(choices),
    ]
    panels.draw(choices, layers, "plot_map", clicked=drawing.clicks(choices))
    panels.captions([texts.LEGEND_RECORDS, *([said] if said else [])])
    if not len(choices.records):
        st.caption(texts.RECORDS_NONE)
    elif np.isnat(choices.records.day).any():
        st.caption(texts.UNDATED)
