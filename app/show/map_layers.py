"""A day's layers on the map, each made once for what it shows."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..state import cached, chosen_day
from ..words import texts
from .maps import colours, marks, plant_layers, route_layers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.planning.route import Route

    from ..state.choices import Choices


def plants(choices: Choices, shade_by: str, rows: tuple[int, int] | None = None) -> list:
    """Return the plants' layers, made once for what is known of them, whoever is to go there."""
    key = f"{choices.key} {choices.revision} {choices.day} {choices.dark}"
    make = partial(_plants, choices, shade_by, rows)
    return cached.layers(f"plants {shade_by} {rows} {key}", make)


def _plants(choices: Choices, shade_by: str, rows: tuple[int, int] | None) -> list:
    grid = choices.plot.grid
    extra = []
    if shade_by == "chance":
        chance = chosen_day.chance(choices)
        shade, notes = colours.by_chance(chance, dark=choices.dark), partial(_chances_said, chance)
    else:
        state, ages = chosen_day.states(choices), chosen_day.ages(choices)
        by_age = partial(colours.by_age, ages, dark=choices.dark)
        shade = colours.by_state(state) if shade_by == "state" else by_age()
        extra = plant_layers.finds(grid, state)
        notes = partial(states_said, state)
    layers = [plant_layers.plants(grid, shade, notes)]
    if rows is not None and len(grid) > plant_layers.POINTS_AT_MOST:
        line = grid.row_line[grid.row] + 1
        part = np.flatnonzero((line >= rows[0]) & (line <= rows[1]))[: plant_layers.POINTS_AT_MOST]
        layers.append(plant_layers.plants(grid, shade, notes, part))
    return [*layers, *extra]


def _chances_said(chance: cached.Array, which: NDArray[np.intp]) -> list[str]:
    return [texts.TIP_CHANCE.format(chance=c) for c in chance[which].tolist()]


def states_said(state: cached.Array, which: NDArray[np.intp]) -> list[str]:
    """Return the state of some plants in words."""
    names = texts.LEGEND_STATES
    words = ((1, names["found"]), (0, names["clean"]), (-1, names["never"]))
    said = {value: texts.TIP_STATE.format(state=word) for value, word in words}
    return [said[s] for s in state[which].tolist()]


def route(choices: Choices, driven: Route, *, numbers: bool) -> list:
    """Return the route's layers, made once."""
    shown = f"{choices.robot} {choices.sampler} {numbers} {choices.dark} {driven.end_s}"
    key = f"route {choices.key} {choices.revision} {choices.day} {shown}"
    return cached.layers(
        key, partial(route_layers.route, driven, numbers=numbers, dark=choices.dark)
    )


def with_marks(choices: Choices, layers: list, shown: list[str]) -> list:
    """Return the layers with hot spots and records, where these are to be shown."""
    if "hot" in shown:
        layers = marks.with_hot(layers, _hot_layers(choices))
    if "records" in shown:
        layers = layers + marks.records(choices.records, dark=choices.dark)
    return layers


def _hot_layers(choices: Choices) -> list:
    def make() -> list:
        return marks.hot(choices.plot.grid, chosen_day.hot_spots(choices), dark=choices.dark)

    key = f"{choices.key} {choices.revision} {choices.day} {choices.dark}"
    return cached.layers(f"hot {key}", make)
