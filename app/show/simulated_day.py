"""A day of a simulated season: what is known by then, and its layers on the map."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.hotspots import hot_spots
from fieldmon.planning.route import route_of
from fieldmon.samplers.base import NEVER, Scene

from . import map_layers
from .maps import colours, marks, plant_layers, route_layers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.simulation.season import SimulatedDay

    from ..state.choices import Choices


def states(season: list[SimulatedDay], number: int) -> NDArray[np.int8]:
    """Return ``(n,)`` found (1), clean (0) or never inspected (-1) after a day, from 0."""
    state = np.where(season[number].last_inspected >= 0, 0, -1).astype(np.int8)
    for day in season[: number + 1]:
        state[day.work.plant[day.work.found]] = 1
    return state


def layers(choices: Choices, season: list[SimulatedDay], number: int, *, truth: bool) -> list:
    """Return what is known after a day and the route driven; `truth`: what is infested, too."""
    grid, day = choices.plot.grid, season[number]
    state = states(season, number)
    scene = Scene(
        aisles=choices.plot.aisles, robot=choices.robot, chance=day.chance,
        last_inspected=np.full(len(grid), NEVER, np.int32), seconds_left=choices.robot.day_s,
    )  # fmt: skip
    shown = [
        plant_layers.plants(grid, colours.by_state(state), partial(map_layers.states_said, state)),
        *plant_layers.finds(grid, state),
        *route_layers.route(route_of(scene, day.work), numbers=False, dark=choices.dark),
    ]
    shown = marks.with_hot(shown, marks.hot(grid, hot_spots(grid, state), dark=choices.dark))
    return [*shown, *marks.truth(grid, _left(day), dark=choices.dark)] if truth else shown


def _left(day: SimulatedDay) -> NDArray[np.bool_]:
    """Return ``(n,)`` whether each plant is infested and not found yet."""
    left = day.infested.copy()
    left[day.work.plant[day.work.found]] = False
    return left
