"""What a visitor's browser says of itself: dark or light, its language."""

from __future__ import annotations

import streamlit as st

from ..words.language import ENGLISH, LANGUAGES


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
