"""What a visitor's browser says of itself: a phone or not, dark or light, and what time it is."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import streamlit as st


def is_phone() -> bool:
    """Return whether the page is shown on a phone, by what its browser says."""
    return "Mobi" in (st.context.headers.get("User-Agent") or "")


def is_dark() -> bool:
    """Return whether the page is dark."""
    return st.context.theme.get("type") == "dark"


def local(at: datetime) -> datetime:
    """Return a moment in the time of the person's browser, without a zone."""
    minutes = st.context.timezone_offset
    if minutes is None:
        return at.astimezone().replace(tzinfo=None)
    return at.astimezone(UTC).replace(tzinfo=None) - timedelta(minutes=minutes)


def now() -> datetime:
    """Return the local time where the person stands, to the second."""
    return local(datetime.now(UTC)).replace(microsecond=0)
