"""The best tours over the rows: from every lane end, how to spend the rest of the day."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.jit import inner_loop, loop
from fieldmon.samplers.adaptive.arrays import N_WAYS, NOWHERE, REACH

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.plot.travel import Clock
    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.adaptive.arrays import BestTours, RowTours

    Float = NDArray[np.float64]


# tours alike but for rounding: the one that begins nearest leaves least for a day cut short
_ALIKE = 1e-9


@loop
def measure_ways(travel: TravelTable, clock: Clock, next_s: Float, home_s: Float) -> None:
    """Find the seconds from every lane end to the next lanes in line, and to the gate.

    In the table of all ways each of them stands far from the last: it is read once a day.
    """
    n_rows, gate = home_s.shape[0], travel.between_m.shape[0] - 1
    for row in range(n_rows):
        for end in range(2):
            here = 2 * row + end
            home_m = travel.between_m[here, gate]
            home_s[row, end] = home_m / clock.speed_m_s if clock.returns else 0.0
            for k in range(2 * REACH):
                other = row + k - REACH if k < REACH else row + k - REACH + 1
                if not 0 <= other < n_rows:
                    continue
                # from REACH rows before to REACH rows after, this one left out
                down, step = (1, row - other - 1) if k < REACH else (0, other - row - 1)
                for other_end in range(2):
                    way_m = travel.between_m[here, 2 * other + other_end]
                    next_s[down, row, end, step, other_end] = way_m / clock.speed_m_s


@inner_loop
def extend_tours(
    clock: Clock,
    rows: RowTours,
    tours: BestTours,
    state: tuple[int, int, float],
) -> None:
    """Find the best rest of the day from every lane end, row after row up or down the plot."""
    down, own, price = state
    n_rows = rows.stale.size
    for place in range(n_rows):
        row = place if down else n_rows - 1 - place
        for end in range(2):
            _best_after(tours, (down, row, end), price)
        for end in range(2):
            tours.net[down, row, end] = tours.left_net[down, row, end]
            tours.seconds[down, row, end] = tours.left_seconds[down, row, end]
            tours.way[down, row, end] = NOWHERE
            if row == own:
                continue
            for way in range(end, N_WAYS, 2):
                if rows.last[row, way] < 0:
                    continue
                out = 1 - end if way < 2 else end
                net = rows.net[row, way] + tours.left_net[down, row, out]
                net -= price * clock.row_change_s
                if net > tours.net[down, row, end]:
                    tours.net[down, row, end] = net
                    tours.seconds[down, row, end] = (
                        clock.row_change_s
                        + rows.seconds[row, way]
                        + tours.left_seconds[down, row, out]
                    )
                    tours.way[down, row, end] = way


@inner_loop
def _best_after(tours: BestTours, place: tuple[int, int, int], price: float) -> None:
    """Find the best rest of the day after a row: home, or to one of the next rows in line."""
    down, row, end = place
    n_rows = tours.net.shape[1]
    best_s = tours.home_s[row, end]
    best, to = -price * best_s, NOWHERE
    for k in range(REACH):
        other = row - 1 - k if down else row + 1 + k
        if not 0 <= other < n_rows:
            break
        for other_end in range(2):
            way_s = tours.next_s[down, row, end, k, other_end]
            net = tours.net[down, other, other_end] - price * way_s
            if net > best:
                best, to = net, 2 * other + other_end
                best_s = way_s + tours.seconds[down, other, other_end]
    tours.left_net[down, row, end], tours.left_seconds[down, row, end] = best, best_s
    tours.to[down, row, end] = to


@inner_loop
def best_from(
    travel: TravelTable, clock: Clock, tours: BestTours, here: int, price: float
) -> tuple[float, float, tuple[int, int, int]]:
    """Return the best way on from a lane end or the gate: its net, seconds, and where to."""
    gate = travel.between_m.shape[0] - 1
    best_s = travel.between_m[here, gate] / clock.speed_m_s if clock.returns else 0.0
    best, onto = -price * best_s, (0, NOWHERE, 0)
    first_s = best_s
    for row in range(tours.net.shape[1]):
        for end in range(2):
            if tours.way[0, row, end] < 0 and tours.way[1, row, end] < 0:
                continue
            way_s = travel.between_m[here, 2 * row + end] / clock.speed_m_s
            for down in range(2):
                if tours.way[down, row, end] < 0:
                    continue
                net = tours.net[down, row, end] - price * way_s
                least = _ALIKE * abs(best)
                if net > best + least or (net > best - least and way_s < first_s):
                    best, onto, first_s = net, (down, row, end), way_s
                    best_s = way_s + tours.seconds[down, row, end]
    return best, best_s, onto
