"""Record: what was found, by stops, one plant, or a file; what was recorded, and its undo."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from ..actions import beginning, bringing_files, contradicting, picking, recording, undoing
from ..show import day, map_layers, plant_history
from ..state import wishes
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Take in what was found."""
    content = map_layers.day_map(choices, first="state", above=picking.layers(choices))
    tapped = partial(recording.take_plant, choices)
    picked = wishes.picked(choices.laid)
    plant_history.want(choices, content, partial(picking.take, choices), tapped, picked=picked)
    if choices.season is None:
        st.markdown(texts.NEEDS_SEASON)
        bringing_files.show_doubts(choices)
        beginning.show(choices)
        return
    day.say_otherwise(choices)
    contradicting.settle(choices)
    recording.show(choices)
    undoing.show_batches(choices)
