"""Three ways in, as pictures: the sample, one's own file, a season that is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..state import menu, plot_source, seasons_folder
from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Callable

_CHOSEN = "way chosen"


def is_first_run() -> bool:
    """Return whether nobody has said yet what to open: not here, nor in the address."""
    return _CHOSEN not in st.session_state and plot_source.chosen() == plot_source.SAMPLE


def show() -> None:
    """Show them side by side."""
    ways: dict[str, Callable[[], None]] = {
        "sample": _sample, "file": _file, "season": _season
    }  # fmt: skip
    with st.container(key="ways", horizontal=True, gap="small"):
        for name, begin in ways.items():
            st.button(texts.WAYS_IN[name], key=f"way_{name}", width="stretch", on_click=begin)
    if st.session_state.pop("ask for a season", False):
        st.dialog(texts.WAYS_IN["season"])(_say_where)()


def _sample() -> None:
    _choose(plot_source.SAMPLE)


def _file() -> None:
    _choose(plot_source.FILES)


def _season() -> None:
    """Open the season that there is; of several, show all of them."""
    names = seasons_folder.names()
    if not names:
        st.session_state["ask for a season"] = True
    elif len(names) == 1:
        _choose(names[0])
    else:
        st.session_state[_CHOSEN] = True
        menu.turn_to("plots")


def _choose(source: str) -> None:
    """Open it at the day's plan, whatever page of the menu was shown before."""
    st.session_state[_CHOSEN] = True
    plot_source.open_season(source)
    menu.turn_to_page("today")


def _say_where() -> None:
    """Say where seasons lie and how one begins."""
    st.markdown(texts.NO_SEASONS.format(folder=seasons_folder.folder()))
