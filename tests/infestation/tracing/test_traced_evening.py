"""What inspections change in a traced map, as rules written out have it."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.ancestry.origins import AT_START, JUMPED, N_ORIGINS, OVERLOOKED
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.tracing.traced_evening import counting, lowered
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.plot.layout import rectangle
from tests.infestation.tracing.traced_maps import FLAT, GRID, LEARNING, QUIET, day_of, mid_season


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


def test_counts_of_a_day_change_what_each_origin_is_believed_to_have_brought():
    before = mid_season()
    day = day_of(before)
    day.found[:], day.expected[:] = np.linspace(0, 3, N_ORIGINS), np.linspace(2, 0.5, N_ORIGINS)
    after = counting(before, before, day)
    # expected as before the season, of jumps as if insects were known to jump
    expected = day.expected / before.counts.scale
    expected[JUMPED:] /= before.jumps
    assert after.counts.found == pytest.approx(before.counts.found + day.found)
    assert after.counts.expected == pytest.approx(before.counts.expected + expected)
    parts = before.shares * before.chance[:, None] * (after.counts.scale / before.counts.scale)
    assert after.chance == pytest.approx(parts.sum(axis=1), rel=1e-5)
    assert after.shares == pytest.approx(parts / parts.sum(axis=1, keepdims=True), rel=1e-4)


def test_what_was_found_clean_about_a_plant_lowers_it_by_the_relatives_it_would_have():
    belief, day = mid_season(), day_of(mid_season())
    rng = np.random.default_rng(2)
    day.dropped[:], day.cleared[:] = rng.uniform(0, 0.3, 12), rng.uniform(0, 0.9, 12)
    after = replace(belief, unseen=belief.unseen * 0.5, chance=belief.chance * 0.8)
    beyond = 1.5 * np.array([0.2, 0.1, 0.05, 0.3, 0.02, 0.1])
    mixed = belief.reach.mixed(beyond)
    to = belief.reach.landed(day.dropped, mixed)
    back = belief.reach.landed(day.cleared * belief.unseen, np.conj(mixed))
    relatives = to * after.unseen / after.chance + back
    assert lowered(belief, after, day, beyond) == pytest.approx(np.exp(-np.minimum(relatives, 3.0)))
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
