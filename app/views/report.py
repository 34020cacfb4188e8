"""The report: the day or the season on paper."""

from __future__ import annotations

import base64
from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.reports.html import html_text
from fieldmon.reports.pdf import PAPERS, pdf_bytes

from ..actions import choosing
from ..show import map_layers, plant_history, report
from ..state import widget_memory
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show the report, and hand it out."""
    plant_history.want(choices, map_layers.day_map(choices))
    about = "day" if choices.season is None else _about()
    if about == "day" and len(choices.team_that_day) > 1:
        widget_memory.show(st.checkbox, texts.REPORT_EACH, key=report.EACH, default=True)
        if not widget_memory.value(report.EACH):
            choosing.whose_day(choices)
    made = _MADE[about](choices)
    paper = widget_memory.show(
        st.selectbox, texts.REPORT_PAPER, [*PAPERS], key="report paper", default="a4",
        format_func=texts.REPORT_PAPERS.__getitem__,
    )  # fmt: skip
    name, page = choices.file_name(about), html_text(made)
    with st.container(horizontal=True):
        # made when it is asked for: fonts are cut and plants are drawn, in a second or two
        st.download_button(
            texts.REPORT_PDF, partial(pdf_bytes, made, paper), f"{name}.pdf", "application/pdf",
            type="primary", on_click="ignore",
        )  # fmt: skip
        st.download_button(texts.REPORT_HTML, page, f"{name}.html", "text/html", on_click="ignore")
    st.markdown(f"**{texts.REPORT_PREVIEW}**")
    # as data it has no way into this page, whatever a plot is called
    data = base64.b64encode(page.encode()).decode()
    st.iframe(f"data:text/html;charset=utf-8;base64,{data}", height=900, alt=texts.REPORT)


_MADE = {
    "day": report.of_day,
    "season": report.of_season,
    "certification": report.for_certifier,
}


def _about() -> str:
    """Return what the report is to be about."""
    chosen: str = widget_memory.show(
        st.radio, texts.REPORT_ABOUT, [*texts.REPORT_KINDS], key="report about", default="day",
        format_func=texts.REPORT_KINDS.__getitem__, horizontal=True,
    )  # fmt: skip
    return chosen
