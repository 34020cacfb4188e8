"""The map of the field: what is believed and known of every plant, day by day, hour by hour."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..actions import rasters
from ..show import field_map, hot_spots, map_layers, plant_history, playback
from ..show.maps import legends
from ..show.maps.plant_layers import POINTS_AT_MOST
from ..state import chosen_day, widget_memory
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show the map, its layers and what its signs mean."""
    st.subheader(f"{choices.name}: {texts.MAP}")
    left, right = st.columns([3, 1])
    with right:
        shade = widget_memory.show(st.radio, texts.SHADE_BY, list(texts.SHADES), key="shade",
                                default="chance", format_func=texts.SHADES.__getitem__)  # fmt: skip
        names = dict(texts.MAP_LAYERS)
        shown = widget_memory.show(
            st.pills, texts.LAYERS, list(names), key="map_layers", default=["route", "hot"],
            format_func=names.__getitem__, selection_mode="multi", wrap=True,
        )  # fmt: skip
        rows = _rows(choices)
        if "backdrop" in shown:
            rasters.show_backdrop()
    with left:
        choices = playback.day(choices)
        playback.show(choices, _layers(choices, shade, shown, rows), on="route" in shown)
        _legend(shade, dark=choices.dark)
        field_map.signs(shown)
    with right:
        plant_history.show(choices)
    said = hot_spots.meanings(choices.plot.grid, chosen_day.hot_spots(choices))
    st.markdown("\n".join(f"- {meaning}" for meaning in said))


def _rows(choices: Choices) -> tuple[int, int] | None:
    """Return which rows are shown plant by plant where a plot is too large to show all so."""
    grid = choices.plot.grid
    if len(grid) <= POINTS_AT_MOST:
        return None
    last = int(grid.row_line.max()) + 1
    first = max(1, last // 2)
    at_once = max(1, POINTS_AT_MOST * last // len(grid))
    return st.slider(texts.ROWS_CLOSE, 1, last, (first, min(first + min(at_once, 10), last)),
                     help=texts.ROWS_CLOSE_HELP, key="rows_close")  # fmt: skip


def _layers(choices: Choices, shade: str, shown: list[str], rows: tuple[int, int] | None) -> list:
    layers = rasters.backdrop_layers(choices) if "backdrop" in shown else []
    layers = [*layers, *map_layers.plants(choices, shade, rows)]
    if "route" in shown:
        route = chosen_day.route(choices).route
        layers += map_layers.route(choices, route, numbers="numbers" in shown)
    return map_layers.with_marks(choices, layers, shown) + plant_history.layers(choices)


def _legend(shade: str, *, dark: bool) -> None:
    if shade == "chance":
        html = legends.chance_legend(dark=dark)
    elif shade == "state":
        html = legends.state_legend(texts.LEGEND_STATES)
    else:
        html = legends.age_legend(texts.LEGEND_NEVER, texts.LEGEND_DAYS, dark=dark)
    st.markdown(f"**{texts.SHADES[shade].capitalize()}**{html}", unsafe_allow_html=True)
