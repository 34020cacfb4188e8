"""Which plants to spray one by one with a knapsack, each with the ring of plants around it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.sparse import csr_array, vstack

from fieldmon.compute.jit import inner_loop, routine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    Mask = NDArray[np.bool_]
    #: of a matrix: values, rows, columns
    _Entries = tuple[Floats, NDArray[np.intp], NDArray[np.intp]]

# rings are tried by suspicion alone where more plants than so many are worth one
_MOST_WORTH = 5_000
# rings are added, taken back and moved so often at most
_PASSES = 30
_LEAST = 1e-9


def best_rings(grid: PlantGrid, gain: Floats, ring: int, per_zone: float = 0.0) -> Mask:
    """Return the plants ``(n,)`` sprayed by the rings that gain most, near the best of all choices.

    A ring costs only what no other has sprayed yet. Rings are tried in the order in which a linear
    program has them, and then added (two at once too), taken back and moved while that gains.

    Parameters
    ----------
    grid
        The plants.
    gain
        ``(n,)`` what spraying each plant gains; below 0 where it costs more than it saves.
    ring
        So many steps from plant to plant around each that is chosen, 1 or more.
    per_zone
        What a ring costs that touches no plant sprayed by another.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.plot.layout import rectangle
    >>> gain = np.full(81, -0.1)
    >>> gain[40] = 1.0
    >>> int(best_rings(rectangle(9, 9), gain, 1).sum())
    5
    """
    worth = np.flatnonzero(gain > 0.0)
    times = np.zeros(len(grid), np.int32)
    if not worth.size:
        return times > 0
    tried = worth[np.argsort(-gain[worth], kind="stable")]
    if len(worth) <= _MOST_WORTH:
        tried = _relaxed(grid, gain, ring)[0]
    rings = _Rings.of(grid, tried, ring)
    _choose(rings, (gain, per_zone), np.zeros(len(tried), np.bool_), times)
    return times > 0


def rings_bound(grid: PlantGrid, gain: Floats, ring: int) -> float:
    """Return what no choice of rings can gain more than, see `best_rings`."""
    return _relaxed(grid, gain, ring)[1] if (gain > 0.0).any() else 0.0


def _relaxed(grid: PlantGrid, gain: Floats, ring: int) -> tuple[NDArray[np.intp], float]:
    """Return plants to spray with their rings, the likeliest of the best choice first; the bound.

    By a linear program in which a ring may be sprayed in part. Who sprays a part of a plant must
    still pay as large a part of the cheapest ring that holds it, somewhere near: without that the
    program would pay for a little of many rings at once, and the bound be three times as far off.
    """
    from scipy.optimize import linprog  # noqa: PLC0415 - what only this needs loads longest

    worth = np.flatnonzero(gain > 0.0)
    # only rings that hold a plant worth it can be worth it
    centres = np.unique(np.concatenate([around(grid, i, ring) for i in worth.tolist()]))
    rings = [around(grid, i, ring) for i in centres.tolist()]
    plants, of_plant = np.unique(np.concatenate(rings), return_inverse=True)
    n, m = len(plants), len(rings)
    of_ring = n + np.repeat(np.arange(m), [len(one) for one in rings])
    each, ones = np.arange(len(of_ring)), np.ones(len(of_ring))
    # a ring takes all its plants along, and a plant is sprayed in a ring only
    takes = _sparse((ones, each, of_ring), (-ones, each, of_plant), (len(each), n + m))
    alone = np.ones(n), np.arange(n), np.arange(n)
    within = _sparse(alone, (-ones, of_plant, of_ring), (n, n + m))
    limits = vstack([takes, within, _paying(grid, gain, ring, (plants, n + m))])
    weights = np.concatenate([-gain[plants], np.zeros(m)])
    made = linprog(weights, limits, np.zeros(limits.shape[0]), bounds=(0.0, 1.0), method="highs")
    order = np.lexsort((-gain[centres], -np.round(made.x[n:], 6)))
    return centres[order], max(-float(made.fun), 0.0)


def _paying(
    grid: PlantGrid, gain: Floats, ring: int, columns: tuple[NDArray[np.intp], int]
) -> csr_array:
    """Return, for each plant worth it, that near it at least its cheapest ring is paid for."""
    plants, wide = columns
    cost, column = np.maximum(-gain, 0.0), np.full(len(grid), -1)
    column[plants] = np.arange(len(plants))
    values, rows, places = [], [], []
    for row, i in enumerate(np.flatnonzero(gain > 0.0).tolist()):
        cheapest = min(cost[around(grid, c, ring)].sum() for c in around(grid, i, ring).tolist())
        near = around(grid, i, 2 * ring)
        near = near[column[near] >= 0]
        values += [np.array([cheapest]), -cost[near]]
        places += [column[[i]], column[near]]
        rows.append(np.full(1 + len(near), row))
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(places))
    return csr_array(entries, shape=(len(rows), wide))


def around(grid: PlantGrid, plant: int, ring: int) -> NDArray[np.intp]:
    """Return a plant and those up to so many steps from it, two faces as one."""
    start, other = grid.vines_beside
    reached = grid.vine[[plant]]
    for _ in range(ring):
        beside = [other[start[i] : start[i + 1]] for i in reached.tolist()]
        reached = np.unique(np.concatenate([reached, *beside]))
    return reached


def _sparse(one: _Entries, other: _Entries, shape: tuple[int, int]) -> csr_array:
    """Return a matrix of values at rows and columns."""
    values, rows, columns = (np.concatenate(pair) for pair in zip(one, other, strict=True))
    return csr_array((values, (rows, columns)), shape)


class _Rings(NamedTuple):
    """Plants of rings ``plant[start[r]:start[r + 1]]``, and the rings that hold each plant."""

    start: Ints
    plant: Ints
    held_start: Ints
    held_by: Ints

    @classmethod
    def of(cls, grid: PlantGrid, centres: NDArray[np.intp], ring: int) -> _Rings:
        rings = [around(grid, i, ring) for i in centres.tolist()]
        sizes = np.array([len(one) for one in rings])
        plant = np.concatenate(rings).astype(np.int64)
        of_ring = np.repeat(np.arange(len(rings)), sizes)
        held = np.bincount(plant, minlength=len(grid))
        return cls(
            np.concatenate([[0], np.cumsum(sizes)]),
            plant,
            np.concatenate([[0], np.cumsum(held)]),
            of_ring[np.argsort(plant, kind="stable")].astype(np.int64),
        )


@routine
def _choose(
    rings: _Rings, pays: tuple[Floats, float], chosen: Mask, times: NDArray[np.int32]
) -> None:
    """Choose rings in place: `times` is by how many each plant is sprayed."""
    for _ in range(_PASSES):
        better = False
        for r in range(chosen.size):
            if chosen[r]:
                _put(rings, r, -1, times)
                chosen[r] = False
                other = _best_near(rings, r, pays, chosen, times)
                more = _adds(rings, other, pays, times)
                own = _adds(rings, r, pays, times)
                if more <= own + _LEAST and own > 0.0:
                    other = r
                elif more <= 0.0:
                    better = True
                    continue
                better |= other != r
                _put(rings, other, 1, times)
                chosen[other] = True
            else:
                own = _adds(rings, r, pays, times)
                _put(rings, r, 1, times)
                chosen[r] = True
                # one that does not pay by itself may with another one
                other = _best_near(rings, r, pays, chosen, times)
                more = _adds(rings, other, pays, times) if other != r else 0.0
                if own + max(more, 0.0) > _LEAST:
                    better = True
                    if more > _LEAST:
                        _put(rings, other, 1, times)
                        chosen[other] = True
                else:
                    _put(rings, r, -1, times)
                    chosen[r] = False
        if not better:
            return


@inner_loop
def _best_near(
    rings: _Rings, r: int, pays: tuple[Floats, float], chosen: Mask, times: NDArray[np.int32]
) -> int:
    """Return the ring not chosen yet that gains most of those that share a plant with r; or r."""
    best, most = r, -np.inf
    for k in range(rings.start[r], rings.start[r + 1]):
        p = rings.plant[k]
        for h in range(rings.held_start[p], rings.held_start[p + 1]):
            other = rings.held_by[h]
            if not chosen[other]:
                gains = _adds(rings, other, pays, times)
                if gains > most:
                    best, most = other, gains
    return best


@inner_loop
def _adds(rings: _Rings, r: int, pays: tuple[Floats, float], times: NDArray[np.int32]) -> float:
    """Return what a ring gains by the plants that no other sprays yet."""
    gain, per_zone = pays
    total, first = 0.0, True
    for k in range(rings.start[r], rings.start[r + 1]):
        p = rings.plant[k]
        if times[p] == 0:
            total += gain[p]
        else:
            first = False
    return total - per_zone if first else total


@inner_loop
def _put(rings: _Rings, r: int, by: int, times: NDArray[np.int32]) -> None:
    for k in range(rings.start[r], rings.start[r + 1]):
        times[rings.plant[k]] += by
