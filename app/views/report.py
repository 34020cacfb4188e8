"""The report: the day or the season on paper."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING

import streamlit as st

from ..show import day, map_layers, plant_history, report
from ..show.assumed import sentence
from ..state import assumptions, chosen_day
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show the report, and hand it out."""
    plant_history.want(choices, map_layers.day_map(choices))
    st.caption(texts.REPORT_INTRO)
    shown = chosen_day.route(choices)
    days = [] if choices.season is None else chosen_day.figures_so_far(choices)
    facts = report.Facts(
        choices.plot.field.name, choices.units.day(choices.day), choices.units,
        chosen_day.chance(choices), chosen_day.states(choices), choices.robot,
        texts.SAMPLERS[choices.sampler], shown, day.found_by_row(choices),
        sentence(assumptions.of(choices), choices.units),
    )  # fmt: skip
    page = report.html(facts, day.stops(choices, shown), days)
    st.download_button(
        texts.REPORT_DOWNLOAD, page, f"report_{choices.day}.html", "text/html", type="primary",
        on_click="ignore",
    )  # fmt: skip
    st.markdown(f"**{texts.REPORT_PREVIEW}**")
    # as data it has no way into this page, whatever a plot is called
    data = base64.b64encode(page.encode()).decode()
    st.iframe(f"data:text/html;charset=utf-8;base64,{data}", height=900, alt=texts.REPORT)
