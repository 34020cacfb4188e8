"""The language of a session: the one chosen in its box, that of the address, or the browser's."""

from __future__ import annotations

import streamlit as st
from streamlit.runtime.scriptrunner import get_script_run_ctx

from ..words import language
from ..words.units import usual
from . import browser, chosen_units, unit_boxes, widget_memory

#: names the box; also the word in the address
KEY = "lang"


def begin() -> None:
    """Speak the session's language from here on: what the address says, until one is chosen."""
    language.ask(chosen)
    said = st.query_params.get(KEY)
    widget_memory.first(KEY, said if language.is_spoken(said) else None)
    language.use(chosen())


def chosen() -> str:
    """Return the session's language; English where there is no session."""
    if get_script_run_ctx(suppress_warning=True) is None:
        return language.ENGLISH
    said = widget_memory.value(KEY)
    return str(said) if language.is_spoken(said) else browser.language()


def keep_in_address(code: str) -> None:
    """Let a reload, and another person's screen, speak a language that is not the browser's."""
    if code == browser.language():
        st.query_params.pop(KEY, None)
    elif st.query_params.get(KEY) != code:
        st.query_params[KEY] = code


def carry_over(before: str) -> None:
    """Write dates and areas as is usual in the language now chosen, unless that was changed."""
    now, units_before = chosen(), chosen_units.units(before)
    language.use(now)
    for name in chosen_units.KEYS:
        was, new = getattr(usual(before), name), getattr(usual(now), name)
        if was != new and widget_memory.value(name) == was:
            widget_memory.put(name, new)
    unit_boxes.carry_over(units_before)
