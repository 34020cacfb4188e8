"""The day that the pages are about: today on the plot, or another one chosen on purpose."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from datetime import date

import streamlit as st

from . import fresh_boxes, plot_source

#: the word in the address that leads back to a day chosen on purpose
KEY = "day"
#: the key of the box that shows the day of a source
BOX = "day {source}"
_CHOSEN, _READ = "days chosen", "day read from address"
_WRITTEN, _ITEM = "day in address", "item of that day"


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


def take_from_address(source: str, item: str) -> None:
    """Show the day that the address of an item names where it was gone back to.

    An address without a day means today, unless it was cleared by a turn to another item. What was
    chosen just now comes first.
    """
    turned = item != st.session_state.get(_ITEM)
    st.session_state[_ITEM] = item
    said, written = st.query_params.get(KEY, ""), st.session_state.get(_WRITTEN)
    now = str(_chosen().get(source, ""))
    if written != (source, now) or said == now:
        return
    named = plot_source.is_in_address(source, cleared=turned)
    if said:
        with suppress(ValueError):
            choose(source, date.fromisoformat(said))
    elif named:
        back_to_today(source)


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


def keep_in_address(source: str, day: date, today: date) -> None:
    """Let a reload lead back to a day of a source that is not today."""
    st.session_state[_WRITTEN] = source, "" if day == today else str(day)
    if day == today:
        st.query_params.pop(KEY, None)
    elif st.query_params.get(KEY) != str(day):
        st.query_params[KEY] = str(day)


def _chosen() -> dict[str, date]:
    chosen: dict[str, date] = st.session_state.setdefault(_CHOSEN, {})
    return chosen
