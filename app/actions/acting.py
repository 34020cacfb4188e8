"""Acting by what is chosen now, not by what was chosen when a button was drawn."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import streamlit as st
from streamlit.runtime.scriptrunner import get_script_run_ctx
from streamlit.runtime.state import SafeSessionState

from ..state import plot_source, presses, widget_memory, work_day
from ..state.choices import WHOSE_DAY

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ..state.fresh_boxes import FreshBoxes


def once(pressed: bool, action: Callable[..., object], *arguments: object) -> None:  # noqa: FBT001 - what a button returns
    """Act if a button was pressed, and draw the page anew.

    A button's `on_click` holds the values of the run that drew it. Where a box was changed a moment
    before the press, those are the earlier ones: a season began with other hours than were shown.
    """
    if pressed:
        action(*arguments)
        st.rerun()


def at_press(
    boxes: FreshBoxes, label: str, action: Callable[..., object], *arguments: object, key: str,
    **settings: Any,  # noqa: ANN401 - those of a button
) -> None:  # fmt: skip
    """Show a button that acts by what is in its boxes when it is pressed; no press is lost.

    The action reads the boxes itself. It is done before the page is drawn anew: what is typed a
    moment after the press breaks that off, and a press that only the drawing hears of is lost.

    Where another day or plot was chosen since the button was drawn, it is done as the page is drawn
    with that; so it is where the boxes were emptied, if something was typed for those to come.
    """
    drawn = _chosen(), boxes.times
    st.button(label, key=key, on_click=_press,
              args=(key, (boxes, drawn), (action, arguments)), **settings)  # fmt: skip
    if key in presses.waiting():
        with _unbroken(), _until_done(key):
            if not presses.waiting()[key] or boxes.hold_anything():
                action(*arguments)
        st.rerun()


def _press(
    key: str, of: tuple[FreshBoxes, tuple[object, int]],
    todo: tuple[Callable[..., object], tuple[object, ...]],
) -> None:  # fmt: skip
    boxes, (chosen, times) = of
    action, arguments = todo
    with _unbroken():
        is_emptied = boxes.times != times
        presses.waiting()[key] = is_emptied
        if not is_emptied and _chosen() == chosen:
            with _until_done(key):
                action(*arguments)


def _chosen() -> tuple[object, ...]:
    """Return what says of which plot, day and person a page is."""
    source = plot_source.chosen()
    return source, work_day.chosen(source), widget_memory.value(WHOSE_DAY)


@contextmanager
def _until_done(key: str) -> Iterator[None]:
    """Keep a press until it is done: to wait for a season's file can be broken off."""
    waiting = presses.waiting()
    try:
        yield
    except Exception:  # a run broken off is none
        waiting.pop(key, None)
        raise
    waiting.pop(key, None)


@contextmanager
def _unbroken() -> Iterator[None]:
    """Let nothing that is typed meanwhile break off what is done: half of it would be done.

    Streamlit breaks a run off wherever it reads or writes its state.
    """
    context = get_script_run_ctx()
    state = None if context is None else context.session_state
    if context is None or not isinstance(state, SafeSessionState):
        yield
        return
    context.session_state = SafeSessionState(state._state, lambda: None)  # noqa: SLF001 - no other way
    try:
        yield
    finally:
        context.session_state = state
