"""What no routes of a team can hold together: the proof beside what is planned in `team`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.planning.bound_wording import PROVED
from fieldmon.planning.routes import bound
from fieldmon.planning.routes.best_route import bounded

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles

    Float = NDArray[np.float64]

# so many prices of plants are tried for a bound, for so long; a step that gained nothing so often
# is halved; directions are remembered so far
PRICES, _WITHIN_S, _PATIENCE, _MEMORY = 60, 20.0, 5, 0.7


class MemberTask(NamedTuple):
    """What one member's route is looked for in."""

    aisles: Aisles
    robot: Robot
    value: Float
    starts_s: float = 0.0


def team_bound(
    tasks: Sequence[MemberTask],
    held: float = 0.0,
    tried: Callable[[int], None] = lambda _prices: None,
) -> float:
    """Return what no routes of a team can hold together: the least of some bounds.

    Whatever is paid once for each plant, no more than all that and what each member could hold
    alone of the rest (a price of plants, as Lagrange's). And where all start at one gate and come
    back to it, what one robot could hold with the hours of all, as fast and sharp-eyed as the best
    of them in everything: it drives the routes of all one after the other. Between two it changes
    aisles once more than they do.

    `held` is what routes are known to hold: the better it is known, the sooner prices are found.
    `tried` is told how many prices were tried, of `PRICES` at most.
    """
    values = np.array([task.value for task in tasks])
    most = values.max(axis=0)
    least = _by_prices(tasks, most, held, tried)
    robots = [task.robot for task in tasks]
    one_gate = all(task.aisles is tasks[0].aisles for task in tasks)
    if not one_gate or not all(robot.returns for robot in robots):
        return least
    quickest = quickest_of(robots)
    seconds = sum(robot.day_s for robot in robots) + (len(robots) - 1) * quickest.row_change_s
    return min(least, bound(tasks[0].aisles, most, quickest, seconds))


def quickest_of(robots: Sequence[Robot]) -> Robot:
    """Return a robot that is as quick as the best of some in everything."""
    return replace(
        robots[0],
        speed_m_s=max(robot.speed_m_s for robot in robots),
        row_change_s=min(robot.row_change_s for robot in robots),
        turn_180_s=min(robot.turn_180_s for robot in robots),
        stop_s=0.0,
        look_s=min(robot.visit_s for robot in robots),
    )


def _by_prices(
    tasks: Sequence[MemberTask],
    most: Float,
    held: float,
    tried: Callable[[int], None] = lambda _prices: None,
) -> float:
    """Return the least bound of many prices of plants.

    A plant that is visited by more than one gets dearer, one that is visited by none cheaper, by
    steps as Polyak's, in a direction that remembers the last ones. Any price gives a bound.
    """
    until = FIRST_USE.work_clock() + _WITHIN_S
    price = direction = np.zeros(len(most))
    least, kept, step, in_vain = np.inf, price, 1.0, 0
    for number in range(PRICES):
        alone = [
            bounded(task.aisles, np.maximum(task.value - price, 0.0), task.robot) for task in tasks
        ]
        tried(number + 1)
        value = float(price.sum()) + sum(each.value for each in alone)
        if value < least:
            least, kept, in_vain = value, price, 0
        else:
            in_vain += 1
        if in_vain >= _PATIENCE:
            price, step, in_vain = kept, step / 2, 0
        slope = 1.0 - sum(each.visits for each in alone)
        direction = slope + _MEMORY * direction
        direction = np.where((price <= 0.0) & (direction > 0.0), 0.0, direction)
        norm = float((direction**2).sum())
        if norm == 0.0 or value <= held * (1.0 + PROVED) or FIRST_USE.work_clock() > until:
            break
        price = np.clip(price - step * (value - held) / norm * direction, 0.0, most)
    return least
