"""The day that the pages are about: today on the plot, or another one chosen on purpose."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from datetime import date

import streamlit as st

from . import fresh_boxes

#: the word in the address that leads back to a day chosen on purpose
KEY = "day"
#: the key of the box that shows the day of a source
BOX = "day {source}"
_CHOSEN, _READ = "days chosen", "day read from address"


@dataclass(frozen=True)
class Calendar:
    """What days a source has: its today, and the days between which one may choose."""

    today: date
    first: date | None = None
    last: date | None = None

    def within(self, day: date) -> date:
        """Return a day, or the nearest that one may choose."""
        day = day if self.first is None else max(day, self.first)
        return day if self.last is None else min(day, self.last)


def begin_from_address(source: str) -> None:
    """Let a source begin on the day that the address names, once a session."""
    if st.session_state.setdefault(_READ, False):
        return
    st.session_state[_READ] = True
    with suppress(ValueError):
        choose(source, date.fromisoformat(st.query_params.get(KEY, "")))


def of(source: str, calendar: Calendar) -> date:
    """Return the day of a source: that chosen on purpose, else today."""
    return calendar.within(_chosen().get(source, calendar.today))


def choose(source: str, day: date) -> None:
    """Choose a day on purpose; it counts until another is chosen, or today is."""
    fresh_boxes.hold()
    _chosen()[source] = day


def chosen(source: str) -> tuple[object, ...]:
    """Return the day chosen for a source on purpose, and what its box shows now."""
    return _chosen().get(source), st.session_state.get(BOX.format(source=source))


def back_to_today(source: str) -> None:
    """Let today count again."""
    fresh_boxes.hold()
    _chosen().pop(source, None)


def keep_in_address(day: date, today: date) -> None:
    """Let a reload lead back to a day that is not today."""
    if day == today:
        st.query_params.pop(KEY, None)
    elif st.query_params.get(KEY) != str(day):
        st.query_params[KEY] = str(day)


def _chosen() -> dict[str, date]:
    chosen: dict[str, date] = st.session_state.setdefault(_CHOSEN, {})
    return chosen
