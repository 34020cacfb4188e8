"""What was recorded, batch by batch, taken back and counting again."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import SettingError

from ..show import recorded_batches
from ..state import notices
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.monitoring.inspecting.batches import Batch, BatchContents

    from ..state.choices import Choices

# batches shown, the last ones, and so many more at each press
_MOST = 20
_UNDO_ASKED, _SHOWN = "undo asked", "batches shown"


def show_batches(choices: Choices) -> None:
    """Show what was recorded, if anything was, the last one first, each with its undo."""
    kept = [batch for batch in choices.open_season.batches() if batch.rows]
    if not kept:
        return
    shown = kept[: _MOST + _more_shown(choices)]
    contents = choices.open_season.contents([batch.number for batch in shown])
    with st.expander(texts.BATCHES, expanded=True):
        for batch in shown:
            _show_batch(choices, batch, contents.get(batch.number))
        if more := len(kept) - len(shown):
            st.button(texts.BATCHES_MORE.format(n=min(more, _MOST)), key="batches_more",
                      on_click=_show_more, args=(choices,))  # fmt: skip


def _more_shown(choices: Choices) -> int:
    """Return how many batches are shown beside the last ones."""
    key, more = st.session_state.get(_SHOWN, ("", 0))
    return more if key == choices.key else 0


def _show_more(choices: Choices) -> None:
    st.session_state[_SHOWN] = choices.key, _more_shown(choices) + _MOST


def _show_batch(choices: Choices, batch: Batch, contents: BatchContents | None) -> None:
    said = recorded_batches.line(choices, batch, contents)
    why = recorded_batches.why_to_ask(choices, batch, contents)
    n, asked = batch.number, _undo_asked(choices) == _known_by(batch) and not batch.undone
    # side by side, not in columns: a button takes what its word needs in each language
    with st.container(horizontal=True, vertical_alignment="center", key=f"batch_{n}"):
        st.markdown(said, width="stretch")
        if batch.undone:
            st.button(texts.REDO, key=f"redo {n}", on_click=redo, help=said, args=(choices, batch))
        elif not asked:
            act = _ask_undo if why else undo
            st.button(texts.UNDO, key=f"undo {n}", on_click=act, help=said, args=(choices, batch))
    if asked:
        st.warning(" ".join([texts.UNDO_ASK, *why]))
        with st.container(horizontal=True, key=f"undo_asked_{n}"):
            st.button(texts.UNDO_YES, key=f"undo_yes {n}", on_click=undo, args=(choices, batch))
            st.button(texts.UNDO_NO, key=f"undo_no {n}", on_click=_ask_no_undo)


def _known_by(batch: Batch) -> tuple[str, ...]:
    """Return what a batch is known by: its number is another one once a copy was merged."""
    return batch.at, batch.kind, batch.source, batch.who


def _undo_asked(choices: Choices) -> tuple[str, ...] | None:
    """Return what the batch is known by of which it is asked whether it is to be undone."""
    key, batch = st.session_state.get(_UNDO_ASKED, ("", None))
    return batch if key == choices.key else None


def _ask_undo(choices: Choices, batch: Batch) -> None:
    st.session_state[_UNDO_ASKED] = choices.key, _known_by(batch)


def _ask_no_undo() -> None:
    st.session_state.pop(_UNDO_ASKED, None)


@notices.reporting
def undo(choices: Choices, batch: Batch, who: str = "") -> str:
    """Take a batch back, unless somebody did so in another window; `who` does, for the log."""
    _ask_no_undo()
    number = _number_now(choices, batch, undone=False)
    if number is None:
        raise SettingError(texts.UNDONE_BEFORE)
    return recorded_batches.undone(choices.open_season.undo(number, who=who))


@notices.reporting
def redo(choices: Choices, batch: Batch) -> str:
    """Let a batch that was undone count again, unless somebody did so in another window."""
    number = _number_now(choices, batch, undone=True)
    if number is None:
        raise SettingError(texts.REDONE_BEFORE)
    return recorded_batches.counts_again(choices.open_season.redo(number))


def _number_now(choices: Choices, batch: Batch, *, undone: bool) -> int | None:
    """Return the number that a batch has by now, if it is still `undone` or not; else None."""
    now = (one for one in choices.open_season.batches() if _known_by(one) == _known_by(batch))
    return next((one.number for one in now if one.undone == undone), None)
