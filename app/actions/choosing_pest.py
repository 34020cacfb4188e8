"""Choosing what is looked for, and bringing the weather that it meets."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import SettingError
from fieldmon.io.readers.pest_file import shipped_pest

from ..show import pest_figures
from ..state import chosen_pest, notices, widget_memory
from ..state.brought_files import brought
from ..state.folds import fold
from ..words import texts
from . import bringing_files

if TYPE_CHECKING:
    from fieldmon.pests.pest import Pest

    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show the pest and the weather; in a season, with a button that lets it take them."""
    season = choices.season
    kept = None if season is None else season.settings.pest
    is_chosen = bool(widget_memory.value(chosen_pest.WHICH))
    with fold(texts.PEST_AND_WEATHER, chosen_pest.WHICH, is_open=is_chosen):
        st.caption(texts.PEST_NOTE)
        if season is not None:
            _say_kept(choices)
        widget_memory.show(
            st.selectbox, texts.WHICH_PEST, list(chosen_pest.options()), key=chosen_pest.WHICH,
            default=_begins_with(kept), filter_mode=None, format_func=_name,
        )  # fmt: skip
        if widget_memory.value(chosen_pest.WHICH) == chosen_pest.OWN:
            bringing_files.show_one(
                texts.PEST_FILE, chosen_pest.PEST, chosen_pest.problem(chosen_pest.PEST)
            )
        bringing_files.show_one(
            texts.WEATHER_FILE, chosen_pest.WEATHER, chosen_pest.problem(chosen_pest.WEATHER)
        )
        chosen = chosen_pest.pest()
        if chosen_pest.WEATHER in brought():
            bringing_files.show_messages(
                chosen_pest.messages(choices.plot, choices.today or choices.on)
            )
        if season is not None:
            st.button(texts.PEST_USE, key="use_pest", on_click=_use, args=(choices,))
        if chosen is not None:
            pest_figures.show(chosen)


def _begins_with(kept: Pest | None) -> str:
    """Return what the box begins with: the season's pest, if it is one that comes along."""
    if kept is None or kept.name not in chosen_pest.options():
        return chosen_pest.NONE
    return kept.name


def _name(which: str) -> str:
    if which == chosen_pest.NONE:
        return texts.NO_PEST
    return texts.OWN_PEST if which == chosen_pest.OWN else pest_figures.title(shipped_pest(which))


def _say_kept(choices: Choices) -> None:
    settings = choices.open_season.settings
    if settings.pest is None:
        return
    st.markdown(texts.PEST_KEPT.format(pest=pest_figures.title(settings.pest)))
    if (weather := settings.weather) is not None and len(weather):
        days = weather.local_days()
        day = choices.units.day
        st.markdown(texts.WEATHER_KEPT.format(first=day(str(days[0])), last=day(str(days[-1]))))


@notices.reporting
def _use(choices: Choices) -> str:
    """Let a season believe its nights by the pest and the weather, from the first on."""
    season = choices.open_season
    settings = season.settings
    pest, weather = chosen_pest.pest(), chosen_pest.met(choices)
    if pest is None and weather is not None:
        raise SettingError(texts.WEATHER_NEEDS_PEST)
    wanted = replace(settings, pest=pest, weather=weather or settings.weather)
    season.change(wanted, settings)
    return texts.PEST_CHANGED
