"""Plants and hot spots: what is known of a plant, where finds cluster."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.reports.sentences import hot_spot_meanings

from ..show import map_layers, plant_history
from ..state import chosen_day
from ..words import texts
from ..words.language import in_words

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show hot spots in words and a plant's history, of any day of the season."""
    plant_history.want(choices, map_layers.day_map(choices))
    st.markdown(f"### {texts.HOT_TITLE}")
    spots, records = chosen_day.hot_spots(choices), chosen_day.records_known(choices)
    if len(records):
        st.caption(in_words(records.sentence(choices.units.in_sentences(choices.on))))
    said = hot_spot_meanings(choices.plot.grid, spots, chosen_day.finds_apart(choices))
    # as their numbers on the map
    signs = [f"{k}." if len(spots) else "-" for k in range(1, len(said) + 1)]
    st.markdown("\n".join(f"{sign} {in_words(one)}" for sign, one in zip(signs, said, strict=True)))
    plant_history.show(choices)
