"""The report: the day or the season on paper."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING

import streamlit as st

from app import keeping, panels, report, texts

if TYPE_CHECKING:
    from app.choices import Choices


def show(choices: Choices) -> None:
    """Show the report, and hand it out."""
    st.subheader(f"{choices.name}: {texts.REPORT}")
    st.caption(texts.REPORT_INTRO)
    today = choices.today()
    days = [] if choices.project is None else keeping.figures(choices)
    facts = report.Facts(
        choices.plot.field.name, choices.units.day(choices.day), choices.units,
        panels.chance_of(choices), panels.states_of(choices), choices.robot,
        texts.SAMPLERS[choices.sampler], panels.route_of_day(choices).route,
        panels.found_on_day(choices),
    )  # fmt: skip
    page = report.html(facts, today, panels.stops(choices, today), days)
    st.download_button(
        texts.REPORT_DOWNLOAD, page, f"report_{choices.day}.html", "text/html", type="primary",
        on_click="ignore",
    )  # fmt: skip
    st.markdown(f"**{texts.REPORT_PREVIEW}**")
    # as data it has no way into this page, whatever a plot is called
    data = base64.b64encode(page.encode()).decode()
    st.iframe(f"data:text/html;charset=utf-8;base64,{data}", height=900, alt=texts.REPORT)
