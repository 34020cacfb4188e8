"""The thesis's seven samplers without prior information: snake, neighbor, random.

As its chapter 4 describes them (not as its listings ran, see `fieldmon.studies`), on any plot.
A *station* is where the robot stops: one plant for the snake and the random sampler, the plants
that face each other across an aisle for the neighbor sampler.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from fieldmon.compute.arrays import read_only
from fieldmon.compute.jit import inner_loop, loop
from fieldmon.compute.random_streams import coin, coin_table
from fieldmon.compute.wording import counted
from fieldmon.plot.travel import Clock, in_time, travel_s
from fieldmon.samplers.base import Sampler, Scene, Stops
from fieldmon.samplers.registry import check_every

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.base import WouldFind

_ONLINE = 0
# a sweep over a plot of which all was visited today ends after so many times round
_MOST_SKIPPED = 4


class Stations(NamedTuple):
    """Stops in the order of a sweep: plants of stop k are ``plant[start[k]:start[k + 1]]``."""

    start: NDArray[np.int32]
    plant: NDArray[np.int32]
    of: NDArray[np.int32]

    def __repr__(self) -> str:
        plants = counted(len(self.plant), "plant")
        return f"<Stations: {counted(len(self.start) - 1, 'station')} of {plants}>"


@dataclass(frozen=True)
class Snake(Sampler):
    """Up one side of an aisle, down the other, then the next aisle; every N-th plant.

    At the end of the plot it turns round, starting at the nearest of the last N plants that was
    not visited yet (the least recently visited if all were). Algorithms 1 and 2 of the thesis.

    Parameters
    ----------
    every
        N; 1 inspects every plant.
    """

    reads_chance: ClassVar[bool] = False
    every: int = 1

    def __post_init__(self) -> None:
        check_every(self.every)

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:  # noqa: ARG002
        """Return the sweep's next stops."""
        return _sweep(scene, _one_by_one(scene.grid), self.every)


@dataclass(frozen=True)
class SnakeRandom(Sampler):
    """The snake with N drawn anew, 1 to 4, at every stop: algorithm 3 of the thesis."""

    reads_chance: ClassVar[bool] = False

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:  # noqa: ARG002
        """Return the sweep's next stops."""
        return _sweep(scene, _one_by_one(scene.grid), _ONLINE)


@dataclass(frozen=True)
class Neighbor(Sampler):
    """Along the aisles, alternately up and down, looking at the plants on both sides of a stop.

    Where rows are inspected on one face only, every aisle has plants on one side. Algorithms 6
    (every = 1) and 4 of the thesis; the plot's end as for `Snake`.

    Parameters
    ----------
    every
        Every N-th stop.
    """

    reads_chance: ClassVar[bool] = False
    every: int = 1

    def __post_init__(self) -> None:
        check_every(self.every)

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:  # noqa: ARG002
        """Return the sweep's next stops."""
        return _sweep(scene, _face_to_face(scene.grid), self.every)


@dataclass(frozen=True)
class NeighborRandom(Sampler):
    """The neighbor sampler with N drawn anew, 1 to 4, at every stop: algorithm 5 of the thesis."""

    reads_chance: ClassVar[bool] = False

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:  # noqa: ARG002
        """Return the sweep's next stops."""
        return _sweep(scene, _face_to_face(scene.grid), _ONLINE)


@dataclass(frozen=True)
class RandomShare(Sampler):
    """One N-th of the plot, drawn anew every day, in the order of the snake: algorithm 7.

    Parameters
    ----------
    every
        N; the share is 1/N, rounded down, but one plant at least.
    """

    reads_chance: ClassVar[bool] = False
    every: int = 3

    def __post_init__(self) -> None:
        check_every(self.every)

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:  # noqa: ARG002
        """Return the day's draw from the start of the plot."""
        n = len(scene.grid)
        drawn = np.argsort(coin_table(scene.key, n))[: max(n // self.every, 1)]
        wanted = np.zeros(n, np.bool_)
        wanted[drawn] = True
        return _walked(scene, _one_by_one(scene.grid), wanted, (0, 1, 1, False))


@lru_cache(maxsize=4)
def _one_by_one(grid: PlantGrid) -> Stations:
    """Return one station a plant, in the order of the snake."""
    n = len(grid)
    of = np.empty(n, np.int32)
    of[grid.snake] = np.arange(n, dtype=np.int32)
    return _stations(np.arange(n + 1, dtype=np.int32), grid.snake, of)


@lru_cache(maxsize=4)
def _face_to_face(grid: PlantGrid) -> Stations:
    """Return a station for each place along an aisle, aisles alternately up and down."""
    n = len(grid)
    # aisles in the order of their first row; pieces of one line keep their direction
    lane = np.round(grid.lane_y_m, 3) if grid.aisle is None else grid.aisle
    aisle = np.unique(lane, return_inverse=True)[1][grid.row]
    corridor = grid.corridor[grid.row]
    place = np.floor((grid.along_m - grid.along_m.min()) / grid.plant_spacing_m + 0.5)
    up = np.where(aisle % 2 == 0, 1, -1)
    # rows on both sides of an aisle may begin at different places
    begin_m = np.full(grid.corridor.max() + 1, np.inf)
    np.minimum.at(begin_m, grid.corridor, grid.lane_x_m[:, 0])
    order = np.lexsort((grid.side[grid.row], up * place, up * begin_m[corridor], aisle))
    keys = np.stack([aisle[order], corridor[order], place[order]], axis=1)
    new = np.append(True, (np.diff(keys, axis=0) != 0).any(axis=1))
    start = np.append(np.flatnonzero(new), n).astype(np.int32)
    of = np.empty(n, np.int32)
    of[order] = (np.cumsum(new) - 1).astype(np.int32)
    return _stations(start, order.astype(np.int32), of)


def _stations(*arrays: NDArray[np.int32]) -> Stations:
    """Return stations that are only read, so that sweeps are compiled once for all of them."""
    return Stations(*map(read_only, arrays))


def _sweep(scene: Scene, stations: Stations, every: int) -> Stops:
    """Return the stops of a sweep that goes on where the last day ended, in its direction."""
    wanted = np.ones(len(scene.grid), np.bool_)
    before = stations.of[scene.trail]
    if scene.resume < 0:
        return _walked(scene, stations, wanted, (0, 1, every, True))
    here = int(stations.of[scene.resume])
    moved = here - before[before != here]
    ahead = 1 if not len(moved) or moved[-1] > 0 else -1
    return _walked(scene, stations, wanted, (here + ahead * max(every, 1), ahead, every, True))


def _walked(
    scene: Scene,
    stations: Stations,
    wanted: NDArray[np.bool_],
    start: tuple[int, int, int, bool],
) -> Stops:
    plants = (wanted, scene.last_inspected.copy())
    return scene.walked(_walk, stations, plants, (*start, scene.at, scene.day, scene.key))


@loop
def _walk(
    travel: TravelTable,
    clock: Clock,
    stations: Stations,
    plants: tuple[NDArray[np.bool_], NDArray[np.int32]],
    start: tuple[int, int, int, bool, int, int, np.uint64],
    stops: Stops,
) -> int:
    wanted, last = plants
    position, ahead, every, turns, at, today, key = start
    m = stations.start.size - 1
    now_s, k, skipped = 0.0, 0, 0
    while skipped < _MOST_SKIPPED * m:
        step = every if every != _ONLINE else 1 + int(4.0 * coin(key, k + skipped))
        if position < 0 or position >= m:
            if not turns:
                break
            position = _turned(stations, last, ahead, step)
            ahead = -ahead
        first = k
        plant = _next_here(travel, stations, (wanted, last, today), position, at)
        while plant >= 0:
            arrive_s = now_s + travel_s(travel, clock, at, plant)
            if k == stops.plant.size or not in_time(travel, clock, plant, arrive_s):
                return k
            stops.plant[k], stops.arrive_s[k] = plant, arrive_s
            now_s = arrive_s + clock.visit_s
            last[plant] = today
            at = plant
            k += 1
            plant = _next_here(travel, stations, (wanted, last, today), position, at)
        skipped = 0 if k > first else skipped + 1
        position += ahead * step
    return k


@inner_loop
def _next_here(
    travel: TravelTable,
    stations: Stations,
    plants: tuple[NDArray[np.bool_], NDArray[np.int32], int],
    position: int,
    at: int,
) -> int:
    """Return a wanted plant of a station not yet visited today, on the robot's side first."""
    wanted, last, today = plants
    found = -1
    for e in range(stations.start[position], stations.start[position + 1]):
        plant = int(stations.plant[e])
        if not wanted[plant] or last[plant] == today:
            continue
        if at >= 0 and travel.side[travel.row[plant]] == travel.side[travel.row[at]]:
            return plant
        if found < 0:
            found = plant
    return found


@inner_loop
def _turned(stations: Stations, last: NDArray[np.int32], ahead: int, step: int) -> int:
    """Return where a sweep goes on at the plot's end: least recently visited, then nearest."""
    m = stations.start.size - 1
    best, best_day = -1, 0
    for back in range(min(step, m)):
        position = m - 1 - back if ahead > 0 else back
        day = last[stations.plant[stations.start[position]]]
        if best < 0 or day < best_day:
            best, best_day = position, day
    return best
