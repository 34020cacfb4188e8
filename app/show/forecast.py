"""How many plants will be infested if nobody inspects any more: a line with its interval."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..state import chosen_day
from ..words import texts
from ..words.language import about, number
from . import charts

if TYPE_CHECKING:
    from fieldmon.infestation.forecast import Forecast

    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show what is expected on the mornings after the day shown, and by what weather."""
    ahead = chosen_day.forecast(choices)
    st.markdown(f"**{texts.AHEAD_TITLE}**")
    axes = (texts.DATE_AXIS, texts.AHEAD_AXIS)
    chart = charts.ahead(choices.day, ahead, axes, choices.units.short_day)
    st.altair_chart(chart, alt=texts.AHEAD_TITLE)
    last, now = (about(ahead.expected[day]) for day in (-1, 0))
    low, high = (number(end[-1], ",.0f") for end in (ahead.low, ahead.high))
    nights = number(ahead.nights, "d")
    st.markdown(texts.AHEAD.format(last=last, low=low, high=high, now=now, nights=nights))
    st.caption(_basis(ahead))


def _basis(ahead: Forecast) -> str:
    """Return what weather it is made from."""
    if ahead.weather is None:
        return texts.AHEAD_BASIS["none"]
    if ahead.weather == 0:
        return texts.AHEAD_BASIS["usual"]
    by_forecast = ahead.weather - ahead.measured
    if ahead.nights in (ahead.measured, by_forecast):
        return texts.AHEAD_BASIS["forecast" if by_forecast else "measured"]
    how = "partly" if not ahead.measured else "both" if by_forecast else "partly_measured"
    said = texts.AHEAD_BASIS[how if ahead.weather < ahead.nights else "both_all"]
    n, measured = (number(each, "d") for each in (by_forecast, ahead.measured))
    return said.format(n=n, measured=measured)
