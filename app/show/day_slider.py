"""The day slider: any day of a season on the map."""

from __future__ import annotations

from dataclasses import replace
from datetime import date
from typing import TYPE_CHECKING

import streamlit as st

from ..state import chosen_day
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> Choices:
    """Show a slider over the season's days; return the choices of the day on it."""
    if choices.season is None:
        return choices
    days = chosen_day.season_days(choices)
    if len(days) < 2:
        return choices
    chosen = st.select_slider(
        texts.MAP_DAY, days, choices.day, key=f"map_day {choices.day} {len(days)}",
        format_func=lambda iso: choices.units.day(date.fromisoformat(iso)),
    )  # fmt: skip
    return replace(choices, day=chosen)
