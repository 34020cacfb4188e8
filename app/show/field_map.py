"""The map of a plot on a page: outline, layers, scale and north; what is tapped and clicked on."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from ..state import chosen_day
from ..words import texts
from . import scale_bar
from .map_room import height_px, room_px
from .maps import deck, legends

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from streamlit.delta_generator import DeltaGenerator

    from ..state.choices import Choices

    #: takes what was tapped, by layer
    Tapped = Callable[[dict], None]


def draw(
    choices: Choices, layers: list, key: str, tap: Tapped | None = None,
    clicked: scale_bar.Clicked | None = None, chart: DeltaGenerator | None = None,
) -> None:  # fmt: skip
    """Show a map with outline, scale and north, in `chart` if there is a place for it already.

    `tap` is called once for each thing that is tapped, `clicked` with every position clicked on.
    """
    grid = choices.plot.grid
    route = next((layer for layer in layers if layer.id == "route"), None)
    finds = int((chosen_day.states(choices) == 1).sum())
    alt = texts.MAP_ALT.format(
        name=choices.plot.field.name, plants=len(grid), finds=finds,
        stops=0 if route is None else len(chosen_day.route(choices).route),
    )  # fmt: skip
    outline = deck.boundary(choices.plot.field, dark=choices.dark)
    picture = deck.deck(grid, [outline, *layers], room_px(key))
    picture.renamed = st.session_state.get(f"renamed {key}", frozenset())
    # a callback, since what was tapped stays selected in all the runs that follow
    (chart or st).pydeck_chart(
        picture, height=height_px(), key=key, alt=alt,
        on_select="ignore" if tap is None else partial(_tapped, key, tap),
    )  # fmt: skip
    scale_bar.show(key, picture.initial_view_state, choices.units, clicked)


def _tapped(key: str, tap: Tapped) -> None:
    objects = {
        name.removesuffix(deck.RENAMED): hits
        for name, hits in st.session_state[key].selection.objects.items()
    }
    renamed = st.session_state.get(f"renamed {key}", frozenset())
    st.session_state[f"renamed {key}"] = renamed ^ objects.keys()
    tap(objects)


def signs(shown: Sequence[str]) -> None:
    """Show what the signs of the layers shown mean."""
    captions([text for name, text in texts.LEGENDS.items() if name in shown])


def state_legend() -> None:
    """Show how found, clean and never inspected plants are told apart."""
    st.markdown(legends.state_legend(texts.LEGEND_STATES), unsafe_allow_html=True)


def captions(parts: Sequence[str]) -> None:
    """Show what the signs of a map mean."""
    st.caption(" · ".join(parts))
