"""Adaptive: the drive that is expected to find most in the hours left, planned anew after a find.

The hours have a price: a plant is worth its stop, and a row its drive, only if what is expected
there is worth more than the seconds cost; and of several looks it gets the one that is worth most
more than it costs. The price is set so that the day is just filled. At a given price the best
drive through the rows, one after the other up or down the plot, is found by dynamic programming:
each row is passed by, driven through, or entered and left by the same end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from fieldmon.compute.jit import inlined, loop, part
from fieldmon.errors import SettingError
from fieldmon.infestation.clustering import (
    ClusterEstimate,
    clustering_scale,
    scale_clustering,
    update_clusters,
)
from fieldmon.infestation.pairs import Neighbourhood, pair_chances, update_neighbourhood
from fieldmon.plot.travel import Clock, travel_s
from fieldmon.samplers.base import InspectionTimes, Sampler, Scene, Stops

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Linked
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import TravelTable
    from fieldmon.samplers.base import WouldFind

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# a row is left for one of the next six in line: on plots with holes the next is not the nearest
_REACH = 6
# ways of driving a row: 0 from the low end through, 1 from the high end through, 2 and 3 in and out
_WAYS = 4
_LEAST = 1e-6
_NOWHERE = -1
# the price moves in steps of a tenth, and stays while the plan fills this much of the hours left
_STEP, _FULL, _TRIES = 1.1, 0.9, 2
_BISECTIONS = 24
# how much closer or less close infested plants must stand than thought to think again
_NOTABLE = 0.1
# plants in line that are looked at together: do any of them pay?
_BLOCK = 32
# a bound stays one however its sum is rounded
_NEARLY = 1.0 - 1e-9


class _BeliefArrays(NamedTuple):
    """What is believed during the day.

    `worth` is of a find, 0 once inspected; `behind` is where in `pair_chance` each plant
    stands with the one before it in its row, -1 if there is none. `dawn_...`: before the first
    look; `company` is what the looks since say of it, and `scale` ``(1,)`` what was made of that.
    """

    chance: Float
    pair_chance: Float
    worth: Float
    near: Neighbourhood
    behind: Int
    dawn_chance: Float
    dawn_both: Float
    company: ClusterEstimate
    scale: Float


class _Rows(NamedTuple):
    """What each way of driving each row comes to, ``(r, 4)``.

    And the plants of each row that are worth their stop at the price, ``n_pays (r,)`` of them
    from where the row starts in `pays`, with what each gains and the seconds of its look,
    ``(n,)``; `most` is the most that a find in each `_BLOCK` of plants in line is expected to be
    worth, -1 where that has changed.
    """

    net: Float
    seconds: Float
    last: Int
    stale: NDArray[np.bool_]
    n_pays: Int
    pays: NDArray[np.int32]
    gain: Float
    stop_s: Float
    most: Float

    @classmethod
    def of(cls, n: int, n_rows: int) -> _Rows:
        """Return room for so many plants and rows."""
        ways = n_rows, _WAYS
        last, stale = np.full(ways, _NOWHERE), np.ones(n_rows, np.bool_)
        n_pays, pays = np.zeros(n_rows, np.int64), np.empty(n, np.int32)
        most = np.full(n // _BLOCK + 1, -1.0)
        room = np.empty(n), np.empty(n)
        return cls(np.zeros(ways), np.zeros(ways), last, stale, n_pays, pays, *room, most)


class _BestTours(NamedTuple):
    """The best rest of the day from a lane end, going up (0) or down (1) the plot, ``(2, r, 2)``.

    ``way`` is how the row is driven, or -1 where it is passed by; ``to`` the lane end
    (2 row + end) after it, or -1 for home. ``left_...``: the same once the row is done.
    ``next_s`` ``(2, r, 2, 6, 2)`` are the seconds to the ends of the next lanes in line, and
    ``home_s`` ``(r, 2)`` those to the gate.
    """

    net: Float
    seconds: Float
    way: Int
    left_net: Float
    left_seconds: Float
    to: Int
    next_s: Float
    home_s: Float

    @classmethod
    def of(cls, n_rows: int) -> _BestTours:
        """Return room for so many rows."""
        net, seconds, left_net, left_seconds = np.zeros((4, 2, n_rows, 2))
        way, to = np.full((2, 2, n_rows, 2), _NOWHERE)
        next_s, home_s = np.empty((2, n_rows, 2, _REACH, 2)), np.empty((n_rows, 2))
        return cls(net, seconds, way, left_net, left_seconds, to, next_s, home_s)


class _Either(NamedTuple):
    """What each direction along the robot's own row comes to, ``(2,)``: while finding a piece."""

    ahead: Float
    ahead_s: Float
    fetch: Float
    fetch_s: Float
    last: Int
    turn: Int

    @classmethod
    def blank(cls) -> _Either:
        """Return room."""
        none = np.full(2, _NOWHERE)
        return cls(np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2), none, none.copy())


class _Piece(NamedTuple):
    """The first piece of a plan: plants of one row up to `last`; what the plan comes to."""

    row: int
    first_end: int
    last: int
    seconds: float


_Work: TypeAlias = tuple[_BeliefArrays, _Rows, _BestTours, InspectionTimes, _Either]


@dataclass(frozen=True)
class Adaptive(Sampler):
    """Take the drive through the rows with the most expected finds for its time.

    A plant is worth its chance of infestation times the chance of detection, and more where a
    find would save plants beside it. A find raises the plants beside it, a clean look lowers
    them, as far as the belief says that they share their fate; then the rest of the day is
    planned again from where the robot stands. Where the map is flat the drive is a plain sweep.

    Parameters
    ----------
    spares
        How much more than itself a find is worth where all plants beside it are clean.
    beside_find
        Chance that a plant next to a find is infested, where the belief says nothing of pairs.
    chooses_time
        Whether it decides at each plant how long to look, by the robot's table of viewpoints;
        if not, it looks as long as the robot is set to.
    """

    spares: float = 0.5
    beside_find: float = 0.5
    chooses_time: bool = False

    def __post_init__(self) -> None:
        if not 0.0 <= self.spares < np.inf:
            raise SettingError(f"Adaptive's spares must be 0 or more, but it is {self.spares}.")
        if not 0.0 <= self.beside_find <= 1.0:
            raise SettingError(
                f"Adaptive's beside_find must be a chance in 0..1, but it is {self.beside_find}."
            )

    def inspection_times(self, robot: Robot) -> InspectionTimes:
        """Return the times to choose from; raise `SettingError` if the robot's table is unknown."""
        if not self.chooses_time:
            return super().inspection_times(robot)
        if robot.detection is not None:
            raise SettingError(
                "A robot must state what each time of looking detects (viewpoints) if the sampler "
                f"is to choose, but its detection is given outright ({robot.detection})."
            )
        seconds, detects = np.array(robot.viewpoints.steps).T
        return InspectionTimes(robot.stop_s + seconds, detects)

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the rest of the day."""
        looks = self.inspection_times(scene.robot)
        stops = scene.room(float(looks.stop_s[0]))
        taken = np.zeros(len(stops.plant), np.uint8)
        pair_chance = scene.pair_chance
        if pair_chance is None:
            pair_chance = pair_chances(scene.chance, scene.grid, self.beside_find)
        n, n_rows = len(scene.chance), scene.grid.n_rows
        mind = _BeliefArrays(
            np.maximum(scene.chance, _LEAST),
            pair_chance.copy(),
            np.zeros(n),
            Neighbourhood.of(n),
            np.full(n, _NOWHERE),
            np.maximum(scene.chance, _LEAST),
            pair_chance.copy(),
            ClusterEstimate.none(n),
            np.ones(1),
        )
        onward = _BestTours.of(n_rows)
        _measure(scene.aisles.travel, scene.clock, onward.next_s, onward.home_s)
        k = _walk(
            scene.aisles.travel,
            scene.clock,
            (scene.grid.linked, mind, would_find.view(np.uint8)),
            (_Rows.of(n, n_rows), onward, looks, _Either.blank()),
            (scene.at, self.spares, scene.last_inspected == scene.day),
            (stops.plant, stops.arrive_s, taken),
        )
        return Stops(stops.plant[:k], stops.arrive_s[:k], taken[:k])


@loop
def _walk(
    travel: TravelTable,
    clock: Clock,
    plants: tuple[Linked, _BeliefArrays, NDArray[np.uint8]],
    room: tuple[_Rows, _BestTours, InspectionTimes, _Either],
    start: tuple[int, float, NDArray[np.bool_]],
    stops: tuple[NDArray[np.int32], Float, NDArray[np.uint8]],
) -> int:
    linked, mind, would_find = plants
    rows, onward, looks, either = room
    at, spares, closed = start
    plant_at, _, look_at = stops
    _worths(linked, mind, closed, spares)
    work = mind, rows, onward, looks, either
    now_s, k = 0.0, 0
    price = _first_price(travel, clock, work, at)
    while k < plant_at.size:
        _regroup(linked, mind, rows)
        here = (at, price, clock.seconds_left - now_s)
        price, piece = _plan_on(travel, clock, work, here)
        before = k
        while piece.row >= 0 and k < plant_at.size:
            plant, look = _next_in(travel, (mind, looks), piece, (at, price))
            if plant < 0 or not _fits(travel, clock, (at, plant), looks.stop_s[look], now_s):
                break
            now_s = _visit(travel, clock, stops, (at, plant, k), (now_s, looks.stop_s[look]))
            look_at[k], at, k = look, plant, k + 1
            found = 0 < would_find[plant] <= look + 1
            _look(travel, linked, mind, rows, (plant, found, looks.detects[look]))
            if found or plant == piece.last:
                break
        if k == before:
            plant, look = _best_left(travel, clock, work, at, now_s)
            if plant < 0:
                break
            now_s = _visit(travel, clock, stops, (at, plant, k), (now_s, looks.stop_s[look]))
            look_at[k], at, k = look, plant, k + 1
            found = 0 < would_find[plant] <= look + 1
            _look(travel, linked, mind, rows, (plant, found, looks.detects[look]))
    return k


@part
def _visit(
    travel: TravelTable,
    clock: Clock,
    stops: tuple[NDArray[np.int32], Float, NDArray[np.uint8]],
    move: tuple[int, int, int],
    times: tuple[float, float],
) -> float:
    """Write down a stop; return the time after it."""
    at, plant, k = move
    now_s, stop_s = times
    arrive_s = now_s + travel_s(travel, clock, at, plant)
    stops[0][k], stops[1][k] = plant, arrive_s
    return arrive_s + stop_s


@part
def _fits(
    travel: TravelTable, clock: Clock, move: tuple[int, int], stop_s: float, now_s: float
) -> bool:
    """Tell whether a stop of so long fits into the day, way back to the gate included."""
    at, plant = move
    end_s = now_s + travel_s(travel, clock, at, plant) + stop_s
    if clock.returns:
        end_s += travel_s(travel, clock, plant, -1)
    return bool(end_s <= clock.seconds_left)


@inlined
def _best_look(
    looks: InspectionTimes, worth: float, chance: float, price: float
) -> tuple[float, int]:
    """Return what the best look gains at a price, and which it is."""
    best, look = -np.inf, 0
    for k in range(looks.stop_s.size):
        gain = looks.detects[k] * worth * chance - price * looks.stop_s[k]
        if gain > best:
            best, look = gain, k
    return best, look


@part
def _worths(linked: Linked, mind: _BeliefArrays, closed: NDArray[np.bool_], spares: float) -> None:
    """Work out what a find would be worth, and where each plant's pair with the last one stands."""
    chance = mind.chance
    for i in range(chance.size):
        first, end = linked.start[i], linked.start[i + 1]
        clean = 0.0
        for e in range(first, end):
            clean += 1.0 - chance[linked.plant[e]]
            if linked.plant[e] == i - 1:
                mind.behind[i] = e
        if not closed[i]:
            mind.worth[i] = 1.0 + spares * clean / max(end - first, 1)


@loop
def _measure(travel: TravelTable, clock: Clock, next_s: Float, home_s: Float) -> None:
    """Find the seconds from every lane end to the next lanes in line, and to the gate.

    In the table of all ways each of them stands far from the last: it is read once a day.
    """
    n_rows, gate = home_s.shape[0], travel.between_m.shape[0] - 1
    for row in range(n_rows):
        for end in range(2):
            here = 2 * row + end
            home_m = travel.between_m[here, gate]
            home_s[row, end] = home_m / clock.speed_m_s if clock.returns else 0.0
            for k in range(2 * _REACH):
                other = row + k - _REACH if k < _REACH else row + k - _REACH + 1
                if not 0 <= other < n_rows:
                    continue
                # from _REACH rows before to _REACH rows after, this one left out
                down, step = (1, row - other - 1) if k < _REACH else (0, other - row - 1)
                for other_end in range(2):
                    way_m = travel.between_m[here, 2 * other + other_end]
                    next_s[down, row, end, step, other_end] = way_m / clock.speed_m_s


@part
def _look(
    travel: TravelTable,
    linked: Linked,
    mind: _BeliefArrays,
    rows: _Rows,
    result: tuple[int, bool, float],
) -> None:
    """Close a plant and let what was seen teach about those near it."""
    i, found, detects = result
    believed = mind.chance, mind.pair_chance
    n = update_neighbourhood(believed, linked, (i, found), (detects, True), mind.near)
    update_clusters((mind.dawn_chance, mind.dawn_both), linked, (i, found, detects), mind.company)
    mind.worth[i] = 0.0
    for t in range(n):
        near_it = mind.near.plant[t]
        rows.stale[travel.row[near_it]], rows.most[near_it // _BLOCK] = True, -1.0


@part
def _regroup(linked: Linked, mind: _BeliefArrays, rows: _Rows) -> None:
    """Take to heart how much infested plants stand together, once it differs enough."""
    scale = clustering_scale(mind.company)
    if abs(scale - mind.scale[0]) < _NOTABLE * mind.scale[0]:
        return
    scale_clustering((mind.chance, mind.pair_chance), linked, scale / max(mind.scale[0], _LEAST))
    mind.scale[0] = scale
    rows.stale[:] = True


@part
def _next_in(
    travel: TravelTable,
    work: tuple[_BeliefArrays, InspectionTimes],
    piece: _Piece,
    state: tuple[int, float],
) -> tuple[int, int]:
    """Return the next plant of a piece that is worth its stop and the look it gets, or -1, 0."""
    mind, looks = work
    at, price = state
    up = piece.first_end == 0
    if at >= 0 and travel.row[at] == piece.row:
        i = at + 1 if up else at - 1
    elif up:
        i = travel.row_start[piece.row]
    else:
        i = travel.row_start[piece.row + 1] - 1
    step = 1 if up else -1
    while (i <= piece.last) if up else (i >= piece.last):
        gain, taken = _best_look(looks, mind.worth[i], mind.chance[i], price)
        if gain > 0.0:
            return int(i), taken
        i += step
    return _NOWHERE, 0


@part
def _best_left(
    travel: TravelTable, clock: Clock, work: _Work, at: int, now_s: float
) -> tuple[int, int]:
    """Return the plant with the most worth for its time that still fits into the day, or -1.

    And the look it gets.
    """
    mind, rows, onward, looks, _ = work
    quick_s, sharp = looks.stop_s[0], looks.detects[-1]
    best, best_rate, taken = _NOWHERE, 0.0, 0
    for row in range(rows.stale.size):
        least_s = _least_s(travel, clock, at, row)
        home_s = min(onward.home_s[row, 0], onward.home_s[row, 1])
        if now_s + least_s + quick_s + home_s > clock.seconds_left:
            continue
        first, end = travel.row_start[row], travel.row_start[row + 1]
        for block in range(first // _BLOCK, (end - 1) // _BLOCK + 1):
            if sharp * _most_in(mind, rows, block) <= best_rate * (least_s + quick_s):
                continue
            for i in range(max(first, block * _BLOCK), min(end, (block + 1) * _BLOCK)):
                if sharp * mind.worth[i] * mind.chance[i] <= best_rate * quick_s:
                    continue
                way_s = travel_s(travel, clock, at, i)
                for k in range(looks.stop_s.size):
                    stop_s = looks.stop_s[k]
                    rate = looks.detects[k] * mind.worth[i] * mind.chance[i] / (way_s + stop_s)
                    if rate > best_rate and _fits(travel, clock, (at, i), stop_s, now_s):
                        best, best_rate, taken = i, rate, k
    return best, taken


@part
def _least_s(travel: TravelTable, clock: Clock, at: int, row: int) -> float:
    """Return seconds that it takes at least from a place to any plant of a row."""
    own = _row_of(travel, at)
    if own < 0 or travel.corridor[own] == travel.corridor[row]:
        return 0.0
    least_m = np.inf
    for end in range(2):
        for other_end in range(2):
            least_m = min(least_m, travel.between_m[2 * own + end, 2 * row + other_end])
    return float((least_m / clock.speed_m_s + clock.row_change_s) * _NEARLY)


@part
def _first_price(
    travel: TravelTable,
    clock: Clock,
    work: _Work,
    at: int,
) -> float:
    """Return the price of a second at which the plan just fills the day."""
    mind, looks = work[0], work[3]
    high = 0.0
    for k in range(looks.stop_s.size):
        most = _LEAST
        for i in range(mind.worth.size):
            most = max(most, looks.detects[k] * mind.worth[i] * mind.chance[i])
        high = max(high, most / looks.stop_s[k])
    low = high * 1e-7
    if _plan_at(travel, clock, work, (at, low)).seconds <= clock.seconds_left:
        return low
    for _ in range(_BISECTIONS):
        middle = np.sqrt(low * high)
        if _plan_at(travel, clock, work, (at, middle)).seconds > clock.seconds_left:
            low = middle
        else:
            high = middle
        if high < 1.04 * low:
            break
    return float(high)


@part
def _plan_on(
    travel: TravelTable,
    clock: Clock,
    work: _Work,
    state: tuple[int, float, float],
) -> tuple[float, _Piece]:
    """Return the price that suits the seconds left, a few steps from the last, and the plan."""
    at, price, left_s = state
    rows = work[1]
    trend = 0
    piece = _replan(travel, clock, work, (at, price))
    for _ in range(_TRIES):
        if piece.seconds > left_s and trend >= 0:
            trend, price = 1, price * _STEP
        elif piece.seconds < _FULL * left_s and trend <= 0:
            trend, price = -1, price / _STEP
        else:
            break
        rows.stale[:] = True
        piece = _replan(travel, clock, work, (at, price))
    return price, piece


@part
def _row_of(travel: TravelTable, at: int) -> int:
    """Return the row of a plant, -1 for the gate; of one integer type, as numba wants it."""
    return 0 + travel.row[at] if at >= 0 else _NOWHERE


@part
def _plan_at(
    travel: TravelTable,
    clock: Clock,
    work: _Work,
    state: tuple[int, float],
) -> _Piece:
    work[1].stale[:] = True
    return _replan(travel, clock, work, state)


@part
def _replan(
    travel: TravelTable,
    clock: Clock,
    work: _Work,
    state: tuple[int, float],
) -> _Piece:
    """Return the first piece of the best plan at a price."""
    mind, rows, onward, looks, _ = work
    at, price = state
    own = _row_of(travel, at)
    for row in range(rows.stale.size):
        if rows.stale[row]:
            _value_row(travel, clock, (mind, rows, looks), (row, price))
            rows.stale[row] = False
    for down in range(2):
        _extend(clock, rows, onward, (down, own, price))
    if at < 0:
        _, seconds, onto = _leave(travel, clock, onward, 2 * (rows.stale.size), price)
        return _first_piece(rows, onward, onto, seconds)
    return _from_row(travel, clock, work, at, price)


@part
def _value_row(
    travel: TravelTable,
    clock: Clock,
    work: tuple[_BeliefArrays, _Rows, InspectionTimes],
    state: tuple[int, float],
) -> None:
    """Work out what each way of driving a row comes to at a price.

    Of neighbours in the row the second counts as it will be after a clean look at the first.
    """
    mind, rows, looks = work
    row, price = state
    first, end = travel.row_start[row], travel.row_start[row + 1]
    rows.last[row] = _NOWHERE
    pays = _pays_from(looks, price)
    previous, before, n = _NOWHERE, 0, 0
    for block in range(first // _BLOCK, (end - 1) // _BLOCK + 1):
        if _most_in(mind, rows, block) < pays:
            continue
        for i in range(max(first, block * _BLOCK), min(end, (block + 1) * _BLOCK)):
            if mind.worth[i] * mind.chance[i] < pays:
                continue
            gain, taken = _best_look(looks, mind.worth[i], mind.chance[i], price)
            if gain > 0.0 and previous == i - 1 and previous >= 0:
                chance = _after_clean(mind, i, looks.detects[before])
                gain, taken = _best_look(looks, mind.worth[i], chance, price)
            if gain > 0.0:
                rows.gain[first + n], rows.stop_s[first + n] = gain, looks.stop_s[taken]
                previous, before = i, taken
                rows.pays[first + n] = i
                n += 1
    rows.n_pays[row] = n
    if n == 0:
        return
    for way in range(2, _WAYS):
        _in_and_out(travel, clock, rows, (row, way), price)
    _through(travel, clock, rows, row, price)


@inlined
def _pays_from(looks: InspectionTimes, price: float) -> float:
    """Return what a find must be expected to be worth for any look to pay; a little less."""
    least = np.inf
    for k in range(looks.stop_s.size):
        least = min(least, looks.stop_s[k] / looks.detects[k])
    return price * least * _NEARLY


@inlined
def _most_in(mind: _BeliefArrays, rows: _Rows, block: int) -> float:
    """Return the most that a find in a block is expected to be worth."""
    most = rows.most[block]
    if most < 0.0:
        most = 0.0
        for i in range(block * _BLOCK, min((block + 1) * _BLOCK, mind.worth.size)):
            most = max(most, mind.worth[i] * mind.chance[i])
        rows.most[block] = most
    return float(most)


# copied: handing over all of a mind takes longer than this
@inlined
def _after_clean(mind: _BeliefArrays, i: int, detects: float) -> float:
    """Return the chance of plant i once the one before it was looked at and seemed clean."""
    p, e = mind.chance[i], mind.behind[i]
    if e < 0:
        return float(p)
    q = mind.chance[i - 1]
    c = min(mind.pair_chance[e], p, q)
    return float((p - detects * c) / max(1.0 - detects * q, _LEAST))


@part
def _in_and_out(
    travel: TravelTable, clock: Clock, rows: _Rows, state: tuple[int, int], price: float
) -> None:
    """Value a row that is left by the end it was entered by, as far in as pays best."""
    row, way = state
    entry_m = travel.end_x_m[row, way - 2]
    first, n = travel.row_start[row], rows.n_pays[row]
    best, best_s, last = -np.inf, 0.0, _NOWHERE
    gains, looking_s = 0.0, 0.0
    for k in range(n):
        place = first + k if way == 2 else first + n - 1 - k
        i = rows.pays[place]
        gains += rows.gain[place]
        looking_s += rows.stop_s[place]
        drive_s = 2.0 * abs(travel.x_m[i] - entry_m) / clock.speed_m_s
        net = gains - price * drive_s
        if net > best:
            best, best_s, last = net, drive_s + looking_s, i
    rows.net[row, way], rows.seconds[row, way], rows.last[row, way] = best, best_s, last


@part
def _through(travel: TravelTable, clock: Clock, rows: _Rows, row: int, price: float) -> None:
    """Value a row that is driven from end to end, either way."""
    first, n = travel.row_start[row], rows.n_pays[row]
    gains, looking_s = 0.0, 0.0
    for place in range(first, first + n):
        gains += rows.gain[place]
        looking_s += rows.stop_s[place]
    drive_s = (travel.end_x_m[row, 1] - travel.end_x_m[row, 0]) / clock.speed_m_s
    for way in range(2):
        rows.net[row, way] = gains - price * drive_s
        rows.seconds[row, way] = drive_s + looking_s
        rows.last[row, way] = rows.pays[first + n - 1] if way == 0 else rows.pays[first]


@part
def _extend(
    clock: Clock,
    rows: _Rows,
    onward: _BestTours,
    state: tuple[int, int, float],
) -> None:
    """Find the best rest of the day from every lane end, row after row up or down the plot."""
    down, own, price = state
    n_rows = rows.stale.size
    for place in range(n_rows):
        row = place if down else n_rows - 1 - place
        for end in range(2):
            _after(onward, (down, row, end), price)
        for end in range(2):
            onward.net[down, row, end] = onward.left_net[down, row, end]
            onward.seconds[down, row, end] = onward.left_seconds[down, row, end]
            onward.way[down, row, end] = _NOWHERE
            if row == own:
                continue
            for way in range(end, _WAYS, 2):
                if rows.last[row, way] < 0:
                    continue
                out = 1 - end if way < 2 else end
                net = rows.net[row, way] + onward.left_net[down, row, out]
                net -= price * clock.row_change_s
                if net > onward.net[down, row, end]:
                    onward.net[down, row, end] = net
                    onward.seconds[down, row, end] = (
                        clock.row_change_s
                        + rows.seconds[row, way]
                        + onward.left_seconds[down, row, out]
                    )
                    onward.way[down, row, end] = way


@part
def _after(onward: _BestTours, place: tuple[int, int, int], price: float) -> None:
    """Find the best rest of the day after a row: home, or to one of the next rows in line."""
    down, row, end = place
    n_rows = onward.net.shape[1]
    best_s = onward.home_s[row, end]
    best, to = -price * best_s, _NOWHERE
    for k in range(_REACH):
        other = row - 1 - k if down else row + 1 + k
        if not 0 <= other < n_rows:
            break
        for other_end in range(2):
            way_s = onward.next_s[down, row, end, k, other_end]
            net = onward.net[down, other, other_end] - price * way_s
            if net > best:
                best, to = net, 2 * other + other_end
                best_s = way_s + onward.seconds[down, other, other_end]
    onward.left_net[down, row, end], onward.left_seconds[down, row, end] = best, best_s
    onward.to[down, row, end] = to


@part
def _leave(
    travel: TravelTable, clock: Clock, onward: _BestTours, here: int, price: float
) -> tuple[float, float, tuple[int, int, int]]:
    """Return the best way on from a lane end or the gate: its net, seconds, and where to."""
    gate = travel.between_m.shape[0] - 1
    best_s = travel.between_m[here, gate] / clock.speed_m_s if clock.returns else 0.0
    best, onto = -price * best_s, (0, _NOWHERE, 0)
    for row in range(onward.net.shape[1]):
        for end in range(2):
            if onward.way[0, row, end] < 0 and onward.way[1, row, end] < 0:
                continue
            way_s = travel.between_m[here, 2 * row + end] / clock.speed_m_s
            for down in range(2):
                if onward.way[down, row, end] < 0:
                    continue
                net = onward.net[down, row, end] - price * way_s
                if net > best:
                    best, onto = net, (down, row, end)
                    best_s = way_s + onward.seconds[down, row, end]
    return best, best_s, onto


@part
def _first_piece(
    rows: _Rows, onward: _BestTours, onto: tuple[int, int, int], seconds: float
) -> _Piece:
    down, row, end = onto
    if row < 0:
        return _Piece(_NOWHERE, 0, _NOWHERE, seconds)
    way = onward.way[down, row, end]
    return _Piece(row, end, rows.last[row, way], seconds)


@part
def _from_row(travel: TravelTable, clock: Clock, work: _Work, at: int, price: float) -> _Piece:
    """Return the first piece of the best plan from the middle of a row.

    The row is left by either end, with the plants that way; before that, plants the other way
    are fetched as far as they pay.
    """
    _, rows, onward, _, either = work
    row = _row_of(travel, at)
    for end in range(2):
        _along(travel, clock, rows, either, (at, end, price))
    best = -np.inf
    piece = _Piece(_NOWHERE, 0, _NOWHERE, 0.0)
    for end in range(2):
        net, seconds, onto = _leave(travel, clock, onward, 2 * row + end, price)
        net += either.ahead[end] + either.fetch[1 - end]
        seconds += either.ahead_s[end] + either.fetch_s[1 - end]
        if net <= best:
            continue
        best = net
        if either.turn[1 - end] >= 0:
            piece = _Piece(row, end, either.turn[1 - end], seconds)
        elif either.last[end] >= 0:
            piece = _Piece(row, 1 - end, either.last[end], seconds)
        else:
            piece = _first_piece(rows, onward, onto, seconds)
    return piece


@part
def _along(
    travel: TravelTable, clock: Clock, rows: _Rows, either: _Either, state: tuple[int, int, float]
) -> None:
    """Value one direction along a row: all the way out, and there and back as far as it pays."""
    at, end, price = state
    row = _row_of(travel, at)
    first, n = travel.row_start[row], rows.n_pays[row]
    gains, looking_s, farthest = 0.0, 0.0, _NOWHERE
    either.fetch[end], either.fetch_s[end], either.turn[end] = 0.0, 0.0, _NOWHERE
    step = -1 if end == 0 else 1
    place = first + np.searchsorted(rows.pays[first : first + n], at)
    if end == 0 or (place < first + n and rows.pays[place] == at):
        place += step
    while first <= place < first + n:
        i = rows.pays[place]
        gains += rows.gain[place]
        looking_s += rows.stop_s[place]
        farthest = i
        way_s = 2.0 * abs(travel.x_m[i] - travel.x_m[at]) / clock.speed_m_s
        if gains - price * way_s > either.fetch[end]:
            either.fetch[end], either.turn[end] = gains - price * way_s, i
            either.fetch_s[end] = way_s + looking_s
        place += step
    out_s = abs(travel.end_x_m[row, end] - travel.x_m[at]) / clock.speed_m_s
    either.ahead[end], either.ahead_s[end] = gains - price * out_s, out_s + looking_s
    either.last[end] = farthest
