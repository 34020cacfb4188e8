"""Plants grouped into pieces of rows by what stands in line about every place of a plot.

About each place a window of some sixty plants is looked through in every direction, and with
every bend: rows are where plants stand in the fewest, densest lines. Windows overlap; lines of two
windows that hold the same plants are one row. So rows may bend and blocks turn: nothing is asked
to be straight farther than a window.
"""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import routine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_PLANTS = 60
_DIRECTIONS = 90
_MOST_MEMBERS = 600
_MOST_LINES = 96
# a line of a window is one with that of another if this part of what both see is in both: first
# those that are most alike; never two lines of one window
_SAME = (0.9, 0.8, 0.7, 0.6)
# directions this near to a neighbouring window's go on from there, if they are nearly the best
_ON_DEG, _ON_SHARE = 12.0, 0.6


class Windows(NamedTuple):
    """Plants sorted into square cells, and the window about each cell.

    Parameters
    ----------
    plant
        ``(n,)`` plants, cell by cell.
    key, start
        ``(w,)`` cells that hold plants, ascending, and ``(w + 1,)`` where their plants start.
    centre_m
        ``(w, 2)`` middle of the plants of each cell.
    high
        Number of cells up the plot: cell (i, j) has the key ``i * high + j``.
    radius_m, near_m
        Radius of the windows, and the usual distance to the nearest plant.
    """

    plant: Int
    key: Int
    start: Int
    centre_m: Float
    high: int
    radius_m: float
    near_m: float

    def __repr__(self) -> str:
        return f"<Windows: {len(self.centre_m)} windows>"

    @classmethod
    def of(cls, xy_m: Float, near_m: float, area_m2: float) -> Windows:
        """Return the windows about plants with so much ground each."""
        radius_m = float(np.sqrt(_PLANTS * area_m2 / np.pi))
        cell = ((xy_m - xy_m.min(axis=0)) / (radius_m / 2)).astype(np.int64)
        high = int(cell[:, 1].max()) + 1
        keys = cell[:, 0] * high + cell[:, 1]
        plant = np.argsort(keys, kind="stable")
        key, start = np.unique(keys[plant], return_index=True)
        n_in = np.diff(np.append(start, len(plant)))
        sums = np.add.reduceat(xy_m[plant], start, axis=0)
        ends = np.append(start, len(plant)).astype(np.int64)
        return cls(plant, key, ends, sums / n_in[:, None], high, radius_m, near_m)


class Directions(NamedTuple):
    """How rows run in each of w windows: ``(w,)`` radians from x, and bend, one by metres."""

    angle: Float
    bend_per_m: Float

    def __repr__(self) -> str:
        return f"<Directions: {len(self.angle)} directions>"


def pieces(xy_m: Float, windows: Windows) -> tuple[Int, Directions]:
    """Return the piece of a row that each plant is in, ``(n,)`` from 0, and how rows run."""
    score = np.empty((len(windows.key), _DIRECTIONS))
    _score_directions(xy_m, windows, score)
    angle = np.empty(len(windows.key))
    _grow(windows, score, angle)
    bend = np.empty(len(windows.key))
    _refine(xy_m, windows, angle, bend)
    start, member, line, n_lines = _see_lines(xy_m, windows, angle, bend)
    first = np.append(0, np.cumsum(n_lines))
    united = _united(len(xy_m), windows, (start, member, line), first)
    piece = _voted(xy_m, windows, (start, member, line), first, united)
    return np.unique(piece, return_inverse=True)[1], Directions(angle, bend)


@routine
def _find(key: Int, wanted: int) -> int:
    place = np.searchsorted(key, wanted)
    return int(place) if place < key.size and key[place] == wanted else -1


@routine
def _members(xy_m: Float, windows: Windows, w: int, buffer: Float, who: Int) -> int:
    """Fill in x, y and closeness to the middle of a window's plants; return how many there are."""
    n = 0
    cx, cy = windows.centre_m[w]
    column, line = windows.key[w] // windows.high, windows.key[w] % windows.high
    square = windows.radius_m**2
    for i in range(column - 3, column + 4):
        if i < 0:
            continue
        for j in range(max(line - 3, 0), min(line + 4, windows.high)):
            cell = _find(windows.key, i * windows.high + j)
            if cell < 0:
                continue
            for place in range(windows.start[cell], windows.start[cell + 1]):
                p = windows.plant[place]
                x, y = xy_m[p, 0] - cx, xy_m[p, 1] - cy
                off = x * x + y * y
                if off < square and n < who.size:
                    buffer[n, 0], buffer[n, 1], buffer[n, 2] = x, y, 1.0 - off / square
                    who[n] = p
                    n += 1
    return n


@routine
def _sharpness(
    buffer: Float, n: int, way: tuple[float, float], bin_m: float, tally: Float
) -> float:
    """Return how dense the lines are in a direction and with a bend: the sum of squares."""
    angle, bend = way
    sin, cos = np.sin(angle), np.cos(angle)
    tally[:] = 0.0
    middle = tally.size / 2
    for k in range(n):
        x = buffer[k, 0] * cos + buffer[k, 1] * sin
        y = buffer[k, 1] * cos - buffer[k, 0] * sin - 0.5 * bend * x * x
        place = middle + y / bin_m
        at = int(place)
        if 0 <= at < tally.size - 1:
            upper = place - at
            tally[at] += (1.0 - upper) * buffer[k, 2]
            tally[at + 1] += upper * buffer[k, 2]
    total = 0.0
    for value in tally:
        total += value * value
    return total


@routine
def _score_directions(xy_m: Float, windows: Windows, score: Float) -> None:
    buffer, who = np.empty((_MOST_MEMBERS, 3)), np.empty(_MOST_MEMBERS, np.int64)
    bin_m = 0.25 * windows.near_m
    tally = np.empty(int(2.2 * windows.radius_m / bin_m) + 4)
    for w in range(windows.key.size):
        n = _members(xy_m, windows, w, buffer, who)
        for k in range(_DIRECTIONS):
            way = (np.pi * k / _DIRECTIONS, 0.0)
            score[w, k] = _sharpness(buffer, n, way, bin_m, tally)


@routine
def _off(a: float, b: float) -> float:
    """Return the angle between two directions, either way along them."""
    return abs((a - b + np.pi / 2) % np.pi - np.pi / 2)


@routine
def _best_near(score: Float, angle: float, reach: float) -> float:
    """Return the best direction near one, or the best of all where none there is as good."""
    best, near = 0, -1
    for k in range(score.size):
        if score[k] > score[best]:
            best = k
        close = _off(np.pi * k / score.size, angle) <= reach
        if close and (near < 0 or score[k] > score[near]):
            near = k
    good = near >= 0 and score[near] >= _ON_SHARE * score[best]
    return np.pi * (near if good else best) / score.size


@routine
def _grow(windows: Windows, score: Float, angle: Float) -> None:
    """Choose each window's direction, from the clearest window on to its neighbours."""
    m = windows.key.size
    reach = np.deg2rad(_ON_DEG)
    done = np.zeros(m, np.bool_)
    clear = np.empty(m)
    for w in range(m):
        clear[w] = score[w].max() / (score[w].sum() + 1e-9)
    for seed in np.argsort(-clear):
        if done[seed]:
            continue
        angle[seed] = np.pi * np.argmax(score[seed]) / score.shape[1]
        done[seed] = True
        queue = [(-clear[seed], seed)]
        while queue:
            _, w = heapq.heappop(queue)
            column, line = windows.key[w] // windows.high, windows.key[w] % windows.high
            for i in range(column - 1, column + 2):
                for j in range(max(line - 1, 0), min(line + 2, windows.high)):
                    other = _find(windows.key, i * windows.high + j) if i >= 0 else -1
                    if other < 0 or done[other]:
                        continue
                    angle[other] = _best_near(score[other], angle[w], reach)
                    done[other] = True
                    heapq.heappush(queue, (-clear[other], other))


@routine
def _refine(xy_m: Float, windows: Windows, angle: Float, bend: Float) -> None:
    """Make each direction exact, and find how rows bend there."""
    buffer, who = np.empty((_MOST_MEMBERS, 3)), np.empty(_MOST_MEMBERS, np.int64)
    bin_m = 0.25 * windows.near_m
    tally = np.empty(int(2.6 * windows.radius_m / bin_m) + 4)
    most = 0.15 / windows.radius_m
    for w in range(windows.key.size):
        n = _members(xy_m, windows, w, buffer, who)
        best, here, curve = -1.0, angle[w], 0.0
        for b in range(-4, 5):
            for a in range(-4, 5):
                way = (angle[w] + np.deg2rad(0.75) * a, most * b / 2)
                # straight unless bent ones are clearly denser
                dense = _sharpness(buffer, n, way, bin_m, tally) * (1.0 - 0.004 * abs(b))
                if dense > best:
                    best, here, curve = dense, way[0], way[1]
        angle[w], bend[w] = here, curve


@routine
def _cuts(tally: Float, least_apart: int, cuts: Int) -> int:
    """Fill in the bins at which one line ends and the next one starts; return how many."""
    n, peak, low, low_at, falling = 0, 0.0, 0.0, 0, False
    peak_at = -least_apart
    for k in range(tally.size):
        if not falling:
            if tally[k] > peak:
                peak, peak_at = tally[k], k
            elif tally[k] < 0.6 * peak:
                falling, low, low_at = True, tally[k], k
        elif tally[k] < low:
            low, low_at = tally[k], k
        elif tally[k] > low / 0.6 and tally[k] > 0.15 and k - peak_at >= least_apart:
            if n < cuts.size:
                cuts[n] = low_at
                n += 1
            peak, peak_at, falling = tally[k], k, False
    return n


@routine
def _see_lines(
    xy_m: Float, windows: Windows, angle: Float, bend: Float
) -> tuple[Int, Int, Int, Int]:
    """Return the plants of each window (CSR start, plant), the line of each, and how many lines."""
    m = windows.key.size
    buffer, who = np.empty((_MOST_MEMBERS, 3)), np.empty(_MOST_MEMBERS, np.int64)
    start = np.zeros(m + 1, np.int64)
    for w in range(m):
        start[w + 1] = start[w] + _members(xy_m, windows, w, buffer, who)
    member, line = np.empty(start[m], np.int64), np.empty(start[m], np.int64)
    n_lines = np.empty(m, np.int64)
    bin_m = 0.1 * windows.near_m
    tally = np.empty(int(2.6 * windows.radius_m / bin_m) + 4)
    smooth, cuts = np.empty(tally.size), np.empty(_MOST_LINES, np.int64)
    place = np.empty(_MOST_MEMBERS)
    for w in range(m):
        n = _members(xy_m, windows, w, buffer, who)
        sin, cos = np.sin(angle[w]), np.cos(angle[w])
        tally[:] = 0.0
        for k in range(n):
            x = buffer[k, 0] * cos + buffer[k, 1] * sin
            y = buffer[k, 1] * cos - buffer[k, 0] * sin - 0.5 * bend[w] * x * x
            place[k] = min(max(tally.size / 2 + y / bin_m, 0.0), tally.size - 1.0)
            tally[int(place[k])] += 1.0
        for _ in range(3):  # a bell of about a quarter of the usual distance
            _blurred(tally, smooth)
        n_cuts = _cuts(tally, 5, cuts)
        n_lines[w] = n_cuts + 1
        for k in range(n):
            member[start[w] + k] = who[k]
            line[start[w] + k] = np.searchsorted(cuts[:n_cuts], int(place[k]))
    return start, member, line, n_lines


@routine
def _blurred(tally: Float, room: Float) -> None:
    n = tally.size
    for k in range(n):
        low, high = max(k - 1, 0), min(k + 1, n - 1)
        lower, upper = max(k - 2, 0), min(k + 2, n - 1)
        room[k] = (tally[lower] + tally[low] + tally[k] + tally[high] + tally[upper]) / 5.0
    for k in range(n):
        tally[k] = room[k]


@routine
def _top(root: Int, k: int) -> int:
    while root[k] != k:
        root[k] = root[root[k]]
        k = root[k]
    return k


class _United(NamedTuple):
    """Lines of windows, united bit by bit: a ring of lines each, its top, and how many they are."""

    top: Int
    after: Int
    size: Int
    window: Int
    plants: Int


def _united(n: int, windows: Windows, seen: tuple[Int, Int, Int], first: Int) -> Int:
    """Return one number for the lines of overlapping windows that hold the same plants."""
    start, _, line = seen
    m, n_lines = int(first[-1]), np.diff(first)
    window = np.repeat(np.arange(len(n_lines)), n_lines)
    plants = np.bincount(np.repeat(first[:-1], np.diff(start)) + line, minlength=m)
    lines = _United(np.arange(m), np.arange(m), np.ones(m, np.int64), window, plants)
    for same in _SAME:
        _unite(n, windows, seen, (first, lines), same)
    return _tops(lines.top)


@routine
def _tops(root: Int) -> Int:
    tops = np.empty(root.size, np.int64)
    for k in range(root.size):
        tops[k] = _top(root, k)
    return tops


@routine
def _unite(
    n: int,
    windows: Windows,
    seen: tuple[Int, Int, Int],
    known: tuple[Int, _United],
    same: float,
) -> None:
    start, member, line = seen
    first, lines = known
    label, stamp = np.empty(n, np.int64), np.full(n, -1)
    shared = np.empty((_MOST_LINES + 2, _MOST_LINES + 2), np.int64)
    here, there = np.empty(_MOST_LINES + 2, np.int64), np.empty(_MOST_LINES + 2, np.int64)
    for w in range(windows.key.size):
        for place in range(start[w], start[w + 1]):
            label[member[place]], stamp[member[place]] = line[place], w
        column, row = windows.key[w] // windows.high, windows.key[w] % windows.high
        for i in range(column, column + 3):
            for j in range(max(row - 2, 0), min(row + 3, windows.high)):
                other = _find(windows.key, i * windows.high + j)
                if other <= w:
                    continue
                ours, theirs = first[w + 1] - first[w], first[other + 1] - first[other]
                shared[:ours, :theirs], here[:ours], there[:theirs] = 0, 0, 0
                for place in range(start[other], start[other + 1]):
                    # plants that the first window does not see are counted apart
                    p = member[place]
                    a = label[p] if stamp[p] == w else ours
                    shared[a, line[place]] += 1
                    here[a] += 1
                    there[line[place]] += a < ours
                for a in range(ours):
                    for b in range(theirs):
                        both = shared[a, b]
                        if both >= 2 and both >= same * (here[a] + there[b] - both):
                            _join(first, lines, first[w] + a, first[other] + b)


@routine
def _join(first: Int, lines: _United, one: int, two: int) -> None:
    """Make two lines one, unless both would then run through one window side by side."""
    one, two = _top(lines.top, one), _top(lines.top, two)
    if one == two:
        return
    if lines.size[one] < lines.size[two]:
        one, two = two, one
    k = two
    while True:
        w = lines.window[k]
        for other in range(first[w], first[w + 1]):
            seen = min(lines.plants[other], lines.plants[k]) >= 3
            if other != k and seen and _top(lines.top, other) == one:
                return
        k = lines.after[k]
        if k == two:
            break
    lines.top[two] = one
    lines.size[one] += lines.size[two]
    lines.after[one], lines.after[two] = lines.after[two], lines.after[one]


@routine
def _voted(
    xy_m: Float, windows: Windows, seen: tuple[Int, Int, Int], first: Int, united: Int
) -> Int:
    """Return the piece of each plant: that of most windows about it, the nearer the weightier."""
    start, member, line = seen
    n = len(xy_m)
    count = np.zeros(n + 1, np.int64)
    for p in member:
        count[p + 1] += 1
    begin = np.cumsum(count)
    at = begin[:-1].copy()
    piece, weight = np.empty(member.size, np.int64), np.empty(member.size)
    for w in range(windows.key.size):
        cx, cy = windows.centre_m[w]
        for place in range(start[w], start[w + 1]):
            p = member[place]
            off = (xy_m[p, 0] - cx) ** 2 + (xy_m[p, 1] - cy) ** 2
            piece[at[p]] = united[first[w] + line[place]]
            weight[at[p]] = 1.05 - off / windows.radius_m**2
            at[p] += 1
    voted = np.empty(n, np.int64)
    for p in range(n):
        best = -1.0
        for a in range(begin[p], begin[p + 1]):
            total = 0.0
            for b in range(begin[p], begin[p + 1]):
                if piece[b] == piece[a]:
                    total += weight[b]
            if total > best:
                best, voted[p] = total, piece[a]
    return voted
