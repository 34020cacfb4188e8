"""Where a phone finds the app and the day's work: the one place that says it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from ipaddress import ip_address
from urllib.parse import urlencode, urlsplit

import streamlit as st

from . import kept_files, plot_source, scout_page, work_day


@dataclass(frozen=True)
class PhoneAddress:
    """An address for a phone, and whether one can reach it: this machine's own name is its own."""

    url: str
    reachable: bool

    @property
    def works_offline(self) -> bool:
        """Return whether phones give it their position, and keep it without a network."""
        return self.reachable and self.url.startswith("https://")


def base() -> PhoneAddress:
    """Return where phones find the app: as it was started for them, else as it is seen here."""
    told = os.environ.get(scout_page.ADDRESS)
    if told:
        return PhoneAddress(told, True)
    here = urlsplit(st.context.url or "")
    if not here.netloc:
        port = os.environ.get("STREAMLIT_SERVER_PORT", "8501")
        return PhoneAddress(f"http://127.0.0.1:{port}", False)
    return PhoneAddress(f"{here.scheme}://{here.netloc}", _is_reachable(here.hostname or ""))


def address() -> PhoneAddress:
    """Return where a phone finds the plan that is open here, of a plot without a season."""
    words = {
        word: st.query_params[word]
        for word in (plot_source.KEY, kept_files.KEY, work_day.KEY)
        if word in st.query_params
    }
    asked = f"?{urlencode(words)}" if words else ""
    at = base()
    return PhoneAddress(f"{at.url}/{asked}", at.reachable)


def _is_reachable(host: str) -> bool:
    """Return whether a name can lead another machine here."""
    if host in {"", "localhost"}:
        return False
    try:
        return not ip_address(host).is_loopback
    except ValueError:
        return True
