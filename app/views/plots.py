"""All plots: on the map and in a table, to be opened; and the ways to begin."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import pandas as pd
import streamlit as st

from ..show import estate_map, field_map
from ..show.map_view import MapAnswers
from ..state import estate, plot_source, rooms
from ..words import texts

if TYPE_CHECKING:
    from ..state.estate import PlotState


def show() -> None:
    """Show the plots."""
    plots, problems = estate.plots()
    with st.container(key="lead"):
        st.markdown(texts.PLOTS_TITLE.format(n=len(plots)))
    with st.container(horizontal=True):
        for name, icon, source in (("sample", "park", plot_source.SAMPLE),
                                   ("file", "upload_file", plot_source.FILES)):  # fmt: skip
            st.button(texts.WAYS_IN[name], icon=f":material/{icon}:", key=f"way_{name}",
                      on_click=_begin, args=(source,))  # fmt: skip
    for problem in problems:
        st.warning(problem)
    field_map.want(estate_map.content(plots), MapAnswers(tapped=partial(_tapped, plots)))
    st.caption(texts.PLOTS_PICK)
    names = texts.PLOTS_COLUMNS
    columns = {names["name"]: [plot.name for plot in plots]}
    if any(plot.expected is not None for plot in plots):
        columns[names["days_since"]] = [plot.days_since for plot in plots]
        columns[names["expected"]] = [plot.expected for plot in plots]
    table = pd.DataFrame(columns)
    st.dataframe(
        table, hide_index=True, key="plots_table", selection_mode="single-row",
        on_select=partial(_picked, plots),
        column_config={names["expected"]: st.column_config.NumberColumn(format="%.0f")},
    )  # fmt: skip


def _begin(source: str) -> None:
    plot_source.open_season(source)
    rooms.turn_to("today" if source == plot_source.SAMPLE else "plot")


def _open(plot: PlotState) -> None:
    estate.open_plot(plot)
    rooms.turn_to("today")


def _tapped(plots: list[PlotState], layer: str, index: int) -> None:
    plot = estate_map.plot_tapped(plots, index) if layer == estate_map.PLOTS else None
    if plot is not None:
        _open(plot)


def _picked(plots: list[PlotState]) -> None:
    rows = st.session_state["plots_table"]["selection"]["rows"]
    if rows:
        _open(plots[rows[0]])
