"""Asking for photos of plants that were picked or tapped on the map, until they have come."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.monitoring.phones import photos_asked

from ..show import plant_history
from ..state import notices, wishes
from ..state.folds import fold
from ..words import texts
from ..words.language import place_in_words

if TYPE_CHECKING:
    from fieldmon.monitoring.phones.photos_asked import AskedPhoto

    from ..state.choices import Choices

_NOTE = "ask_photo_note"
# shown, the last ones
_MOST = 20


def show(choices: Choices) -> None:
    """Show what can be asked for, and what is."""
    if choices.season is None:
        return
    plants = wishes.picked(choices.laid) or plant_history.tapped(choices)
    asked = photos_asked.photos_asked(choices.season)
    if not plants and not asked:
        return
    label = texts.ASK_PHOTOS.format(n=len(asked))
    with fold(label, f"ask photos {choices.place}", is_open=bool(plants)):
        if plants:
            _show_asking(choices, plants)
        for one in asked[: -_MOST - 1 : -1]:
            _show_one(choices, one)


def _show_asking(choices: Choices, plants: tuple[int, ...]) -> None:
    st.text_input(texts.ASK_PHOTO, key=_NOTE, max_chars=photos_asked.LONGEST_NOTE)
    counted = texts.PLANTS_COUNTED.format(n=len(plants))
    st.button(texts.ASK_PHOTO_BUTTON.format(plants=counted), key="ask_photo", on_click=_ask,
              args=(choices, plants))  # fmt: skip
    st.caption(texts.ASK_PHOTO_NOTE)


def _show_one(choices: Choices, one: AskedPhoto) -> None:
    place = place_in_words(choices.open_season.plot.grid, one.plant)
    note = texts.isolated(one.note)
    # a button is as wide as its words, in every language
    with st.container(horizontal=True, vertical_alignment="center"):
        st.markdown(texts.ASKED_PHOTO.format(**place, note=note))
        st.button(texts.ASK_NO_MORE, key=f"no photo {one.id}", width="content",
                  on_click=_ask_no_more, args=(choices, one.id))  # fmt: skip


@notices.reporting
def _ask(choices: Choices, plants: tuple[int, ...]) -> str:
    for plant in plants:
        photos_asked.ask_photo(choices.open_season, plant, st.session_state[_NOTE])
    wishes.pick(choices.laid, ())
    return ""


@notices.reporting
def _ask_no_more(choices: Choices, name: str) -> str:
    photos_asked.ask_no_more(choices.open_season, name)
    return ""
