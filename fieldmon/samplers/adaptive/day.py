"""Adaptive's day: drive, inspect, learn, plan on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inlined, inner_loop, loop
from fieldmon.infestation.calibration_slope import note_inspection, proved_slope
from fieldmon.infestation.chance_bounds import bounded_chance, bounded_pair_chance
from fieldmon.infestation.pairs.clustering import (
    chance_apart,
    clustering_scale,
    leaning,
    scale_clustering,
    update_clusters,
)
from fieldmon.infestation.pairs.pairs import update_neighbourhood
from fieldmon.infestation.tracing.tracing import rescale_traced, trace
from fieldmon.plot.travel import travel_s
from fieldmon.samplers.adaptive.arrays import BLOCK, LEAST, NEARLY, NOWHERE
from fieldmon.samplers.adaptive.replan import first_price, plan_on, row_of
from fieldmon.samplers.adaptive.rows import (
    best_time,
    mark_all_changed,
    mark_changed,
    most_in,
    trusted_value,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Linked
    from fieldmon.plot.travel import Clock
    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.adaptive.arrays import (
        BeliefArrays,
        BestTours,
        OwnRow,
        RowTours,
        Stretch,
        Workspace,
    )
    from fieldmon.samplers.base import InspectionTimes

    Float = NDArray[np.float64]

# how much closer or less close infested plants must stand than thought to think again
_NOTABLE = 0.1
#: how many finds the morning's idea of how many plants are infested is worth (our choice)
LEVEL_FINDS = 3.0
#: as if so many finds had told how many plants are infested: a day whose results are supposed tells
#: nothing more
SETTLED_FINDS = 1e12
# where this share is infested, half of the trust in differences must have been earned; and the
# least that is left (our choice)
_HEAVY, _LEAST_TRUST = 0.1, 1e-3
# all of it, from here on
_NEARLY_ALL = 0.99
# and how much more or less likely jumps must be
_NOTABLE_JUMPS = 0.005
# how much less or more differences must be trusted to think again
_NOTABLE_TRUST = 0.05


@loop
def drive_day(
    travel: TravelTable,
    clock: Clock,
    plants: tuple[Linked, BeliefArrays, NDArray[np.uint8]],
    room: tuple[RowTours, BestTours, InspectionTimes, OwnRow],
    start: tuple[int, float, NDArray[np.bool_]],
    stops: tuple[NDArray[np.int32], Float, NDArray[np.uint8]],
) -> int:
    """Write down the stops of the rest of the day; return how many there are.

    Parameters
    ----------
    plants
        Who stands beside whom, what is believed, and what an inspection would find.
    room
        To plan in, and the inspection times to choose from.
    start
        Where the robot stands, how much more than itself a find is worth, and ``(n,)`` which
        plants were inspected today.
    stops
        Room for plants, seconds on arrival, and which inspection time each gets.
    """
    linked, belief, _ = plants
    rows, tours, times, own_row = room
    at, spares, inspected = start
    _value_finds(linked, belief, inspected, spares)
    work = belief, rows, tours, times, own_row
    now_s, k = 0.0, 0
    price = first_price(travel, clock, work, at)
    while k < stops[0].size:
        _learn_clustering(linked, belief, rows)
        here = (at, price, clock.seconds_left - now_s)
        price, stretch = plan_on(travel, clock, work, here)
        before = k
        while stretch.row >= 0 and k < stops[0].size:
            plant, time = _next_in(travel, (belief, times), stretch, (at, price))
            if plant < 0 or not _fits(travel, clock, (at, plant), times.stop_s[time], now_s):
                break
            move = (at, plant, time, k)
            now_s, found = _inspect(travel, clock, plants, (rows, times), stops, (move, now_s))
            at, k = plant, k + 1
            if found or plant == stretch.last:
                break
        if k == before:
            plant, time = _best_left(travel, clock, work, at, now_s)
            if plant < 0:
                break
            move = (at, plant, time, k)
            now_s, _ = _inspect(travel, clock, plants, (rows, times), stops, (move, now_s))
            at, k = plant, k + 1
    return k


@inner_loop
def _inspect(
    travel: TravelTable,
    clock: Clock,
    plants: tuple[Linked, BeliefArrays, NDArray[np.uint8]],
    work: tuple[RowTours, InspectionTimes],
    stops: tuple[NDArray[np.int32], Float, NDArray[np.uint8]],
    state: tuple[tuple[int, int, int, int], float],
) -> tuple[float, bool]:
    """Write down stop k, at a plant for one of the times, and learn from it.

    Return the time after it, and whether something was found.
    """
    linked, belief, would_find = plants
    rows, times = work
    (at, plant, time, k), now_s = state
    arrive_s = now_s + travel_s(travel, clock, at, plant)
    stops[0][k], stops[1][k], stops[2][k] = plant, arrive_s, time
    found = 0 < would_find[plant] <= time + 1
    _learn(travel, linked, belief, rows, (plant, found, times.detects[time]))
    return arrive_s + times.stop_s[time], found


@inner_loop
def _fits(
    travel: TravelTable, clock: Clock, move: tuple[int, int], stop_s: float, now_s: float
) -> bool:
    """Tell whether a stop of so long fits into the day, way back to the gate included."""
    at, plant = move
    end_s = now_s + travel_s(travel, clock, at, plant) + stop_s
    if clock.returns:
        end_s += travel_s(travel, clock, plant, -1)
    return bool(end_s <= clock.seconds_left)


@inner_loop
def _value_finds(
    linked: Linked, belief: BeliefArrays, inspected: NDArray[np.bool_], spares: float
) -> None:
    """Work out what a find would be worth, and where each plant's pair with the last one stands."""
    chance = belief.chance
    for i in range(chance.size):
        first, end = linked.start[i], linked.start[i + 1]
        clean = 0.0
        for e in range(first, end):
            clean += 1.0 - chance[linked.plant[e]]
            if linked.plant[e] == i - 1:
                belief.pair_before[i] = e
        if not inspected[i]:
            belief.worth[i] = 1.0 + spares * clean / max(end - first, 1)


@inner_loop
def _learn(
    travel: TravelTable,
    linked: Linked,
    belief: BeliefArrays,
    rows: RowTours,
    result: tuple[int, bool, float],
) -> None:
    """Learn from a plant's inspection about those near it: it is worth no second one."""
    i, found, detects = result
    believed = belief.chance, belief.pair_chance
    p = belief.chance[i]
    note_inspection(belief.traces.slope_sums, p, found)
    belief.level[0] += found
    belief.level[1] += detects * p / belief.level[2]
    n = update_neighbourhood(believed, linked, (i, found), (detects, True), belief.near)
    if found:
        _trace(travel, linked, belief, rows, (i, p))
    else:
        belief.traces.unseen[i] *= 1.0 - detects
    update_clusters(
        (belief.morning_chance, belief.morning_pair_chance),
        linked,
        (i, found, detects),
        belief.clusters,
    )
    belief.worth[i] = 0.0
    for t in range(n):
        mark_changed(travel, rows, belief.near.plant[t])


@inner_loop
def _trace(
    travel: TravelTable,
    linked: Linked,
    belief: BeliefArrays,
    rows: RowTours,
    find: tuple[int, float],
) -> None:
    """Look for what a find has infested and came from; `find` is the plant, and its chance."""
    believed, traces = (belief.chance, belief.pair_chance), belief.traces
    n = trace(believed, linked, traces, (*find, belief.scale[1]), belief.raised)
    for t in range(n):
        mark_changed(travel, rows, belief.raised.plant[t])
    traces.unseen[find[0]] = 0.0


@inner_loop
def _learn_clustering(linked: Linked, belief: BeliefArrays, rows: RowTours) -> None:
    """Believe how much infested plants stand together, once it differs enough from what was."""
    _learn_jumps(linked, belief, rows)
    _learn_level(linked, belief, rows)
    _learn_trust(belief, rows)
    scale = clustering_scale(belief.clusters)
    # where finds are not traced, no direction is told from another
    lean = 0.5 if belief.traces.kernel.size == 1 else leaning(belief.clusters.evidence)
    turned = abs(lean - belief.scale[2]) >= _NOTABLE * min(belief.scale[2], 1.0 - belief.scale[2])
    # nothing in common stays nothing: no change is less than a tenth of 0
    if abs(scale - belief.scale[0]) <= _NOTABLE * belief.scale[0] and not turned:
        return
    ratio = scale / max(belief.scale[0], LEAST)
    ratios = ratio * lean / belief.scale[2], ratio * (1.0 - lean) / (1.0 - belief.scale[2])
    scale_clustering((belief.chance, belief.pair_chance), linked, ratios)
    belief.scale[0], belief.scale[2] = scale, lean
    mark_all_changed(rows)


@inner_loop
def _learn_level(linked: Linked, belief: BeliefArrays, rows: RowTours) -> None:
    """Believe in more or fewer infested plants, once finds differ enough from those expected.

    A plan, whose results are supposed, begins so sure of the number that nothing changes.
    """
    level = belief.level[0] / belief.level[1]
    if belief.traces.kernel.size == 1 or abs(level - belief.level[2]) < _NOTABLE * belief.level[2]:
        return
    room = belief.near.after, belief.raised.by
    believed, ratio = (belief.chance, belief.pair_chance), level / belief.level[2]
    times_odds_of_all(believed, linked, ratio, room)
    belief.level[2] = level
    belief.scale[4] = belief.chance.mean()
    mark_all_changed(rows)


@inner_loop
def _learn_trust(belief: BeliefArrays, rows: RowTours) -> None:
    """Rely on differences between plants as far as they have come true, where many are infested."""
    if belief.traces.kernel.size == 1 or belief.level[1] >= SETTLED_FINDS:
        return
    trust = trust_in_differences(belief.scale[4], belief.traces.slope_sums)
    if abs(trust - belief.scale[3]) < _NOTABLE_TRUST:
        return
    belief.scale[3] = trust
    mark_all_changed(rows)


@inlined
def trust_in_differences(share: float, slope_sums: Float) -> float:
    """Return the power of a find's chance and worth by which plans are made.

    Where few are infested a good order may find ten times as much as a sweep. Where many are, it
    finds little more: there differences count as far as they have come true this season, and
    until then the day is a sweep.
    """
    few = 1.0 / (1.0 + (share / _HEAVY) ** 4)
    trust = few + (1.0 - few) * proved_slope(slope_sums)
    return 1.0 if trust > _NEARLY_ALL else float(max(trust, _LEAST_TRUST))


@loop
def times_odds_of_all(
    believed: tuple[Float, Float], linked: Linked, ratio: float, room: tuple[Float, Float]
) -> None:
    """Multiply every plant's odds; what neighbours have in common stays, as a correlation.

    `believed` is ``chance (n,)`` and ``pair_chance (e,)``, changed in place; `room` two arrays of n
    to work in.
    """
    chance, pair_chance = believed
    more, wider = room
    for i in range(chance.size):
        p = chance[i]
        more[i] = times_odds(p, ratio)
        wider[i] = np.sqrt(more[i] * (1.0 - more[i]) / (p * (1.0 - p)))
    for i in range(chance.size):
        for e in range(linked.start[i], linked.start[i + 1]):
            j = linked.plant[e]
            in_common = (pair_chance[e] - chance[i] * chance[j]) * wider[i] * wider[j]
            both = more[i] * more[j] + in_common
            pair_chance[e] = bounded_pair_chance(both, more[i], more[j])
    for i in range(chance.size):
        chance[i] = more[i]


@inlined
def times_odds(chance: float, ratio: float) -> float:
    """Return a chance whose odds are so many times as high."""
    return bounded_chance(chance * ratio / (1.0 - chance + chance * ratio))


@inner_loop
def _learn_jumps(linked: Linked, belief: BeliefArrays, rows: RowTours) -> None:
    """Believe in jumps beyond neighbours, once that differs enough from what was."""
    jumps = chance_apart(belief.clusters.evidence)
    least = max(_NOTABLE * belief.scale[1], _NOTABLE_JUMPS)
    if belief.traces.kernel.size == 1 or abs(jumps - belief.scale[1]) < least:
        return
    believed, ratio = (belief.chance, belief.pair_chance), jumps / belief.scale[1]
    rescale_traced(believed, linked, belief.traces.from_afar, ratio)
    belief.scale[1] = jumps
    mark_all_changed(rows)


@inner_loop
def _next_in(
    travel: TravelTable,
    work: tuple[BeliefArrays, InspectionTimes],
    stretch: Stretch,
    state: tuple[int, float],
) -> tuple[int, int]:
    """Return the next plant of a stretch that is worth its stop, or -1, and the time it gets."""
    belief, times = work
    at, price = state
    up = stretch.first_end == 0
    if at >= 0 and travel.row[at] == stretch.row:
        i = at + 1 if up else at - 1
    elif up:
        i = travel.row_start[stretch.row]
    else:
        i = travel.row_start[stretch.row + 1] - 1
    step = 1 if up else -1
    while (i <= stretch.last) if up else (i >= stretch.last):
        gain, time = best_time(times, trusted_value(belief, i), price)
        if gain > 0.0:
            return int(i), time
        i += step
    return NOWHERE, 0


@inner_loop
def _best_left(
    travel: TravelTable, clock: Clock, work: Workspace, at: int, now_s: float
) -> tuple[int, int]:
    """Return the plant with the most worth for its seconds that still fits into the day, or -1.

    And which inspection time it gets.
    """
    belief, rows, tours, times, _ = work
    quick_s, sharp = times.stop_s[0], times.detects[-1]
    best, best_rate, time = NOWHERE, 0.0, 0
    for row in range(rows.stale.size):
        least_s = _least_s(travel, clock, at, row)
        home_s = min(tours.home_s[row, 0], tours.home_s[row, 1])
        if now_s + least_s + quick_s + home_s > clock.seconds_left:
            continue
        first, end = travel.row_start[row], travel.row_start[row + 1]
        for block in range(first // BLOCK, (end - 1) // BLOCK + 1):
            if sharp * most_in(belief, rows, times, block) <= best_rate * (least_s + quick_s):
                continue
            for i in range(max(first, block * BLOCK), min(end, (block + 1) * BLOCK)):
                worth = rows.value[i]
                if sharp * worth <= best_rate * quick_s:
                    continue
                way_s = travel_s(travel, clock, at, i)
                for k in range(times.stop_s.size):
                    stop_s = times.stop_s[k]
                    rate = times.detects[k] * worth / (way_s + stop_s)
                    if rate > best_rate and _fits(travel, clock, (at, i), stop_s, now_s):
                        best, best_rate, time = i, rate, k
    return best, time


@inner_loop
def _least_s(travel: TravelTable, clock: Clock, at: int, row: int) -> float:
    """Return seconds that it takes at least from a place to any plant of a row."""
    own = row_of(travel, at)
    if own < 0 or travel.corridor[own] == travel.corridor[row]:
        return 0.0
    least_m = np.inf
    for end in range(2):
        for other_end in range(2):
            least_m = min(least_m, travel.between_m[2 * own + end, 2 * row + other_end])
    return float((least_m / clock.speed_m_s + clock.row_change_s) * NEARLY)
