"""Presses of buttons that are not carried out yet."""

from __future__ import annotations

from dataclasses import dataclass

import streamlit as st

_PRESSES, _DONE = "presses", "press done"


@dataclass(frozen=True)
class Press:
    """A press of a page: of which plot and day it was, and how often its boxes were emptied."""

    chosen: tuple[object, ...]
    times: int = 0


def waiting() -> dict[str, Press]:
    """Return the presses that wait, by the keys of their buttons."""
    presses: dict[str, Press] = st.session_state.setdefault(_PRESSES, {})
    return presses


def end(key: str, *, done: bool) -> None:
    """Let the press of a button wait no more, as it was carried out, or failed."""
    press = waiting().pop(key, None)
    if done:
        st.session_state[_DONE] = key, press


def is_done(key: str, press: Press) -> bool:
    """Return whether this press of a button was carried out as the last of all."""
    return st.session_state.get(_DONE) == (key, press)


def forget() -> None:
    """Forget presses of buttons that a whole run did not show: they are of another page."""
    waiting().clear()
