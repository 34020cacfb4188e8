"""The price of a second that fills the day, and the plan at it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inner_loop
from fieldmon.samplers.adaptive.arrays import BLOCK, LEAST, NOWHERE, Stretch
from fieldmon.samplers.adaptive.rows import most_in, turn_price, value_row
from fieldmon.samplers.adaptive.tours import best_from, extend_tours

if TYPE_CHECKING:
    from fieldmon.plot.travel import Clock
    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.adaptive.arrays import BestTours, OwnRow, RowTours, Workspace

# the price moves in steps of a tenth, and stays while the plan fills this much of the hours left
_STEP, _FULL, _TRIES = 1.1, 0.9, 2
_BISECTIONS, _CLOSE = 24, 1.04


@inner_loop
def first_price(
    travel: TravelTable,
    clock: Clock,
    work: Workspace,
    at: int,
) -> float:
    """Return the price of a second at which the plan just fills the day."""
    belief, rows, times = work[0], work[1], work[3]
    most, high = LEAST, 0.0
    for block in range((belief.worth.size - 1) // BLOCK + 1):
        most = max(most, most_in(belief, rows, times, block))
    for k in range(times.stop_s.size):
        high = max(high, times.detects[k] * most / times.stop_s[k])
    low = high * 1e-7
    if _plan_at(travel, clock, work, (at, low)).seconds <= clock.seconds_left:
        return low
    for _ in range(_BISECTIONS):
        middle = np.sqrt(low * high)
        if _plan_at(travel, clock, work, (at, middle)).seconds > clock.seconds_left:
            low = middle
        else:
            high = middle
        if high < _CLOSE * low:
            break
    return float(high)


@inner_loop
def plan_on(
    travel: TravelTable,
    clock: Clock,
    work: Workspace,
    state: tuple[int, float, float],
) -> tuple[float, Stretch]:
    """Return the price that suits the seconds left, a few steps from the last, and the plan."""
    at, price, left_s = state
    rows = work[1]
    trend = 0
    stretch = _replan(travel, clock, work, (at, price))
    for _ in range(_TRIES):
        if stretch.seconds > left_s and trend >= 0:
            trend, to = 1, price * _STEP
        elif stretch.seconds < _FULL * left_s and trend <= 0:
            trend, to = -1, price / _STEP
        else:
            break
        turn_price(rows, price, to)
        price = to
        stretch = _replan(travel, clock, work, (at, price))
    return price, stretch


@inner_loop
def row_of(travel: TravelTable, at: int) -> int:
    """Return the row of a plant, -1 for the gate; of one integer type, as numba wants it."""
    return 0 + travel.row[at] if at >= 0 else NOWHERE


@inner_loop
def _plan_at(
    travel: TravelTable,
    clock: Clock,
    work: Workspace,
    state: tuple[int, float],
) -> Stretch:
    work[1].stale[:] = True
    return _replan(travel, clock, work, state)


@inner_loop
def _replan(
    travel: TravelTable,
    clock: Clock,
    work: Workspace,
    state: tuple[int, float],
) -> Stretch:
    """Return the first stretch of the best plan at a price."""
    belief, rows, tours, times, _ = work
    at, price = state
    own = row_of(travel, at)
    for row in range(rows.stale.size):
        # only of its own row the robot asks which plants pay
        if rows.stale[row] or (row == own and rows.pays_of[row] != rows.before.plans[0]):
            value_row(travel, clock, (belief, rows, times), (row, price))
            rows.stale[row], rows.pays_of[row] = False, rows.before.plans[0]
    for down in range(2):
        extend_tours(clock, rows, tours, (down, own, price))
    if at < 0:
        _, seconds, onto = best_from(travel, clock, tours, 2 * (rows.stale.size), price)
        return _first_stretch(rows, tours, onto, seconds)
    return _from_row(travel, clock, work, at, price)


@inner_loop
def _first_stretch(
    rows: RowTours, tours: BestTours, onto: tuple[int, int, int], seconds: float
) -> Stretch:
    down, row, end = onto
    if row < 0:
        return Stretch(NOWHERE, 0, NOWHERE, seconds)
    way = tours.way[down, row, end]
    return Stretch(row, end, rows.last[row, way], seconds)


@inner_loop
def _from_row(travel: TravelTable, clock: Clock, work: Workspace, at: int, price: float) -> Stretch:
    """Return the first stretch of the best plan from the middle of a row.

    The row is left by either end, with the plants that way; before that, plants the other way
    are fetched as far as they pay.
    """
    _, rows, tours, _, own_row = work
    row = row_of(travel, at)
    for end in range(2):
        _along(travel, clock, rows, own_row, (at, end, price))
    best = -np.inf
    stretch = Stretch(NOWHERE, 0, NOWHERE, 0.0)
    for end in range(2):
        net, seconds, onto = best_from(travel, clock, tours, 2 * row + end, price)
        net += own_row.ahead[end] + own_row.fetch[1 - end]
        seconds += own_row.ahead_s[end] + own_row.fetch_s[1 - end]
        if net <= best:
            continue
        best = net
        if own_row.turn[1 - end] >= 0:
            stretch = Stretch(row, end, own_row.turn[1 - end], seconds)
        elif own_row.last[end] >= 0:
            stretch = Stretch(row, 1 - end, own_row.last[end], seconds)
        else:
            stretch = _first_stretch(rows, tours, onto, seconds)
    return stretch


@inner_loop
def _along(
    travel: TravelTable,
    clock: Clock,
    rows: RowTours,
    own_row: OwnRow,
    state: tuple[int, int, float],
) -> None:
    """Value one direction along a row: all the way out, and there and back as far as it pays."""
    at, end, price = state
    row = row_of(travel, at)
    first, n = travel.row_start[row], rows.n_pays[row]
    gains, inspecting_s, farthest = 0.0, 0.0, NOWHERE
    own_row.fetch[end], own_row.fetch_s[end], own_row.turn[end] = 0.0, 0.0, NOWHERE
    step = -1 if end == 0 else 1
    place = first + np.searchsorted(rows.pays[first : first + n], at)
    if end == 0 or (place < first + n and rows.pays[place] == at):
        place += step
    while first <= place < first + n:
        i = rows.pays[place]
        gains += rows.gain[place]
        inspecting_s += rows.stop_s[place]
        farthest = i
        way_s = 2.0 * abs(travel.x_m[i] - travel.x_m[at]) / clock.speed_m_s
        if gains - price * way_s > own_row.fetch[end]:
            own_row.fetch[end], own_row.turn[end] = gains - price * way_s, i
            own_row.fetch_s[end] = way_s + inspecting_s
        place += step
    out_s = abs(travel.end_x_m[row, end] - travel.x_m[at]) / clock.speed_m_s
    own_row.ahead[end], own_row.ahead_s[end] = gains - price * out_s, out_s + inspecting_s
    own_row.last[end] = farthest
