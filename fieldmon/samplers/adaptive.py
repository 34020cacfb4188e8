"""Adaptive: the drive that is expected to find most in the hours left, planned anew after a find.

The hours have a price: a plant is worth its stop, and a row its drive, only if what is expected
there is worth more than the seconds cost. The price is set so that the day is just filled. At a
given price the best drive through the rows, one after the other up or down the plot, is found by
dynamic programming: each row is passed by, driven through, or entered and left by the same end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.belief import Near, look, near, pairs
from fieldmon.compiled import loop, part
from fieldmon.errors import SettingError
from fieldmon.samplers.scene import Clock, Scene, Stops, can_visit, travel_s

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.aisles import Ground
    from fieldmon.grid import Csr, PlantGrid

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
# plants in line that are looked at together: do any of them pay?
_BLOCK = 32
# a bound stays one however its sum is rounded
_NEARLY = 1.0 - 1e-9


class _Mind(NamedTuple):
    """What is believed during the day.

    `worth` is per chance of infestation, 0 once inspected; `behind` is where in `both` each plant
    stands with the one before it in its row, -1 if there is none.
    """

    chance: Float
    both: Float
    worth: Float
    detects: float
    treats: bool
    near: Near
    behind: Int


class _Rows(NamedTuple):
    """What each way of driving each row comes to, ``(r, 4)``, and each plant's gain ``(n,)``.

    `pays` is room for the plants of one row with a gain, `most` the most that a plant of each
    `_BLOCK` in line is worth, -1 where that has changed.
    """

    net: Float
    seconds: Float
    last: Int
    gain: Float
    stale: NDArray[np.bool_]
    pays: Int
    most: Float


class _Onward(NamedTuple):
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


class _Piece(NamedTuple):
    """The first piece of a plan: plants of one row up to `last`; what the plan comes to."""

    row: int
    first_end: int
    last: int
    seconds: float


class _Along(NamedTuple):
    """What the plants from one on to an end of its row come to, up to the `last` of them.

    ``fetch_...``: the same for going only as far as pays, to `turn`, and back.
    """

    net: float
    seconds: float
    last: int
    fetch_net: float
    fetch_seconds: float
    turn: int


@dataclass(frozen=True)
class Adaptive:
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
    """

    spares: float = 0.5
    beside_find: float = 0.5

    def __post_init__(self) -> None:
        if not 0.0 <= self.spares < np.inf:
            raise SettingError(f"Adaptive's spares must be 0 or more, but it is {self.spares}.")
        if not 0.0 <= self.beside_find <= 1.0:
            raise SettingError(
                f"Adaptive's beside_find must be a chance in 0..1, but it is {self.beside_find}."
            )

    def walk(self, scene: Scene, would_find: NDArray[np.bool_]) -> Stops:
        """Return the stops of the rest of the day."""
        stops, n = scene.blank(), len(scene.chance)
        both = scene.both
        if both is None:
            both = pairs(scene.chance, scene.grid, self.beside_find)
        mind = _Mind(
            np.maximum(scene.chance, _LEAST),
            both.copy(),
            np.zeros(n),
            scene.robot.detects,
            True,
            near(n),
            np.full(n, _NOWHERE),
        )
        closed = scene.last_inspected == scene.day
        _begin(scene.grid.adjacent, scene.chance, closed, self.spares, mind)
        onward = _onward(scene.grid.n_rows)
        _measure(scene.aisles.ground, scene.clock, onward.next_s, onward.home_s)
        k = _walk(
            scene.aisles.ground,
            scene.clock,
            (scene.grid.adjacent, would_find),
            (mind, _rows(scene.grid), onward),
            scene.at,
            stops,
        )
        return Stops(stops.plant[:k], stops.arrive_s[:k])


def _rows(grid: PlantGrid) -> _Rows:
    """Return room for what each way of driving each row comes to; nothing is worked out yet."""
    shape = (grid.n_rows, _WAYS)
    return _Rows(
        np.zeros(shape),
        np.zeros(shape),
        np.full(shape, _NOWHERE),
        np.zeros(len(grid)),
        np.ones(grid.n_rows, np.bool_),
        np.empty(len(grid), np.int64),
        np.full(len(grid) // _BLOCK + 1, -1.0),
    )


def _onward(n_rows: int) -> _Onward:
    """Return room for the best rests of the day."""
    shape = (2, n_rows, 2)
    return _Onward(
        np.zeros(shape),
        np.zeros(shape),
        np.full(shape, _NOWHERE),
        np.zeros(shape),
        np.zeros(shape),
        np.full(shape, _NOWHERE),
        np.empty((*shape, _REACH, 2)),
        np.empty((n_rows, 2)),
    )


@loop
def _walk(
    ground: Ground,
    clock: Clock,
    plants: tuple[Csr, NDArray[np.bool_]],
    work: tuple[_Mind, _Rows, _Onward],
    at: int,
    stops: Stops,
) -> int:
    adjacent, would_find = plants
    mind, rows, _ = work
    now_s, k = 0.0, 0
    price = _first_price(ground, clock, work, at)
    while k < stops.plant.size:
        here = (at, price, clock.seconds_left - now_s)
        price, piece = _plan_on(ground, clock, work, here)
        before = k
        while piece.row >= 0 and k < stops.plant.size:
            plant = _next_in(ground, clock, mind, piece, (at, price))
            if plant < 0 or not can_visit(ground, clock, at, plant, now_s):
                break
            now_s, at, k = _visit(ground, clock, stops, (at, plant, k), now_s)
            _look(ground, adjacent, mind, rows, (plant, would_find[plant]))
            if would_find[plant] or plant == piece.last:
                break
        if k == before:
            plant = _best_left(ground, clock, work, at, now_s)
            if plant < 0:
                break
            now_s, at, k = _visit(ground, clock, stops, (at, plant, k), now_s)
            _look(ground, adjacent, mind, rows, (plant, would_find[plant]))
    return k


@part
def _visit(
    ground: Ground, clock: Clock, stops: Stops, move: tuple[int, int, int], now_s: float
) -> tuple[float, int, int]:
    """Write down a stop; return the time after it, the place, and the number of stops."""
    at, plant, k = move
    arrive_s = now_s + travel_s(ground, clock, at, plant)
    stops.plant[k], stops.arrive_s[k] = plant, arrive_s
    return arrive_s + clock.visit_s, plant, k + 1


@loop
def _begin(
    adjacent: Csr, chance: Float, closed: NDArray[np.bool_], spares: float, mind: _Mind
) -> None:
    """Find what a chance is worth at each plant, and each plant's place beside the one before."""
    for i in range(chance.size):
        first, end = adjacent.start[i], adjacent.start[i + 1]
        clean = 0.0
        for e in range(first, end):
            clean += 1.0 - chance[adjacent.plant[e]]
            if adjacent.plant[e] == i - 1:
                mind.behind[i] = e
        if not closed[i]:
            mind.worth[i] = mind.detects * (1.0 + spares * clean / max(end - first, 1))


@loop
def _measure(ground: Ground, clock: Clock, next_s: Float, home_s: Float) -> None:
    """Find the seconds from every lane end to the next lanes in line, and to the gate.

    In the table of all ways each of them stands far from the last: it is read once a day.
    """
    n_rows, gate = home_s.shape[0], ground.between_m.shape[0] - 1
    for row in range(n_rows):
        for end in range(2):
            here = 2 * row + end
            home_m = ground.between_m[here, gate]
            home_s[row, end] = home_m / clock.speed_m_s if clock.returns else 0.0
            for k in range(2 * _REACH):
                other = row + k - _REACH if k < _REACH else row + k - _REACH + 1
                if not 0 <= other < n_rows:
                    continue
                # from _REACH rows before to _REACH rows after, this one left out
                down, step = (1, row - other - 1) if k < _REACH else (0, other - row - 1)
                for other_end in range(2):
                    way_m = ground.between_m[here, 2 * other + other_end]
                    next_s[down, row, end, step, other_end] = way_m / clock.speed_m_s


@part
def _look(
    ground: Ground,
    adjacent: Csr,
    mind: _Mind,
    rows: _Rows,
    result: tuple[int, bool],
) -> None:
    """Close a plant and let what was seen teach about those near it."""
    i, found = result
    believed = mind.chance, mind.both
    n = look(believed, adjacent, (i, found), (mind.detects, mind.treats), mind.near)
    mind.worth[i] = 0.0
    for t in range(n):
        near_it = mind.near.plant[t]
        rows.stale[ground.row[near_it]], rows.most[near_it // _BLOCK] = True, -1.0


@part
def _next_in(
    ground: Ground, clock: Clock, mind: _Mind, piece: _Piece, state: tuple[int, float]
) -> int:
    """Return the next plant of a piece that is worth its stop, from where the robot is, or -1."""
    at, price = state
    up = piece.first_end == 0
    if at >= 0 and ground.row[at] == piece.row:
        i = at + 1 if up else at - 1
    elif up:
        i = ground.row_start[piece.row]
    else:
        i = ground.row_start[piece.row + 1] - 1
    step = 1 if up else -1
    while (i <= piece.last) if up else (i >= piece.last):
        if mind.worth[i] * mind.chance[i] > price * clock.visit_s:
            return int(i)
        i += step
    return _NOWHERE


@part
def _best_left(
    ground: Ground, clock: Clock, work: tuple[_Mind, _Rows, _Onward], at: int, now_s: float
) -> int:
    """Return the plant with the most worth for its time that still fits into the day, or -1."""
    mind, rows, onward = work
    best, best_rate = _NOWHERE, 0.0
    for row in range(rows.stale.size):
        least_s = _least_s(ground, clock, at, row)
        home_s = min(onward.home_s[row, 0], onward.home_s[row, 1])
        if now_s + least_s + clock.visit_s + home_s > clock.seconds_left:
            continue
        first, end = ground.row_start[row], ground.row_start[row + 1]
        for block in range(first // _BLOCK, (end - 1) // _BLOCK + 1):
            if _most_in(mind, rows, block) <= best_rate * (least_s + clock.visit_s):
                continue
            for i in range(max(first, block * _BLOCK), min(end, (block + 1) * _BLOCK)):
                most = mind.worth[i] * mind.chance[i]
                if most <= best_rate * clock.visit_s:
                    continue
                rate = most / (travel_s(ground, clock, at, i) + clock.visit_s)
                if rate > best_rate and can_visit(ground, clock, at, i, now_s):
                    best, best_rate = i, rate
    return best


@part
def _least_s(ground: Ground, clock: Clock, at: int, row: int) -> float:
    """Return seconds that it takes at least from a place to any plant of a row."""
    own = _row_of(ground, at)
    if own < 0 or ground.corridor[own] == ground.corridor[row]:
        return 0.0
    least_m = np.inf
    for end in range(2):
        for other_end in range(2):
            least_m = min(least_m, ground.between_m[2 * own + end, 2 * row + other_end])
    return float((least_m / clock.speed_m_s + clock.row_change_s) * _NEARLY)


@part
def _first_price(
    ground: Ground,
    clock: Clock,
    work: tuple[_Mind, _Rows, _Onward],
    at: int,
) -> float:
    """Return the price of a second at which the plan just fills the day."""
    mind = work[0]
    high = _LEAST
    for i in range(mind.worth.size):
        high = max(high, mind.worth[i] * mind.chance[i])
    high /= clock.visit_s
    low = high * 1e-7
    if _plan_at(ground, clock, work, (at, low)).seconds <= clock.seconds_left:
        return low
    for _ in range(_BISECTIONS):
        middle = np.sqrt(low * high)
        if _plan_at(ground, clock, work, (at, middle)).seconds > clock.seconds_left:
            low = middle
        else:
            high = middle
        if high < 1.04 * low:
            break
    return float(high)


@part
def _plan_on(
    ground: Ground,
    clock: Clock,
    work: tuple[_Mind, _Rows, _Onward],
    state: tuple[int, float, float],
) -> tuple[float, _Piece]:
    """Return the price that suits the seconds left, a few steps from the last, and the plan."""
    at, price, left_s = state
    rows = work[1]
    trend = 0
    piece = _replan(ground, clock, work, (at, price))
    for _ in range(_TRIES):
        if piece.seconds > left_s and trend >= 0:
            trend, price = 1, price * _STEP
        elif piece.seconds < _FULL * left_s and trend <= 0:
            trend, price = -1, price / _STEP
        else:
            break
        rows.stale[:] = True
        piece = _replan(ground, clock, work, (at, price))
    return price, piece


@part
def _row_of(ground: Ground, at: int) -> int:
    """Return the row of a plant, -1 for the gate; of one integer type, as numba wants it."""
    return 0 + ground.row[at] if at >= 0 else _NOWHERE


@part
def _plan_at(
    ground: Ground,
    clock: Clock,
    work: tuple[_Mind, _Rows, _Onward],
    state: tuple[int, float],
) -> _Piece:
    work[1].stale[:] = True
    return _replan(ground, clock, work, state)


@part
def _replan(
    ground: Ground,
    clock: Clock,
    work: tuple[_Mind, _Rows, _Onward],
    state: tuple[int, float],
) -> _Piece:
    """Return the first piece of the best plan at a price."""
    mind, rows, onward = work
    at, price = state
    own = _row_of(ground, at)
    for row in range(rows.stale.size):
        if rows.stale[row]:
            _value_row(ground, clock, (mind, rows), (row, price))
            rows.stale[row] = False
    for down in range(2):
        _go(clock, rows, onward, (down, own, price))
    if at < 0:
        _, seconds, onto = _leave(ground, clock, onward, 2 * (rows.stale.size), price)
        return _first_piece(rows, onward, onto, seconds)
    return _from_row(ground, clock, (mind, rows, onward), (at, price))


@part
def _value_row(
    ground: Ground,
    clock: Clock,
    work: tuple[_Mind, _Rows],
    state: tuple[int, float],
) -> None:
    """Work out what each way of driving a row comes to at a price.

    Of neighbours in the row the second counts as it will be after a clean look at the first.
    """
    mind, rows = work
    row, price = state
    first, end = ground.row_start[row], ground.row_start[row + 1]
    toll = price * clock.visit_s
    if rows.last[row, 0] >= 0:
        rows.gain[first:end] = 0.0
        rows.last[row] = _NOWHERE
    previous, n = _NOWHERE, 0
    for block in range(first // _BLOCK, (end - 1) // _BLOCK + 1):
        if _most_in(mind, rows, block) <= toll:
            continue
        for i in range(max(first, block * _BLOCK), min(end, (block + 1) * _BLOCK)):
            gain = mind.worth[i] * mind.chance[i] - toll
            if gain > 0.0 and previous == i - 1 and previous >= 0:
                gain = mind.worth[i] * _after_clean(mind, i) - toll
            if gain > 0.0:
                rows.gain[i] = gain
                previous = i
                rows.pays[n] = i
                n += 1
    if n == 0:
        return
    for way in range(2, _WAYS):
        _in_and_out(ground, clock, rows, (row, way, n), price)
    _through(ground, clock, rows, (row, n), price)


@part
def _most_in(mind: _Mind, rows: _Rows, block: int) -> float:
    """Return the most that a plant of a block is worth."""
    if rows.most[block] < 0.0:
        most = 0.0
        for i in range(block * _BLOCK, min((block + 1) * _BLOCK, mind.worth.size)):
            most = max(most, mind.worth[i] * mind.chance[i])
        rows.most[block] = most
    return float(rows.most[block])


@part
def _after_clean(mind: _Mind, i: int) -> float:
    """Return the chance of plant i once the one before it was looked at and seemed clean."""
    p, e = mind.chance[i], mind.behind[i]
    if e < 0:
        return float(p)
    q = mind.chance[i - 1]
    c = min(mind.both[e], p, q)
    return float((p - mind.detects * c) / max(1.0 - mind.detects * q, _LEAST))


@part
def _in_and_out(
    ground: Ground, clock: Clock, rows: _Rows, state: tuple[int, int, int], price: float
) -> None:
    """Value a row that is left by the end it was entered by, as far in as pays best."""
    row, way, n = state
    entry_m = ground.end_x_m[row, way - 2]
    best, best_s, last = -np.inf, 0.0, _NOWHERE
    gains = 0.0
    for k in range(n):
        i = rows.pays[k] if way == 2 else rows.pays[n - 1 - k]
        gains += rows.gain[i]
        drive_s = 2.0 * abs(ground.x_m[i] - entry_m) / clock.speed_m_s
        net = gains - price * drive_s
        if net > best:
            best, best_s, last = net, drive_s + (k + 1) * clock.visit_s, i
    rows.net[row, way], rows.seconds[row, way], rows.last[row, way] = best, best_s, last


@part
def _through(
    ground: Ground, clock: Clock, rows: _Rows, state: tuple[int, int], price: float
) -> None:
    """Value a row that is driven from end to end, either way."""
    row, n = state
    gains = 0.0
    for k in range(n):
        gains += rows.gain[rows.pays[k]]
    drive_s = (ground.end_x_m[row, 1] - ground.end_x_m[row, 0]) / clock.speed_m_s
    for way in range(2):
        rows.net[row, way] = gains - price * drive_s
        rows.seconds[row, way] = drive_s + n * clock.visit_s
        rows.last[row, way] = rows.pays[n - 1] if way == 0 else rows.pays[0]


@part
def _go(
    clock: Clock,
    rows: _Rows,
    onward: _Onward,
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
def _after(onward: _Onward, place: tuple[int, int, int], price: float) -> None:
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
    ground: Ground, clock: Clock, onward: _Onward, here: int, price: float
) -> tuple[float, float, tuple[int, int, int]]:
    """Return the best way on from a lane end or the gate: its net, seconds, and where to."""
    gate = ground.between_m.shape[0] - 1
    best_s = ground.between_m[here, gate] / clock.speed_m_s if clock.returns else 0.0
    best, onto = -price * best_s, (0, _NOWHERE, 0)
    for row in range(onward.net.shape[1]):
        for end in range(2):
            if onward.way[0, row, end] < 0 and onward.way[1, row, end] < 0:
                continue
            way_s = ground.between_m[here, 2 * row + end] / clock.speed_m_s
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
    rows: _Rows, onward: _Onward, onto: tuple[int, int, int], seconds: float
) -> _Piece:
    down, row, end = onto
    if row < 0:
        return _Piece(_NOWHERE, 0, _NOWHERE, seconds)
    way = onward.way[down, row, end]
    return _Piece(row, end, rows.last[row, way], seconds)


@part
def _from_row(
    ground: Ground,
    clock: Clock,
    work: tuple[_Mind, _Rows, _Onward],
    state: tuple[int, float],
) -> _Piece:
    """Return the first piece of the best plan from the middle of a row.

    The row is left by either end, with the plants that way; before that, plants the other way
    are fetched as far as they pay.
    """
    _, rows, onward = work
    at, price = state
    row = _row_of(ground, at)
    best = -np.inf
    piece = _Piece(_NOWHERE, 0, _NOWHERE, 0.0)
    for end in range(2):
        that_way = _along(ground, clock, rows, (at, row, end), price)
        other_way = _along(ground, clock, rows, (at, row, 1 - end), price)
        net, seconds, onto = _leave(ground, clock, onward, 2 * row + end, price)
        net += that_way.net + other_way.fetch_net
        seconds += that_way.seconds + other_way.fetch_seconds
        if net <= best:
            continue
        best = net
        if other_way.turn >= 0:
            piece = _Piece(row, end, other_way.turn, seconds)
        elif that_way.last >= 0:
            piece = _Piece(row, 1 - end, that_way.last, seconds)
        else:
            piece = _first_piece(rows, onward, onto, seconds)
    return piece


@part
def _along(
    ground: Ground, clock: Clock, rows: _Rows, place: tuple[int, int, int], price: float
) -> _Along:
    """Return what the rest of a row comes to, from a plant to an end."""
    at, row, end = place
    gains, n, farthest = 0.0, 0, _NOWHERE
    fetch_net, fetch_s, turn = 0.0, 0.0, _NOWHERE
    i = at - 1 if end == 0 else at + 1
    while ground.row_start[row] <= i < ground.row_start[row + 1]:
        if rows.gain[i] > 0.0:
            gains += rows.gain[i]
            n += 1
            farthest = i
            way_s = 2.0 * abs(ground.x_m[i] - ground.x_m[at]) / clock.speed_m_s
            if gains - price * way_s > fetch_net:
                fetch_net, turn = gains - price * way_s, i
                fetch_s = way_s + n * clock.visit_s
        i = i - 1 if end == 0 else i + 1
    out_s = abs(ground.end_x_m[row, end] - ground.x_m[at]) / clock.speed_m_s
    net, seconds = gains - price * out_s, out_s + n * clock.visit_s
    return _Along(net, seconds, farthest, fetch_net, fetch_s, turn)
