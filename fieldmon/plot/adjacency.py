"""Who stands next to whom, as lists of neighbours (CSR: start offsets and plants)."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from fieldmon.compute.arrays import offsets
from fieldmon.compute.jit import loop

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float: TypeAlias = NDArray[np.float64]
    Index: TypeAlias = NDArray[np.intp]
    Lists: TypeAlias = tuple[NDArray[np.int32], NDArray[np.int32]]

#: what is further away than this many spacings is no longer the next one
NEXT = 1.5
_NOBODY = -1


def lists(n: int, one: Index, other: Index) -> Lists:
    """Return CSR ``(start, plant)`` of n plants from pairs, each pair counted both ways."""
    start = offsets(np.bincount(one, minlength=n) + np.bincount(other, minlength=n))
    plant = np.empty(2 * len(one), np.int32)
    _fill(start[:-1].copy(), np.asarray(one), np.asarray(other), plant)
    _in_order(start, plant)
    return start.astype(np.int32), plant


def along(x_m: Float, row: NDArray[np.integer], plant_spacing_m: Float | float) -> Lists:
    """Return each plant's neighbours before and after it in its own row.

    A gap of more than one and a half spacings (one for all, or ``(n,)``) parts neighbours: a
    plant is missing there.
    """
    reach_m = NEXT * np.broadcast_to(plant_spacing_m, row.shape)[1:]
    near = (row[1:] == row[:-1]) & (np.diff(x_m) <= reach_m)
    pair = np.flatnonzero(near)
    return lists(len(x_m), pair, pair + 1)


def across(
    xy_m: Float, line: NDArray[np.integer], row_spacing_m: float, plant_spacing_m: float
) -> Lists:
    """Return each plant's neighbours on the lines on either side.

    They are the nearest plant on that line, at most half a plant spacing further along, and the
    plants whose nearest one this is. Lines more than one and a half row spacings apart have no
    neighbours.

    Parameters
    ----------
    xy_m
        ``(n, 2)`` line by line, x ascending within each.
    line
        ``(n,)`` line of each plant, ascending without gaps.
    """
    above = _nearest(xy_m, line, 1, row_spacing_m, plant_spacing_m)
    below = _nearest(xy_m, line, -1, row_spacing_m, plant_spacing_m)
    return _either_way(above, below)


def across_aisles(
    aisle: NDArray[np.integer],
    place_m: Float,
    off_m: Float,
    row_spacing_m: Float,
    plant_spacing_m: Float,
) -> Lists:
    """Return each plant's neighbours over the aisles on both sides, however the rows run.

    As `across`: nearest is who stands nearest along the aisle between them.

    Parameters
    ----------
    aisle
        ``(n, 2)`` the aisles to the right and to the left of each plant's row.
    place_m
        ``(n, 2)`` each plant's place along both, ascending in each aisle.
    off_m
        ``(n, 2)`` how far it stands from the middle of both.
    row_spacing_m, plant_spacing_m
        ``(n,)`` as its block is planted.
    """
    # one ascending axis for all aisles, as above
    stretch = float(np.ptp(place_m)) + 4 * float(plant_spacing_m.max())
    key = place_m + aisle * stretch
    reach_m = (0.5 + 1e-6) * plant_spacing_m

    def over(own: int) -> Index:
        other = key[:, 1 - own]
        after = np.searchsorted(other, key[:, own]).clip(0, len(key) - 1)
        before = (after - 1).clip(0)
        nearer = key[:, own] - other[before] <= other[after] - key[:, own]
        found: Index = np.where(nearer, before, after)
        far_m = off_m[:, own] + off_m[found, 1 - own]
        alone = np.abs(other[found] - key[:, own]) > reach_m
        found[alone | (far_m > NEXT * row_spacing_m)] = _NOBODY
        return found

    return _either_way(over(1), over(0))


def beside_vines(
    vine: Index,
    place: tuple[Float, NDArray[np.integer]],
    spacing_m: tuple[float, float],
    along_rows: Lists,
    *,
    bent: bool,
) -> Lists:
    """Return the neighbours of each vine, in its row and the next ones, by its first face.

    Second faces have none. Where rows bend, the nearest of the next row is one if it stands about
    as near as rows do.

    Parameters
    ----------
    vine
        ``(n,)`` the first face of the vine that each plant is.
    place
        Where plants stand, ``(n, 2)`` in metres, and the line ``(n,)`` that each stands on.
    spacing_m
        Distances between rows and between plants.
    along_rows
        Neighbours along the rows, as `along` has them.
    bent
        Whether rows bend.
    """
    vines = np.flatnonzero(vine == np.arange(len(vine)))
    xy_m, line = place[0][vines], place[1][vines]
    if bent:
        one, other = (vines[which] for which in _nearest_of_next(xy_m, line, spacing_m))
    else:
        start, plant = across(xy_m, line, *spacing_m)
        one, other = np.repeat(vines, np.diff(start)), vines[plant]
    start, plant = along_rows
    one = np.concatenate([vine[np.repeat(np.arange(len(vine)), np.diff(start))], one])
    other = np.concatenate([vine[plant], other])
    # each pair once, whichever of the two named it
    pairs = np.unique(np.sort(np.stack([one, other], axis=1), axis=1), axis=0)
    return lists(len(vine), *pairs.T)


def _nearest_of_next(
    xy_m: Float, line: NDArray[np.integer], spacing_m: tuple[float, float]
) -> tuple[Index, Index]:
    """Return plants ``(k,)`` by places, and the nearest to each on a line beside its own."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - as below

    row_m, plant_m = spacing_m
    near_m = NEXT * float(np.hypot(row_m, plant_m / 2))
    pairs = cKDTree(xy_m).query_pairs(near_m, output_type="ndarray")
    pairs = np.concatenate([pairs, pairs[:, ::-1]])
    step = line[pairs[:, 1]] - line[pairs[:, 0]]
    pairs, step = pairs[np.abs(step) == 1], step[np.abs(step) == 1]
    apart_m = np.hypot(*(xy_m[pairs[:, 0]] - xy_m[pairs[:, 1]]).T)
    order = np.lexsort((apart_m, step, pairs[:, 0]))
    pairs, step = pairs[order], step[order]
    first = np.ones(len(pairs), bool)
    first[1:] = (pairs[1:, 0] != pairs[:-1, 0]) | (step[1:] != step[:-1])
    return pairs[first, 0], pairs[first, 1]


def delaunay_sides(xy_m: Float) -> Index:
    """Return the pairs ``(e, 2)`` of points beside each other in a net of triangles."""
    from scipy.spatial import Delaunay, QhullError  # noqa: PLC0415 - half a second to import

    try:
        corners = np.asarray(Delaunay(xy_m).simplices, np.intp)
        sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    except (QhullError, ValueError):  # fewer than three, or all in line
        along = np.lexsort(xy_m.T)
        sides = np.stack([along[:-1], along[1:]], axis=1)
    pairs: Index = np.unique(np.sort(sides, axis=1), axis=0)
    return pairs


def gabriel_pairs(xy_m: Float) -> Index:
    """Return the pairs ``(e, 2)`` of points within whose common circle no other one lies."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - as above

    sides = delaunay_sides(xy_m)
    if not len(sides):
        return sides
    middle = xy_m[sides].mean(axis=1)
    way = xy_m[sides[:, 0]] - xy_m[sides[:, 1]]
    radius_m = np.hypot(way[:, 0], way[:, 1]) / 2
    nearest_m = cKDTree(xy_m).query(middle)[0]
    pairs: Index = sides[nearest_m >= radius_m * (1 - 1e-9)]
    return pairs


def _either_way(above: Index, below: Index) -> Lists:
    """Return lists of neighbours from who is nearest above and who below each, -1 for nobody."""
    lower = np.flatnonzero(above != _NOBODY)
    upper = np.flatnonzero((below != _NOBODY) & (above[below] != np.arange(len(below))))
    return lists(
        len(above),
        np.concatenate([lower, below[upper]]),
        np.concatenate([above[lower], upper]),
    )


def _nearest(
    xy_m: Float, line: NDArray[np.integer], step: int, row_spacing_m: float, plant_spacing_m: float
) -> Index:
    x, y = xy_m.T
    # one ascending axis for all lines, so that one binary search serves them all
    stretch = float(np.ptp(x)) + 4 * plant_spacing_m
    place = x + line * stretch
    wanted = place + step * stretch
    after = np.searchsorted(place, wanted).clip(0, len(x) - 1)
    before = (after - 1).clip(0)
    nearer_before = wanted - place[before] <= place[after] - wanted
    found: Index = np.where(nearer_before, before, after)
    out_of_reach = (
        (np.abs(x[found] - x) > (0.5 + 1e-6) * plant_spacing_m)
        | (np.abs(y[found] - y) > NEXT * row_spacing_m)
        | (line[found] != line + step)
    )
    found[out_of_reach] = _NOBODY
    return found


@loop
def link(start: NDArray[np.int32], plant: NDArray[np.int32], back: NDArray[np.int32]) -> None:
    """Note in `back` where each neighbour's own list has the plant; its own place if nowhere."""
    for i in range(start.size - 1):
        for e in range(start[i], start[i + 1]):
            back[e] = e
            for other in range(start[plant[e]], start[plant[e] + 1]):
                if plant[other] == i:
                    back[e] = other


@loop
def _fill(free: Index, one: Index, other: Index, plant: NDArray[np.int32]) -> None:
    """Write each pair into both lists, where each has its next free place."""
    for k in range(one.size):
        plant[free[one[k]]], plant[free[other[k]]] = other[k], one[k]
        free[one[k]] += 1
        free[other[k]] += 1


@loop
def _in_order(start: Index, plant: NDArray[np.int32]) -> None:
    """Sort each list, which is short."""
    for i in range(start.size - 1):
        for e in range(start[i] + 1, start[i + 1]):
            this, at = plant[e], e
            while at > start[i] and plant[at - 1] > this:
                plant[at] = plant[at - 1]
                at -= 1
            plant[at] = this
