"""Bringing a season back: its file where a plot's goes, or one that was taken off the list."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import streamlit as st

from ..state import notices, plot_source, seasons_folder
from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from streamlit.runtime.uploaded_file_manager import UploadedFile

_DROPPED, _REMOVED = "season dropped", "season to bring back"


def hold(parts: Sequence[UploadedFile]) -> bool:
    """Hold what was dropped until it is answered, if it is the file of a season; tell whether."""
    st.session_state.pop(_DROPPED, None)
    if len(parts) != 1 or not seasons_folder.is_of_season(data := parts[0].getvalue()):
        return False
    st.session_state[_DROPPED] = parts[0].name, data
    return True


def show() -> None:
    """Ask whether the file of a season that was dropped shall be one, and offer those removed."""
    if _DROPPED in st.session_state:
        name, _ = st.session_state[_DROPPED]
        with st.container(border=True):
            st.markdown(texts.SEASON_FILE.format(name=texts.isolated(name)))
            st.button(texts.SEASON_TAKE_IN, key="take_in", type="primary", on_click=_take_in)
    removed = seasons_folder.removed()
    if not removed:
        return
    with st.expander(texts.REMOVED_ONES):
        st.selectbox(texts.REMOVED_WHICH, removed, key=_REMOVED)
        st.button(texts.BRING_BACK, key="bring_back", on_click=_bring_back)


@notices.reporting
def _take_in() -> str:
    name, data = st.session_state[_DROPPED]
    kept = seasons_folder.take_in(data, Path(name).stem)
    del st.session_state[_DROPPED]
    return _opened(kept)


@notices.reporting
def _bring_back() -> str:
    return _opened(seasons_folder.bring_back(st.session_state[_REMOVED]))


def _opened(name: str) -> str:
    plot_source.open_season(name)
    return texts.SEASON_BACK.format(name=texts.isolated(name))
