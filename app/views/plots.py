"""All plots: on the map and in a table, to be opened; and the ways to begin."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import pandas as pd
import streamlit as st

from ..actions import ways_in
from ..show import estate_map, field_map
from ..show.map_view import MapAnswers
from ..state import estate, rooms
from ..words import texts

if TYPE_CHECKING:
    from ..state.estate import PlotState


def show() -> None:
    """Show the plots."""
    plots, problems = estate.plots()
    with st.container(key="lead"):
        st.markdown(texts.PLOTS_TITLE.format(n=len(plots)))
    ways_in.show()
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
