"""Begin and stop work that goes on in the background."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..words import texts
from . import acting

if TYPE_CHECKING:
    from ..state.comparison import Comparison
    from ..state.driving import DriveRun
    from ..state.live_drive import LiveDrive


def buttons(work: Comparison | DriveRun | LiveDrive, label: str, *, key: str, over: bool) -> None:
    """Offer to begin and to stop it; `over`: there is nothing left to do."""
    with st.container(horizontal=True):
        pressed = st.button(label, type="primary", key=key, disabled=work.running or over)
        acting.once(pressed, work.start)
        st.button(texts.STOP, key=f"{key}_stop", on_click=work.stop, disabled=not work.running)
