"""What stands where the map would be while there is none: that something is wrong, and what next.

What is wrong stands in the panel, beside what can be changed there.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import ChoiceNeeded

from ..show import field_map
from ..state import brought_files, plot_source
from ..state.brought_files import BLOCKS, PLANTS, PLOT, RECORDS, ROWS
from ..words import texts
from . import editing_plot

if TYPE_CHECKING:
    from fieldmon.errors import FieldmonError

_KINDS = (PLOT, RECORDS, PLANTS, ROWS, BLOCKS)


def want(problem: FieldmonError | None) -> None:
    """Want this in the map's place, unless a map is wanted there."""
    if field_map.wanted() is None:
        field_map.want_instead(partial(show, problem))


def show(problem: FieldmonError | None) -> None:
    """Say that there is no map, and offer what to do about it."""
    case, file = _case(problem)
    with st.container(key="no_map"):
        st.markdown(f"### {texts.NO_MAP[case]}")
        if case in texts.NO_MAP_DO:
            st.caption(texts.NO_MAP_DO[case])
        if case == "file" and file:
            st.button(_take_out(brought_files.brought()[file]), key="no_map_take_out",
                      on_click=brought_files.take_out, args=(file,))  # fmt: skip
        elif case == "season":
            # a press runs the page again, and that is trying again
            st.button(texts.TRY_AGAIN, key="no_map_again", type="primary")


def _take_out(file: brought_files.File) -> str:
    name = texts.isolated(file.name)
    if file.files == 1:
        return texts.NO_MAP_TAKE_OUT.format(name=name)
    return texts.NO_MAP_TAKE_OUT_ALL.format(name=name, n=file.files - 1)


def _case(problem: FieldmonError | None) -> tuple[str, str]:
    """Return which words are said, and the kind of the file that they are about."""
    if problem is None:
        return "bring", ""
    if isinstance(problem, ChoiceNeeded):
        return "asked", ""
    if plot_source.chosen() not in (plot_source.FILES, plot_source.SAMPLE):
        return "season", ""
    brought, asking = brought_files.brought(), brought_files.asking()
    file = next((k for k in _KINDS if k in brought and brought[k].asked == asking), "")
    return ("plot" if editing_plot.is_within_reach(problem) else "file"), file
