"""Decide: the looks that tell soonest whether so much of the plot is infested that treating pays.

Which share is infested is told best by looks that are spread over the whole plot, and denser
where a look is less foreseen (Neyman's allocation, J. R. Stat. Soc. 97 (1934) 558). A find tells
where its neighbours stand, not how much is infested elsewhere: it draws no more looks to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.compute.jit import inner_loop, loop
from fieldmon.compute.random_streams import coin
from fieldmon.errors import SettingError
from fieldmon.infestation.pairs.pairs import Neighbourhood, pair_chances, update_neighbourhood
from fieldmon.plot.travel import Clock, in_time, travel_s
from fieldmon.samplers.base import Sampler, Scene, Stops

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Linked, PlantGrid
    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.base import WouldFind

    Floats = NDArray[np.float64]

# passes of a low-discrepancy sequence: each goes between the stops of those before
_GOLDEN = 0.6180339887498949
# a day ends after so many passes in which nothing fitted into what is left of it
_TRIES = 3
_LEAST = 1e-6


class _Believed(NamedTuple):
    """Chances of plants ``(n,)`` and pairs ``(e,)`` now, those of the morning, and room."""

    chance: Floats
    pair_chance: Floats
    morning: Floats
    near: Neighbourhood


class _Pass(NamedTuple):
    """Room for a pass, ``(n,)`` each: what plants weigh, the chosen, and who is seen.

    And ``(rows,)`` what the plants of each row weigh together, and whether it is driven.
    """

    weight: Floats
    chosen: NDArray[np.int64]
    seen: NDArray[np.bool_]
    of_row: Floats
    driven: NDArray[np.bool_]


@dataclass(frozen=True)
class Decide(Sampler):
    """Look where a look changes the verdict most: spread over the plot, denser where unforeseen.

    It drives the plot in passes of some looks each, up and down in the order of the rows. A pass
    drives some rows only, for the way through a row costs as much as many looks, and spreads its
    looks along them; how dense rows and looks are is as the chances say. Each pass goes between
    the looks of those before it. So there is a fair picture of the whole plot early, and it
    becomes finer until the day is over or a verdict is clear.

    Parameters
    ----------
    looks_a_pass
        Looks in one pass over the plot (our choice: about as many as the fewest that decide).
    apart
        Plants between two looks of a row at least: more than a cluster is wide (our choice).
    """

    looks_a_pass: int = 25
    apart: int = 20

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value < 1:
                raise SettingError(f"Decide's {name} must be 1 or more, but it is {value}.")

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the rest of the day."""
        n, grid = len(scene.chance), scene.grid
        chance = np.maximum(scene.chance, _LEAST)
        pairs = scene.pair_chance
        pairs = pair_chances(scene.chance, grid) if pairs is None else pairs.copy()
        return scene.walked(
            _walk,
            (grid.linked, grid.snake, as_compiled(would_find.view(np.uint8))),
            (
                _Believed(chance, pairs, chance.copy(), Neighbourhood.of(n)),
                _Pass(
                    np.empty(n),
                    np.empty(n, np.int64),
                    scene.last_inspected == scene.day,
                    np.empty(grid.n_rows),
                    np.empty(grid.n_rows, np.bool_),
                ),
            ),
            (scene.at, self._rows(grid), scene.robot.detects, scene.key),
        )

    def _rows(self, grid: PlantGrid) -> tuple[int, int]:
        """Return the looks of a pass, and in how many rows."""
        usual = max(1.0, len(grid) / grid.n_rows / self.apart)
        return self.looks_a_pass, max(1, min(round(self.looks_a_pass / usual), grid.n_rows))


@loop
def _walk(
    travel: TravelTable,
    clock: Clock,
    plants: tuple[Linked, NDArray[np.int32], NDArray[np.uint8]],
    work: tuple[_Believed, _Pass],
    start: tuple[int, tuple[int, int], float, np.uint64],
    stops: Stops,
) -> int:
    believed, room = work
    at, looks, detects, key = start
    linked, snake, would_find = plants
    now_s, k, tries, number = 0.0, 0, 0, 0
    first = coin(key, 0)
    while k < stops.plant.size and tries < _TRIES:
        place = (first + number * _GOLDEN) % 1.0
        n = _choose(travel, (believed, room), snake, (looks, place, detects))
        if n == 0:
            break
        _turn(travel, clock, room.chosen, (at, n))
        number, before = number + 1, k
        for t in range(n):
            plant = room.chosen[t]
            arrive_s = now_s + travel_s(travel, clock, at, plant)
            if k == stops.plant.size or not in_time(travel, clock, plant, arrive_s):
                continue
            stops.plant[k], stops.arrive_s[k] = plant, arrive_s
            now_s, at, k = arrive_s + clock.visit_s, plant, k + 1
            room.seen[plant] = True
            result = (plant, would_find[plant] > 0)
            chances = believed.chance, believed.pair_chance
            update_neighbourhood(chances, linked, result, (detects, True), believed.near)
        tries = tries + 1 if k == before else 0
    return k


@inner_loop
def _choose(
    travel: TravelTable,
    work: tuple[_Believed, _Pass],
    snake: NDArray[np.int32],
    wishes: tuple[tuple[int, int], float, float],
) -> int:
    """Choose the plants of a pass in the order of the rows; return how many.

    Rows by what their plants weigh together, from a place that moves from pass to pass; and in
    each of them equally many plants, by what each weighs.
    """
    believed, room = work
    (looks, rows), place, detects = wishes
    _weigh(believed, room, detects)
    room.of_row[:] = 0.0
    for i in range(room.weight.size):
        room.of_row[travel.row[i]] += room.weight[i]
    _drive_rows(room, rows, place)
    total = 0.0
    for row in range(room.of_row.size):
        total += 1.0 if room.driven[row] else 0.0
    n, so_far, ahead = 0, 0.0, place
    for j in range(snake.size):
        i = snake[j]
        row = travel.row[i]
        if not room.driven[row] or room.weight[i] <= 0.0:
            continue
        so_far += room.weight[i] / room.of_row[row]
        if so_far * looks > ahead * total:
            room.chosen[n] = i
            n += 1
            ahead = max(ahead + 1.0, np.floor(so_far * looks / total - place) + 1.0 + place)
    return n


@inner_loop
def _weigh(believed: _Believed, room: _Pass, detects: float) -> None:
    """Weigh each plant by how unforeseen a look at it is; nothing where one was seen today."""
    for i in range(room.weight.size):
        # what today's finds beside it tell of a plant is no news about the plot
        p = min(believed.chance[i], believed.morning[i])
        q = detects * p
        told = q * (1.0 - p) ** 2 * detects * p / max(q * (1.0 - q), _LEAST * _LEAST)
        room.weight[i] = 0.0 if room.seen[i] else np.sqrt(told)


@inner_loop
def _drive_rows(room: _Pass, rows: int, place: float) -> None:
    """Choose the rows of a pass: one at each equal share of all weights."""
    total, so_far, ahead = room.of_row.sum(), 0.0, place
    for row in range(room.of_row.size):
        so_far += room.of_row[row]
        room.driven[row] = room.of_row[row] > 0.0 and so_far * rows > ahead * total
        while so_far * rows > ahead * total and ahead < rows:
            ahead += 1.0


@inner_loop
def _turn(
    travel: TravelTable, clock: Clock, chosen: NDArray[np.int64], state: tuple[int, int]
) -> None:
    """Begin a pass at the end that is nearer."""
    at, n = state
    if travel_s(travel, clock, at, chosen[0]) <= travel_s(travel, clock, at, chosen[n - 1]):
        return
    for t in range(n // 2):
        chosen[t], chosen[n - 1 - t] = chosen[n - 1 - t], chosen[t]
