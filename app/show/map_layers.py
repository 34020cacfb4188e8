"""What a day's map shows: plants in three shades, route, hot spots, records; each made once."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..state import cached, chosen_day
from ..words import language, texts
from . import field_map
from .map_view import Frames, MapContent, Switch
from .maps import colours, deck, labels, legends, marks, plant_layers, route_layers
from .maps.plant_layers import PlantNotes

if TYPE_CHECKING:
    from fieldmon.planning.route import Route

    from ..state.choices import Choices

#: the layers of each switch
PARTS = {
    "route": ("casing", "route", "arrows", "gate"),
    "hot": ("hot", "hot-edge"),
    "records": ("records",),
    "numbers": (),
    "rows": ("row-lines",),
    "before": ("rows-before", "boundary-before"),
    "backdrop": ("backdrop",),
}
# more days than these are a film in steps of several
_FRAMES = 60
_FINDS = ("finds0", "finds1", "found")


def day_map(
    choices: Choices, *, below: list | None = None, above: list | None = None,
    first: str = "chance", off: tuple[str, ...] = ("records",),
) -> MapContent:  # fmt: skip
    """Return the map of the chosen day; `first` names the shade that is on before any is chosen."""
    driven = chosen_day.route(choices)
    route = driven.route
    shades = shaded(choices, first)
    layers = [
        *(below or []),
        deck.boundary(choices.plot.field, dark=choices.dark),
        *marks.with_hot(plants(choices), _hot_layers(choices)),
        *route_of(choices, route),
        *marks.records(choices.records, dark=choices.dark),
        *(above or []),
    ]
    play = route_layers.playback(route, driven.begins)
    if play is not None:
        play["key"] = f"{language.current()} {_route_key(choices, route)}"
    return MapContent(
        **field_map.of_plot(choices, len(route)), layers=layers,
        switches=switches(layers, off, ("numbers", "rows")), shades=shades,
        legend=legend(choices), play=play,
        labels=[*labels.stops(route), *labels.rows(choices.plot.grid)],
    )  # fmt: skip


def season_frames(choices: Choices) -> Frames | None:
    """Return the season's days, evenly chosen where there are very many; None: there is but one."""
    if choices.season is None:
        return None
    days = chosen_day.season_days(choices)
    if len(days) < 2:
        return None
    kept = np.unique(np.linspace(0, len(days) - 1, min(len(days), _FRAMES)).round().astype(int))
    days = [days[k] for k in kept.tolist()]
    at = [replace(choices, day=day) for day in days]
    key = f"{language.current()} {choices.key} {choices.revision} {choices.day} {choices.dark}"
    names = tuple(choices.units.day(day) for day in days)
    now = int(np.searchsorted(days, choices.day))
    shown = cached.frames(key, lambda: [marks.with_hot(_plants(one), _hot(one)) for one in at])
    return Frames(key, names, tuple(shown), min(now, len(days) - 1))


def shaded(choices: Choices, first: str = "chance") -> tuple[Switch, ...]:
    """Return the three ways to shade plants, the first one on."""
    own = {"chance": ("plants-chance",), "state": ("plants-state", *_FINDS), "age": ("plants-age",)}
    names = sorted(own, key=lambda name: name != first)
    if choices.season is None:
        names.remove("age")
    return tuple(Switch(name, texts.SHADES[name], own[name]) for name in names)


def switches(
    layers: list, off: tuple[str, ...] = (), written: tuple[str, ...] = ("rows",)
) -> tuple[Switch, ...]:  # fmt: skip
    """Return the switches of the layers that there are, and of the labels that are `written`."""
    there = {layer.id for layer in layers}
    return tuple(
        Switch(name, texts.MAP_LAYERS[name], ids, name not in off)
        for name, ids in PARTS.items()
        if there.intersection(ids) or name in written
    )


def legend(choices: Choices) -> list[legends.LegendPart]:
    """Return the legend of a day's map."""
    dark = choices.dark
    return [legends.by_chance(dark=dark), legends.by_state(), legends.by_age(dark=dark),
            *legends.signs(dark=dark)]  # fmt: skip


def plants(choices: Choices) -> list:
    """Return the plants in all shades, made once for what is known of them."""
    key = f"plants {choices.key} {choices.revision} {choices.day} {choices.dark}"
    return cached.layers(key, partial(_plants, choices))


def _plants(choices: Choices) -> list:
    grid = choices.plot.grid
    chance, state = chosen_day.chance(choices), chosen_day.states(choices)
    by_chance = colours.by_chance(chance, dark=choices.dark)
    ages = []
    if choices.season is not None:
        by_age = colours.by_age(chosen_day.ages(choices), dark=choices.dark)
        ages = [plant_layers.plants(grid, by_age, name="plants-age")]
    return [
        plant_layers.plants(grid, by_chance, PlantNotes(chance), "plants-chance"),
        *ages,
        *in_states(choices, state),
    ]


def in_states(choices: Choices, state: np.ndarray) -> list:
    """Return plants shaded by their state, and the rings of finds."""
    grid, names = choices.plot.grid, texts.LEGEND_STATES
    said = tuple(texts.TIP_STATE.format(state=names[name]) for name in ("never", "clean", "found"))
    notes = PlantNotes(by_rank=said)
    return [
        plant_layers.plants(grid, colours.by_state(state), notes, "plants-state"),
        *plant_layers.finds(grid, state),
    ]


def route_of(choices: Choices, route: Route) -> list:
    """Return the route's layers, made once."""
    return cached.layers(
        _route_key(choices, route), partial(route_layers.route, route, dark=choices.dark)
    )


def _route_key(choices: Choices, route: Route) -> str:
    shown = f"{choices.robot} {choices.sampler} {choices.dark} {choices.wishes}"
    shown = f"{shown} {route.end_s} {len(route)}"
    return f"route {choices.key} {choices.revision} {choices.day} {shown}"


def _hot_layers(choices: Choices) -> list:
    key = f"{choices.key} {choices.revision} {choices.day} {choices.dark}"
    return cached.layers(f"hot {key}", partial(_hot, choices))


def _hot(choices: Choices) -> list:
    return marks.hot(choices.plot.grid, chosen_day.hot_spots(choices), dark=choices.dark)
