"""What a visitor's browser says of itself: a phone or not, dark or light."""

from __future__ import annotations

import streamlit as st


def is_phone() -> bool:
    """Return whether the page is shown on a phone, by what its browser says."""
    return "Mobi" in (st.context.headers.get("User-Agent") or "")


def is_dark() -> bool:
    """Return whether the page is dark."""
    return st.context.theme.get("type") == "dark"
