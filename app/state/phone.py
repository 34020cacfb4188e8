"""Where a phone finds the day's work: the one place that says it."""

from __future__ import annotations

from dataclasses import dataclass
from ipaddress import ip_address
from typing import TYPE_CHECKING
from urllib.parse import urlencode, urlsplit

import streamlit as st

from . import kept_files, plot_source, rooms, work_day

if TYPE_CHECKING:
    from .choices import Choices


@dataclass(frozen=True)
class PhoneAddress:
    """An address for a phone, and whether one can reach it: this machine's own name is its own."""

    url: str
    reachable: bool


def address(choices: Choices) -> PhoneAddress:
    """Return where a phone finds the chosen day: the next plant of a season, else the plan."""
    here = urlsplit(st.context.url or "")
    words = {
        word: st.query_params[word]
        for word in (plot_source.KEY, kept_files.KEY, work_day.KEY)
        if word in st.query_params
    }
    if choices.season is not None:
        words[rooms.KEY] = "scout"
    asked = f"?{urlencode(words)}" if words else ""
    return PhoneAddress(
        f"{here.scheme}://{here.netloc}/{asked}", _is_reachable(here.hostname or "")
    )


def _is_reachable(host: str) -> bool:
    """Return whether a name can lead another machine here."""
    if host in {"", "localhost"}:
        return False
    try:
        return not ip_address(host).is_loopback
    except ValueError:
        return True
