"""Decide: treat or not, in one sentence; where; by what assumptions; and the files for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..actions import assuming, beginning, deciding
from ..show import advice as shown
from ..show import cautions, map_layers, plant_history
from ..state import deciding as asked
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show what the season advises on the chosen day."""
    if choices.season is None:
        plant_history.want(choices, map_layers.day_map(choices))
        st.markdown(texts.DECIDE_NEEDS_SEASON)
        beginning.show(choices)
        return
    advice = asked.advice(choices)
    plant_history.want(choices, shown.zone_map(choices, advice))
    shown.headline(choices, advice)
    deciding.threshold()
    shown.figures(choices, advice, asked.product())
    cautions.show_if_treated(choices, advice, asked.product())
    deciding.assumed(advice)
    shown.zones(advice)
    deciding.files(choices, advice)
    cautions.show(choices)
    deciding.treated(choices, advice)
    deciding.known_thresholds(choices)
    assuming.show(choices)
