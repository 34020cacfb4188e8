"""A day of a simulated season: what is known by then, and its layers on the map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.hotspots import hot_spots
from fieldmon.planning.route import route_of
from fieldmon.samplers.base import NEVER, Scene

from ..words import texts
from ..words.language import number as written
from . import field_map, map_layers
from .map_view import MapContent, Switch
from .maps import colours, labels, legends, marks, route_layers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.season import SimulatedDay

    from ..state.choices import Choices


def states(season: list[SimulatedDay], number: int) -> NDArray[np.int8]:
    """Return ``(n,)`` found (1), clean (0) or never inspected (-1) after a day, from 0."""
    state = np.where(season[number].last_inspected >= 0, 0, -1).astype(np.int8)
    for day in season[: number + 1]:
        state[day.work.plant[day.work.found]] = 1
    return state


def content(
    choices: Choices, season: list[SimulatedDay], number: int, *, truth: bool
) -> MapContent:  # fmt: skip
    """Return what is known after a day and the route driven; `truth`: what is infested, too."""
    grid, day, dark = choices.plot.grid, season[number], choices.dark
    state = states(season, number)
    scene = Scene(
        aisles=choices.plot.aisles, robot=choices.robot, chance=day.chance,
        last_inspected=np.full(len(grid), NEVER, np.int32), seconds_left=choices.robot.day_s,
    )  # fmt: skip
    driven = route_of(scene, day.work)
    shown = marks.with_hot(
        map_layers.in_states(choices, state), marks.hot(grid, hot_spots(grid, state), dark=dark)
    )
    layers = [
        *map_layers.plan(choices), *shown,
        *route_layers.route(driven, dark=dark),
        map_layers.gate(choices),
        *(marks.truth(grid, _left(day), dark=dark) if truth else []),
    ]  # fmt: skip
    colour = colours.TRUTH_IN_DARK if dark else colours.TRUTH
    more = [legends.part("", [("dot", colour, texts.LEGEND_TRUTH)])] if truth else []
    return MapContent(
        **field_map.of_plot(choices, len(driven)), layers=layers,
        switches=map_layers.switches(layers),
        shades=(Switch("state", texts.SHADES["state"], ("plants-state",)),),
        legend=[*map_layers.legend(choices), *more],
        labels=[*labels.stops(driven), *map_layers.words(choices)],
    )  # fmt: skip


def visit(season: SeasonMetrics, day: int, every: int) -> str:
    """Return which visit a day, from 1, has or is after, and what all visits came to."""
    past, since = divmod(day - 1, every)
    said = texts.NO_VISIT if since else texts.VISIT_OF_DAY
    said = said.format(visit=past + 1, visits=season.visits, day=day - since)
    percent = texts.IN_PERCENT.format(value=written(season.visited_each_time_pct, ".0f"))
    hours = written(season.worked_h.sum(), ",.0f")
    return f"{said} {texts.VISITS_CAME_TO.format(hours=hours, percent=percent)}"


def _left(day: SimulatedDay) -> NDArray[np.bool_]:
    """Return ``(n,)`` whether each plant is infested and not found yet."""
    left = day.infested.copy()
    left[day.work.plant[day.work.found]] = False
    return left
