"""The seven strategies as the thesis's prose describes them, on its own rectangular field.

Independent of the listings and of fieldmon's samplers, so that each can be held against the others.
Stops are numbered along the way the robot drives (from 0); faces as in `Vineyard` (from 0).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import routine
from fieldmon.compute.random_streams import coin_table, fill_coins
from fieldmon.studies.thesis.chapter4.listings import (
    END,
    EVER,
    FOUND,
    INFESTED,
    LEFT_S,
    NEW_COUNTED,
    NEW_TRUE,
    VISITED,
    fill,
)
from fieldmon.studies.thesis.chapter4.vineyard import infest

if TYPE_CHECKING:
    from numpy.typing import NDArray

_STOP, _DIRECTION, _DRAWN = range(3)


class ProseWalk(NamedTuple):
    """How a strategy goes about the field.

    `skip` is N; `stop_s` is all that a stop takes, `turn_s` and `change_s` what it takes to come to
    the other side of an aisle and to the next one.
    """

    plants: int
    sides: int
    neighbor: bool
    skip: int
    online: bool
    scattered: bool
    plant_s: float
    stop_s: float
    turn_s: float
    change_s: float
    day_s: float
    days: int
    reenter_anywhere: bool
    severity: float
    one_coin: bool


class _FieldState(NamedTuple):
    """What a day changes: faces, stops, and the robot's place in `at`."""

    infested: NDArray[np.bool_]
    seen: NDArray[np.bool_]
    today: NDArray[np.bool_]
    visits: NDArray[np.int64]
    at: NDArray[np.int64]
    steps: NDArray[np.float64]


@routine
def _face(walk: ProseWalk, stop: int) -> int:
    """Return the face at a stop; for neighbor strategies that on the aisle's first side."""
    block, j = divmod(stop, walk.plants)
    if block % 2 == 1:
        j = walk.plants - 1 - j
    return (2 * block if walk.neighbor else block) * walk.plants + j


@routine
def _look(field: _FieldState, face: int) -> int:
    """Look at a face and clean it; return 1 if it was infested, else 0."""
    found = 1 if field.infested[face] else 0
    field.infested[face] = False
    field.seen[face] = True
    field.today[face] = True
    return found


@routine
def _drive_s(walk: ProseWalk, here: int, there: int) -> float:
    """Return the seconds from stop to stop: every vine passed, every side or aisle left."""
    low, high = min(here, there), max(here, there)
    seconds = (high - low) * walk.plant_s
    for block in range(low // walk.plants, high // walk.plants):
        same_aisle = not walk.neighbor and block % 2 == 0
        seconds += walk.turn_s if same_aisle else walk.change_s
    return seconds


@routine
def _reentry(walk: ProseWalk, field: _FieldState, here: int, n: int) -> int:
    """Return where to go on at an end of the field: the least visited stop, then the nearest."""
    stops = field.visits.size
    first, last = (0, n - 1) if here < stops // 2 else (stops - n, stops - 1)
    if walk.reenter_anywhere and field.visits.min() == 0:
        first, last = 0, stops - 1
    best = first
    for stop in range(first, last + 1):
        fewer = field.visits[stop] - field.visits[best]
        if fewer < 0 or (fewer == 0 and abs(stop - here) < abs(best - here)):
            best = stop
    return best


@routine
def _next_stop(walk: ProseWalk, field: _FieldState, here: int) -> int:
    """Return the stop N further on, or where to turn round to."""
    at = field.at
    n = walk.skip
    if walk.online:
        n = 1 + int(4 * field.steps[at[_DRAWN]])
        at[_DRAWN] += 1
    there = int(here + at[_DIRECTION] * n)
    if 0 <= there < field.visits.size:
        return there
    at[_DIRECTION] = -at[_DIRECTION]
    return _reentry(walk, field, here, n)


@routine
def _sweep_day(walk: ProseWalk, field: _FieldState) -> tuple[float, int]:
    """Go on along the field for one day; return the seconds left and how many faces were found."""
    at, left_s, found = field.at, walk.day_s, 0
    here = at[_STOP]
    while True:
        there = at[_STOP]
        cost_s = _drive_s(walk, here, there) + walk.stop_s
        if cost_s > left_s:
            return left_s, found
        left_s -= cost_s
        here = there
        field.visits[here] += 1
        face = _face(walk, here)
        found += _look(field, face)
        if walk.neighbor:
            found += _look(field, face + walk.plants)
        at[_STOP] = _next_stop(walk, field, here)


@routine
def _scattered_day(walk: ProseWalk, field: _FieldState) -> tuple[float, int]:
    """Look at 1/N of the field, drawn anew, in the snake's order from its first face."""
    stops = field.visits.size
    deck, is_chosen = np.arange(stops), np.zeros(stops, np.bool_)
    chosen = stops // walk.skip
    for k in range(chosen):
        pick = k + int((stops - k) * field.steps[field.at[_DRAWN]])
        field.at[_DRAWN] += 1
        deck[k], deck[pick] = deck[pick], deck[k]
        is_chosen[deck[k]] = True
    left_s, found, here = walk.day_s, 0, 0
    for there in range(stops):  # sorting them would be compiled for two seconds
        if not is_chosen[there]:
            continue
        cost_s = _drive_s(walk, here, there) + walk.stop_s
        if cost_s > left_s:
            break
        left_s -= cost_s
        here = there
        field.visits[here] += 1
        found += _look(field, _face(walk, here))
        field.at[_STOP] = here
    return left_s, found


@routine
def spread(walk: ProseWalk, infested: NDArray[np.bool_], coins: NDArray[np.float64]) -> int:
    """Let every infested face infect its row mates and its vine's other face, in place.

    `coins` ``(3, T)``: one row for the vine before, the vine after and the other face; the first
    row for all three where they share a coin. Return how many faces are new.
    """
    before = infested.copy()
    plants = walk.plants
    for face in range(infested.size):
        if not before[face]:
            continue
        side, j = divmod(face, plants)
        other = face
        if side % 2 == 1 and side < walk.sides - 1:
            other = face + plants
        elif side % 2 == 0 and side > 0:
            other = face - plants
        targets = (face - 1 if j > 0 else face, face + 1 if j < plants - 1 else face, other)
        for k in range(3):
            if coins[0 if walk.one_coin else k, face] < walk.severity:
                infested[targets[k]] = True
    return int(infested.sum() - before.sum())


@routine
def run(
    walk: ProseWalk,
    infested: NDArray[np.bool_],
    coins: NDArray[np.float64],
    steps: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Run a strategy on one field; return the days' numbers, ``(days, 8)`` (see `listings`).

    `infested` ``(T,)`` is not changed; `coins` ``(days, 3, T)`` are the nights', `steps` the
    draws' uniform numbers (see `most_draws`).
    """
    days = np.zeros((walk.days, 8))
    faces = infested.size
    field = _FieldState(
        infested.copy(),
        np.zeros(faces, np.bool_),
        np.zeros(faces, np.bool_),
        np.zeros(faces // 2 if walk.neighbor else faces, np.int64),
        np.array([0, 1, 0]),
        steps,
    )
    for day in range(walk.days):
        row = days[day]
        field.today[:] = False
        row[INFESTED] = field.infested.sum()
        if walk.scattered:
            row[LEFT_S], row[FOUND] = _scattered_day(walk, field)
        else:
            row[LEFT_S], row[FOUND] = _sweep_day(walk, field)
        row[VISITED], row[EVER] = field.today.sum(), field.seen.sum()
        row[END] = field.at[_STOP]
        row[NEW_TRUE] = spread(walk, field.infested, coins[day])
        row[NEW_COUNTED] = row[NEW_TRUE]
    return days


def most_draws(walk: ProseWalk) -> int:
    """Return how many numbers a run can draw at most."""
    if walk.scattered:
        return walk.days * (walk.plants * walk.sides // walk.skip)
    return walk.days * (int(walk.day_s / walk.stop_s) + 1) if walk.online else 0


@routine
def repeat(
    walk: ProseWalk, start: float, draws: int, keys: NDArray[np.uint64]
) -> NDArray[np.float64]:
    """Run a strategy once for each row of `keys`; return the days' numbers ``(m, days, 8)``."""
    replicates = keys.shape[0]
    faces, vines = walk.sides * walk.plants, (walk.sides // 2 + 1) * walk.plants
    days = np.empty((replicates, walk.days, 8))
    coins = np.empty((walk.days, 3, faces))
    used = faces if walk.one_coin else 3 * faces
    for k in range(replicates):
        infested = infest(walk.plants, walk.sides, coin_table(keys[k, 0], vines), start)
        for day in range(walk.days):
            fill_coins(coins[day].ravel()[:used], keys[k, 2 + day])
        fill(days[k], run(walk, infested, coins, coin_table(keys[k, 1], draws)))
    return days
