"""When plans stop: no sooner than said, and on simulated counts as their formulas say."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.decisions.sequential import WaldPlan
from fieldmon.decisions.stopping import after, decided, least_more, simulated_curve, tried
from fieldmon.errors import SettingError

SPREAD = WaldPlan(2, 4, "negative binomial", k=4.6)
LEAVES = WaldPlan(0.10, 0.22)


def test_simulated_counts_agree_with_the_curve():
    rng = np.random.default_rng(1)
    for mean in (2.0, 2.8, 4.0):
        counts = rng.negative_binomial(4.6, 4.6 / (4.6 + mean), (4000, 300))
        trials = tried(SPREAD, counts)
        curve = SPREAD.operating_curve(mean)
        assert trials.treats + trials.leaves == 1.0
        assert trials.leaves == pytest.approx(curve.leaves_it[0], abs=0.08)
        assert trials.looks.mean() >= curve.looks[0]


def test_looks_at_neighbours_end_in_more_mistakes_than_the_formula_says():
    """Clustered looks are why a plan is tried on simulated plots too."""
    rng = np.random.default_rng(2)
    patches = rng.random((3000, 40)) < LEAVES.low
    trials = tried(LEAVES, np.repeat(patches, 10, axis=1))
    assert trials.treats > 1.5 * LEAVES.treats_wrongly


@given(st.integers(0, 60), st.integers(0, 60))
def test_a_verdict_comes_no_sooner_than_said_and_can_come_then(looks, infested):
    infested = min(looks, infested)
    more = least_more(LEAVES, looks, infested)
    lines = LEAVES.lines(looks + more + 1)

    def clear(n, total):
        return n > 0 and (total <= lines.low[n - 1] or total >= lines.high[n - 1])

    possible = [clear(looks + more, infested), clear(looks + more, infested + more)]
    assert any(possible)
    for sooner in range(more):
        assert not clear(looks + sooner, infested)
        assert not clear(looks + sooner, infested + sooner)


def test_a_total_is_judged_as_its_counts_are_one_by_one():
    rng = np.random.default_rng(5)
    judged = []
    for counts in rng.random((40, 25)) < 0.2:
        for n in range(1, 26):
            verdict, looks = decided(LEAVES, counts[:n])
            if looks == n:
                judged.append((verdict, after(LEAVES, n, counts[:n].sum())))
    assert len({verdict for verdict, _ in judged}) > 1
    assert all(told == verdict for verdict, told in judged)


def test_a_simulated_curve_shows_what_clustered_finds_do():
    """The curve of clustered looks is flatter: more mistakes at both levels."""
    rng = np.random.default_rng(6)

    def alone(share):
        return rng.random((1500, 200)) < share

    def together(share):
        return np.repeat(rng.random((1500, 20)) < share, 10, axis=1)

    levels = [LEAVES.low, LEAVES.high]
    apart, clustered = (simulated_curve(LEAVES, levels, draw) for draw in (alone, together))
    assert apart.leaves_it == pytest.approx(LEAVES.operating_curve(levels).leaves_it, abs=0.06)
    assert clustered.leaves_it[0] < apart.leaves_it[0] - 0.03
    assert clustered.leaves_it[1] > apart.leaves_it[1]


def test_levels_too_near_each_other_are_refused():
    with pytest.raises(SettingError, match="further apart"):
        least_more(WaldPlan(0.1, 0.1000001), 0, 0)
