"""Correcting when an inspection was made: its day, its time, or both."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import streamlit as st

from fieldmon.errors import SettingError

from ..show import plant_history
from ..state import notices, unconfirmed
from ..state.fresh_boxes import FreshBoxes
from ..words import texts
from . import acting

if TYPE_CHECKING:
    from datetime import date, time

    from fieldmon.monitoring.inspecting.numbered_inspections import NumberedInspection

    from ..state.choices import Choices

_WHEN = "when"


class _Inspection(NamedTuple):
    """One that may be corrected. What is said of it is part of it: corrected, it is shown anew."""

    number: int
    said: str


def show(choices: Choices, plant: int | None) -> None:
    """Offer to correct the day or time of an inspection of a plant, if it has any.

    None: no plant is meant yet.
    """
    if plant is None:
        return
    made = choices.open_season.numbered(plant=plant)
    if not made:
        return
    boxes = FreshBoxes(_WHEN, choices)
    with st.expander(texts.CORRECT_WHEN):
        st.caption(texts.CORRECT_WHEN_NOTE)
        which = [_Inspection(one.number, _said(choices, one)) for one in made]
        numbers, key = [one.number for one in which], _which(choices, plant)
        before: _Inspection = st.session_state.get(key, which[-1])
        at_first = numbers.index(before.number) if before.number in numbers else len(which) - 1
        st.selectbox(texts.CORRECT_WHICH, which, at_first, lambda one: one.said, key=key)
        day, at = st.columns(2)
        boxes.show(day.date_input, texts.CORRECT_DAY, box="when_day")
        boxes.show(at.time_input, texts.CORRECT_TIME, box="when_time")
        acting.at_press(texts.CORRECT_BUTTON, _correct, choices, plant, key="correct_when",
                        boxes=boxes)  # fmt: skip
        if unconfirmed.refused(_told(choices, plant)):
            acting.at_press(texts.CORRECT_BOTH, _correct_both, choices, plant, key="correct_both",
                            boxes=boxes)  # fmt: skip


def _told(choices: Choices, plant: int) -> tuple[str, int, date | None, time | None]:
    """Return of which season and inspection what is to be corrected to."""
    said = FreshBoxes(_WHEN, choices).said
    which: _Inspection = st.session_state[_which(choices, plant)]
    return choices.key, which.number, said("when_day"), said("when_time")


def _which(choices: Choices, plant: int) -> str:
    """Return the key of the box that says which inspection is meant."""
    return f"when_which {plant} {choices.key}"


def _said(choices: Choices, one: NumberedInspection) -> str:
    """Return an inspection in words, and whose it is."""
    result = texts.HISTORY_RESULTS[one.result]
    line = plant_history.line_of(choices, one.on, one.second, result)
    return f"{line} · {texts.isolated(one.who)}" if one.who else line


@notices.reporting
def _correct(choices: Choices, plant: int) -> str:
    return _taken(choices, plant, confirmed=False)


@notices.reporting
def _correct_both(choices: Choices, plant: int) -> str:
    """Correct it though it contradicts what else is recorded."""
    return _taken(choices, plant, confirmed=True)


def _taken(choices: Choices, plant: int, *, confirmed: bool) -> str:
    _, number, day, at = told = _told(choices, plant)
    if day is None and at is None:
        raise SettingError(texts.CORRECT_UNSAID)
    with unconfirmed.of_corrections(told):
        choices.open_season.correct_time(number, at, "", day, confirmed=confirmed)
    FreshBoxes(_WHEN, choices).empty()
    return texts.CORRECTED.format(n=1)
