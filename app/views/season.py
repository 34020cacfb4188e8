"""The season: found and inspected by day, and what is still out there."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from ..actions import assuming, beginning, keeping, treating
from ..show import cautions, charts, development, forecast, learnt, map_layers, plant_history
from ..show import day as show_day
from ..state import chosen_day
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.monitoring import DayFigures, Progress

    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show where the season stands."""
    content = map_layers.day_map(choices)
    plant_history.want(choices, replace(content, frames=map_layers.season_frames(choices)))
    if choices.season is None:
        st.markdown(texts.NEEDS_SEASON)
        beginning.show(choices)
        return
    days, progress = chosen_day.figures_so_far(choices), chosen_day.progress(choices)
    show_day.figures(choices, days[-1], progress)
    show_day.beside_figures(choices)
    show_day.planned_only(choices)
    show_day.say_otherwise(choices)
    cautions.show(choices)
    cautions.show_treatments(choices)
    treating.ask_wait(choices)
    assuming.show(choices)
    development.show(choices)
    _charts(choices, days, progress)
    forecast.show(choices)
    learnt.show(choices)
    keeping.show(choices)


def _charts(choices: Choices, days: list[DayFigures], progress: Progress) -> None:
    named, day, out = choices.units.short_day, texts.DATE_AXIS, texts.OUT_AXIS
    worked = (day, texts.INSPECTED_AXIS, texts.FOUND_AXIS)
    if progress.inspected:  # a chart of nothing says nothing, least of all to who hears it read
        st.altair_chart(charts.season_days(days, worked, named), alt=texts.FOUND_AXIS)
    st.altair_chart(charts.still_out(days, (day, out), named), alt=out)
    st.markdown(f"**{texts.ROW_AGES}**")
    line = choices.plot.grid.row_line_number
    rows, seen = (len(np.unique(of)) for of in (line, line[~np.isnan(progress.days_since)]))
    if progress.inspected:
        signs, axes = choices.plot.grid.line_signs, (texts.ROW_AXIS, texts.DAYS_SINCE)
        ages = charts.row_ages(progress.days_since, line, axes, signs)
        st.altair_chart(ages, alt=texts.ROW_AGES)
    st.caption(texts.NEVER_ROWS.format(n=rows - seen, all=rows) if seen < rows else texts.EVERY_ROW)
