"""A belief that learns how insects spread: in worlds that were made without it."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.chance_bounds import AS_GOOD_AS_CLEAN, bounded_pair_chance
from fieldmon.infestation.origins import (
    ANYWHERE,
    AT_START,
    AT_START_ELSEWHERE,
    BY_ADJACENT,
    BY_EDGE,
    JUMPED,
    N_ORIGINS,
    OVERLOOKED,
    OriginCounts,
)
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.infestation.spread import Spread
from fieldmon.infestation.traced_day import KernelRoom, TracedDay, _count, _share, _share_traced
from fieldmon.infestation.traced_night import TracedNight
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.infestation.tracing import Raised
from fieldmon.plot.layout import rectangle

GRID = rectangle(20, 20)
N = 400
FLAT = np.full(N, 0.02)
EVERY = np.arange(N, dtype=np.int32)
LEARNING, QUIET = Learning(detection=0.84), Spread(0.3, "one")


def seen(belief, infested, learning=LEARNING, days=1):
    """Inspect every plant for some days, by draws of seed 1; finds are treated."""
    rng, left = np.random.default_rng(1), infested.copy()
    for _ in range(days):
        found = left & (rng.random(N) < learning.detection)
        belief = belief.learn(EVERY, found, learning)
        left &= ~found
        belief = belief.overnight(QUIET)
    return belief


@pytest.mark.parametrize("to", ["one", "each"])
def test_chances_stay_chances_and_their_origins_add_up(to):
    infested = np.zeros(N, np.bool_)
    infested[[40, 41, 42, 60, 61, 222, 390]] = True
    belief = TracedPairs.of(GRID, FLAT)
    for found in (infested, np.zeros(N, np.bool_)):
        belief = belief.learn(EVERY[::3], found[::3], LEARNING)
        belief = belief.overnight(Spread(0.3, to))
        assert ((belief.chance > 0.0) & (belief.chance < 1.0)).all()
        assert belief.shares.sum(axis=1) == pytest.approx(1.0, abs=1e-4)
        start, other = GRID.adjacent
        p, q = np.repeat(belief.chance, np.diff(start)), belief.chance[other]
        assert (belief.pair_chance <= np.minimum(p, q) + 1e-9).all()
        assert (belief.pair_chance >= np.maximum(p + q - 1.0, 0.0) - 1e-9).all()
        assert belief.doubt > 0.0


def test_a_suspicion_that_proves_wrong_says_nothing_of_plants_that_were_not_suspected():
    suspected = (EVERY % 20 < 10) & (EVERY < 200)
    first = TracedPairs.of(GRID, np.where(suspected, 0.1, 0.01))
    assert first.at_start == pytest.approx([10.0, 3.0])
    clean = np.flatnonzero(suspected).astype(np.int32)[::2]
    belief = first.learn(clean, np.zeros(clean.size, np.bool_), LEARNING)
    inside = np.setdiff1d(np.flatnonzero(suspected), clean)
    assert belief.chance[inside].mean() < 0.3 * 0.1
    # farther than neighbours, only jumps that may be (12 %) tell a little
    far = (EVERY % 20 > 13) | (EVERY > 260)
    assert belief.chance[far] == pytest.approx(first.chance[far], rel=0.05)


def test_a_suspicion_of_all_alike_is_learnt_of_all():
    first = TracedPairs.of(GRID, FLAT)
    assert first.at_start == pytest.approx([8.0, 0.0])
    clean = EVERY[:200]
    belief = first.learn(clean, np.zeros(200, np.bool_), LEARNING)
    assert belief.chance[260:].mean() < 0.35 * 0.02


def test_a_day_in_clusters_says_that_insects_do_not_jump_and_one_apart_that_they_do():
    apart = np.zeros(N, np.bool_)
    apart[23::37] = True
    together = np.zeros(N, np.bool_)
    together[[21, 22, 41, 42, 150, 151, 170, 171, 305, 306, 325, 326]] = True
    first = TracedPairs.of(GRID, FLAT)
    assert seen(first, together).jumps < 0.5 * first.jumps
    assert seen(first, apart).jumps > 0.9


def test_a_find_raises_plants_beyond_its_neighbours_and_a_clean_day_lowers_them():
    apart = np.zeros(N, np.bool_)
    apart[23::37] = True
    told = seen(TracedPairs.of(GRID, FLAT), apart)
    one = told.learn(np.array([210], np.int32), np.array([True]), LEARNING)
    within = [213, 250, 168]
    pairs = PairApproximation(GRID, told.chance, told.pair_chance)
    without = pairs.learn(np.array([210], np.int32), np.array([True]), LEARNING)
    assert (one.chance[within] > 1.05 * without.chance[within]).all()


def test_finds_beyond_what_was_told_raise_the_arrivals():
    rng, belief = np.random.default_rng(5), TracedPairs.of(GRID, np.full(N, 1e-4))
    for _ in range(8):
        belief = belief.learn(EVERY, rng.random(N) < 0.02, LEARNING).overnight(Spread(0.0))
    assert belief.counts.scale[[ANYWHERE, BY_EDGE]].max() > 2.0


def test_a_treatment_leaves_its_share():
    belief = TracedPairs.of(GRID, FLAT)
    after = belief.treated(np.full(N, 0.25))
    assert after.chance == pytest.approx(0.005)
    assert after.pair_chance == pytest.approx(belief.pair_chance / 16.0)


def test_a_plot_of_one_plant_is_believed_in_too():
    belief = TracedPairs.of(rectangle(1, 1), np.array([0.1]))
    after = belief.learn(np.array([0], np.int32), np.array([True]), LEARNING).overnight(QUIET)
    assert 0.0 < after.chance[0] < 0.1


def test_a_day_moves_the_chance_of_jumping_as_bayes_rule_does_and_counts_it_once():
    """Two ways to stand are as good as out of the question, so the rule fits on a line."""
    row, looked_at = rectangle(1, 40), np.array([5, 4, 6], np.int32)
    told = TracedPairs.of(row, np.full(40, 0.02))
    shares = np.zeros_like(told.shares)
    shares[:, [AT_START, JUMPED]] = 0.6, 0.4
    told = replace(told, shares=shares, evidence=np.array([0.0, -60.0, -60.0, 0.0]))
    after = told.learn(looked_at, np.array([True, False, False]), LEARNING)
    # two plants beside a find are clean; side by side half of those that others did not infest
    # would be, apart 15 % (the pair knows 98 % of that), and each counts half
    clean = [1.0 - 0.84 * (0.02 + 0.98**2 * each) for each in (0.5, 0.15)]
    # and nothing is settled for good: the other two keep exp(-6) of the likeliest
    others = 0.24 * np.exp(-6.0) * clean[1]
    jumps = 0.12 * clean[1] / (0.64 * clean[0] + 0.12 * clean[1] + others)
    assert told.jumps == pytest.approx(0.12 / 0.76)
    assert after.jumps == pytest.approx(jumps)
    # no find is traced so far: of its chance 0.6 stays, and 0.4 goes with the chance of jumping
    scale = after.counts.scale / told.counts.scale
    wanted = 0.02 * (0.6 * scale[AT_START] + 0.4 * scale[JUMPED] * jumps / told.jumps)
    assert after.chance[39] == pytest.approx(wanted, rel=2e-3)


FEW = rectangle(3, 4)


def mid_season(seed=0):
    """Return what may be believed some days into a season on a dozen plants."""
    rng = np.random.default_rng(seed)
    belief = TracedPairs.of(FEW, rng.uniform(0.02, 0.4, 12))
    shares = rng.random((12, N_ORIGINS)).astype(np.float32)
    counts = OriginCounts(rng.uniform(0.0, 4.0, N_ORIGINS), rng.uniform(0.0, 4.0, N_ORIGINS))
    return replace(
        belief, shares=shares / shares.sum(axis=1, keepdims=True), counts=counts,
        unseen=rng.uniform(0.0, 7.0, 12), evidence=np.array([0.0, -1.0, 0.4, -0.3]),
    )  # fmt: skip


def test_known_finds_keep_their_chance_and_others_are_scaled_up_to_what_is_unknown():
    belief = mid_season()
    chance = belief.chance.copy()
    chance[[3, 7]] = 0.995, 0.985
    scale = np.linspace(0.2, 9.0, 12)
    after = replace(belief, chance=chance).times(scale)
    for i in range(12):
        most = max(chance[i], 0.95)
        wanted = 0.995 if i == 3 else min(chance[i] * scale[i], most)
        assert after.chance[i] == pytest.approx(wanted)
    start, other = FEW.adjacent
    own = np.repeat(np.arange(12), np.diff(start))
    scale[3] = 1.0
    both = belief.pair_chance * np.sqrt(scale[own] * scale[other])
    # as far as two such chances allow
    each = zip(both, after.chance[own], after.chance[other], strict=True)
    assert after.pair_chance == pytest.approx([bounded_pair_chance(*one) for one in each])


def test_the_number_infested_is_as_sure_as_what_origins_bring_and_as_groups_are_large():
    belief = mid_season()
    # as many were there at the start as was told
    found, expected = belief.counts.found.copy(), belief.counts.expected.copy()
    found[[AT_START, AT_START_ELSEWHERE]] = expected[[AT_START, AT_START_ELSEWHERE]]
    belief = replace(belief, counts=OriginCounts(found, expected))
    brought = (belief.chance @ belief.shares).astype(np.float64)
    total, beside = brought.sum(), brought[BY_ADJACENT]
    # what came from neighbours came from where those did, in proportion
    brought *= total / (total - beside)
    brought[BY_ADJACENT] = beside
    origins = np.sqrt(((brought * belief.counts.doubt) ** 2).sum()) / total
    sent = belief.unseen @ belief.chance / total
    group = 2.0 * belief.jumps * belief.beyond.sum() * sent / total
    assert belief.doubt == pytest.approx(np.hypot(origins, np.sqrt(group)), rel=1e-5)
    # offspring as an origin of its own
    alone = (belief.chance @ belief.shares * belief.counts.doubt / total).astype(np.float64)
    assert belief.doubt_of_rates == pytest.approx(np.sqrt((alone**2).sum() + group), rel=1e-5)
    # twelve plots of the like are as sure as one by its origins, and groups matter less
    assert belief.doubt > origins


@pytest.mark.parametrize("beside", [0.0, 0.3, 0.9])
def test_offspring_is_no_surer_than_what_it_came_from(beside):
    belief = mid_season()
    shares = np.zeros_like(belief.shares)
    shares[:, AT_START], shares[:, BY_ADJACENT] = 1.0 - beside, beside
    # how many come from neighbours is well known, how many were there at the start is not
    found = np.zeros(N_ORIGINS)
    found[BY_ADJACENT] = 1e9
    counts = OriginCounts(found, found)
    doubted = replace(belief, shares=shares, counts=counts, unseen=np.zeros(len(belief.chance)))
    assert doubted.doubt == pytest.approx(counts.doubt[AT_START], rel=1e-4)


def test_in_hindsight_an_evening_says_what_the_next_morning_does_of_the_same_finds():
    """Where a third of what was inspected is infested, and a fiftieth was told."""
    belief, plants = TracedPairs.of(GRID, FLAT), np.arange(40, dtype=np.int32)
    # no heavier infestation is thought of
    evening = belief._inspected(plants, plants % 3 == 0, LEARNING).settled()
    still = Spread(0.0)
    told, morning = evening.in_hindsight(still), evening.overnight(still)
    assert morning.chance.sum() > 1.3 * evening.chance.sum()
    assert told.chance.sum() == pytest.approx(morning.chance.sum(), rel=0.05)
    # with nothing new there is nothing to look back on
    for known in (belief, morning, told, replace(evening, ancestry=None)):
        assert known.in_hindsight(still) is known


@pytest.mark.parametrize("treated", [True, False])
def test_the_evening_and_the_next_morning_are_told_by_one_draw_a_night_apart(treated):
    """Another draw may believe twice as much: the number would jump without a new result."""
    plants, night = np.arange(40, dtype=np.int32), Spread(0.05)
    found = np.isin(plants, [3, 4, 18, 31])
    belief = replace(TracedPairs.of(GRID, FLAT), others=())
    evening = belief.learn(plants, found, Learning(0.84, treated=treated))
    told, morning = evening.in_hindsight(night), evening.overnight(night)
    assert told.ancestry.infested_at_start == morning.ancestry.infested_at_start
    by_origins = (
        TracedNight(evening, night).morning(tells_apart=True).chance.sum() / evening.chance.sum()
    )
    assert morning.chance.sum() / told.chance.sum() == pytest.approx(by_origins, rel=0.1)
    # only the night brings anything back to what was found and treated
    if treated:
        assert (told.chance[plants[found]] <= AS_GOOD_AS_CLEAN).all()


def test_once_it_is_told_who_infested_whom_the_number_is_in_less_doubt():
    belief, plants = TracedPairs.of(GRID, FLAT), np.arange(40, dtype=np.int32)
    belief = replace(belief, others=())  # no heavier infestation is thought of
    idle, evening = belief.overnight(QUIET), belief.learn(plants, plants == 7, LEARNING)
    for untold in (belief, idle, evening):
        assert untold.doubt == replace(untold, ancestry=None).doubt
    for told in (evening.in_hindsight(QUIET), evening.overnight(QUIET)):
        assert told.doubt == pytest.approx(0.85 * replace(told, ancestry=None).doubt)


def test_as_far_as_more_were_there_at_the_start_than_was_told_the_number_is_in_doubt():
    belief, nothing, doubts = mid_season(), np.zeros(N_ORIGINS), []
    for times in (0.2, 0.5, 1.0, 2.0, 4.0, 16.0):
        found, expected = nothing.copy(), nothing.copy()
        found[[AT_START, AT_START_ELSEWHERE]] = 100.0
        expected[[AT_START, AT_START_ELSEWHERE]] = 101.0 / times - 1.0
        doubts.append(replace(belief, counts=OriginCounts(found, expected)).doubt)
    # nothing else is known better or worse
    assert doubts[0] == doubts[1] == doubts[2]
    assert doubts[2] < doubts[3] < doubts[4] < doubts[5]


def day_of(belief):
    n, none = len(belief.chance), np.zeros((2, N_ORIGINS))
    zeros = np.zeros((2, n))
    return TracedDay(
        belief.shares.astype(np.float64), belief.chance.copy(), *zeros, *none, np.zeros(1)
    )


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


def test_counts_of_a_day_change_what_each_origin_is_believed_to_have_brought():
    before = mid_season()
    day = day_of(before)
    day.found[:], day.expected[:] = np.linspace(0, 3, N_ORIGINS), np.linspace(2, 0.5, N_ORIGINS)
    after = before.counting(before, day)
    # expected as before the season, of jumps as if insects were known to jump
    expected = day.expected / before.counts.scale
    expected[JUMPED:] /= before.jumps
    assert after.counts.found == pytest.approx(before.counts.found + day.found)
    assert after.counts.expected == pytest.approx(before.counts.expected + expected)
    parts = before.shares * before.chance[:, None] * (after.counts.scale / before.counts.scale)
    assert after.chance == pytest.approx(parts.sum(axis=1), rel=1e-5)
    assert after.shares == pytest.approx(parts / parts.sum(axis=1, keepdims=True), rel=1e-4)


def test_finds_from_outside_are_those_that_arrived():
    belief = mid_season()
    found = belief.counts.found
    assert belief.arrivals_found == pytest.approx(found[ANYWHERE] + found[BY_EDGE])


def test_what_was_found_clean_about_a_plant_lowers_it_by_the_relatives_it_would_have():
    belief, day = mid_season(), day_of(mid_season())
    rng = np.random.default_rng(2)
    day.dropped[:], day.cleared[:] = rng.uniform(0, 0.3, 12), rng.uniform(0, 0.9, 12)
    after = replace(belief, unseen=belief.unseen * 0.5, chance=belief.chance * 0.8)
    beyond = 1.5 * np.array([0.2, 0.1, 0.05, 0.3, 0.02, 0.1])
    to = belief.reach.brought(day.dropped, beyond)
    back = belief.reach.brought(day.cleared * belief.unseen, beyond, back=True)
    relatives = to * after.unseen / after.chance + back
    lowered = belief.lowered(after, day, beyond)
    assert lowered == pytest.approx(np.exp(-np.minimum(relatives, 3.0)))
    assert (relatives > 3.0).any()
    assert (relatives < 3.0).any()


def test_a_flagged_plant_that_seems_clean_later_is_in_doubt_and_teaches_no_detection():
    belief, plants = TracedPairs.of(GRID, FLAT), np.array([105, 210], np.int32)
    flagged = belief.learn(plants, np.ones(2, bool), Learning(0.84, treated=False))
    morning = flagged.overnight(QUIET)
    assert morning.ancestry.left.nonzero()[0].tolist() == plants.tolist()
    looked = morning.learn(plants, np.array([True, False]), Learning(0.84, treated=False))
    assert looked.chance[105] > 0.99
    assert looked.chance[210] == pytest.approx(0.7 * 0.16 / (0.7 * 0.16 + 0.3), abs=0.02)
    later = looked.overnight(QUIET)
    assert later.ancestry.left.nonzero()[0].tolist() == [105]
    assert later.chance[210] < 0.3
    # whoever overlooks half leaves it likely, and two looks are more than one
    once, twice = (
        morning.learn(np.full(k, 210, np.int32), np.zeros(k, bool), Learning(0.5, treated=False))
        for k in (1, 2)
    )
    assert 0.5 < once.chance[210] < 0.6
    assert once.ancestry.left[210]
    assert twice.chance[210] == pytest.approx(0.175 / 0.475, abs=0.02)
    for after in (looked, once, twice):
        assert after.counts.found[OVERLOOKED] == morning.counts.found[OVERLOOKED]
    # a find of the same day says that it is there
    both = np.array([210, 210], np.int32)
    again = morning.learn(both, np.array([True, False]), Learning(0.84, treated=False))
    assert again.chance[210] > 0.99
