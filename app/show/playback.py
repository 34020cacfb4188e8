"""The day slider, and the playback of a day's work: the path grows with the clock."""

from __future__ import annotations

from dataclasses import replace
from datetime import date, timedelta
from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from ..state import chosen_day
from ..words import texts
from . import field_map, plant_history
from .maps import route_layers

if TYPE_CHECKING:
    from ..state.choices import Choices

_FRAMES = 60


def day(choices: Choices) -> Choices:
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


def show(choices: Choices, layers: list, *, on: bool) -> None:
    """Show the map with the clock of the day above it; a tap shows a plant's history."""
    shown = chosen_day.route(choices)
    route = shown.route
    tap = partial(plant_history.take_plant, choices)
    if not on or not len(route):
        field_map.draw(choices, layers, "field_map", tap)
        return
    key = f"clock {choices.day}"
    if st.session_state.get("playing"):
        _forward(key, route.end_s)
    left, right = st.columns([2, 5], vertical_alignment="bottom")
    playing = bool(st.session_state.get("playing"))
    left.button(texts.PAUSE if playing else texts.PLAY, key="play", on_click=_toggle,
                icon=":material/pause:" if playing else ":material/play_arrow:")  # fmt: skip
    minutes = int(route.end_s // 60) + 1
    st.session_state[key] = min(st.session_state.get(key, 0), minutes)
    minute = right.slider(texts.MAP_CLOCK, 0, minutes, key=key, format="%d min")
    second = min(60.0 * minute, route.end_s)
    if minute:
        layers = [one for one in layers if one.id not in ("route", "arrows", "numbers")]
        layers += route_layers.playback(route, second, dark=choices.dark)
    st.caption(f"{shown.begins + timedelta(seconds=second):%H:%M}")
    field_map.draw(choices, layers, "field_map", tap)
    if playing:
        _tick()


@st.fragment(run_every=0.8)
def _tick() -> None:
    """Ask for the next frame; the first run of a fragment is that of the page itself."""
    if st.session_state.get("ticked") and st.session_state.get("playing"):
        st.session_state["ticked"] = False
        st.rerun()
    st.session_state["ticked"] = True


def _forward(key: str, end_s: float) -> None:
    minutes = int(end_s // 60) + 1
    now = min(st.session_state.get(key, 0) + max(1, minutes // _FRAMES), minutes)
    st.session_state[key] = now
    if now == minutes:
        st.session_state["playing"] = False


def _toggle() -> None:
    st.session_state["playing"] = not st.session_state.get("playing")
    st.session_state["ticked"] = False
