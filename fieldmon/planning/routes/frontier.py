"""What a drive on a ladder may look like between one aisle and the next, as tables.

Every edge of a ladder need be driven at most twice (two passes can be left out of three without
losing anything but their time). Between two neighbouring elements each headland is therefore
driven 0, 1 or 2 times, and what lies below either joins the two or not. The tables list all ways
of going on; how they follow from degrees and connections is in ``docs/exact_walk.md``.
"""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

# of numpy, and no literals: for each literal numba compiles anew what it is handed to
_WAY: Any = np.arange(12)
#: what may be driven in an aisle: nothing; in and out from the left, the right or both; through
#: once or twice; in from the left or the right to where the day ends, with in and out from the
#: other end or without; through from the left or the right, and later from the other end back in
#: to where the day ends
NOTHING, FROM_LEFT, FROM_RIGHT, FROM_BOTH, ONCE, TWICE = _WAY[:6]
END_LEFT, END_RIGHT, END_LEFT_AND, END_RIGHT_AND, LEFT_BACK, RIGHT_BACK = _WAY[6:]
N_WAYS = 12


class Way(NamedTuple):
    """Passes at the left and right end of an aisle, whether they meet, and whether the day ends."""

    left: int
    right: int
    meets: bool
    ends: bool


WAYS = (
    Way(0, 0, False, False),
    Way(2, 0, False, False),
    Way(0, 2, False, False),
    Way(2, 2, False, False),
    Way(1, 1, True, False),
    Way(2, 2, True, False),
    Way(1, 0, False, True),
    Way(0, 1, False, True),
    Way(1, 2, False, True),
    Way(2, 1, False, True),
    Way(1, 2, True, True),
    Way(2, 1, True, True),
)
#: at the gate, passes of its stubs: closed days come back, one-way days do not
GATE_CLOSED = ((2, 0), (0, 2), (1, 1), (2, 2))
GATE_OPEN = ((1, 0), (0, 1), (1, 2), (2, 1))


class State(NamedTuple):
    """Passes of both headlands on to the next element, whether joined below, whether ended."""

    left: int
    right: int
    joined: bool
    ended: bool


class Tables(NamedTuple):
    """All ways of going on, ``(t, 3)`` int64: state before, way driven, state after.

    `aisle` for aisles and cross links, `gate` for the gate. State 0 is a drive not begun, 1 one
    that is complete; ``passes`` ``(s, 2)`` are a state's passes of the left and right headland.
    """

    aisle: NDArray[np.int64]
    gate: NDArray[np.int64]
    passes: NDArray[np.int64]


@cache
def tables(*, returns: bool) -> Tables:
    """Return the tables for days that come back to the gate, or for those that do not."""
    states = [State(0, 0, False, False), State(0, 0, True, True)]
    ended = (True,) if returns else (False, True)
    for left, right, joined, end in product(range(3), range(3), (False, True), ended):
        if (left and right) or (left + right > 0 and joined):
            states.append(State(left, right, joined, end))
    number = {state: k for k, state in enumerate(states)}
    aisle = [
        (number[before], way, number[after])
        for before in states
        for way, drive in enumerate(WAYS)
        for after in _onward(before, drive, returns=returns)
        if after in number
    ]
    at_gate = [
        (number[before], way, number[after])
        for before in states
        for way, (left, right) in enumerate(GATE_CLOSED if returns else GATE_OPEN)
        for after in _onward(before, Way(left, right, bool(left and right), False), returns=returns)
        if after in number and before != states[1]
    ]
    passes = np.array([(state.left, state.right) for state in states])
    return Tables(np.array(aisle), np.array(at_gate), passes)


def _onward(before: State, way: Way, *, returns: bool) -> list[State]:
    """Return the states after an element that is driven in some way."""
    begun = before.left + before.right > 0
    if not begun and way.left + way.right == 0:
        # nothing here: still not begun, or long complete
        return [before]
    if not begun and before.joined:
        return []
    if way.ends and (returns or before.ended):
        return []
    ended = returns or before.ended or way.ends
    # a one-way day may also end at a node of a headland: -1 nowhere, 0 left, 1 right
    stops = (-1,) if ended else (-1, 0, 1)
    found = []
    for stop, left, right in product(stops, range(3), range(3)):
        if _fits(before, way, (left, right), stop):
            joined = (before.joined and before.left > 0 and before.right > 0) or way.meets
            after = _after(before, way, (left, right, joined), ended=ended or stop >= 0)
            if after is not None:
                found.append(after)
    return found


def _fits(before: State, way: Way, on: tuple[int, int], stop: int) -> bool:
    """Tell whether passes add up to even numbers at both nodes, and no node is new for nothing."""
    for side in range(2):
        come = (before.left, before.right)[side] + (way.left, way.right)[side]
        if (come + on[side] + (stop == side)) % 2 or (come == 0 and (on[side] or stop == side)):
            return False
    return True


def _after(before: State, way: Way, on: tuple[int, int, bool], *, ended: bool) -> State | None:
    """Return the state after, None where a piece would be left behind."""
    left, right, joined = on
    there = before.left + way.left > 0, before.right + way.right > 0
    if all(there) and not joined and not (left and right):
        return None
    if left + right == 0:
        return State(0, 0, True, True) if ended else None
    return State(left, right, joined if left and right else True, ended)
