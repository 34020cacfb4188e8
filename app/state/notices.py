"""Sentences that an action leaves for the next run of the page, which shows them above it."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError, SettingError

from ..words import texts
from ..words.language import of_error
from . import opened_seasons, season_held, seasons_folder

if TYPE_CHECKING:
    from collections.abc import Callable

_KEY, _WARNS, _UNKEPT = "notice", "notice warns", "season gone unkept"


def keep(kind: str, sentence: str) -> None:
    """Keep a sentence for the next run: ``"success"``, ``"warning"`` or ``"error"``."""
    st.session_state[_KEY] = (kind, sentence)


def show() -> None:
    """Show what was kept, once."""
    kind, sentence = st.session_state.pop(_KEY, (None, ""))
    if kind is not None:
        with st.container(key="notice", horizontal=True, vertical_alignment="top"):
            getattr(st, kind)(sentence, width="stretch")
            # what it covers is seen again; the next run shows it no more anyway
            st.button(texts.NOTICE_CLOSE, key="notice_close", type="tertiary",
                      icon=":material/close:")  # fmt: skip


def warn() -> None:
    """Let what the action under way returns be no success: some of it was not done."""
    st.session_state[_WARNS] = True


def gone(season: str) -> str:
    """Return that a season is not there, its new name, and whether what was done was not kept.

    It says so until a season is found again.
    """
    is_unkept, name = st.session_state.get(_UNKEPT) == season, texts.isolated(season)
    new = None
    with suppress(SettingError):  # an address may name what is no name
        new = opened_seasons.called_now(seasons_folder.path_of(season))
    if new is not None:
        said = texts.SEASON_RENAMED_UNKEPT if is_unkept else texts.SEASON_RENAMED
        return said.format(name=name, new=texts.isolated(new))
    said = texts.SEASON_GONE_UNKEPT if is_unkept else texts.SEASON_GONE
    return said.format(name=name)


def found() -> None:
    """Say no more that something was not kept: a season that is there is shown."""
    st.session_state.pop(_UNKEPT, None)


def reporting(action: Callable[..., str]) -> Callable[..., None]:
    """Return a callback that keeps the sentence its action returns, or the problem it meets.

    An empty sentence is nothing to say. An action on a season waits here for whoever writes it, for
    the page to say so: the action itself would wait as long without a word. Nobody is kept out
    meanwhile, and readers are not waited for. Where the season is gone, the page says so in its
    place, see `gone`.
    """

    def callback(*arguments: object) -> None:
        season = getattr(arguments[0], "season", None) if arguments else None
        try:
            if season is not None:  # what is done may be kept in it
                season_held.wait(season.path, to_write=True)
            sentence = action(*arguments)
        except FieldmonError as error:
            if season is not None and not season.path.is_file():
                st.session_state[_UNKEPT] = season.path.stem
            else:
                keep("error", of_error(error))
        else:
            if sentence:
                keep("warning" if st.session_state.get(_WARNS) else "success", sentence)
        finally:
            st.session_state.pop(_WARNS, None)

    return callback
