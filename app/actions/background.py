"""Begin and stop work that goes on in the background."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..words import texts

if TYPE_CHECKING:
    from ..state.comparison import Comparison
    from ..state.driving import DriveRun
    from ..state.live_drive import LiveDrive


def buttons(work: Comparison | DriveRun | LiveDrive, label: str, *, key: str, over: bool) -> bool:
    """Offer to begin and to stop it; return whether it is at work. `over`: nothing is left to do.

    It begins before its button is drawn, by what is chosen now: so no second run has to tell the
    buttons.
    """
    if st.session_state.get(key) and not over:
        work.start()
    at_work = work.running
    with st.container(horizontal=True):
        st.button(label, type="primary", key=key, disabled=at_work or over)
        st.button(texts.STOP, key=f"{key}_stop", on_click=work.stop, disabled=not at_work)
    return at_work
