"""Make stops in order fit the hours, and better: all by the plot's own seconds."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_loop, loop
from fieldmon.plot.travel import GATE, travel_s

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.travel import Clock
    from fieldmon.plot.travel_table import TravelTable

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_NOWHERE = -1
_NOTICEABLE_S = 1e-7
_SHORTENED = 20


class Tour(NamedTuple):
    """Stops in order: ``plant[:size[0]]``; ``visited`` ``(n,)``; seconds in ``used[0]``.

    ``more_s``, ``place`` ``(n,)``: what a further stop at each plant would cost, and where.
    """

    plant: Int
    size: Int
    visited: NDArray[np.bool_]
    used: Float
    more_s: Float
    place: Int

    @classmethod
    def of(cls, stops: Int, n: int) -> Tour:
        """Return a tour of the stops, with room for all n plants."""
        plant, visited = np.empty(n + 1, np.int64), np.zeros(n, np.bool_)
        plant[: len(stops)] = stops
        visited[stops] = True
        size = np.array([len(stops)])
        return cls(plant, size, visited, np.zeros(1), np.empty(n), np.empty(n, np.int64))

    @property
    def stops(self) -> Int:
        """Return the plants in order."""
        return self.plant[: self.size[0]].copy()


@loop
def fit(travel: TravelTable, clock: Clock, tour: Tour, reward: Float, least: float) -> float:
    """Shorten the drive, leave out stops until it fits, and fill what is left; return its reward.

    Plants of at most the `least` reward are not considered.
    """
    for _ in range(_SHORTENED):
        _shorten(travel, clock, tour)
        if not _move(travel, clock, tour):
            break
    tour.used[0] = _seconds(travel, clock, tour)
    _leave_out(travel, clock, tour, reward, clock.seconds_left)
    _fill(travel, clock, tour, reward, least)
    return _reward(tour, reward)


@loop
def ruin(travel: TravelTable, clock: Clock, tour: Tour, reward: Float, seconds: float) -> None:
    """Leave out the poorest stops until so many seconds are used at most."""
    tour.used[0] = _seconds(travel, clock, tour)
    _leave_out(travel, clock, tour, reward, seconds)


@inner_loop
def _reward(tour: Tour, reward: Float) -> float:
    total = 0.0
    for k in range(tour.size[0]):
        total += reward[tour.plant[k]]
    return total


@inner_loop
def _leg_s(travel: TravelTable, clock: Clock, tour: Tour, a: int, b: int) -> float:
    """Return the seconds from the a-th to the b-th stop; -1 and one past the last: the gate."""
    n = tour.size[0]
    if b >= n:
        if not clock.returns or a < 0:
            return 0.0
        return travel_s(travel, clock, tour.plant[a], GATE)
    if a < 0:
        return travel_s(travel, clock, GATE, tour.plant[b])
    return travel_s(travel, clock, tour.plant[a], tour.plant[b])


@inner_loop
def _seconds(travel: TravelTable, clock: Clock, tour: Tour) -> float:
    total: float = tour.size[0] * clock.visit_s
    for k in range(tour.size[0] + 1):
        total += _leg_s(travel, clock, tour, k - 1, k)
    return total


@inner_loop
def _leave_out(
    travel: TravelTable, clock: Clock, tour: Tour, reward: Float, seconds: float
) -> None:
    """Leave out stops with the least reward for their time until the rest fits."""
    while tour.used[0] > seconds and tour.size[0] > 0:
        worst, worst_rate, worst_s = 0, np.inf, 0.0
        for k in range(tour.size[0]):
            saved_s = clock.visit_s + _leg_s(travel, clock, tour, k - 1, k)
            saved_s += _leg_s(travel, clock, tour, k, k + 1)
            saved_s -= _leg_s(travel, clock, tour, k - 1, k + 1)
            rate = reward[tour.plant[k]] / max(saved_s, 1e-9)
            if rate < worst_rate:
                worst, worst_rate, worst_s = k, rate, saved_s
        tour.visited[tour.plant[worst]] = False
        for k in range(worst, tour.size[0] - 1):
            tour.plant[k] = tour.plant[k + 1]
        tour.size[0] -= 1
        tour.used[0] -= worst_s
    tour.used[0] = _seconds(travel, clock, tour)


@inner_loop
def _detour_s(travel: TravelTable, clock: Clock, tour: Tour, plant: int, k: int) -> float:
    """Return the seconds that a plant between the stops k - 1 and k adds, itself included."""
    before = tour.plant[k - 1] if k > 0 else GATE
    more_s = clock.visit_s + travel_s(travel, clock, before, plant)
    if k < tour.size[0]:
        more_s += travel_s(travel, clock, plant, tour.plant[k])
    elif clock.returns:
        more_s += travel_s(travel, clock, plant, GATE)
    return more_s - _leg_s(travel, clock, tour, k - 1, k)


@inner_loop
def _find_place(travel: TravelTable, clock: Clock, tour: Tour, plant: int) -> None:
    """Find where a plant costs least: beside stops of its aisle, or between two aisles."""
    tour.more_s[plant] = np.inf
    for k in range(tour.size[0] + 1):
        _try_place(travel, clock, tour, plant, k)


@inner_loop
def _try_place(travel: TravelTable, clock: Clock, tour: Tour, plant: int, k: int) -> None:
    """Note a place for a plant if it costs less there; amid another aisle it hardly ever does."""
    aisle = travel.corridor[travel.row[plant]]
    if 0 < k < tour.size[0]:
        before = travel.corridor[travel.row[tour.plant[k - 1]]]
        after = travel.corridor[travel.row[tour.plant[k]]]
        if before == after and before != aisle:
            return
    more_s = _detour_s(travel, clock, tour, plant, k)
    if more_s < tour.more_s[plant]:
        tour.more_s[plant], tour.place[plant] = more_s, k


@inner_loop
def _fill(  # noqa: C901, PLR0912 - one loop over all
    travel: TravelTable, clock: Clock, tour: Tour, reward: Float, least: float
) -> None:
    """Put in the plants with the most reward for their time as long as they fit."""
    n = reward.size
    for i in range(n):
        if not tour.visited[i] and reward[i] > least:
            _find_place(travel, clock, tour, i)
    while True:
        best, best_rate = _NOWHERE, 0.0
        for i in range(n):
            if tour.visited[i] or reward[i] <= least:
                continue
            if tour.used[0] + tour.more_s[i] > clock.seconds_left:
                continue
            rate = reward[i] / max(tour.more_s[i], 1e-9)
            if rate > best_rate:
                best, best_rate = i, rate
        if best < 0:
            return
        place = tour.place[best]
        for k in range(tour.size[0], place, -1):
            tour.plant[k] = tour.plant[k - 1]
        tour.plant[place] = best
        tour.size[0] += 1
        tour.visited[best] = True
        tour.used[0] = _seconds(travel, clock, tour)
        for i in range(n):
            if tour.visited[i] or reward[i] <= least:
                continue
            if tour.place[i] == place:
                _find_place(travel, clock, tour, i)
                continue
            if tour.place[i] > place:
                tour.place[i] += 1
            for k in range(place, place + 2):
                _try_place(travel, clock, tour, i, k)


@inner_loop
def _shorten(travel: TravelTable, clock: Clock, tour: Tour) -> None:
    """Turn round stretches between changes of aisle as long as that shortens the drive."""
    n = tour.size[0]
    shorter = True
    rounds = 0
    while shorter and rounds < 20:
        shorter = False
        rounds += 1
        for a in range(n):
            if a > 0 and _same_aisle(travel, tour, a - 1, a):
                continue
            for b in range(a, n):
                if b + 1 < n and _same_aisle(travel, tour, b, b + 1):
                    continue
                old_s = _leg_s(travel, clock, tour, a - 1, a) + _leg_s(
                    travel, clock, tour, b, b + 1
                )
                before = tour.plant[a - 1] if a > 0 else GATE
                new_s = travel_s(travel, clock, before, tour.plant[b])
                if b + 1 < n:
                    new_s += travel_s(travel, clock, tour.plant[a], tour.plant[b + 1])
                elif clock.returns:
                    new_s += travel_s(travel, clock, tour.plant[a], GATE)
                if new_s < old_s - _NOTICEABLE_S:
                    _turn(tour, a, b)
                    shorter = True


@inner_loop
def _move(  # noqa: C901 - one loop over all
    travel: TravelTable, clock: Clock, tour: Tour
) -> bool:
    """Move the stops made in one aisle to wherever the drive is shortest; tell if any moved."""
    n, moved, a = tour.size[0], False, 0
    while a < n:
        b = a
        while b + 1 < n and _same_aisle(travel, tour, b, b + 1):
            b += 1
        best_s, place, turned = -_NOTICEABLE_S, _NOWHERE, False
        saved_s = _leg_s(travel, clock, tour, a - 1, a) + _leg_s(travel, clock, tour, b, b + 1)
        saved_s -= _leg_s(travel, clock, tour, a - 1, b + 1)
        for k in range(n + 1):
            if a <= k <= b + 1 or (0 < k < n and _same_aisle(travel, tour, k - 1, k)):
                continue
            for turn in range(2):
                first, last = (
                    (tour.plant[b], tour.plant[a]) if turn else (tour.plant[a], tour.plant[b])
                )
                before = tour.plant[k - 1] if k > 0 else GATE
                more_s = travel_s(travel, clock, before, first)
                if k < n:
                    more_s += travel_s(travel, clock, last, tour.plant[k])
                elif clock.returns:
                    more_s += travel_s(travel, clock, last, GATE)
                more_s -= _leg_s(travel, clock, tour, k - 1, k) + saved_s
                if more_s < best_s:
                    best_s, place, turned = more_s, k, turn == 1
        if place >= 0:
            moved = True
            if turned:
                _turn(tour, a, b)
            # a rotation by three turns
            low, middle, high = (place, a, b) if place < a else (a, b + 1, place - 1)
            _turn(tour, low, middle - 1)
            _turn(tour, middle, high)
            _turn(tour, low, high)
        a = b + 1
    return moved


@inner_loop
def _turn(tour: Tour, low: int, high: int) -> None:
    """Turn a stretch of stops round."""
    while low < high:
        kept = tour.plant[low]
        tour.plant[low], tour.plant[high] = tour.plant[high], kept
        low += 1
        high -= 1


@inner_loop
def _same_aisle(travel: TravelTable, tour: Tour, a: int, b: int) -> bool:
    aisle_a = travel.corridor[travel.row[tour.plant[a]]]
    return bool(aisle_a == travel.corridor[travel.row[tour.plant[b]]])
