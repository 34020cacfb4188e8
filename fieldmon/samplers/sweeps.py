"""Naive and Bouncy: row after row, every plant or every N-th, wherever the insects are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from fieldmon.compute.jit import inner_loop, loop
from fieldmon.plot.travel import Clock, in_time, travel_s
from fieldmon.samplers.base import Sampler, Scene, Stops
from fieldmon.samplers.registry import check_every

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.base import WouldFind


@dataclass(frozen=True)
class Naive(Sampler):
    """Inspect plant after plant, up one row and down the next; go on tomorrow where today ended.

    At the end of the plot it starts again at the first row. The chance map is not looked at
    (our reading of the thesis, whose text does not define the order).
    """

    reads_chance: ClassVar[bool] = False

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:  # noqa: ARG002
        """Return the sweep's next stops."""
        return _sweep(scene, 1)


@dataclass(frozen=True)
class Bouncy(Sampler):
    """Inspect every N-th plant of the same sweep; the next pass takes other plants.

    A pass starts at that one of the first N plants which was inspected least recently.

    Parameters
    ----------
    every
        N; the thesis leaves one plant out between two (2).
    """

    reads_chance: ClassVar[bool] = False
    every: int = 2

    def __post_init__(self) -> None:
        check_every(self.every)

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:  # noqa: ARG002
        """Return the sweep's next stops."""
        return _sweep(scene, self.every)


def _sweep(scene: Scene, every: int) -> Stops:
    plants = (scene.grid.snake, scene.last_inspected.copy())
    return scene.walked(_walk, plants, (scene.at, scene.resume, scene.day, every))


@loop
def _walk(
    travel: TravelTable,
    clock: Clock,
    plants: tuple[NDArray[np.int32], NDArray[np.int32]],
    start: tuple[int, int, int, int],
    stops: Stops,
) -> int:
    snake, last = plants
    at, after, today, every = start
    left = 0
    for day in last:
        left += day != today
    position = _first(snake, last, every) if after < 0 else _place(snake, after) + every
    now_s, k = 0.0, 0
    # where the pass began, and after how many stops
    begin, before = 0, -1
    while left > 0 and k < stops.plant.size:
        if position >= snake.size:
            # a pass on which all were inspected today leads nowhere: the next one takes others
            position = _first(snake, last, every) if k > before else (begin + 1) % every
            begin, before = position, k
            continue
        plant = snake[position]
        position += every
        if last[plant] == today:
            continue
        arrive_s = now_s + travel_s(travel, clock, at, plant)
        if not in_time(travel, clock, plant, arrive_s):
            break
        stops.plant[k], stops.arrive_s[k] = plant, arrive_s
        now_s = arrive_s + clock.visit_s
        last[plant] = today
        at = plant
        left -= 1
        k += 1
    return k


@inner_loop
def _first(snake: NDArray[np.int32], last: NDArray[np.int32], every: int) -> int:
    """Return where a new pass starts: at the first plant inspected least recently."""
    best = 0
    for position in range(1, min(every, snake.size)):
        if last[snake[position]] < last[snake[best]]:
            best = position
    return best


@inner_loop
def _place(snake: NDArray[np.int32], plant: int) -> int:
    """Return where in the sweep a plant stands."""
    for position in range(snake.size):
        if snake[position] == plant:
            return position
    return -1
