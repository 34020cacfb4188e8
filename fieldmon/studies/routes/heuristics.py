"""Published heuristics for the aisle-graph orienteering problem, written from their descriptions.

GR and GPR: T. Thayer, S. Vougioukas, K. Goldberg and S. Carpin, Routing algorithms for robot
assisted precision irrigation (ICRA 2018). OFR, GFR and HPR: F. Betti Sorbelli, S. Carpin, F. Coro,
A. Navarra and C. Pinotti, Optimal routing schedules for robots operating in aisle-structures
(ICRA 2020). These are our own implementations; what a description leaves open is noted where it
is decided. Each returns the places of a closed walk of at most so many steps.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import loop
from fieldmon.studies.routes.drive import Walker, driven

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]


def greedy_row(reward: Float, budget: int) -> Int:
    """GR: drive through the row with the most reward, then the next, as long as one gets back.

    A row that does not fit is left out for good and the next one tried. From the right headland
    one gets back through the row itself.
    """
    return _full_rows(reward, budget, by_time=False)


def greedy_full_row(reward: Float, budget: int) -> Int:
    """GFR: the same by reward per step to drive there and through.

    Doubt: the second group's texts use the name also for GR itself. Read so, it would be GR.
    """
    return _full_rows(reward, budget, by_time=True)


def _full_rows(reward: Float, budget: int, *, by_time: bool) -> Int:
    walker, (m, n) = Walker(reward.shape[1]), reward.shape
    held, left = reward.sum(axis=1), np.ones(m, np.bool_)
    while left.any():
        away = np.abs(np.arange(m) - walker.row)
        rank = held / (away + n + 1) if by_time else held
        row = int(np.argmax(np.where(left, rank, -1.0)))
        left[row] = False
        passes = 2 if walker.column == 0 else 1
        need = away[row] + passes * (n + 1) + row
        if held[row] > 0 and len(walker.places) - 1 + need <= budget:
            walker.through(row)
    return walker.home()


def greedy_partial_row(reward: Float, budget: int) -> Int:
    """GPR: take the row, or the part of a row from this headland, with the most reward per step.

    A whole row is driven through, a part in and out. What has been passed counts no more.

    Doubt: where the best one does not fit, the description takes others out of the running, too;
    here it is only that one and whatever fits no more, which can but help.
    """
    m, n = reward.shape
    walker, rest = Walker(n), reward.copy()
    deep, row = np.arange(1, n + 1), np.arange(m)
    while True:
        left_steps = budget - (len(walker.places) - 1)
        away = np.abs(row - walker.row)
        at_left = walker.column == 0
        held = np.cumsum(rest if at_left else rest[:, ::-1], axis=1)
        part_steps = away[:, None] + 2 * deep
        back = row[:, None] + (0 if at_left else n + 1)
        part = np.where(part_steps + back <= left_steps, held / part_steps, 0.0)
        whole_steps = away + n + 1
        fits = whole_steps + row + (n + 1 if at_left else 0) <= left_steps
        whole = np.where(fits, held[:, -1] / whole_steps, 0.0)
        best_part, best_whole = part.max(), whole.max()
        if max(best_part, best_whole) <= 0.0:
            return walker.home()
        if best_whole >= best_part:
            chosen = int(np.argmax(whole))
            walker.through(chosen)
            rest[chosen] = 0.0
            continue
        chosen, far = (int(k) for k in np.unravel_index(np.argmax(part), part.shape))
        walker.excursion(chosen, far + 1)
        if at_left:
            rest[chosen, : far + 1] = 0.0
        else:
            rest[chosen, n - far - 1 :] = 0.0


def optimal_full_row(reward: Float, budget: int) -> Int:
    """OFR: the best walk of all that drive through whole rows only.

    For each farthest row the even number of passes that fit is spent on it and on the best of the
    rows before it; an odd number of rows takes one of them twice.
    """
    return _drive_rows(_best_rows(reward, budget), reward.shape[1])


def _best_rows(reward: Float, budget: int) -> list[int]:
    m, n = reward.shape
    held = reward.sum(axis=1)
    best, most = [], 0.0
    for last in range(m):
        passes = (budget - 2 * last) // (n + 1) // 2 * 2
        if passes < 2:
            break
        before = np.argsort(-held[:last], kind="stable")[: passes - 1]
        total = held[last] + held[before].sum()
        if total > most:
            best, most = [*sorted(before.tolist()), last], total
    return best


def _drive_rows(
    rows: list[int], n: int, left: dict[int, int] | None = None, right: dict[int, int] | None = None
) -> Int:
    """Walk through whole rows one after the other, with excursions from either headland between.

    An odd last row is driven back, too.
    """
    left, right = left or {}, right or {}
    walker, low = Walker(n), 0
    for row in [*rows, None]:
        here = left if walker.column == 0 else right
        stop = row if row is not None else max(left, default=-1) + 1
        for each in range(low, stop):
            if here.get(each, 0) > 0:
                walker.excursion(each, here[each])
        if row is None:
            break
        walker.through(row)
        low = row + 1
    return walker.home()


def heuristic_partial_row(reward: Float, budget: int) -> Int:
    """HPR: the best of five walks made of whole rows and of parts of rows from one headland.

    (1) OFR, and what is left of the budget on the near halves of the rows it comes by; (2) the
    same with those rows whole that the best walks in and out from the left and from the right
    together go deeper than half into; (3) the first row and the last that can be reached whole,
    and the near halves between from both headlands; (4) OFR; (5) the best in and out from the left.

    Doubts: in (2) rows are taken as whole from a third, a quarter ... if none qualifies from half;
    with an odd number the poorest is left out; pairs are left out from the end until they fit.
    """
    walks = [
        _completed(reward, budget, _best_rows(reward, budget)),
        _completed(reward, budget, _deep_rows(reward, budget)),
        _around(reward, budget),
        optimal_full_row(reward, budget),
        _from_left(reward, budget),
    ]
    return max(walks, key=lambda walk: driven(walk, reward).reward)


def _from_left(reward: Float, budget: int) -> Int:
    """Return the best walk in and out of rows from the left headland alone."""
    best, most = np.zeros((1, 2), np.int64), 0.0
    depth, held = _knapsack(reward, budget // 2, drive=True)
    for last in range(reward.shape[0]):
        spare = budget // 2 - last
        if spare > 0 and held[last, spare] > most:
            most = held[last, spare]
            deep = _trace(depth, last, spare)
            best = _drive_rows([], reward.shape[1], left=deep)
    return best


def _deep_rows(reward: Float, budget: int) -> list[int]:
    m, n = reward.shape
    deep = np.zeros(m, np.int64)
    for side in (reward, reward[:, ::-1]):
        depth, _ = _knapsack(side, budget // 2, drive=False)
        for row, far in _trace(depth, m - 1, budget // 2).items():
            deep[row] += far
    reach = min(m, (budget - 2 * (n + 1)) // 2 + 1)
    held = reward.sum(axis=1)
    for part in range(2, n + 3):
        rows = [row for row in range(max(reach, 0)) if deep[row] > (n + 2) / part]
        if len(rows) % 2:
            rows.remove(min(rows, key=lambda row: held[row]))
        if rows:
            break
    while rows and 2 * rows[-1] + len(rows) * (n + 1) > budget:
        rows = rows[:-2]
    return rows


def _completed(reward: Float, budget: int, rows: list[int]) -> Int:
    """Return a walk through whole rows with the rest of the budget on near halves by the way."""
    m, n = reward.shape
    if not rows:
        return np.zeros((1, 2), np.int64)
    passes = len(rows) + len(rows) % 2
    spare = (budget - 2 * rows[-1] - passes * (n + 1)) // 2
    at_left: list[int] = []
    at_right: list[int] = []
    side, low = 0, 0
    for row in rows:
        (at_left if side == 0 else at_right).extend(range(low, row))
        side, low = 1 - side, row + 1
    # going on to the last rows costs its way there and back, if the budget allows for it
    beyond = m - 1 - rows[-1]
    if side == 0 and 0 < beyond <= spare:
        at_left.extend(range(rows[-1] + 1, m))
        spare -= beyond
    return _with_halves(reward, spare, rows, (at_left, at_right))


def _around(reward: Float, budget: int) -> Int:
    m, n = reward.shape
    last = min(m - 1, (budget - 2 * (n + 1)) // 2)
    if last < 1:
        return np.zeros((1, 2), np.int64)
    spare = (budget - 2 * (n + 1) - 2 * last) // 2
    # right halves are walked into on the way there, left halves on the way back
    inner = list(range(1, last))
    left, right = _halves(reward, spare, (inner, inner))
    walker = Walker(n)
    walker.through(0)
    for row in inner:
        if right.get(row, 0):
            walker.excursion(row, right[row])
    walker.through(last)
    for row in inner[::-1]:
        if left.get(row, 0):
            walker.excursion(row, left[row])
    return walker.home()


def _with_halves(
    reward: Float, spare: int, rows: list[int], sides: tuple[list[int], list[int]]
) -> Int:
    left, right = _halves(reward, spare, sides)
    return _drive_rows(rows, reward.shape[1], left, right)


def _halves(
    reward: Float, spare: int, sides: tuple[list[int], list[int]]
) -> tuple[dict[int, int], dict[int, int]]:
    """Return how deep to go into the near halves of rows from the left and from the right."""
    at_left, at_right = sides
    n = reward.shape[1]
    if spare <= 0 or not at_left + at_right:
        return {}, {}
    half = n // 2
    parts = np.concatenate([reward[at_left, :half], reward[at_right, ::-1][:, :half]])
    depth, _ = _knapsack(parts, spare, drive=False)
    deep = _trace(depth, len(parts) - 1, spare)
    left = {row: deep.get(k, 0) for k, row in enumerate(at_left)}
    right = {row: deep.get(len(at_left) + k, 0) for k, row in enumerate(at_right)}
    return left, right


def _knapsack(reward: Float, spare: int, *, drive: bool) -> tuple[NDArray[np.int32], Float]:
    """Return how deep to go into each row, and the most reward, by depths spent so far.

    ``(m, spare + 1)`` each. With `drive` the rewards are those of all rows up to that one.
    """
    m = len(reward)
    depth, held = np.zeros((m, spare + 1), np.int32), np.zeros((m, spare + 1))
    _spend(np.ascontiguousarray(reward), depth, held)
    return depth, held if drive else held[-1:]


def _trace(depth: NDArray[np.int32], last: int, spare: int) -> dict[int, int]:
    deep = {}
    for row in range(last, -1, -1):
        deep[row] = int(depth[row, spare])
        spare -= deep[row]
    return deep


@loop
def _spend(reward: Float, depth: NDArray[np.int32], held: Float) -> None:
    m, n = reward.shape
    for row in range(m):
        for b in range(held.shape[1] if row > 0 else 0):
            held[row, b] = held[row - 1, b]
        total, most = 0.0, 0.0
        for k in range(1, n + 1):
            total += reward[row, k - 1]
            if total <= most:
                continue
            most = total
            for b in range(held.shape[1] - 1, k - 1, -1):
                before = held[row - 1, b - k] if row > 0 else 0.0
                if before + total > held[row, b]:
                    held[row, b], depth[row, b] = before + total, k


HEURISTICS: dict[str, Callable[[Float, int], Int]] = {
    "GR": greedy_row,
    "GPR": greedy_partial_row,
    "GFR": greedy_full_row,
    "OFR": optimal_full_row,
    "HPR": heuristic_partial_row,
}
