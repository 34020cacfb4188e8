"""What people want of a day besides: plants picked on the map, to be inspected too, or not.

`laid` is of which plot and plants, see `Choices.laid`.
"""

from __future__ import annotations

import streamlit as st

from fieldmon.planning.wishes import Wishes

_PICKED, _WISHES = "plants picked", "wishes "


def of(laid: str, day: str) -> Wishes:
    """Return what is wanted of a day (ISO)."""
    wishes: Wishes = st.session_state.get(_key(laid, day), Wishes())
    return wishes


def were_told(laid: str, day: str) -> bool:
    """Return whether anything was wished of a day here, though it may be wished no more."""
    return _key(laid, day) in st.session_state


def want(laid: str, day: str, wishes: Wishes) -> None:
    """Want this of a day."""
    st.session_state[_key(laid, day)] = wishes


def forget(laid: str, day: str) -> None:
    """Want of a day here what is kept of it."""
    st.session_state.pop(_key(laid, day), None)


def picked(laid: str) -> tuple[int, ...]:
    """Return the plants that are picked on a plot."""
    where, plants = st.session_state.get(_PICKED, ("", ()))
    return plants if where == laid else ()


def pick(laid: str, plants: tuple[int, ...]) -> None:
    """Pick plants; whatever was picked before is not any more."""
    st.session_state[_PICKED] = laid, plants


def _key(laid: str, day: str) -> str:
    return f"{_WISHES}{laid} {day}"


def said() -> dict[str, tuple[tuple[int, ...], tuple[int, ...]]]:
    """Return all that is wanted, as JSON can hold it."""
    keys = [str(key) for key in st.session_state if str(key).startswith(_WISHES)]
    told: dict[str, Wishes] = {key: st.session_state[key] for key in keys}
    return {key: (of.wanted, of.unwanted) for key, of in told.items()}


def take(said: dict[str, list[list[int]]]) -> None:
    """Want what was wanted before a reload, as `said` returned it."""
    for key, (wanted, unwanted) in said.items():
        st.session_state[key] = Wishes(tuple(wanted), tuple(unwanted))
