"""What a visitor's browser says of itself: dark or light, its language, whether it is there."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st
from streamlit import runtime
from streamlit.runtime.scriptrunner import get_script_run_ctx

from ..words.language import ENGLISH, LANGUAGES

if TYPE_CHECKING:
    from collections.abc import Callable


def is_dark() -> bool:
    """Return whether the page is dark."""
    return st.context.theme.get("type") == "dark"


def language() -> str:
    """Return the first language that the browser asks for, if the app speaks it, else English."""
    said = st.context.locale or (st.context.headers.get("Accept-Language") or "").split(",")[0]
    # what Java called Hebrew once
    code = said.split(";")[0].split("-")[0].strip().lower().replace("iw", "he")
    return code if code in LANGUAGES else ENGLISH


def zone() -> str:
    """Return the time zone of the browser's device; empty where it says none."""
    return st.context.timezone or ""


def is_phone() -> bool:
    """Return whether it is a phone's browser."""
    return "Mobi" in (st.context.headers.get("User-Agent") or "")


def tab() -> tuple[str, Callable[[], bool]] | None:
    """Return the name of this tab, and what tells in any thread whether it is connected.

    None: the page is in no browser.
    """
    context = get_script_run_ctx(suppress_warning=True)
    if context is None or not runtime.exists():
        return None
    return context.session_id, partial(runtime.get_instance().is_active_session, context.session_id)
