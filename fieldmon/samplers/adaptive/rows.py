"""What each way of driving a row comes to, at a price of a second."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inner_inlined, inner_loop
from fieldmon.samplers.adaptive.arrays import BLOCK, LEAST, N_WAYS, NEARLY, NOWHERE

if TYPE_CHECKING:
    from fieldmon.plot.travel import Clock
    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.adaptive.arrays import BeliefArrays, RowTours
    from fieldmon.samplers.base import InspectionTimes

# what a find is worth is never below nothing
_UNKNOWN = -1.0


@inner_inlined
def best_time(times: InspectionTimes, value: float, price: float) -> tuple[float, int]:
    """Return what the best inspection time gains at a price, and which it is.

    `value` is what a find there is expected to be worth.
    """
    best, time = -np.inf, 0
    for k in range(times.stop_s.size):
        gain = times.detects[k] * value - price * times.stop_s[k]
        if gain > best:
            best, time = gain, k
    return best, time


@inner_loop
def value_row(
    travel: TravelTable,
    clock: Clock,
    work: tuple[BeliefArrays, RowTours, InspectionTimes],
    state: tuple[int, float],
) -> None:
    """Work out what each way of driving a row comes to at a price.

    Of neighbours in the row the second counts as it will be after a clean inspection of the first.
    """
    belief, rows, times = work
    row, price = state
    first, end = travel.row_start[row], travel.row_start[row + 1]
    rows.last[row] = NOWHERE
    pays = _pays_from(times, price)
    previous, before, n = NOWHERE, 0, 0
    for block in range(first // BLOCK, (end - 1) // BLOCK + 1):
        if most_in(belief, rows, times, block) < pays:
            continue
        for i in range(max(first, block * BLOCK), min(end, (block + 1) * BLOCK)):
            value = rows.value[i]
            if value < pays:
                continue
            gain, time = best_time(times, value, price)
            if gain > 0.0 and previous == i - 1 and previous >= 0:
                worth = value_after_clean(belief, rows, (i, before), times.detects[before])
                gain, time = best_time(times, worth, price)
            if gain > 0.0:
                rows.gain[first + n], rows.stop_s[first + n] = gain, times.stop_s[time]
                previous, before = i, time
                rows.pays[first + n] = i
                n += 1
    rows.n_pays[row] = n
    if n == 0:
        return
    for way in range(2, N_WAYS):
        _in_and_out(travel, clock, rows, (row, way), price)
    _through(travel, clock, rows, row, price)


@inner_inlined
def _pays_from(times: InspectionTimes, price: float) -> float:
    """Return what a find must be expected to be worth for any inspection to pay; a little less."""
    least = np.inf
    for k in range(times.stop_s.size):
        least = min(least, times.stop_s[k] / times.detects[k])
    return price * least * NEARLY


@inner_inlined
def trusted(belief: BeliefArrays, value: float) -> float:
    """Return what a find is expected to be worth, as plans are made by it."""
    trust = belief.scale[3]
    return float(value if trust == 1.0 else value**trust)


@inner_inlined
def trusted_value(belief: BeliefArrays, i: int) -> float:
    """Return what a find at plant i is expected to be worth, as plans are made by it."""
    return trusted(belief, belief.worth[i] * belief.chance[i])


@inner_inlined
def most_in(belief: BeliefArrays, rows: RowTours, times: InspectionTimes, block: int) -> float:
    """Return the most that a find in a block is expected to be worth; value its plants for that."""
    most = rows.most[block]
    if most < 0.0:
        most = 0.0
        for i in range(block * BLOCK, min((block + 1) * BLOCK, belief.worth.size)):
            rows.value[i] = trusted_value(belief, i)
            most = max(most, rows.value[i])
            for k in range(times.detects.size):
                rows.after_clean[i, k] = _UNKNOWN
        rows.most[block] = most
    return float(most)


@inner_inlined
def mark_changed(travel: TravelTable, rows: RowTours, i: int) -> None:
    """Mark a plant, and the one after it, as ones of which something else is believed."""
    rows.stale[travel.row[i]] = rows.before.stale[travel.row[i]] = True
    rows.most[i // BLOCK] = rows.most[(i + 1) // BLOCK] = -1.0


@inner_inlined
def mark_all_changed(rows: RowTours) -> None:
    """Mark all plants as ones of which something else is believed."""
    rows.stale[:] = rows.before.stale[:] = True
    rows.most[:] = -1.0


@inner_loop
def turn_price(rows: RowTours, price: float, to: float) -> None:
    """Leave what rows come to at a price, and take up what they came to at another, if it is kept.

    Nothing is kept of the first price of a day: rows were valued at prices beside it.
    """
    before, plans = rows.before, rows.before.plans
    kept = before.price[0] == to
    before.price[0] = price if plans[0] > 0 else np.nan
    number = plans[1] if kept else max(plans[0], plans[1]) + 1
    plans[1], plans[0] = plans[0], number
    for row in range(rows.stale.size):
        for way in range(N_WAYS):
            ways = row, way
            net, seconds, last = before.net[ways], before.seconds[ways], before.last[ways]
            before.net[ways], rows.net[ways] = rows.net[ways], net
            before.seconds[ways], rows.seconds[ways] = rows.seconds[ways], seconds
            before.last[ways], rows.last[ways] = rows.last[ways], last
        stale = before.stale[row] or not kept
        before.stale[row], rows.stale[row] = rows.stale[row], stale


@inner_inlined
def value_after_clean(
    belief: BeliefArrays, rows: RowTours, place: tuple[int, int], detects: float
) -> float:
    """Return what a find at plant i is expected to be worth after a clean one before it.

    `place` is i and which of the times, with this detection, the one before it got. It is worked
    out where it is asked for: few plants pay.
    """
    i, time = place
    if rows.after_clean[i, time] == _UNKNOWN:
        value = belief.worth[i] * _after_clean(belief, i, detects)
        rows.after_clean[i, time] = trusted(belief, value)
    return float(rows.after_clean[i, time])


# copied: handing over all of a belief takes longer than this
@inner_inlined
def _after_clean(belief: BeliefArrays, i: int, detects: float) -> float:
    """Return the chance of plant i once the one before it was inspected and seemed clean."""
    p, e = belief.chance[i], belief.pair_before[i]
    if e < 0:
        return float(p)
    q = belief.chance[i - 1]
    c = min(belief.pair_chance[e], p, q)
    return float((p - detects * c) / max(1.0 - detects * q, LEAST))


@inner_loop
def _in_and_out(
    travel: TravelTable, clock: Clock, rows: RowTours, state: tuple[int, int], price: float
) -> None:
    """Value a row that is left by the end it was entered by, as far in as pays best."""
    row, way = state
    entry_m = travel.end_x_m[row, way - 2]
    first, n = travel.row_start[row], rows.n_pays[row]
    best, best_s, last = -np.inf, 0.0, NOWHERE
    gains, inspecting_s = 0.0, 0.0
    for k in range(n):
        place = first + k if way == 2 else first + n - 1 - k
        i = rows.pays[place]
        gains += rows.gain[place]
        inspecting_s += rows.stop_s[place]
        drive_s = 2.0 * abs(travel.x_m[i] - entry_m) / clock.speed_m_s
        net = gains - price * drive_s
        if net > best:
            best, best_s, last = net, drive_s + inspecting_s, i
    rows.net[row, way], rows.seconds[row, way], rows.last[row, way] = best, best_s, last


@inner_loop
def _through(travel: TravelTable, clock: Clock, rows: RowTours, row: int, price: float) -> None:
    """Value a row that is driven from end to end, either way."""
    first, n = travel.row_start[row], rows.n_pays[row]
    gains, inspecting_s = 0.0, 0.0
    for place in range(first, first + n):
        gains += rows.gain[place]
        inspecting_s += rows.stop_s[place]
    drive_s = (travel.end_x_m[row, 1] - travel.end_x_m[row, 0]) / clock.speed_m_s
    for way in range(2):
        rows.net[row, way] = gains - price * drive_s
        rows.seconds[row, way] = drive_s + inspecting_s
        rows.last[row, way] = rows.pays[first + n - 1] if way == 0 else rows.pays[first]
