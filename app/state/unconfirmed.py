"""Results that contradict what is recorded: they wait until somebody confirms them or not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import streamlit as st

if TYPE_CHECKING:
    from fieldmon.infestation.inspections import Inspections

_KEY = "unconfirmed results"


@dataclass(frozen=True, eq=False)
class Unconfirmed:
    """Results that wait for a word: of which season, from where, and in which form (or none)."""

    season: str
    results: Inspections
    source: str
    form: str = ""


def keep(waiting: Unconfirmed) -> None:
    """Let results wait; those that waited before are dropped."""
    st.session_state[_KEY] = waiting


def of(season: str) -> Unconfirmed | None:
    """Return what waits for a word on a season, by its key."""
    waiting: Unconfirmed | None = st.session_state.get(_KEY)
    return waiting if waiting is not None and waiting.season == season else None


def drop() -> None:
    """Let nothing wait any more."""
    st.session_state.pop(_KEY, None)
