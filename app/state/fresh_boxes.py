"""Boxes for what was done on a day: empty on each day and in each season, and once it is kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import streamlit as st

if TYPE_CHECKING:
    from .choices import Choices


@dataclass(frozen=True, eq=False)
class FreshBoxes:
    """The boxes of one form: what somebody said of a day is never read as said of another.

    Parameters
    ----------
    form
        What the form is for; each is emptied by itself.
    choices
        Of which season and day it is.
    """

    form: str
    choices: Choices

    def key(self, box: str) -> str:
        """Return the key of a box."""
        place = f"{self.choices.day} {self.choices.key}"
        return f"{box} {self.form} {st.session_state.get(_times(self.form), 0)} {place}"

    def said(self, box: str) -> Any:  # noqa: ANN401 - whatever the widget holds
        """Return what a box holds; None where it is not shown."""
        return st.session_state.get(self.key(box))

    def put(self, box: str, value: object) -> None:
        """Let a box hold a value (for callbacks)."""
        st.session_state[self.key(box)] = value

    def empty(self) -> None:
        """Let the boxes be empty from the next run on."""
        empty(self.form)


def empty(form: str) -> None:
    """Let the boxes of a form be empty from the next run on; of no form: nothing."""
    if form:
        st.session_state[_times(form)] = st.session_state.get(_times(form), 0) + 1


def _times(form: str) -> str:
    return f"emptied {form}"
