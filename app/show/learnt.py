"""What the inspections of a season tell of the insects: how far they jump, how many arrive."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.infestation.learnt import worth_saying
from fieldmon.monitoring.estimates.what_was_told import earlier_season_note

from ..state import chosen_day
from ..words import texts
from ..words.language import in_words

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.compute.wording import Worded

    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show each estimate with its interval, or that finds are traced to neighbours only.

    And with which inspections another detection was said than the season's own.
    """
    st.markdown(f"**{texts.LEARNT_TITLE}**")
    estimates, said = chosen_day.learnt(choices), chosen_day.other_detections(choices)
    if not estimates:
        st.caption(texts.NOT_LEARNT)
        _list(one.sentence() for one in said)
        return
    taught = earlier_season_note(choices.open_season)
    notes = [] if taught is None else [in_words(taught)]
    if not chosen_day.progress(choices).inspected:
        notes.append(texts.LEARNT_AT_FIRST)
        if len(records := chosen_day.records_known(choices)):
            notes.append(in_words(records.sentence(choices.units.in_sentences(choices.on))))
    notes += [texts.LEARNT_COUNTS_FOR, texts.LEARNT_INTERVALS]
    st.caption(" ".join(notes))
    worth = (one.sentence() for one in worth_saying(estimates))
    _list([*worth, *(one.sentence() for one in said)])


def _list(sentences: Iterable[Worded]) -> None:
    if lines := [f"- {in_words(one)}" for one in sentences]:
        st.markdown("\n".join(lines))
