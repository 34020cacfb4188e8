"""Boxes that open by themselves, and are folded by hand alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

if TYPE_CHECKING:
    from streamlit.delta_generator import DeltaGenerator

_OPENED = "opened folds"


def fold(label: str, key: str, *, is_open: bool) -> DeltaGenerator:
    """Return a box that opens once it is to be open.

    Streamlit folds one that need not be open any more under the hand that took out what was in it.
    """
    opened: set[str] = st.session_state.setdefault(_OPENED, set())
    if is_open:
        opened.add(key)
    return st.expander(label, expanded=key in opened)
