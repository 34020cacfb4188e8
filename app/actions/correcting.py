"""Correcting when an inspection was made: its day, its time, or both."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import SettingError

from ..show import plant_history
from ..state import notices
from ..state.fresh_boxes import FreshBoxes
from ..words import texts
from . import acting

if TYPE_CHECKING:
    from fieldmon.monitoring.numbered_inspections import NumberedInspection

    from ..state.choices import Choices

_WHEN = "when"


def show(choices: Choices, plant: int | None) -> None:
    """Offer to correct the day or time of an inspection of a plant, if it has any.

    None: no plant is meant yet.
    """
    if plant is None:
        return
    made = choices.open_season.inspections_of(plant)
    if not made:
        return
    boxes = FreshBoxes(_WHEN, choices)
    with st.expander(texts.CORRECT_WHEN):
        st.caption(texts.CORRECT_WHEN_NOTE)
        said = {one.number: _said(choices, one) for one in made}
        st.selectbox(texts.CORRECT_WHICH, list(said), len(said) - 1, said.__getitem__,
                     key=_which(choices, plant))  # fmt: skip
        day, at = st.columns(2)
        boxes.show(day.date_input, texts.CORRECT_DAY, box="when_day")
        boxes.show(at.time_input, texts.CORRECT_TIME, box="when_time")
        acting.at_press(texts.CORRECT_BUTTON, _correct, choices, plant, key="correct_when",
                        boxes=boxes)  # fmt: skip


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
    boxes = FreshBoxes(_WHEN, choices)
    day, at = map(boxes.said, ("when_day", "when_time"))
    if day is None and at is None:
        raise SettingError(texts.CORRECT_UNSAID)
    number = st.session_state[_which(choices, plant)]
    # what contradicts is shown with the day
    choices.open_season.correct_time(number, at, choices.who or "", day, confirmed=True)
    boxes.empty()
    return texts.CORRECTED.format(n=1)
