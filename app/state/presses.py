"""Presses of buttons that are not carried out yet."""

from __future__ import annotations

import streamlit as st

_PRESSES = "presses"


def waiting() -> dict[str, bool]:
    """Return whether the boxes were emptied since, of each button whose press waits, by its key."""
    presses: dict[str, bool] = st.session_state.setdefault(_PRESSES, {})
    return presses


def forget() -> None:
    """Forget presses of buttons that a whole run did not show: they are of another page."""
    waiting().clear()
