"""What people want of a day besides: plants picked on the map, to be inspected too, or not."""

from __future__ import annotations

import streamlit as st

from fieldmon.planning.wishes import Wishes

_PICKED = "plants picked"


def of(place: str, day: str) -> Wishes:
    """Return what is wanted of a day (ISO) on a plot; kept as long as the session."""
    wishes: Wishes = st.session_state.get(_key(place, day), Wishes())
    return wishes


def were_told(place: str, day: str) -> bool:
    """Return whether anything was wished of a day, though it may be wished no more."""
    return _key(place, day) in st.session_state


def want(place: str, day: str, wishes: Wishes) -> None:
    """Want this of a day."""
    st.session_state[_key(place, day)] = wishes


def picked(place: str) -> tuple[int, ...]:
    """Return the plants that are picked on a plot."""
    where, plants = st.session_state.get(_PICKED, ("", ()))
    return plants if where == place else ()


def pick(place: str, plants: tuple[int, ...]) -> None:
    """Pick plants; whatever was picked before is not any more."""
    st.session_state[_PICKED] = place, plants


def _key(place: str, day: str) -> str:
    return f"wishes {place} {day}"
