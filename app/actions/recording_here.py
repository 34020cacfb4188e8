"""The plant that was tapped, recorded where it is shown: one press says what was seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections

from ..show import plant_history, recorded_batches
from ..state import notices
from ..words import texts
from ..words.language import place_in_words
from . import contradicting, recording_results, undoing
from .recording import TYPED_IN

if TYPE_CHECKING:
    from fieldmon.monitoring import Batch

    from ..state.choices import Choices

# what was recorded here last: of which season, and when; merging changes numbers of batches
_LAST = "recorded here"


def show(choices: Choices) -> None:
    """Offer to record the plant that was tapped as found or as clean, and to take it back.

    The buttons record what they stood beside: the plant and the day that were shown.
    """
    plants = plant_history.tapped(choices)
    ahead = choices.today is not None and choices.on > choices.today
    if choices.season is None or ahead or not plants:
        return
    st.markdown(texts.HERE.format(**place_in_words(choices.plot.grid, plants[0])))
    with st.container(horizontal=True, key="record_here"):
        for result in (FOUND, CLEAN):
            st.button(texts.HERE_RESULTS[result], key=f"here_{result}", on_click=_record,
                      args=(choices, plants[0], result))  # fmt: skip
        batch = _last(choices)
        if batch is not None:
            st.button(texts.UNDO, key="here_undo", icon=":material/undo:",
                      on_click=undoing.undo, args=(choices, batch))  # fmt: skip
    # the plant shown now may be another one
    if batch and (said := choices.season.contents([batch.number]).get(batch.number)):
        st.caption(recorded_batches.last(choices, said))
    contradicting.ask_about_contradictions(choices)


@notices.reporting
def _record(choices: Choices, plant: int, result: int) -> str:
    results = Inspections.of(np.array([plant]), np.array([result]), np.datetime64(choices.day))
    done = recording_results.recorded(choices, results, TYPED_IN)
    if done is not None and done.batch is not None:
        at = {one.number: one.at for one in choices.open_season.batches()}
        st.session_state[_LAST] = choices.key, at[done.batch]
    return recording_results.said_of(choices, done, results)


def _last(choices: Choices) -> Batch | None:
    """Return the batch that was recorded here last, unless it was taken back."""
    key, at = st.session_state.get(_LAST, ("", None))
    if key != choices.key or at is None:
        return None
    kept = (one for one in choices.open_season.batches() if one.at == at and not one.undone)
    return next(kept, None)
