"""Who of a team works in which aisles: even sections, or those worth most together."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import loop
from fieldmon.compute.wording import counted
from fieldmon.plot.travel import robot_clock

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles, Clock
    from fieldmon.plot.travel_table import TravelTable

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# prices of a second at which aisles are valued: from the dearest down, each so much less
_PRICES, _STEP = 16, 1.6


def aisle_heights(grid: PlantGrid) -> Float:
    """Return where across the plot each aisle lies, ``(a,)`` metres."""
    up = np.zeros(int(grid.corridor.max()) + 1)
    up[grid.corridor] = grid.lane_y_m
    return up


def even_sections(grid: PlantGrid, shares: Float) -> Int:
    """Return who has each aisle, ``(a,)``: beside each other, plants as `shares` ``(m,)`` say.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.plot.layout import rectangle
    >>> even_sections(rectangle(6, 10), np.ones(2)).tolist()
    [0, 0, 0, 1, 1, 1]
    """
    return sections_of(grid, np.bincount(grid.corridor[grid.row]).astype(np.float64), shares)


def sections_of(grid: PlantGrid, work: Float, shares: Float) -> Int:
    """Return who has each aisle, ``(a,)``: beside each other, work ``(a,)`` as `shares` say."""
    return _cut(work, shares, np.argsort(aisle_heights(grid), kind="stable"))


def _cut(work: Float, shares: Float, order: Int) -> Int:
    """Return sections of aisles in order, so that the work ``(a,)`` in each is as its share."""
    section = np.zeros(len(work), np.int64)
    done = np.cumsum(work[order]) - work[order] / 2
    until = np.cumsum(shares) / shares.sum()
    section[order] = np.searchsorted(until[:-1], done / max(work.sum(), 1e-12), "right")
    return section


class AisleWorth(NamedTuple):
    """What each aisle holds for each of a team, at falling prices of a second.

    Parameters
    ----------
    price
        ``(p,)`` finds a second.
    net, seconds
        ``(p, m, a)`` finds beyond what their seconds cost, and those seconds, of the best drive
        in each aisle alone.
    """

    price: Float
    net: Float
    seconds: Float

    def __repr__(self) -> str:
        return f"<AisleWorth: {counted(self.net.shape[1], 'member')}>"


def aisle_worth(aisles: Aisles, robots: Sequence[Robot], chance: Float) -> AisleWorth:
    """Return what aisles hold, by the chance ``(n,)`` of each plant: 0 where none may go.

    Ways between aisles cost a change of aisle and no more: it is a measure to share out by, not
    a plan.
    """
    travel, grid = aisles.travel, aisles.grid
    dearest = max(robot.detects / robot.visit_s for robot in robots) * float(chance.max())
    price = np.array([max(dearest, 1e-12) / _STEP**k for k in range(1, _PRICES + 1)])
    n_aisles, lanes = int(grid.corridor.max()) + 1, (grid.corridor, ~grid.cut_ends)
    made: dict[tuple[object, ...], tuple[Float, Float]] = {}
    for robot in robots:
        clock = robot_clock(robot, robot.day_s)
        key = (*clock, robot.detects)
        if key not in made:
            net, seconds = np.zeros((2, _PRICES, n_aisles))
            for p in range(_PRICES):
                finds = chance * robot.detects
                _value(travel, lanes, clock, finds, price[p], (net[p], seconds[p]))
            made[key] = net, seconds
    keys = [(*robot_clock(robot, robot.day_s), robot.detects) for robot in robots]
    net = np.stack([made[key][0] for key in keys], axis=1)
    return AisleWorth(price, net, np.stack([made[key][1] for key in keys], axis=1))


def worth_together(worth: AisleWorth, section: Int, left_s: Float) -> float:
    """Return about how many finds a team expects with its aisles given out so ``(a,)``.

    `left_s` ``(m,)`` are the seconds of each. By the price of time, as in
    `fieldmon.planning.routes`.
    """
    members = np.arange(worth.net.shape[1])
    own = section[None, :] == members[:, None]
    held = (worth.net * own).sum(axis=2) + worth.price[:, None] * np.maximum(left_s, 0.0)
    return float(held.min(axis=0).sum())


def best_sections(worth: AisleWorth, heights: Float, left_s: Float, up: Int) -> Int:
    """Return who has each aisle, ``(a,)``: beside each other, each with work for its seconds.

    Work is what pays at a price of a second; of the prices at which all are about busy that one
    counts whose sections hold most. `up` ``(m,)`` is the order of members across the plot.
    """
    demand = worth.seconds.mean(axis=1).sum(axis=1)
    left_s = np.maximum(left_s, 0.0)
    # prices fall, so demand rises; with time for everything the cheapest is left
    busy = min(int(np.searchsorted(demand, left_s.sum())), len(demand) - 1)
    order = np.argsort(heights, kind="stable")
    shares = left_s[up] if left_s.sum() > 0 else np.ones(len(up))
    tried = []
    for p in range(max(busy - 1, 0), min(busy + 2, len(demand))):
        section = up[_cut(worth.seconds[p].mean(axis=0) + 1e-9, shares, order)]
        tried.append((worth_together(worth, section, left_s), -p, section))
    return max(tried, key=lambda each: each[:2])[2]


@loop
def _value(
    travel: TravelTable,
    lanes: tuple[NDArray[np.int32], NDArray[np.bool_]],
    clock: Clock,
    finds: Float,
    price: float,
    worth: tuple[Float, Float],
) -> None:
    """Add up what the best drive in each row gains beyond its seconds, by aisle.

    `lanes` are the aisle of each row ``(r,)``, and by which ends it is entered ``(r, 2)``.
    """
    (aisle, entered), (net, seconds) = lanes, worth
    least = price * clock.visit_s
    for row in range(travel.row_start.size - 1):
        first, end = travel.row_start[row], travel.row_start[row + 1]
        low_m, high_m = travel.end_x_m[row, 0], travel.end_x_m[row, 1]
        best, best_s = 0.0, 0.0
        for from_high in (False, True):
            if not entered[row, int(from_high)]:
                continue
            gains, n = 0.0, 0
            for k in range(end - first):
                i = end - 1 - k if from_high else first + k
                if finds[i] > least:
                    gains += finds[i]
                    n += 1
                    deep_m = high_m - travel.x_m[i] if from_high else travel.x_m[i] - low_m
                    spent_s = clock.row_change_s + n * clock.visit_s
                    spent_s += 2.0 * deep_m / clock.speed_m_s
                    if gains - price * spent_s > best:
                        best, best_s = gains - price * spent_s, spent_s
            if n > 0 and not from_high and entered[row, 1]:  # all through
                spent_s = clock.row_change_s + n * clock.visit_s
                spent_s += (high_m - low_m) / clock.speed_m_s
                if gains - price * spent_s > best:
                    best, best_s = gains - price * spent_s, spent_s
        net[aisle[row]] += best
        seconds[aisle[row]] += best_s
