"""What phones send while a page is open: the page is drawn anew, without a press."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.monitoring.phones import scouts

from ..state import chosen_day

if TYPE_CHECKING:
    from ..state.choices import Choices

#: so often it is looked whether anything came
LOOK_S = 5.0
_HELD = "news held"


def hold() -> None:
    """Draw nothing anew beside what is open now: that would close it."""
    st.session_state[_HELD] = True


def watch(choices: Choices) -> None:
    """Draw the page anew once something is recorded, and each minute of a day that is worked.

    In a season for which nobody has a code, nothing comes by itself. `hold` puts it off.
    """
    if st.session_state.pop(_HELD, False):
        return
    if choices.season is not None and scouts.scouts_of(choices.season):
        st.fragment(_look, run_every=LOOK_S)(choices, _now(choices))


def _look(choices: Choices, shown: tuple[str, str]) -> None:
    try:
        is_shown = _now(choices) == shown
    except FieldmonError:  # another program holds the file: it is looked again
        return
    if not is_shown:
        st.rerun()


def _now(choices: Choices) -> tuple[str, str]:
    """Return what changes with all that is recorded, and with the hours that run."""
    runs = choices.is_today and chosen_day.progress(choices).inspected_today > 0
    return choices.revision, f"{choices.clock.now():%H:%M}" if runs else ""
