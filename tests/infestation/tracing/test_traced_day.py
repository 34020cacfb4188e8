"""What a day says of each origin: what is overlooked, and what a clean look leaves."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.origins import BY_ADJACENT, JUMPED, N_ORIGINS, OVERLOOKED
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.pairs import Neighbourhood
from fieldmon.infestation.tracing.traced_day import (
    KernelRoom,
    TracedDay,
    _count,
    _share,
    _share_traced,
    learn_day,
)
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.infestation.tracing.tracing import Raised
from fieldmon.plot.layout import rectangle
from tests.infestation.tracing.traced_maps import (
    EVERY,
    FEW,
    FLAT,
    GRID,
    LEARNING,
    day_of,
    mid_season,
)


def test_known_finds_looked_at_again_tell_the_detection():
    flagged, rng = Learning(detection=0.84, treated=False), np.random.default_rng(2)
    plants = EVERY[:80]
    belief = TracedPairs.of(GRID, FLAT).learn(plants, np.ones(80, np.bool_), flagged)
    for _ in range(3):
        belief = belief.learn(plants, rng.random(80) < 0.5, flagged)
    assert belief.counts.detection(0.84).value == pytest.approx(0.5, abs=0.08)
    assert belief.counts.scale[OVERLOOKED] > 2.0


@pytest.mark.parametrize("nights", [0, 3])
def test_a_clean_look_leaves_what_was_overlooked_and_all_that_hides(nights):
    """Bayes' rule for one plant alone: nothing beside it tells anything."""
    told = TracedPairs.of(rectangle(1, 1), np.array([0.2]))
    for _ in range(nights):
        told = told.overnight(Spread(0.0, arrivals_per_day=0.1))
    after = told.learn(np.array([0], np.int32), np.array([False]), LEARNING)
    hidden = told.chance[0] - told.in_sight.chance[0]
    assert (hidden > 0.005) == (nights > 0)
    overlooked = (told.chance[0] - hidden) * (1.0 - 0.84)
    clean = 1.0 - told.chance[0] + hidden + overlooked
    parts = hidden * told.shares[0] / clean
    parts[OVERLOOKED] += overlooked / clean
    # what each origin counts for has changed by this look as well
    parts *= after.counts.scale / told.counts.scale
    assert after.chance[0] == pytest.approx(parts.sum(), rel=1e-5)
    assert after.shares[0] == pytest.approx(parts / parts.sum(), abs=1e-5)


@pytest.mark.parametrize("treated", [False, True])
def test_what_inspections_raise_plants_by_came_from_beside_them_one_after_the_other(treated):
    """By the chances after each of them, where no insect jumps."""
    belief, linked = mid_season(), FEW.linked
    plants = np.array([5, 9, 6, 2, 10], np.int32)
    found, detects = np.array([True, False, True, False, True]), np.full(5, 0.8)
    each = belief.reach.kernels * belief.beyond[:, None, None]

    def after(n):
        chance, pair_chance = belief.chance.copy(), belief.pair_chance.copy()
        day = TracedDay(belief.shares.copy(), chance.copy(), *np.zeros((2, 12)),
                        *np.zeros((2, N_ORIGINS)), np.zeros(1))  # fmt: skip
        traces = belief.traces.own()._replace(kernel=np.zeros((1, 1)))
        room = KernelRoom(each, Neighbourhood.of(12, chance), Raised.of(12))
        inspections = plants[:n], found[:n], detects[:n], np.zeros(n)
        learn_day((chance, pair_chance), linked, inspections, (treated, 0.3), (day, traces), room)
        return chance, day

    before, shares, raised = belief.chance, belief.shares.astype(np.float64), 0
    for n, plant in enumerate(plants.tolist(), 1):
        chance, day = after(n)
        for j in np.flatnonzero(chance > before):
            parts = shares[j] * before[j]
            parts[BY_ADJACENT] += chance[j] - before[j]
            shares[j] = parts / chance[j]
            raised += j != plant
        shares[plant] = np.arange(N_ORIGINS) == OVERLOOKED
        assert day.shares == pytest.approx(shares, abs=1e-5)
        before = chance
    assert raised > 5


@pytest.mark.parametrize("found", [False, True])
def test_finds_are_counted_by_origin_and_known_ones_tell_nothing(found):
    day = day_of(mid_season())
    _count.py_func(day, 5, found, 0.3)
    assert day.found == pytest.approx(found * day.shares[5])
    assert day.expected == pytest.approx(0.3 * day.shares[5])
    assert np.exp(day.likely[0]) == pytest.approx(0.3 if found else 0.7)
    day = day_of(mid_season())
    day.before[5] = 0.995
    _count.py_func(day, 5, found, 0.8)
    assert not day.found.any()
    assert not day.expected.any()
    assert day.likely[0] == 0.0


def test_what_a_chance_rises_by_came_from_the_plant_beside_and_what_falls_tells_no_origin():
    belief = mid_season()
    for now in (1.5, 0.5):
        day, chance = day_of(belief), belief.chance * now
        _share.py_func(day, chance, 5)
        parts = belief.shares[5] * belief.chance[5]
        if now > 1.0:
            parts[BY_ADJACENT] += 0.5 * belief.chance[5]
            assert day.shares[5] == pytest.approx(parts / chance[5], rel=1e-5)
        else:
            assert day.shares[5] == pytest.approx(belief.shares[5])
        assert day.before[5] == chance[5]


@pytest.mark.parametrize(("i", "j"), [(5, 6), (5, 8), (0, 11), (11, 0), (2, 4)])
def test_what_a_find_raises_a_plant_by_is_shared_among_the_kernels_that_reach_it(i, j):
    belief = mid_season()
    rng, n_kernels = np.random.default_rng(1), 6
    day, traces = day_of(belief), belief.traces.own()
    each = rng.random((n_kernels, 7, 7))
    room = KernelRoom(each, None, Raised.of(12))
    room.raised.plant[3], room.raised.by[3] = j, 0.07
    p, unseen, q = 0.1, 1.3, belief.chance[j]
    _share_traced.py_func(day, traces, room, (i, p, unseen), 3)
    (y, x), (to_y, to_x) = np.transpose(np.divmod([i, j], 4))
    away = np.array([to_y - y, to_x - x])
    to, back = each[:, 3 + away[0], 3 + away[1]], each[:, 3 - away[0], 3 - away[1]]
    ways = belief.unseen[j] * to + min(q / p, 1.0) * unseen * back
    parts = belief.shares[j] * q
    parts[JUMPED:] += 0.07 * ways / ways.sum()
    assert day.shares[j] == pytest.approx(parts / (q + 0.07), rel=1e-5)
