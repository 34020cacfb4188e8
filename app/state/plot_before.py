"""The plot as it was before the last change of how its file is read or its rows are laid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

if TYPE_CHECKING:
    from fieldmon.plot.plot import Plot

    from .choices import Choices

_SHOWN = "plot shown"


def plot_before(choices: Choices) -> Plot | None:
    """Return the plot as it was before, as long as it is the same plot; None: it was no other.

    It is called once a run of the page that shows it.
    """
    plot, before = choices.plot, None
    shown: tuple[Plot, Plot | None] | None = st.session_state.get(_SHOWN)
    if shown is not None and shown[0].field.name == plot.field.name:
        before = shown[1] if _is_alike(shown[0], plot) else shown[0]
    st.session_state[_SHOWN] = plot, before
    return before


def _is_alike(one: Plot, other: Plot) -> bool:
    """Return whether two plots have the same outline and the same plants."""
    if one is other:
        return True
    same = len(one.grid) == len(other.grid)
    return same and bool(
        np.array_equal(one.grid.lonlat(), other.grid.lonlat())
        and one.field.boundary.equals(other.field.boundary)
    )


def forget() -> None:
    """Forget it: what is, is as it should be (for callbacks)."""
    st.session_state.pop(_SHOWN, None)
