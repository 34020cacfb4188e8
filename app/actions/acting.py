"""Acting by what is chosen now, not by what was chosen when a button was drawn."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import streamlit as st
from streamlit.runtime.scriptrunner import get_script_run_ctx
from streamlit.runtime.state import SafeSessionState

from ..state import button_presses, notices, plot_source, work_day
from ..state.button_presses import Press
from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ..state.fresh_boxes import FreshBoxes


def at_press(
    label: str, action: Callable[..., object], *arguments: object, key: str,
    boxes: FreshBoxes | None = None, at_once: bool = True,
    button: Callable[..., object] = st.button,
    **settings: Any,  # noqa: ANN401 - those of a button
) -> None:  # fmt: skip
    """Show a button that acts by what is chosen when it is pressed; no press is lost.

    It acts before the page is drawn anew: what is typed a moment after the press breaks that off,
    and a press that only the drawing hears of is lost. Where its boxes were emptied since it was
    drawn, it acts as the page is drawn with those to come, if something was typed for them.

    A press of a page of another day or plot than that chosen does nothing, and the page says so:
    nobody saw yet what it would be done by.

    Parameters
    ----------
    label, key, settings
        As of any button; `button` shows it.
    action, arguments
        What is done. But for the plot and the day the action reads itself what is chosen.
    boxes
        What the action empties, so that a second press does nothing twice.
    at_once
        False: the arguments follow from more than those two, so that it acts as the page is drawn.
    """
    drawn = Press(_chosen(), 0 if boxes is None else boxes.times)
    button(label, key=key, on_click=_press,
           args=(key, label, (boxes, drawn), (action, arguments), at_once), **settings)  # fmt: skip
    press = button_presses.waiting().get(key)
    if press is None:
        return
    with _unbroken(), _until_done(key):
        if press.chosen != drawn.chosen:
            _say_chosen_before(label)
        elif press.times == drawn.times or (boxes is not None and boxes.hold_anything()):
            action(*arguments)
    st.rerun()


def _press(
    key: str, label: str, of: tuple[FreshBoxes | None, Press],
    todo: tuple[Callable[..., object], tuple[object, ...]], at_once: bool,  # noqa: FBT001 - as given
) -> None:  # fmt: skip
    boxes, drawn = of
    action, arguments = todo
    with _unbroken():
        if _chosen() != drawn.chosen:
            # where it was pressed twice it chose another itself
            if not button_presses.is_done(key, drawn):
                _say_chosen_before(label)
            return
        button_presses.waiting()[key] = drawn
        if at_once and (boxes is None or boxes.times == drawn.times):
            with _until_done(key):
                action(*arguments)


def _say_chosen_before(label: str) -> None:
    notices.keep("warning", texts.PRESSED_BEFORE.format(button=label))


def _chosen() -> tuple[object, ...]:
    """Return what says of which plot and day a page is."""
    source = plot_source.chosen()
    return source, work_day.chosen(source)


@contextmanager
def _until_done(key: str) -> Iterator[None]:
    """Keep a press until it is done: to wait for a season's file can be broken off."""
    try:
        yield
    except Exception:  # a run broken off is none
        button_presses.end(key, done=False)
        raise
    button_presses.end(key, done=True)


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
