"""What inspections tell, in words."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.infestation.ancestry.origins import (
    ANYWHERE,
    AT_START,
    AT_START_ELSEWHERE,
    BY_EDGE,
    JUMPED,
    Estimate,
)
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.jump_reach import kernel_means
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.learnt import Learnt, _length, learnt_from, with_start, worth_saying
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.plot_estimate import estimate_plot
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import Entry, Movement, Pest
from fieldmon.plot.layout import rectangle
from tests.infestation.tracing.traced_maps import mid_season

GRID = rectangle(9, 9)
FLAT = np.full(81, 0.02)


def test_at_first_it_is_what_was_believed_with_wide_intervals():
    told = {one.name: one for one in learnt_from(TracedPairs.of(GRID, FLAT), 0.84)}
    assert told["detection"].value == 0.84
    assert told["infested at the start"].value == pytest.approx(1.62)
    assert all(one.low <= one.value <= one.high for one in told.values())
    said = "1.6 plants were infested at the start (0.0 to 13)."
    assert told["infested at the start"].sentence() == said
    assert told["hiding"].value == pytest.approx(0.15)
    assert told["jumps beyond neighbours"].is_share
    assert 1.0 <= told["length of jumps"].low < 4.0 < told["length of jumps"].high + 1.0


def test_infested_at_the_start_are_those_suspected_and_the_others():
    chance = np.where(np.arange(81) < 27, 0.1, 0.01)
    told = {one.name: one for one in learnt_from(TracedPairs.of(GRID, chance), 0.84)}
    assert told["infested at the start"].value == pytest.approx(chance.sum())


def test_no_more_were_at_the_start_than_ever_and_what_is_inspected_later_counts_as_far_as_it_goes():
    learnt = Learnt("detection", 0.8, 0.7, 0.9), Learnt("infested at the start", 73, 18, 129)
    fewer, more = Estimate(53, 20, 110), Estimate(80, 30, 200)

    def start(ever, *first):
        kept, one = with_start(learnt, ever, *first)
        assert kept == learnt[0]
        return one.value, one.low, one.high

    for ever, later in ((fewer, (53, 18, 110)), (more, (73, 18, 129))):
        assert start(ever, ever, 0.0) == (ever.value, ever.low, ever.high)
        assert start(ever) == start(ever, fewer, 1.0) == later
    assert start(more, fewer, 0.5) == (63.0, 19.0, 119.5)


def test_a_belief_that_traces_nothing_has_learnt_nothing():
    assert learnt_from(PairApproximation.of(GRID, FLAT), 0.84) == ()


@pytest.mark.parametrize("seed", range(3))
def test_what_is_told_are_the_counts_of_origins_with_their_intervals(seed):
    belief = mid_season(seed)
    told = {one.name: (one.value, one.low, one.high) for one in learnt_from(belief, 0.7)}
    counts, n = belief.counts, len(belief.chance)

    def both(one, other):
        return one.value + other.value, one.low + other.low, one.high + other.high

    start = both(counts.estimate(AT_START, float(belief.at_start[0])),
                 counts.estimate(AT_START_ELSEWHERE, float(belief.at_start[1])))  # fmt: skip
    # two in ten thousand plants a night anywhere, one by the edge, as first believed
    nightly = both(counts.estimate(ANYWHERE, 2e-4 * n), counts.estimate(BY_EDGE, 1e-4 * n))
    assert told["infested at the start"] == pytest.approx(start)
    assert told["arrivals a night"] == pytest.approx(nightly)
    seen = counts.detection(0.7)
    assert told["detection"] == pytest.approx((seen.value, seen.low, seen.high))
    assert told["jumps beyond neighbours"] == pytest.approx((belief.jumps,) * 3)


@pytest.mark.parametrize("seed", range(3))
def test_jumps_are_as_long_as_their_kernels_and_as_doubtful_as_each_share_of_them(seed):
    """A doubt of each kernel's share, a little of it at a time, as it moves the mean."""
    belief = mid_season(seed)
    (length,) = [one for one in learnt_from(belief, 0.7) if one.name == "length of jumps"]
    means = kernel_means(belief.reach.cells.size_m, belief.reach.kernels)

    def mean_of(beyond):
        return float(beyond @ means / beyond.sum())

    moved, little = [], 1e-6
    for k in range(6):
        more = belief.beyond.copy()
        more[k] *= 1.0 + little
        by = (mean_of(more) - mean_of(belief.beyond)) / little
        moved.append(by * belief.counts.doubt[JUMPED + k])
    off = 1.645 * np.sqrt(np.square(moved).sum())
    assert length.value == pytest.approx(mean_of(belief.beyond))
    assert length.high - length.value == pytest.approx(off, rel=1e-3)
    assert length.low == pytest.approx(max(length.value - off, 1.0), rel=1e-3)


@pytest.mark.parametrize("k", range(6))
def test_jumps_that_are_all_of_one_kernel_are_as_long_as_it_without_a_doubt(k):
    mite = Pest("mite", movement=Movement("exponential", 0.4, reach_m=0.5))
    belief = TracedPairs.of(GRID, FLAT).of_pest(mite)
    alone = SimpleNamespace(beyond=np.eye(6)[k], reach=belief.reach, counts=belief.counts)
    mean = kernel_means(belief.reach.cells.size_m, belief.reach.kernels)[k]
    length = _length(alone)[0]
    assert (length.value, length.low, length.high) == pytest.approx((mean, mean, mean))


def test_estimates_have_the_digits_of_all_estimates_and_shares_are_in_percent():
    assert Learnt("infested at the start", 306.04, 253.5, 1363.3).sentence() == (
        "306 plants were infested at the start (254 to 1,363)."
    )
    assert Learnt("hiding", 0.153, 0.153, 0.153).sentence().endswith("with a chance of 15 %.")
    said = Learnt("detection", 0.996, 0.93, 0.9998).sentence()
    assert said == "An inspection finds over 99 % of what is there (93 % to over 99 %)."


def test_how_far_insects_jump_is_said_where_they_may():
    length = Learnt("length of jumps", 3.4, 3.1, 3.8)
    for chance, n in ((0.004, 1), (0.3, 2)):
        jumps = Learnt("jumps beyond neighbours", chance, chance, chance)
        assert len(worth_saying((jumps, length))) == n


def test_hiding_is_learnt_where_no_pest_says_it():
    traced = TracedPairs.of(GRID, FLAT)
    mite = traced.of_pest(Pest("mite"))
    names = [[one.name for one in learnt_from(belief, 0.84)] for belief in (traced, mite)]
    assert "hiding" in names[0]
    assert "hiding" not in names[1]


def test_before_anything_is_inspected_the_start_is_in_as_much_doubt_as_what_is_there():
    belief = TracedPairs.of(GRID, FLAT)
    now = estimate_plot(GRID, belief.chance, belief.pair_chance, doubt=belief.doubt)
    start = {one.name: one for one in learnt_from(belief, 0.84)}["infested at the start"]
    assert start.value == pytest.approx(belief.chance.sum())
    assert (start.low, start.high) == pytest.approx((now.low, now.high))
    later = {one.name: one for one in learnt_from(belief.overnight(Spread(0.3)), 0.84)}
    assert later["infested at the start"].value == pytest.approx(start.value)


def test_what_comes_from_none_is_told_by_the_ancestry_of_finds():
    belief = TracedPairs.of(GRID, FLAT)
    plants = np.arange(81, dtype=np.int32)
    evening = belief.learn(plants, np.isin(plants, [4, 40, 44, 70]), Learning())
    evening = evening.in_hindsight(Spread(0.3))
    told = {one.name: one for one in learnt_from(evening, 0.84)}
    known = evening.ancestry
    assert told["infested at the start"].value == known.infested_at_start.value
    assert 4.0 < told["infested at the start"].value < 6.0
    assert told["arrivals a night"].high == known.arrivals.high
    # without one it is told by the origins of finds
    alone = {one.name: one for one in learnt_from(replace(evening, ancestry=None), 0.84)}
    start = alone["infested at the start"]
    assert start.value == pytest.approx(
        evening.counts.estimate(AT_START, float(evening.at_start[0])).value
        + evening.counts.estimate(AT_START_ELSEWHERE, float(evening.at_start[1])).value
    )


def test_of_a_pest_whose_jumps_all_land_anywhere_there_is_no_length():
    far = Movement("exponential", 0.1, reach_m=5.0, share_of_long_jumps=1.0)
    belief = TracedPairs.of(rectangle(9, 9), np.full(81, 0.02)).of_pest(Pest("far", movement=far))
    assert "length of jumps" not in {one.name for one in learnt_from(belief, 0.84)}


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (Entry(), "are infested from outside (0.0 to 1.2); the file of the pest says 0.0."),
        (Entry(anywhere_per_day=0.01), "10 plants a night are infested from outside (0.0 to 40)."),
        (Entry(edge_per_day=0.02), "the file of the pest says "),
    ],
)
def test_as_many_are_said_to_come_from_outside_as_the_map_lets_come(entry, said):
    pest, grid = Pest("stays", movement=Movement(per_day=0.0), entry=entry), rectangle(32, 32)
    belief = TracedPairs.of(grid, np.full(1024, 1e-6), by_ancestry=False).of_pest(pest)
    night = PestInWeather(pest).spread(0, grid.frame)
    (arrivals,) = [one for one in learnt_from(belief, 0.84, night) if one.name.startswith("arriv")]
    come = float((belief.overnight(night).chance - belief.chance).sum())
    assert arrivals.value == pytest.approx(come, rel=0.02)
    assert said in arrivals.sentence()
