"""The thesis's simulator without prior information, as its listings A.5, A.6 and A.7 run.

Kept apart from fieldmon's own samplers: this file repeats a published program, slips included, so
that its tables can be made again. What each slip does is told in `ListingErrors`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import routine
from fieldmon.compute.random_streams import coin_table, fill_coins
from fieldmon.studies.thesis.chapter4.nights import ABORTED, NEIGHBOR, RANDOM_SNAKE, Night, spread
from fieldmon.studies.thesis.chapter4.vineyard import infest

if TYPE_CHECKING:
    from numpy.typing import NDArray

VISITED, FOUND, INFESTED, NEW_COUNTED, NEW_TRUE, END, LEFT_S, EVER = range(8)
"""Columns of a run's days: faces visited today, detected today, infested in the morning, new in
the night as counted and in truth, the face stood at, seconds left, faces ever visited."""

FIXED, EACH_STOP, EACH_PASS = range(3)

_POSITION, _FORWARD, _ROW, _SKIP, _DRAWN, _TRACED, _FOUND = range(7)


class ListingWalk(NamedTuple):
    """How a listing walks (see `ListingErrors` for the switches).

    `skip` is N, `draws` says when it is drawn anew, from 1 to `most`.
    """

    plants: int
    sides: int
    listing: int
    skip: int
    draws: int
    most: int
    travel_s: float
    look_s: float
    turn_s: float
    change_s: float
    day_s: float
    days: int
    travel_once: bool
    change_by_counter: bool
    one_way: bool
    reentry_by_index: bool


class _WalkState(NamedTuple):
    """What a walk changes: faces by number, and its own place in `at`."""

    infested: NDArray[np.bool_]
    visits: NDArray[np.int64]
    today: NDArray[np.bool_]
    at: NDArray[np.int64]
    steps: NDArray[np.float64]


class _Curve(NamedTuple):
    """Where points of the detection curve go, ``(m, 2)``, and what is known of the day."""

    points: NDArray[np.float64]
    day: int
    known: float


@routine
def _draw(walk: ListingWalk, state: _WalkState) -> None:
    """Draw the next N."""
    u = state.steps[state.at[_DRAWN]]
    state.at[_DRAWN] += 1
    state.at[_SKIP] = 1 + int(walk.most * u)


@routine
def _face(walk: ListingWalk, q: int) -> int:
    """Return the face (from 0) that stands at number `q` of the walk."""
    side, j = divmod(q - 1, walk.plants)
    block = side // 2 if walk.listing == NEIGHBOR else side
    if not walk.one_way and block % 2 == 1:
        j = walk.plants - 1 - j
    return side * walk.plants + j


@routine
def _visit(walk: ListingWalk, state: _WalkState, q: int) -> None:
    """Look at number `q`; clean that face if it is infested."""
    face = _face(walk, q)
    state.visits[q - 1] += 1
    state.today[q - 1] = True
    if state.infested[face]:
        state.infested[face] = False
        state.at[_FOUND] += 1


@routine
def _note(walk: ListingWalk, state: _WalkState, curve: _Curve, left_s: float) -> None:
    """Append a point to the detection curve: days worked, percent of the known insects found."""
    k = state.at[_TRACED]
    if k < curve.points.shape[0]:
        curve.points[k, 0] = curve.day + 1 - left_s / walk.day_s
        curve.points[k, 1] = 100.0 * state.at[_FOUND] / curve.known if curve.known > 0 else np.nan
        state.at[_TRACED] += 1


@routine
def _least_visited(visits: NDArray[np.int64], first: int, last: int, keep_first: bool) -> int:  # noqa: FBT001 - a kernel
    """Return the number in first..last with the fewest visits: the first such, or the last."""
    best = first
    for q in range(first + 1, last + 1):
        fewer = visits[q - 1] < visits[best - 1]
        if fewer or (not keep_first and visits[q - 1] == visits[best - 1]):
            best = q
    return best


@routine
def _nearest_new(visits: NDArray[np.int64], from_end: bool) -> int:  # noqa: FBT001 - a kernel
    """Return the number nearest to one end that was never visited; 0 if there is none."""
    n = visits.size
    for k in range(n):
        q = n - k if from_end else 1 + k
        if visits[q - 1] == 0:
            return q
    return 0


@routine
def _reenter(walk: ListingWalk, state: _WalkState, at_end: bool) -> None:  # noqa: FBT001 - a kernel
    """Turn round at one end of the field and choose where to go on."""
    at, n, last = state.at, state.at[_SKIP], state.visits.size
    if at_end or walk.listing == NEIGHBOR or not walk.reentry_by_index:
        # at the first face the snake listings leave this to their next pass
        at[_FORWARD] = 0 if at_end else 1
    if not walk.reentry_by_index:
        fresh = _nearest_new(state.visits, at_end)
        if fresh > 0:
            at[_POSITION] = fresh
            at[_ROW] = (fresh - 1) // walk.plants + (2 if at_end else 1)
            return
    if walk.listing == RANDOM_SNAKE:
        here = at[_POSITION]
        if at_end:
            at[_POSITION] = here + 1 if here + 1 < last else here - 1
        else:
            at[_POSITION] = here - 1 if here - 1 > 1 else here + 1
    elif at_end:
        at[_POSITION] = _least_visited(state.visits, last - n + 1, last, False)
    else:
        at[_POSITION] = _least_visited(state.visits, 1, n, walk.listing == NEIGHBOR)


@routine
def _travel_s(walk: ListingWalk, state: _WalkState) -> float:
    return walk.travel_s if walk.travel_once else walk.travel_s * state.at[_SKIP]


@routine
def _side_change_s(walk: ListingWalk, before: int, after: int) -> float:
    """Return the seconds between two numbers for the sides and aisles that lie between."""
    side, other = (before - 1) // walk.plants, (after - 1) // walk.plants
    if side == other:
        return 0.0
    return walk.turn_s if side // 2 == other // 2 else walk.change_s


@routine
def _snake_pass(
    walk: ListingWalk,
    state: _WalkState,
    curve: _Curve,
    left_s: float,
    forward: bool,  # noqa: FBT001 - a kernel
) -> float:
    """Walk one pass of a snake listing along a "row" of its counter; return the seconds left."""
    at, last, n = state.at, state.visits.size, state.at[_SKIP]
    # a counter, not the robot: it steps by the N of the pass's beginning, whatever is drawn later
    for k in range((walk.plants + n - 1) // n):
        counter = 1 + k * n if forward else walk.plants - k * n
        if walk.draws == EACH_STOP:
            _draw(walk, state)
        cost_s = _travel_s(walk, state) + walk.look_s
        if left_s - cost_s <= 0:
            break
        left_s -= cost_s
        here = at[_POSITION]
        _visit(walk, state, here)
        if walk.change_by_counter and counter == walk.plants:
            left_s -= walk.change_s
        there = here + at[_SKIP] if forward else here - at[_SKIP]
        if not 1 <= there <= last:
            _reenter(walk, state, forward)
            break
        at[_POSITION] = there
        if not walk.change_by_counter:
            left_s -= _side_change_s(walk, here, there)
        _note(walk, state, curve, left_s)
    return left_s


@routine
def _snake_day(walk: ListingWalk, state: _WalkState, curve: _Curve) -> float:
    """Work one day of listing A.5 or A.7; return the seconds left."""
    at, last = state.at, state.visits.size
    left_s = walk.day_s
    while left_s - (_travel_s(walk, state) + walk.look_s + 10.0) > 0:
        forward = at[_FORWARD] == 1
        for _ in range(walk.sides):
            if walk.draws == EACH_PASS:
                _draw(walk, state)
            there = at[_POSITION] + (at[_SKIP] if forward else -at[_SKIP])
            if not 1 <= there <= last:
                at[_FORWARD] = 0 if forward else 1
                break
            left_s = _snake_pass(walk, state, curve, left_s, forward)
            # the listing leaves only the inner loop when it turns round: it may pass once more
            if (at[_FORWARD] == 1) != forward and not walk.reentry_by_index:
                break
    return left_s


@routine
def _neighbor_step(walk: ListingWalk, state: _WalkState, forward: bool) -> bool:  # noqa: FBT001 - a kernel
    """Move N on along the aisle, or into the next; return whether the aisle was left."""
    at, plants = state.at, walk.plants
    here, n, row = at[_POSITION], at[_SKIP], at[_ROW]
    if forward and here + n <= row * plants:
        at[_POSITION] = here + n
        return False
    if not forward and here - n > (row - 2) * plants:
        at[_POSITION] = here - n
        return False
    direction = 1 if forward else -1
    at[_POSITION] = here + direction * (n + plants)
    at[_ROW] = row + 2 * direction
    if walk.draws == EACH_PASS:
        _draw(walk, state)
    return True


@routine
def _neighbor_day(walk: ListingWalk, state: _WalkState, curve: _Curve) -> float:
    """Work one day of listing A.6; return the seconds left."""
    at, plants, last = state.at, walk.plants, state.visits.size
    left_s = walk.day_s
    while True:
        if walk.draws == EACH_STOP:
            _draw(walk, state)
        cost_s = _travel_s(walk, state) + 2 * walk.look_s + walk.turn_s
        if left_s - cost_s <= 0:
            return left_s
        left_s -= cost_s
        forward = at[_FORWARD] == 1
        _visit(walk, state, at[_POSITION])
        _visit(walk, state, at[_POSITION] + (plants if forward else -plants))
        if _neighbor_step(walk, state, forward):
            left_s -= walk.change_s
        if (forward and at[_POSITION] > last) or (not forward and at[_POSITION] - plants < 1):
            _reenter(walk, state, forward)
            if left_s - cost_s <= 0:
                return left_s
        else:
            _note(walk, state, curve, left_s)


@routine
def run(
    walk: ListingWalk,
    night: Night,
    infested: NDArray[np.bool_],
    coins: NDArray[np.float64],
    steps: NDArray[np.float64],
    trace: NDArray[np.float64],
) -> tuple[NDArray[np.float64], int, int]:
    """Run a listing on one field.

    Parameters
    ----------
    infested
        Faces at the start, ``(T,)``; not changed.
    coins
        The nights' uniform numbers, ``(days, T)``.
    steps
        Uniform numbers for N in the order drawn; see `most_draws`.
    trace
        Room for the detection curve, ``(m, 2)``: days worked, percent found; m may be 0.

    Returns
    -------
    The days' numbers ``(days, 8)`` (columns above), how many points the curve has, and the night
    in which the listing was aborted, from 1 (0: it was not).
    """
    days = np.zeros((walk.days, 8))
    state = _WalkState(
        infested.copy(),
        np.zeros(infested.size, np.int64),
        np.zeros(infested.size, np.bool_),
        np.array([1, 1, 1, walk.skip, 0, 0, 0]),
        steps,
    )
    if walk.draws != FIXED:
        # whatever comes later, the first N is drawn from 1 to 4
        state.at[_SKIP] = 1 + int(4 * steps[0])
        state.at[_DRAWN] = 1
    known = float(state.infested.sum())
    if trace.shape[0] > 0:
        trace[0] = 0.0
        state.at[_TRACED] = 1
    for day in range(walk.days):
        row = days[day]
        state.today[:] = False
        found = state.at[_FOUND]
        row[INFESTED] = state.infested.sum()
        curve = _Curve(trace, day, known)
        if walk.listing == NEIGHBOR:
            row[LEFT_S] = _neighbor_day(walk, state, curve)
        else:
            row[LEFT_S] = _snake_day(walk, state, curve)
        row[VISITED] = state.today.sum()
        row[EVER] = (state.visits > 0).sum()
        row[FOUND] = state.at[_FOUND] - found
        row[END] = state.at[_POSITION]
        counted, true = spread(night, state.infested, coins[day])
        if counted == ABORTED:
            return days, state.at[_TRACED], day + 1
        row[NEW_COUNTED], row[NEW_TRUE] = counted, true
        known += counted
    return days, state.at[_TRACED], 0


def most_draws(walk: ListingWalk) -> int:
    """Return how many numbers a run can draw at most.

    One before the first day; then at most three for a stop (the stop's own, and two passes that
    begin at an end of the field and only turn), and one for each pass of a day already spent.
    """
    if walk.draws == FIXED:
        return 0
    stops = int(walk.day_s / (walk.travel_s + walk.look_s)) + 2
    return 1 + walk.days * (3 * stops + walk.sides)


def most_points(walk: ListingWalk) -> int:
    """Return how many points a run's detection curve can have at most."""
    return 1 + walk.days * (int(walk.day_s / (walk.travel_s + walk.look_s)) + 2)


@routine
def fill(days: NDArray[np.float64], numbers: NDArray[np.float64]) -> None:
    """Fill in the numbers of a run's days, both ``(days, 8)``, one by one as `fill_coins` does."""
    for day in range(numbers.shape[0]):
        for k in range(numbers.shape[1]):
            days[day, k] = numbers[day, k]


@routine
def repeat(
    walk: ListingWalk, night: Night, start: float, draws: int, keys: NDArray[np.uint64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Run a listing once for each row of `keys`, ``(replicates, 2 + days)`` (see `draws.keys`).

    Returns the days' numbers ``(replicates, days, 8)`` and the nights of abortion
    ``(replicates,)``.
    """
    replicates = keys.shape[0]
    faces, vines = walk.sides * walk.plants, (walk.sides // 2 + 1) * walk.plants
    days = np.empty((replicates, walk.days, 8))
    aborted = np.zeros(replicates, np.int64)
    coins = np.empty((walk.days, faces))
    trace = np.zeros((0, 2))
    for k in range(replicates):
        infested = infest(walk.plants, walk.sides, coin_table(keys[k, 0], vines), start)
        for day in range(walk.days):
            fill_coins(coins[day], keys[k, 2 + day])
        steps = coin_table(keys[k, 1], draws)
        numbers, _, aborted[k] = run(walk, night, infested, coins, steps, trace)
        fill(days[k], numbers)
    return days, aborted


@routine
def curve(
    trace: NDArray[np.float64], points: int, at_days: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the curve's last value at each of `at_days`, ``(m,)``, rising."""
    values = np.zeros(at_days.size)
    k = 0
    for i in range(at_days.size):
        while k + 1 < points and trace[k + 1, 0] <= at_days[i]:
            k += 1
        values[i] = trace[k, 1] if points else np.nan
    return values
