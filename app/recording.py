"""Recording what was found: one plant, the stops of the route, or a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd
import streamlit as st

from fieldmon.plot.grid import row_label

from . import cached, keeping, texts

if TYPE_CHECKING:
    from .choices import Choices


def show(choices: Choices) -> None:
    """Show the three ways of recording."""
    st.markdown(f"**{texts.RECORD} · {choices.units.day(choices.day)}**")
    st.caption(texts.RECORD_NOTE)
    route, one, file, treat = st.tabs(
        [texts.RECORD_ROUTE, texts.RECORD_ONE, texts.RECORD_UPLOAD, texts.TREAT]
    )
    with route:
        _route(choices)
    with one, st.form("one_plant_form", border=False):
        left, right = st.columns(2)
        left.number_input(texts.HISTORY_ROW, 1, None, 1, key="one_row")
        right.number_input(texts.HISTORY_PLANT, 1, None, 1, key="one_plant")
        st.segmented_control(texts.RESULT, list(texts.RESULTS_OF), default=keeping.CLEAN,
                             format_func=texts.RESULTS_OF.__getitem__, key="one_result",
                             required=True)  # fmt: skip
        st.number_input(texts.COUNT, 0, None, None, key="one_count")
        st.form_submit_button(texts.RECORD_BUTTON, on_click=keeping.record_one, args=(choices,))
    with file:
        brought = st.file_uploader(texts.RECORD_FILE_IN, key="findings_file")
        st.checkbox(texts.TAKE_DOUBTFUL, key="take_doubtful")
        if brought is not None:
            st.button(texts.RECORD_BUTTON, key="record_file", type="primary",
                      on_click=keeping.record_file,
                      args=(choices, brought.name, brought.getvalue()))  # fmt: skip
    with treat, st.form("treatment_form", border=False):
        st.number_input(texts.TREAT_EFFICACY, 0, 100, 90, 5, key="efficacy")
        st.text_input(texts.TREAT_PRODUCT, key="product")
        st.form_submit_button(texts.TREAT_BUTTON, on_click=keeping.treat, args=(choices,))


def _route(choices: Choices) -> None:
    """Show the route given out for the day, or the one planned, to be marked stop by stop."""
    kept = cached.season_route(choices.key, choices.revision, choices.day, choices.project)
    plants = kept if len(kept) else choices.today().route.plant
    label = row_label(choices.plot.grid, plants)
    table = pd.DataFrame(
        {
            texts.COLUMN_ROW: label.line,
            texts.COLUMN_PLANT: label.number,
            texts.LEGEND_STATES["found"]: False,
        },
        index=pd.RangeIndex(1, len(plants) + 1, name="stop"),
    )
    # Enter after typing a number must not record: the button under it would record as many again
    with st.form("route_form", border=False, enter_to_submit=False):
        st.caption(texts.RECORD_REST)
        st.number_input(texts.RECORD_STOPS, 0, len(plants), len(plants), key="stops_done")
        with st.container(key="route_marks"):
            marked = st.data_editor(table, height=230, disabled=list(table.columns[:2]),
                                    key=f"marks {choices.day} {len(plants)}")  # fmt: skip
        pressed = st.form_submit_button(texts.RECORD_BUTTON, type="primary")
    if pressed:
        found = marked.index[marked[texts.LEGEND_STATES["found"]]].tolist()
        keeping.record_stops(choices, plants, found)
        st.rerun()
