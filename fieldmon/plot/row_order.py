"""Which lines run beside which, and so which are rows of one block, in their order."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.strands import Strands

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# rows beside each other run the same way within this, and are this many usual spacings apart
ASTRAY_DEG, _MOST_SPACINGS = 30.0, 1.7


class StrandRows(NamedTuple):
    """Which strands are level with each other, block by block.

    ``row (f,)`` of each strand, rows by block and level; ``turned (f,)`` whether it runs against
    its row; ``block (r,)`` of each row; the usual spacing, NaN if no rows are beside each other.
    """

    row: Int
    turned: NDArray[np.bool_]
    block: Int
    spacing_m: float

    def __repr__(self) -> str:
        return f"<StrandRows: {len(self.row)} strands in {len(self.block)} rows>"

    @classmethod
    def of(cls, strands: Strands, beside: StrandPairs) -> StrandRows:
        """Sort strands into rows and blocks by who is beside whom."""
        f = len(strands.start) - 1
        level, sign, block = _levels(f, beside)
        _left_of_north(strands, level, sign, block)
        spacing_m = float(np.median(beside.apart_m)) if len(beside.apart_m) else np.nan
        _part_doubled(level, block, beside)
        place = _block_order(strands, block)
        keys = np.stack([place, level], axis=1)
        rows, row = np.unique(keys, axis=0, return_inverse=True)
        return cls(
            row.reshape(-1), sign < 0, np.unique(rows[:, 0], return_inverse=True)[1], spacing_m
        )


class StrandPairs(NamedTuple):
    """Pairs of strands beside each other ``(e,)``: the other is left (+1) or right of one."""

    one: Int
    other: Int
    side: Int
    same_way: Int
    votes: Int
    apart_m: Float

    def __repr__(self) -> str:
        return f"<StrandPairs: {len(self.one)} pairs>"


def neighbouring_strands(strands: Strands, step_m: float) -> StrandPairs:
    """Return which strands run beside which."""
    m = len(strands.plant)
    owner = strands.owner
    usual = np.hypot(*np.diff(strands.line_m, axis=0).T)[np.diff(owner) == 0]
    every = max(int(step_m / np.median(usual)), 1) if len(usual) else 1
    place = np.arange(m) - strands.start[owner]
    thin = np.flatnonzero((place % every == 0) | (np.arange(m) == strands.start[owner + 1] - 1))
    at, ahead, owner = strands.line_m[thin], strands.ahead[thin], owner[thin]
    k = min(24, len(thin))
    near = cKDTree(at).query(at, k=np.arange(1, k + 1))[1]
    way = at[near] - at[:, None]
    along = np.einsum("ijk,ik->ij", way, ahead)
    left = ahead[:, None, 0] * way[:, :, 1] - ahead[:, None, 1] * way[:, :, 0]
    turn = np.einsum("ijk,ik->ij", ahead[near], ahead)
    fits = (owner[near] != owner[:, None]) & (np.abs(along) <= 0.7 * np.abs(left))
    one, other, side, same, apart = [], [], [], [], []
    for sign in (1, -1):
        off = np.where(fits & (sign * left > 0), np.abs(left), np.inf)
        best = off.argmin(axis=1)
        rows = np.arange(len(thin))
        ok = np.isfinite(off[rows, best])
        ok &= np.abs(turn[rows, best]) >= np.cos(np.deg2rad(ASTRAY_DEG))
        one.append(owner[ok])
        other.append(owner[near[rows, best]][ok])
        side.append(np.full(int(ok.sum()), sign))
        same.append(np.sign(turn[rows, best][ok]))
        apart.append(off[rows, best][ok])
    columns = [np.concatenate(part) for part in (one, other, side, same, apart)]
    return counted_pairs(len(strands.start) - 1, *columns)


def counted_pairs(
    f: int, one: Int, other: Int, side: Int, same: Float, apart: Float
) -> StrandPairs:
    """Return each pair once, with its votes; pairs too far apart for rows are left out."""
    usual = np.full(f, np.inf)
    order = np.argsort(one, kind="stable")
    for part in np.split(order, np.flatnonzero(np.diff(one[order])) + 1):
        if len(part):
            usual[one[part[0]]] = np.median(apart[part])
    # at the edge of a block the nearest row on the far side is another block's
    limit = _MOST_SPACINGS * np.minimum(usual[one], usual[other])
    kept = apart <= limit * 1.0000001
    one, other, side, same, apart = (v[kept] for v in (one, other, side, same, apart))
    key = (one * f + other) * 2 + (side > 0)
    _, first, group, votes = np.unique(
        key, return_index=True, return_inverse=True, return_counts=True
    )
    way = np.sign(np.bincount(group, same, len(first)) + 0.5).astype(np.int64)
    mean = np.bincount(group, apart, len(first)) / np.maximum(votes, 1)
    return StrandPairs(one[first], other[first], side[first], way, votes, mean)


def _levels(f: int, beside: StrandPairs) -> tuple[Int, Int, Int]:
    """Return of each strand its level in its block, its direction in it (1, -1), and the block.

    Strands are placed from the best known on: by the pairs with most votes.
    """
    from heapq import heappop, heappush  # noqa: PLC0415

    edges: list[list[tuple[int, int, int, int]]] = [[] for _ in range(f)]
    columns = (beside.one, beside.other, beside.side, beside.same_way, beside.votes)
    for one, other, side, same, votes in zip(*(c.tolist() for c in columns), strict=True):
        edges[one].append((votes, other, side, same))
        edges[other].append((votes, one, -side * same, same))
    level, sign, block = np.zeros(f, np.int64), np.ones(f, np.int64), np.full(f, -1)
    n_blocks = 0
    for seed in range(f):
        if block[seed] >= 0:
            continue
        queue = [(0, seed, 0, 1)]
        while queue:
            _, strand, at, way = heappop(queue)
            if block[strand] >= 0:
                continue
            block[strand], level[strand], sign[strand] = n_blocks, at, way
            for votes, other, side, same in edges[strand]:
                if block[other] < 0:
                    heappush(queue, (-votes, other, at + way * side, way * same))
        n_blocks += 1
    return level, sign, block


def _left_of_north(strands: Strands, level: Int, sign: Int, block: Int) -> None:
    """Turn blocks so that rows point to the east of north-south, and levels rise to their left."""
    owner = strands.owner
    ahead = strands.ahead * sign[owner, None]
    of = block[owner]
    east, north = (np.bincount(of, ahead[:, k], block.max() + 1) for k in range(2))
    back = (east < -1e-9) | ((np.abs(east) <= 1e-9) & (north < 0))
    sign[back[block]] *= -1
    level[back[block]] *= -1


def _part_doubled(level: Int, block: Int, beside: StrandPairs) -> None:
    """Give strands that are level with one beside them a block of their own."""
    same = (block[beside.one] == block[beside.other]) & (level[beside.one] == level[beside.other])
    for k in np.flatnonzero(same & (beside.votes >= 2)):
        one, other = int(beside.one[k]), int(beside.other[k])
        if block[one] == block[other]:
            block[max(one, other)] = block.max() + 1


def _block_order(strands: Strands, block: Int) -> Int:
    """Return the number of each strand's block: those with more plants first."""
    size = np.bincount(block[strands.owner], minlength=block.max() + 1)
    rank = np.empty(len(size), np.int64)
    rank[np.argsort(-size, kind="stable")] = np.arange(len(size))
    return rank[block]


def in_line(strands: Strands, rows: StrandRows, parts: list[int]) -> list[int]:
    """Return strands of one row in their order along it."""
    if len(parts) == 1:
        return parts
    ahead, middle = [], []
    for strand in parts:
        a, b = strands.start[strand], strands.start[strand + 1]
        sign = -1.0 if rows.turned[strand] else 1.0
        ahead.append(sign * strands.ahead[a:b].sum(axis=0))
        middle.append(strands.line_m[a:b].mean(axis=0))
    along = np.array(middle) @ np.sum(ahead, axis=0)
    return [parts[k] for k in np.argsort(along)]
