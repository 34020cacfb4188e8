"""Acting by what is chosen now, not by what was chosen when a button was drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

if TYPE_CHECKING:
    from collections.abc import Callable


def once(pressed: bool, action: Callable[..., object], *arguments: object) -> None:  # noqa: FBT001 - what a button returns
    """Act if a button was pressed, and draw the page anew.

    A button's `on_click` holds the values of the run that drew it. Where a box was changed a moment
    before the press, those are the earlier ones: a season began with other hours than were shown.
    """
    if pressed:
        action(*arguments)
        st.rerun()
