"""What each row yields is the most that so deep a drive can hold, and is traced back to it."""

from itertools import product

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.planning.routes.walk_sweep import (
    APART,
    CLOSING,
    FROM_BOTH,
    FROM_LEFT,
    FROM_RIGHT,
    JOINED,
    LEFT,
    NEVER,
    ONCE,
    RIGHT,
    ROUND,
    SOME_LEFT,
    SOME_RIGHT,
    TABLES,
    KeptStates,
    StateWorth,
    SweepRoom,
    _spread,
    _worth_it,
    depths,
    fill_tables,
    narrow,
    sweep,
)
from tests.thorough import seeds

REWARD = np.random.default_rng(7).integers(0, 9, (3, 6)).astype(float)
N = REWARD.shape[1]


def tables_of_rewards():
    made = np.full((len(REWARD), TABLES, N + 2), NEVER)
    fill_tables(REWARD, made)
    return made


def held(row, left, right):
    """Return what plants so deep from the left and from the right hold, each counted once."""
    passed = np.arange(N)
    return REWARD[row, (passed < left) | (passed >= N - right)].sum()


@pytest.mark.parametrize(("row", "deep"), list(product(range(3), range(N + 1))))
def test_no_other_way_in_and_out_holds_more(row, deep):
    tables = tables_of_rewards()
    ways = [(deep - right, right) for right in range(deep + 1)]
    assert tables[row, FROM_LEFT, deep] == held(row, deep, 0)
    assert tables[row, FROM_RIGHT, deep] == held(row, 0, deep)
    assert tables[row, FROM_BOTH, deep] == max(held(row, *way) for way in ways)
    if deep:
        assert tables[row, SOME_RIGHT, deep] == max(held(row, *way) for way in ways if way[1])
        assert tables[row, SOME_LEFT, deep] == max(held(row, *way) for way in ways if way[0])


def test_a_row_driven_through_holds_all_its_plants():
    tables = tables_of_rewards()
    assert tables[:, ONCE, 0].tolist() == tables[:, CLOSING, N + 1].tolist() == (
        REWARD.sum(axis=1).tolist()
    )  # fmt: skip


@pytest.mark.parametrize("table", [FROM_LEFT, FROM_RIGHT, FROM_BOTH, SOME_RIGHT, SOME_LEFT])
def test_what_a_row_yields_is_traced_back_to_how_deep_it_was_driven(table):
    tables = tables_of_rewards()
    for row, deep in product(range(3), range(1, N + 1)):
        left, right = depths(tables[row], table, deep)
        assert left + right == deep
        assert held(row, left, right) == tables[row, table, deep]
        assert right > 0 or table != SOME_RIGHT
        assert left > 0 or table != SOME_LEFT


def all_ways(row):
    """Yield state before a row, state after, half steps in it, and what they hold."""
    n, all_there = len(row), row.sum()
    for left, right in product(range(n + 1), repeat=2):
        if left + right <= n:
            some = row[:left].sum() + row[n - right :].sum()
            yield from ((state, state, left + right, some) for state in (ROUND, JOINED, APART))
            yield (LEFT, APART if right else LEFT, left + right, some)
            yield (RIGHT, APART if left else RIGHT, left + right, some)
    for state in (LEFT, RIGHT, JOINED, APART):
        yield state, ROUND, 0, all_there
    for state in (LEFT, RIGHT, ROUND, APART):
        yield state, JOINED, n + 1, all_there


#: between rows: state after one, state before the next, half steps of the headlands
ONWARD = (
    (LEFT, LEFT, 1), (JOINED, LEFT, 1), (RIGHT, RIGHT, 1), (JOINED, RIGHT, 1), (ROUND, ROUND, 1),
    (JOINED, JOINED, 2), (APART, APART, 2),
)  # fmt: skip
MOST_HALF = 40


def step_by_step(reward):
    """Return the most by row, state and half steps, by every way there is.

    ``(m, 5, h)`` each: up to before a row and up to after it, and on from before and from after it.
    """
    m = len(reward)
    arrived, done, before, after = (np.full((m, 5, MOST_HALF), -np.inf) for _ in range(4))

    def raised(to, source, steps, held):
        end = MOST_HALF - steps
        to[steps:] = np.maximum(to[steps:], source[:end] + held)

    arrived[0, LEFT, 0] = 0.0
    for k in range(m):
        for state, to, steps, held in all_ways(reward[k]):
            raised(done[k, to], arrived[k, state], steps, held)
        for state, to, steps in ONWARD if k + 1 < m else ():
            raised(arrived[k + 1, to], done[k, state], steps, 0.0)
    for k in range(m - 1, -1, -1):
        after[k, [LEFT, RIGHT, JOINED], 0] = 0.0
        for state, to, steps in ONWARD if k + 1 < m else ():
            raised(after[k, state], before[k + 1, to], steps, 0.0)
        for state, to, steps, held in all_ways(reward[k]):
            raised(before[k, state], after[k, to], steps, held)
    return arrived, done, before, after


RANDOM = np.random.default_rng(11).random((4, 3))
PRICES = np.array([0.31, 1e-4, 0.07, 0.6, 2.0])
EVERY = step_by_step(RANDOM)


def worth_of_random():
    """Return what states of the random rows are worth, and their tables."""
    made = np.full((len(RANDOM), TABLES, RANDOM.shape[1] + 2), NEVER)
    fill_tables(RANDOM, made)
    return StateWorth.at(PRICES, made), made


def test_at_each_price_the_best_way_to_a_state_and_on_from_it_is_the_best_of_all_lengths():
    found, _ = worth_of_random()
    charged = PRICES[:, None, None, None] * np.arange(MOST_HALF)
    for mine, every in zip((found.arrived, found.done, found.before, found.after), EVERY,
                           strict=True):  # fmt: skip
        best = (every - charged).max(axis=-1)
        possible = best > -np.inf
        np.testing.assert_allclose(mine[possible], best[possible], atol=1e-12)
        assert (mine[~possible] < -1e299).all()
    on = (EVERY[2] - charged).argmax(axis=-1)
    possible = found.before > -1e299
    assert (found.half[possible] == on[possible]).all()


@pytest.mark.parametrize("half", [4, 9, 14])
@pytest.mark.parametrize("share", [0.7, 0.98, 1.0])
def test_so_many_half_steps_are_kept_as_hold_enough_at_every_two_prices(half, share):
    found, _ = worth_of_random()
    # at a little more than the best no rounding decides
    least = share * max((EVERY[2][0, LEFT] - price * np.arange(MOST_HALF)).max() + price * half
                        for price in PRICES[:1]) + 1e-7  # fmt: skip
    spans = np.full((2, 2, len(RANDOM), 5), -9)
    narrow(found, (half, least), spans)
    for which, (up, on) in enumerate(((found.arrived, found.before), (found.done, found.after))):
        for row, state in product(range(len(RANDOM)), range(5)):
            low, high = spans[which, :, row, state]
            for h in range(half + 1):
                to_there = (up[:, row, state] + PRICES * h).min()
                onward = (on[:, row, state] + PRICES * (half - h)).min()
                assert (low <= h <= high) == (to_there + onward >= least), (row, state, h)
            assert high <= half
            assert low >= 0


def swept(found, tables, half, least):
    """Return what is kept of walks of so many half steps that may hold so much, and the end."""
    m, width = len(tables), tables.shape[2]
    spans = np.zeros((2, 2, m, 5), np.int64)
    narrow(found, (half, least), spans)
    size = np.maximum(spans[:, 1] - spans[:, 0] + 1, 0)
    start = np.cumsum(size[0]).reshape(m, 5) - size[0]
    kept = KeptStates(spans[0, 0], spans[0, 1], start, np.full(int(size[0].sum()), NEVER))
    widest = int(size.max())
    room = SweepRoom(
        np.empty((5, widest)), np.empty(widest + width), np.zeros(width, np.int64), np.empty(width)
    )
    end = np.full(1, NEVER), np.zeros(3, np.int64)
    sweep(tables, (found, least - float(PRICES[0]) * half), kept, spans[1], room, end)
    return kept, end


@pytest.mark.parametrize("half", [0, 1, 3, 6, 9, 14])
@pytest.mark.parametrize("lacks", [0.0, 0.1, 1.0])
def test_of_walks_that_hold_enough_the_sweep_keeps_the_most_at_every_length(half, lacks):
    found, tables = worth_of_random()
    arrived, done, before, _ = EVERY
    most = done[:, [LEFT, RIGHT, JOINED], : half + 1]
    least = most.max() - lacks * RANDOM.sum() - 1e-9
    kept, (held, (row, state, h)) = swept(found, tables, half, least)
    assert held[0] == pytest.approx(most.max())
    assert done[row, state, h] == pytest.approx(most.max())
    assert h <= half
    assert state in {LEFT, RIGHT, JOINED}
    on = np.maximum.accumulate(before, axis=-1)
    n_reached = 0
    for row, state in product(range(len(RANDOM)), range(5)):
        low, high = kept.low[row, state], kept.high[row, state]
        for h in range(half + 1):
            through = arrived[row, state, h] + on[row, state, half - h]
            if low <= h <= high:
                value = kept.most[kept.start[row, state] + h - low]
                assert value <= arrived[row, state, h] + 1e-9 or value < -1e299
            if through >= least:
                assert low <= h <= high
                assert value == pytest.approx(arrived[row, state, h])
                n_reached += 1
    assert n_reached > 0


@loop
def spread(source, target, at, room):
    _spread(source, target, at, room)


@loop
def worth_it(table, limits, room):
    return _worth_it(table, limits, room)


@pytest.mark.parametrize("seed", seeds(6, 12))
def test_half_steps_in_a_row_are_added_to_those_before_it_in_blocks_as_one_by_one(seed):
    rng = np.random.default_rng(seed)
    n, source = int(rng.integers(1, 12)), rng.random(int(rng.integers(1, 60)))
    # the target begins before the source, within it, or beyond a block of it
    by = int(rng.integers(-20, 20)) if seed % 3 else 505 - len(source)
    target = 0.7 * rng.random(600 if seed % 3 == 0 else int(rng.integers(1, 70)))
    deep = np.sort(rng.choice(15, n, replace=False)).astype(np.int64)
    value = rng.random(n)
    expected = target.copy()
    for k, brings in zip(deep, value, strict=True):
        for j, has in enumerate(source):
            if 0 <= j + by + k < len(target):
                expected[j + by + k] = max(expected[j + by + k], has + brings)
    room = SweepRoom(
        np.empty((5, 1)), np.full(len(target) + 17, np.nan), np.append(deep, [0] * 3),
        np.append(value, [9.0] * 3),
    )  # fmt: skip
    spread(source, target, (by, n), room)
    np.testing.assert_allclose(target, expected, rtol=0, atol=1e-12)


def test_of_a_row_half_steps_are_listed_that_bring_more_than_fewer_and_enough():
    table, price = np.array([0.5, 0.5, 0.9, 0.7, 1.0, NEVER]), 0.1
    room = SweepRoom(np.empty((5, 1)), np.empty(1), np.zeros(6, np.int64), np.zeros(6))
    listed = [(0, 0.5), (2, 0.9), (4, 1.0)]
    for least, those in ((0.4, listed), (0.55, listed[1:]), (0.65, listed[1:2]), (0.75, [])):
        n = worth_it(table, (price, least), room)
        assert list(zip(room.deep[:n].tolist(), room.value[:n].tolist(), strict=True)) == those
