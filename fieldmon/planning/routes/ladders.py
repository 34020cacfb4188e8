"""A ladder below a plot: two headlands and rungs between them on which no way is longer.

A ladder has a left and a right node for each aisle, in the order of the aisles up the plot, and
ways only between neighbours in that order and along the aisles. On it the best drive at a price of
time can be found exactly. So that what no drive on the ladder can reach no drive on the plot can
reach either, each distance on the ladder must be at most the true one. That is made sure for every
pair of lane ends and the gate of the plot at hand: where the ladder's way would be longer, as
around holes and between parts, a cross link is put in.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from fieldmon.compute.jit import loop

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.travel import Aisles
    from fieldmon.plot.travel_table import TravelTable

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_EXACT_M = 1e-7
_LESS = 1.0 - 1e-9
_ROUNDS = 40
# an aisle goes on being the main one of its height if it has this share of the longest there
_MUCH_SHORTER = 0.3


class Ladder(NamedTuple):
    """A ladder on which no way is longer than on the plot.

    Its e elements are aisles, cross links and, once, the gate, in order up the plot.

    Parameters
    ----------
    up_m
        ``(e - 1, 2)`` metres from each element to the next along the left and right headland.
    across_m
        ``(e,)`` metres from the left to the right node of an aisle or cross link.
    stub_m
        ``(2,)`` metres from the gate to the left and to the right node of its element.
    gate
        Number of the gate's element.
    plant
        ``(n,)`` all plants, aisle after aisle, by their place along it.
    start
        ``(e + 1,)`` offsets: plants of element k are ``plant[start[k]:start[k + 1]]``.
    in_m
        ``(n,)`` metres from the left node to each of `plant`.
    upper
        ``(n,)`` whether each of `plant` stands on the upper side of its aisle.
    cross_links
        Number of cross links: 0 where the plot is a ladder.
    hangs
        ``(e,)`` whether an element joins both headlands (0), or both its ends are one place of
        the left (1) or of the right headland (2).
    rung
        ``(e,)`` number of the rung that an element is, -1 of cross links and the gate.
    """

    up_m: Float
    across_m: Float
    stub_m: Float
    gate: int
    plant: Int
    start: Int
    in_m: Float
    upper: NDArray[np.bool_]
    cross_links: int
    hangs: Int
    rung: Int


class Rungs(NamedTuple):
    """Each aisle as a rung: its ends, and true metres between all of them and the gate.

    ``low``, ``high`` ``(k,)``: x of the rung's ends; ``up`` ``(k,)`` its y. ``apart_m``
    ``(2, 2, k + 1, k + 1)``: from the left (0) or right (1) end of an aisle to the left or right
    end of another; the last is the gate, whose two ends are one. ``part`` ``(k,)``: 0 of an aisle;
    of a part of the plot that is one place of this ladder (see `pendant_parts`), 1 on its left
    headland, 2 on its right.
    """

    low: Float
    high: Float
    up: Float
    apart_m: Float
    part: Int


#: rungs and ladders of each plot as a robot drives it, for as long as its ways are kept
_MADE: WeakKeyDictionary[Aisles, tuple[Rungs, dict[object, Ladder]]] = WeakKeyDictionary()


class Ladders:
    """Ladders below a plot, or below some of its aisles, on which no way is longer than true.

    They hang on the ways alone: those of a plot are made once, whatever the hours and the rewards.
    """

    def __init__(self, aisles: Aisles, rungs: Rungs | None = None) -> None:
        self.aisles = aisles
        self._made: dict[object, Ladder] = {}
        if rungs is not None:
            self.rungs = rungs
            return
        if aisles not in _MADE:
            _MADE[aisles] = rungs_of(aisles), self._made
        self.rungs, self._made = _MADE[aisles]

    def of(self, rungs: Rungs) -> Ladders:
        """Return ladders of other rungs, as where parts of the plot are one place."""
        return Ladders(self.aisles, rungs)

    def whole(self, *, hanging: bool) -> Ladder:
        """Return a ladder of all aisles with the plot's gate; short ones beside others may hang."""
        every = np.arange(len(self.rungs.low))
        to_gate = self.rungs.apart_m[:, 0, :-1, -1]
        return self.among(every, (to_gate, float(self.aisles.gate_m[1])), hanging=hanging)

    def among(self, members: Int, gate: tuple[Float, float], *, hanging: bool) -> Ladder:
        """Return a ladder of some aisles, made once.

        ``gate``: metres ``(2, k)`` from the left and right ends of the members to a gate, and its
        y.
        """
        asked = members.tobytes(), gate[0].tobytes(), gate[1], hanging
        if asked not in self._made:
            self._made[asked] = self._among(members, gate, hanging=hanging)
        return self._made[asked]

    def _among(self, members: Int, gate: tuple[Float, float], *, hanging: bool) -> Ladder:
        rungs = self.rungs
        up, low = rungs.up[members], rungs.low[members]
        order = np.lexsort((low, np.round(up, 3)))
        order = np.insert(order, np.searchsorted(up[order], gate[1]), len(up))
        hangs = np.zeros(len(up), np.int64)
        if hanging:
            hangs = _hanging(rungs, members, 0.6 * self.aisles.grid.row_spacing_m)
        own = rungs.part[members]
        hangs = np.append(np.where(own > 0, own, hangs), 0)[order]
        apart_m = _apart(rungs, members, gate[0])[:, :, order][:, :, :, order]
        at = int(np.flatnonzero(order == len(up))[0])
        across_m = np.append(rungs.high[members] - low, np.inf)[order]
        lines = _lines(apart_m, hangs)
        left, right, links = _fitted(lines, np.where(hangs > 0, np.inf, across_m), at)
        stub_m = np.array([_stub(left, lines[0, 0], at), _stub(right, lines[1, 1], at)])
        placed = np.append(members, -1)[order]
        return _assembled(
            self.aisles.travel, rungs, (placed, hangs), (left, right), (links, across_m, stub_m)
        )


def _apart(rungs: Rungs, members: Int, to_gate_m: Float) -> Float:
    """Return the metres between the ends of some aisles and a gate of their own, the last."""
    apart_m = np.full((2, 2, len(members) + 1, len(members) + 1), np.inf)
    apart_m[:, :, :-1, :-1] = rungs.apart_m[:, :, members[:, None], members]
    for side in range(2):
        apart_m[side, :, :-1, -1] = to_gate_m[side]
        apart_m[:, side, -1, :-1] = to_gate_m[side]
    return apart_m


def _lines(apart_m: Float, hangs: Int) -> Float:
    """Return the metres between places of the two headlands, some aisles hanging on one of them.

    Both ends of an aisle that hangs are one place of its headland, and it has none of the other.
    """
    if not hangs.any():
        return apart_m
    either_from = apart_m.min(axis=0)
    lines = apart_m.copy()
    for side in range(2):
        own, gone = hangs == side + 1, hangs == 2 - side
        lines[side][:, own] = either_from[:, own]
        lines[side][:, gone] = np.inf
    either_to = lines.min(axis=1)
    for side in range(2):
        own, gone = hangs == side + 1, hangs == 2 - side
        lines[:, side][:, :, own] = either_to[:, :, own]
        lines[:, side][:, :, gone] = np.inf
    return lines


def _hanging(rungs: Rungs, members: Int, same_m: float) -> Int:
    """Return which aisles ``(k,)`` hang on a headland: those beside the main one of their height.

    The main aisle goes on from the one below as long as it is not much shorter than the others.
    """
    low, high, up = rungs.low[members], rungs.high[members], rungs.up[members]
    hangs, main = np.zeros(len(members), np.int64), -1
    order = np.argsort(up, kind="stable")
    for i in order:
        beside = np.flatnonzero((np.abs(up - up[i]) < same_m) & ((low > high[i]) | (high < low[i])))
        longest = max((high[beside] - low[beside]).max(initial=0.0), high[i] - low[i])
        goes_on = main < 0 or (low[i] < high[main] and high[i] > low[main])
        if len(beside) == 0 or (goes_on and high[i] - low[i] > _MUCH_SHORTER * longest):
            main = int(i)
            continue
        k = int(beside[np.argmax(high[beside] - low[beside])])
        if main in beside:
            k = main
        elif high[i] - low[i] >= longest:
            main = int(i)
            continue
        hangs[i] = 1 if high[i] < low[k] else 2
    return hangs


def rungs_of(aisles: Aisles) -> Rungs:
    """Join rows that are inspected from one aisle."""
    travel = aisles.travel
    n_aisles = int(travel.corridor.max()) + 1
    first, last = np.full(n_aisles, np.inf), np.full(n_aisles, -np.inf)
    np.minimum.at(first, travel.corridor, travel.end_x_m[:, 0])
    np.maximum.at(last, travel.corridor, travel.end_x_m[:, 1])
    # metres that a lane ends short of the longest lane of its aisle
    short = np.stack(
        [
            first[travel.corridor] - travel.end_x_m[:, 0],
            travel.end_x_m[:, 1] - last[travel.corridor],
        ]
    )
    while True:
        apart_m = _between_aisles(travel, short)
        least = np.array([apart_m[side].min(axis=(0, 2))[:-1] for side in range(2)])
        bad = (least < 0.0) & _some_short(short, travel.corridor, n_aisles)
        if not bad.any():
            break
        # ends of such an aisle count as one place: the innermost
        for side in range(2):
            short[side, bad[side][travel.corridor]] = 0.0
            rows = np.flatnonzero(bad[side][travel.corridor])
            inner = (first, last)[side]
            inner[bad[side]] = (-np.inf, np.inf)[side]
            pick = np.maximum if side == 0 else np.minimum
            pick.at(inner, travel.corridor[rows], travel.end_x_m[rows, side])
    middle = (first + last) / 2
    crossed = first > last
    first[crossed] = last[crossed] = middle[crossed]
    up = np.zeros(n_aisles)
    up[travel.corridor] = aisles.grid.lane_y_m
    return Rungs(first, last, up, np.maximum(apart_m, 0.0), np.zeros(n_aisles, np.int64))


def _some_short(short: Float, corridor: NDArray[np.int32], n_aisles: int) -> NDArray[np.bool_]:
    some = np.zeros((2, n_aisles), np.bool_)
    for side in range(2):
        some[side, corridor[short[side] < 0.0]] = True
    return some


def _between_aisles(travel: TravelTable, short: Float) -> Float:
    """Return the least metres from aisle end to aisle end, and to the gate."""
    n_rows, n_aisles = len(travel.end_x_m), int(travel.corridor.max()) + 1
    owner = np.append(travel.corridor, n_aisles)
    by = np.argsort(owner, kind="stable")
    start = np.searchsorted(owner[by], np.arange(n_aisles + 1))
    apart_m = np.empty((2, 2, n_aisles + 1, n_aisles + 1))
    for a in range(2):
        here = np.append(2 * np.arange(n_rows) + a, 2 * n_rows)
        for b in range(2):
            there = np.append(2 * np.arange(n_rows) + b, 2 * n_rows)
            metres = travel.between_m[np.ix_(here, there)]
            metres += np.append(short[a], 0.0)[:, None] + np.append(short[b], 0.0)
            metres = np.minimum.reduceat(metres[by], start, axis=0)
            apart_m[a, b] = np.minimum.reduceat(metres[:, by], start, axis=1)
    # from an aisle to itself nothing is asked
    apart_m[:, :, np.arange(n_aisles), np.arange(n_aisles)] = np.inf
    return apart_m


def _hull(apart_m: Float) -> Float:
    """Return for a < b the least metres from any place up to a to any place from b on."""
    metres = np.where(np.tri(len(apart_m), dtype=bool), np.inf, apart_m)
    metres = np.minimum.accumulate(metres, axis=0)
    return np.minimum.accumulate(metres[:, ::-1], axis=1)[:, ::-1]


def _places(apart_m: Float) -> Float:
    """Return places ``(e,)`` on a line, ascending, no two further apart than they truly are."""
    place = np.zeros(len(apart_m))
    _put_in_line(np.ascontiguousarray(_hull(apart_m).T), place)
    return place


@loop
def _put_in_line(hull: Float, place: Float) -> None:
    """Put each place as far up as all before it allow; ``hull[b, a]`` is the metres from a to b."""
    for k in range(1, place.size):
        least = np.inf
        for j in range(k):
            least = min(least, place[j] + hull[k, j])
        place[k] = least * _LESS
        if not np.isfinite(place[k]):
            # nothing of this headland is there, or below
            place[k] = place[k - 1]


def _fitted(
    apart_m: Float, across_m: Float, gate: int
) -> tuple[Float, Float, list[tuple[int, float]]]:
    """Return left and right places of all elements, and the cross links that are needed."""
    left, right = _places(apart_m[0, 0]), _places(apart_m[1, 1])
    links = _cross_links((left, right), apart_m[0, 1], across_m, gate)
    if links is None:
        # the sides lie so near each other that one headland must do for both
        left = right = _places(apart_m.min(axis=(0, 1)))
        links = _cross_links((left, right), apart_m[0, 1], across_m, gate)
    if links is None:
        links = [(k, 0.0) for k in range(len(left)) if k != gate]
    return left, right, links


def _cross_links(
    places: tuple[Float, Float], apart_m: Float, across_m: Float, gate: int
) -> list[tuple[int, float]] | None:
    """Return cross links that make no way from left to right longer than the true one.

    ``apart_m`` ``(e, e)`` is from left ends to right ends. None if no cross link is short enough.
    """
    left, right = places
    cross = np.where(np.arange(len(left)) == gate, np.inf, across_m)
    asked = np.where(np.eye(len(left), dtype=bool), np.inf, apart_m)
    # the gate's own ways are its stubs
    asked[gate], asked[:, gate] = np.inf, np.inf
    over = _from_left_to_right(left, right, cross) - asked
    # ways only become shorter: where none is too long, none will be
    rows = np.flatnonzero(over.max(axis=1) > _EXACT_M)
    left_of, over, asked = left[rows], over[rows], asked[rows]
    links: dict[int, float] = {}
    worst = int(np.argmax(over)) if len(over) else 0
    for _ in range(_ROUNDS * 10):
        a, b = divmod(worst, len(left))
        if not len(over) or over[a, b] <= _EXACT_M:
            return sorted(links.items())
        room = asked[a, b] - np.abs(left - left_of[a]) - np.abs(right - right[b])
        room[gate] = -np.inf
        best = int(np.argmax(room))
        if room[best] < 0.0:
            return None
        links[best] = min(links.get(best, np.inf), float(room[best]))
        if links[best] < cross[best]:
            cross[best] = links[best]
            worst = _take_crossing(
                over, np.abs(left_of - left[best]) + cross[best], right, best, asked
            )
    return None


@loop
def _take_crossing(over: Float, to: Float, right: Float, k: int, asked: Float) -> int:
    """Let ways from left to right take one more crossing, or a shorter one; return the worst way.

    To the last bit what `_from_left_to_right` gives with it: the smaller of two numbers is it
    after the same is added to both, too. A way is numbered as `argmax` numbers it.

    Parameters
    ----------
    over
        ``(r, e)`` metres that ways from r left nodes to all right ones are too long; changed.
    to
        ``(r,)`` metres from the left nodes to the right end of the crossing.
    right
        ``(e,)`` places of the right nodes.
    k
        The crossing.
    asked
        ``(r, e)`` the true metres.
    """
    worst, most = 0, -np.inf
    for a in range(to.size):
        down, up = to[a] + right[k], to[a] - right[k]
        for b in range(k + 1):
            over[a, b] = min(over[a, b], down - right[b] - asked[a, b])
        for b in range(k, right.size):
            over[a, b] = min(over[a, b], up + right[b] - asked[a, b])
        for b in range(right.size):
            if over[a, b] > most:
                worst, most = a * right.size + b, over[a, b]
    return worst


def _from_left_to_right(left: Float, right: Float, cross: Float) -> Float:
    """Return the metres ``(e, e)`` from left to right nodes by the best single crossing."""
    to = np.abs(left[:, None] - left) + cross
    up = np.minimum.accumulate(to - right, axis=1) + right
    down = np.minimum.accumulate((to + right)[:, ::-1], axis=1)[:, ::-1] - right
    return np.minimum(up, down)


def _stub(place: Float, apart_m: Float, gate: int) -> float:
    """Return how far the gate can be from its node with no way from it being too long."""
    spare = np.delete(apart_m[gate] - np.abs(place - place[gate]), gate)
    least = float(spare.min(initial=np.inf))
    return max(least * _LESS, 0.0) if np.isfinite(least) else 0.0


def _assembled(
    travel: TravelTable,
    rungs: Rungs,
    order: tuple[Int, Int],
    places: tuple[Float, Float],
    fitted: tuple[list[tuple[int, float]], Float, Float],
) -> Ladder:
    """Return the ladder of aisles in order (the gate: -1), cross links being their own elements."""
    links, across_m, stub_m = fitted
    placed, hangs = order
    rank = np.full(len(rungs.low), -1)
    rank[placed[placed >= 0]] = np.flatnonzero(placed >= 0)
    aisle = travel.corridor[travel.row]
    x = np.clip(travel.x_m, rungs.low[aisle], rungs.high[aisle])
    in_m = x - rungs.low[aisle]
    plant = np.lexsort((in_m, rank[aisle]))
    plant = plant[rank[aisle[plant]] >= 0]
    count = np.bincount(rank[aisle[plant]], minlength=len(placed))
    after = np.array([k for k, _ in links], np.int64) + 1
    left, right = (np.insert(p, after, p[after - 1]) for p in places)
    across = np.insert(across_m, after, [metres for _, metres in links])
    count = np.insert(count, after, 0)
    gate = int(np.flatnonzero(placed < 0)[0])
    gate += int((after <= gate).sum())
    across[gate] = np.inf
    return Ladder(
        np.stack([np.diff(left), np.diff(right)], axis=1),
        across,
        stub_m,
        gate,
        plant,
        np.concatenate([[0], np.cumsum(count)]),
        in_m[plant],
        travel.side[travel.row[plant]] > 0,
        len(links),
        np.insert(hangs, after, 0),
        np.insert(placed, after, -1),
    )
