"""Results that contradict what is recorded: they wait until somebody confirms them or not."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import streamlit as st

from fieldmon.errors import ContradictionError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.import_report import ImportMessage

_KEY, _CORRECTIONS = "unconfirmed results", "unconfirmed corrections"
_LOST = "unconfirmed results of before a reload"


@dataclass(frozen=True, eq=False)
class Unconfirmed:
    """Results that wait for a word: of which season, from where, and in which form (or none).

    And the day (ISO) on which they were brought: nobody is asked on another. And what was said of
    their file, as of lines that were left out. And who inspected, where they do not say.
    """

    season: str
    day: str
    results: Inspections
    source: str
    form: str = ""
    messages: tuple[ImportMessage, ...] = ()
    who: str = ""


def keep(waiting: Unconfirmed) -> None:
    """Let results wait; those that waited before are dropped."""
    st.session_state.pop(_LOST, None)
    st.session_state[_KEY] = waiting


def of(season: str, day: str) -> Unconfirmed | None:
    """Return what waits for a word on a day (ISO) of a season, by its key."""
    waiting: Unconfirmed | None = st.session_state.get(_KEY)
    asked = waiting is not None and (waiting.season, waiting.day) == (season, day)
    return waiting if asked else None


def drop() -> None:
    """Let nothing wait any more."""
    st.session_state.pop(_KEY, None)
    st.session_state.pop(_LOST, None)


def said() -> dict[str, Any]:
    """Return of what waits the season, the day, the source and how many, as JSON can hold it."""
    waiting: Unconfirmed | None = st.session_state.get(_KEY)
    if waiting is None:
        return dict(st.session_state.get(_LOST, {}))
    season, day, source = waiting.season, waiting.day, waiting.source
    return {"season": season, "day": day, "source": source, "n": len(waiting.results)}


def take(said: dict[str, Any]) -> None:
    """Keep in mind what waited before a reload, as `said` returned it: it was not recorded."""
    if said:
        st.session_state[_LOST] = said


def lost(season: str, day: str) -> tuple[int, str] | None:
    """Return how many results waited on this day of a season before a reload, and from where."""
    was = st.session_state.get(_LOST, {})
    return (
        (was["n"], was["source"]) if (was.get("season"), was.get("day")) == (season, day) else None
    )


def refused(corrections: tuple[object, ...]) -> bool:
    """Return whether these corrections, and none since, were refused as they contradict results."""
    return bool(st.session_state.get(_CORRECTIONS) == corrections)


@contextmanager
def of_corrections(corrections: tuple[object, ...]) -> Iterator[None]:
    """Keep in mind, while they are taken, which corrections are refused as they contradict."""
    st.session_state.pop(_CORRECTIONS, None)
    try:
        yield
    except ContradictionError:
        st.session_state[_CORRECTIONS] = corrections
        raise
