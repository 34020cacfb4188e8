"""The map of a plot: what pages want shown on it, drawn once a run when the page is done."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

import streamlit as st

from ..state import chosen_day
from ..words import texts
from . import ground, map_view
from .maps import deck

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..state.choices import Choices
    from .ground import GroundShown
    from .map_view import MapAnswers, MapContent

_WANTED, _INSTEAD = "map wanted", "wanted instead of a map"


class OfPlot(TypedDict):
    """What all maps of a plot have in common, as `MapContent` has it."""

    place: str
    bounds: list[float]
    alt: str
    ground: GroundShown
    title: str
    when: str


def clear() -> None:
    """Want no map yet, at the beginning of a run."""
    st.session_state[_WANTED] = st.session_state[_INSTEAD] = None


def want_instead(show: Callable[[], None]) -> None:
    """Want this shown where the map would be, as long as no map is wanted."""
    st.session_state[_INSTEAD] = show


def want(content: MapContent, answers: MapAnswers | None = None) -> None:
    """Want this on the map of the page."""
    st.session_state[_WANTED] = content, answers


def wanted() -> MapContent | None:
    """Return what the page wants on its map, if it has one."""
    kept = st.session_state.get(_WANTED)
    return None if kept is None else kept[0]


def draw() -> None:
    """Show what is wanted.

    The frame does it, not the page: so one map stays through all pages, with its zoom.
    """
    kept = st.session_state.get(_WANTED)
    instead = st.session_state.get(_INSTEAD)
    if kept is not None:
        map_view.show(*kept)
    elif instead is not None:
        instead()


def of_plot(choices: Choices, stops: int = 0) -> OfPlot:
    """Return what all maps of a plot have in common: the place, what is in view, and the words."""
    grid = choices.plot.grid
    finds = int((chosen_day.states_apart(choices)[0] == 1).sum())
    alt = texts.MAP_ALT.format(
        name=choices.plot.field.name, plants=len(grid), finds=finds, stops=stops
    )
    return {"place": choices.place, "bounds": deck.of_grid(grid), "alt": alt,
            "ground": ground.of(choices),
            "title": choices.plot.field.name, "when": choices.units.day(choices.day)}  # fmt: skip
