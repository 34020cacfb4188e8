"""The map of the field: what is believed and known of every plant, day by day, hour by hour."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from app import grounds, maps, panels, playing, remembered, texts

if TYPE_CHECKING:
    from app.choices import Choices


def show(choices: Choices) -> None:
    """Show the map, its layers and what its signs mean."""
    st.subheader(f"{choices.name}: {texts.MAP}")
    left, right = st.columns([3, 1])
    with right:
        shade = remembered.show(st.radio, texts.SHADE_BY, list(texts.SHADES), key="shade",
                                default="chance", format_func=texts.SHADES.__getitem__)  # fmt: skip
        names = dict(texts.MAP_LAYERS)
        shown = remembered.show(
            st.pills, texts.LAYERS, list(names), key="map_layers", default=["route", "hot"],
            format_func=names.__getitem__, selection_mode="multi", wrap=True,
        )  # fmt: skip
        rows = _rows(choices)
        if "backdrop" in shown:
            grounds.bring()
    with left:
        choices = playing.day(choices)
        playing.show(choices, _layers(choices, shade, shown, rows), on="route" in shown)
        _legend(shade)
        panels.signs(shown)
    with right:
        panels.history(choices)
    st.markdown("\n".join(f"- {meaning}" for meaning in panels.meanings(choices)))


def _rows(choices: Choices) -> tuple[int, int] | None:
    """Return which rows are shown plant by plant where a plot is too large to show all so."""
    grid = choices.plot.grid
    if len(grid) <= maps.POINTS_AT_MOST:
        return None
    last = int(grid.row_line.max()) + 1
    first = max(1, last // 2)
    at_once = max(1, maps.POINTS_AT_MOST * last // len(grid))
    return st.slider(texts.ROWS_CLOSE, 1, last, (first, min(first + min(at_once, 10), last)),
                     help=texts.ROWS_CLOSE_HELP, key="rows_close")  # fmt: skip


def _layers(choices: Choices, shade: str, shown: list[str], rows: tuple[int, int] | None) -> list:
    layers = grounds.layers(choices) if "backdrop" in shown else []
    layers = [*layers, *panels.plant_layers(choices, shade, rows)]
    if "route" in shown:
        route = panels.route_of_day(choices).route
        layers += panels.route_layers(choices, route, numbers="numbers" in shown)
    return panels.with_marks(choices, layers, shown) + panels.chosen_layers(choices)


def _legend(shade: str) -> None:
    if shade == "chance":
        html = maps.chance_legend()
    elif shade == "state":
        html = maps.state_legend(texts.LEGEND_STATES)
    else:
        html = maps.age_legend(texts.LEGEND_NEVER, texts.LEGEND_DAYS)
    st.markdown(f"**{texts.SHADES[shade].capitalize()}**{html}", unsafe_allow_html=True)
