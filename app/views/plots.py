"""All plots: on the map and in a table, to be opened; and the ways to begin."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from ..actions import sharing_plots, ways_in
from ..show import estate_map, estate_table, field_map
from ..show.map_view import MapAnswers
from ..state import estate, menu
from ..words import texts

if TYPE_CHECKING:
    from ..state.estate import PlotState


def show() -> None:
    """Show the plots."""
    plots, problems = estate.plots()
    with st.container(key="head"):
        st.markdown(f"### {texts.PLOTS_TITLE.format(n=len(plots))}")
    if not sharing_plots.is_on():
        ways_in.show()
    sharing_plots.show_button(plots)
    for problem in problems:
        st.warning(problem.said)
    held = [problem.held for problem in problems if problem.held]
    if held:
        st.fragment(_watch, run_every=estate.LOOK_AGAIN_S)(held)
    turns = sharing_plots.show(plots, problems).turns if sharing_plots.is_on() else ()
    # those with work come first, in the order of the day
    planned = {id(turn.state): (turn.begins, turn.number) for turn in turns}
    plots = sorted(plots, key=lambda one: (id(one) not in planned, planned.get(id(one), ())))
    field_map.want(estate_map.content(plots, turns), MapAnswers(tapped=partial(_tapped, plots)))
    table, config = estate_table.of(plots, turns)
    st.dataframe(
        table, hide_index=True, key="plots_table", selection_mode="single-row",
        on_select=partial(_picked, plots), column_config=config, placeholder="",
    )  # fmt: skip
    # below: the table's own tools lie on what stands above it
    st.caption(texts.PLOTS_PICK)


def _watch(held: list[str]) -> None:
    """Show a season that another program held as soon as it is free."""
    if estate.is_one_free(held):
        st.rerun()


def _open(plot: PlotState) -> None:
    estate.open_plot(plot)
    menu.turn_to("today")


def _tapped(plots: list[PlotState], layer: str, index: int) -> None:
    plot = estate_map.plot_tapped(plots, index, layer)
    if plot is not None:
        _open(plot)


def _picked(plots: list[PlotState]) -> None:
    rows = st.session_state["plots_table"]["selection"]["rows"]
    if rows:
        _open(plots[rows[0]])
