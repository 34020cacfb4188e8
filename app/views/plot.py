"""Plot and records: what was brought, what the import found, rows, gate, paths and no-go areas."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..actions import (
    answering,
    beginning,
    bringing_files,
    choosing_pest,
    drawing_plot,
    editing_plot,
    laying_ground,
    rasters,
    turning_rows,
    without_map,
)
from ..show import assumed, field_map, plot_figures
from ..show import records as records_shown
from ..state import menu, plot_before, plot_source
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.errors import FieldmonError

    from ..state.choices import Choices


def bring(problem: FieldmonError | None) -> None:
    """Show the ways to a plot while there is none to show, and what is wrong with it."""
    if drawing_plot.show():
        return
    if problem is None:
        st.title(texts.TITLE)
        st.markdown(texts.EMPTY)
    # what is wrong, or asked, comes first: below five boxes it was not seen
    said = st.container()
    if plot_source.chosen() == plot_source.FILES:
        drawing_plot.offer()
    if problem is not None:
        with said:
            answering.show(problem)
            editing_plot.within_reach(problem)
    without_map.want(problem)


def show(choices: Choices) -> None:
    """Show the plot as it was understood, and change what was not."""
    st.button(texts.TO_ROUTE, key="to_route", type="primary", on_click=menu.turn_to_page,
              args=("today",))  # fmt: skip
    plot_figures.show(choices.plot, choices.units)
    before = plot_before.plot_before(choices) if choices.season is None else None
    if before is not None:
        st.caption(texts.BEFORE_NOTE)
        st.button(texts.BEFORE_DROP, key="forget_before", on_click=plot_before.forget)
    st.caption(assumed.sentence(choices.plot.assumed, choices.units))
    turning_rows.show(choices)
    if plot_source.chosen() == plot_source.FILES:
        with st.expander(texts.FILES):
            bringing_files.show()
    records, said = records_shown.records_until(choices.records)
    if choices.season is None:
        editing_plot.tools(choices)
        editing_plot.rows(choices.plot_key, measured=choices.plot.field.plants is not None)
        editing_plot.blocks(choices)
        rasters.show()
    else:
        st.info(texts.FIXED)
        beginning.another(choices)
    choosing_pest.show(choices)
    laying_ground.show(choices)
    with st.expander(texts.MESSAGES, expanded=True):
        bringing_files.show_of_plot(choices)
        bringing_files.show_of_records(choices)
    records_shown.say(choices, said)
    field_map.want(*answering.of_records(choices) or editing_plot.content(choices, records, before))
