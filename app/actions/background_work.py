"""Begin and stop work that goes on in the background."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..state import browser
from ..words import texts

if TYPE_CHECKING:
    from ..state.comparison import WatchedComparison
    from ..state.driving import DriveRun
    from ..state.live_drive import LiveDrive

# for a first answer is waited in steps that a click ends, less than a second in all
_STEP_S, _STEPS = 0.05, 18


def buttons(
    work: WatchedComparison | DriveRun | LiveDrive, label: str, *, key: str, over: bool,
    stop: str = "",
) -> bool:  # fmt: skip
    """Offer to begin and to stop it; return whether it is at work. `over`: nothing is left to do.

    It begins before its button is drawn, by what is chosen now: so no second run has to tell the
    buttons.
    """
    _watch(work, key)
    if st.session_state.get(key) and not over:
        work.start()
    at_work = work.running
    with st.container(horizontal=True):
        st.button(label, type="primary", key=key, disabled=at_work or over)
        st.button(stop or texts.STOP, key=f"{key}_stop", on_click=work.stop, disabled=not at_work)
    return at_work


def _watch(work: WatchedComparison | DriveRun | LiveDrive, key: str) -> None:
    """Note that this tab watches it, and no more what its buttons were for before.

    That is out of reach: it waits, and ends if nobody comes back to it.
    """
    if (tab := browser.tab()) is None:
        return
    work.watch(*tab)
    before = st.session_state.get(f"{key} watched")
    if before is not None and before is not work:
        before.leave(tab[0])
    st.session_state[f"{key} watched"] = work


def show_progress(running: WatchedComparison) -> None:
    """Say how far it is; while there is no answer yet, wait a little for the first."""
    if not running.running and not running.done:  # nothing was begun
        st.info(texts.COMPARE_EMPTY)
        return
    draw = st.progress
    for _ in range(_STEPS):
        said = texts.COMPARE_PROGRESS.format(done=running.done, total=running.total)
        draw = draw(running.done / running.total, said).progress
        if running.is_answered or not running.running:
            return
        running.wait(_STEP_S)
