"""Where the plot comes from: the sample estate, a person's own files, or a season that is kept."""

from __future__ import annotations

import streamlit as st

from . import widget_memory

#: names the box that says it; also the word in the address
KEY = "season"
#: what the box holds beside the names of seasons, and the address, whatever the language
SAMPLE, FILES = "Sample estate", "My own files"
_OPENS = "season to open"


def begin_from_address() -> None:
    """Let the box begin with what the address says: a season's name leads back to the season."""
    widget_memory.first(KEY, st.query_params.get(KEY))
    if _OPENS in st.session_state:
        st.session_state[KEY] = st.session_state.pop(_OPENS)


def chosen() -> str:
    """Return `SAMPLE`, `FILES` or the name of a season."""
    source: str = widget_memory.value(KEY, SAMPLE)
    return source


def keep_in_address(source: str) -> None:
    """Let the address lead back to a source after a reload, and to another person's screen."""
    if source == SAMPLE:
        st.query_params.pop(KEY, None)
    elif st.query_params.get(KEY) != source:
        st.query_params[KEY] = source


def open_season(name: str) -> None:
    """Let the season of this name be open from the next run on."""
    st.session_state[_OPENS] = name


def feature_key(file_key: str) -> str:
    """Return the key of the box that says which plot of a file is open."""
    return f"feature {file_key}"


def choose_feature(file_key: str, number: int) -> None:
    """Let this plot of a file be open from the next run on (for callbacks)."""
    st.session_state[feature_key(file_key)] = number
