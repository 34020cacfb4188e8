"""Sentences that an action leaves for the next run of the page, which shows them above it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError

from ..words.language import of_error
from . import held

if TYPE_CHECKING:
    from collections.abc import Callable

_KEY = "notice"


def keep(kind: str, sentence: str) -> None:
    """Keep a sentence for the next run: ``"success"`` or ``"error"``."""
    st.session_state[_KEY] = (kind, sentence)


def show() -> None:
    """Show what was kept, once."""
    kind, sentence = st.session_state.pop(_KEY, (None, ""))
    if kind is not None:
        getattr(st, kind)(sentence)


def reporting(action: Callable[..., str]) -> Callable[..., None]:
    """Return a callback that keeps the sentence its action returns, or the problem it meets.

    An empty sentence is nothing to say. An action on a season waits here for whoever writes it, for
    the page to say so: the action itself would wait as long without a word. Nobody is kept out
    meanwhile, and readers are not waited for.
    """

    def callback(*arguments: object) -> None:
        season = getattr(arguments[0], "season", None) if arguments else None
        try:
            if season is not None:  # what is done may be kept in it
                held.wait(season.path, to_write=True)
            sentence = action(*arguments)
        except FieldmonError as error:
            keep("error", of_error(error))
        else:
            if sentence:
                keep("success", sentence)

    return callback
