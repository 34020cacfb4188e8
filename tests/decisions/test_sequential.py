"""Sequential plans: published examples, an exact walk over the lattice, and simulated looks."""

import numpy as np
import pytest

from fieldmon.decisions.sequential import (
    INSPECT_MORE,
    LEAVE,
    TREAT,
    BayesPlan,
    IwaoPlan,
    WaldPlan,
)
from fieldmon.decisions.stopping import decided
from fieldmon.decisions.taylor import TaylorLaw
from fieldmon.errors import SettingError

SPREAD = WaldPlan(2, 4, "negative binomial", k=4.6)
LEAVES = WaldPlan(0.10, 0.22)
PLANS = {
    "presence": LEAVES,
    "poisson": WaldPlan(2, 4, "poisson"),
    "negative binomial": SPREAD,
    "unequal": WaldPlan(0.05, 0.15, treats_wrongly=0.2, leaves_wrongly=0.05),
}


def test_the_published_example_ends_with_treatment_at_the_fifth_count():
    """The tests of the R package sequential.pops 0.1.1 (Rincon et al. 2025)."""
    assert decided(SPREAD, [2, 5, 6, 2, 7]) == (TREAT, 5)
    assert decided(SPREAD, [2, 5, 6, 2]) == (INSPECT_MORE, 4)


@pytest.mark.parametrize("plan", PLANS.values(), ids=PLANS)
def test_between_the_lines_the_likelihood_ratio_is_between_its_limits(plan):
    """The lines are those of the ratio of likelihoods, taken here from scipy's distributions."""
    from scipy import stats

    def ratio(x):
        if plan.counts == "presence":
            each = stats.bernoulli(plan.high).logpmf(x) - stats.bernoulli(plan.low).logpmf(x)
        elif plan.counts == "poisson":
            each = stats.poisson(plan.high).logpmf(x) - stats.poisson(plan.low).logpmf(x)
        else:
            of = [stats.nbinom(plan.k, plan.k / (plan.k + m)) for m in (plan.low, plan.high)]
            each = of[1].logpmf(x) - of[0].logpmf(x)
        return np.cumsum(each)

    rng = np.random.default_rng(4)
    for _ in range(30):
        x = rng.integers(0, 2 if plan.counts == "presence" else 7, 40)
        log, total, lines = ratio(x), np.cumsum(x), plan.lines(40)
        assert (
            (total <= lines.low) == (log <= np.log(plan.leaves_wrongly / (1 - plan.treats_wrongly)))
        ).all()
        assert (
            (total >= lines.high)
            == (log >= np.log((1 - plan.leaves_wrongly) / plan.treats_wrongly))
        ).all()


def exact(plan, share, most=1500):
    """Return chance of no treatment and mean looks of a presence plan, cell by cell."""
    lines, at = plan.lines(most), {0: 1.0}
    leaves, looks = 0.0, 0.0
    for n in range(1, most + 1):
        new = {}
        for total, chance in at.items():
            for x, p in ((0, 1 - share), (1, share)):
                new[total + x] = new.get(total + x, 0.0) + chance * p
        at = {}
        for total, chance in new.items():
            if total <= lines.low[n - 1]:
                leaves += chance
            if lines.low[n - 1] < total < lines.high[n - 1]:
                at[total] = chance
            else:
                looks += n * chance
    assert sum(at.values()) < 1e-6
    return leaves, looks


@pytest.mark.parametrize("share", [0.03, 0.10, 0.15, 0.22, 0.40])
def test_walds_curve_is_near_the_exact_one_and_says_no_more_looks(share):
    leaves, looks = exact(LEAVES, share)
    said = LEAVES.operating_curve(share)
    assert said.leaves_it[0] == pytest.approx(leaves, abs=0.05)
    assert said.looks[0] <= looks
    assert said.looks[0] == pytest.approx(looks, rel=0.25)


def test_the_mistakes_are_no_more_frequent_than_tolerated():
    assert 1 - exact(LEAVES, LEAVES.low)[0] <= LEAVES.treats_wrongly
    assert exact(LEAVES, LEAVES.high)[0] <= LEAVES.leaves_wrongly


@pytest.mark.parametrize("plan", PLANS.values(), ids=PLANS)
def test_at_its_two_levels_the_curve_has_the_tolerated_mistakes(plan):
    curve = plan.operating_curve([plan.low, plan.high])
    assert curve.leaves_it == pytest.approx([1 - plan.treats_wrongly, plan.leaves_wrongly])


@pytest.mark.parametrize("plan", PLANS.values(), ids=PLANS)
def test_the_curve_falls_and_looks_are_most_between_the_levels(plan):
    means = np.linspace(plan.low / 4, plan.high * 2, 200)
    curve = plan.operating_curve(means)
    assert (np.diff(curve.leaves_it) <= 1e-9).all()
    assert plan.low < means[np.argmax(curve.looks)] < plan.high
    assert (curve.looks > 0).all()


def test_the_curve_has_no_seam_where_the_ratio_stays_where_it_is():
    one_more, look = LEAVES.evidence
    flat = -look / one_more
    near = LEAVES.operating_curve([flat - 1e-6, flat, flat + 1e-6])
    assert np.ptp(near.leaves_it) < 1e-4
    assert np.ptp(near.looks) < 1e-2


def test_iwaos_lines_are_a_confidence_interval_round_the_threshold():
    plan = IwaoPlan(5.0, TaylorLaw())
    lines = plan.lines(400)
    assert (lines.low + lines.high) / 2 == pytest.approx(5.0 * np.arange(1, 401))
    error = np.sqrt(TaylorLaw().variance(5.0) / 100)
    assert (lines.high[99] / 100 - 5.0) / error == pytest.approx(1.645)
    assert decided(plan, [0] * 10)[0] == LEAVE
    assert decided(plan, [12] * 40)[0] == TREAT
    assert decided(IwaoPlan(0.22), [0, 1, 0, 0] * 4) == (INSPECT_MORE, 16)


def test_the_bayesian_plan_says_the_published_chances():
    """The tests of the R package sequential.pops 0.1.1: counts 1, 2, 3 and a threshold of 2."""
    assert BayesPlan(2, "poisson").chance_above(3, 6) == pytest.approx(0.60630278, abs=1e-8)
    clustered = BayesPlan(2, "negative binomial", k=2)
    assert clustered.chance_above(3, 6) == pytest.approx(0.72558593, abs=1e-8)


@pytest.mark.parametrize(
    "plan",
    [BayesPlan(0.22), BayesPlan(2, "poisson"), BayesPlan(5, "negative binomial", k=0.8)],
    ids=["presence", "poisson", "negative binomial"],
)
def test_on_its_lines_the_bayesian_plan_is_as_sure_as_asked(plan):
    looks, lines = np.arange(1, 61), plan.lines(60)
    told = looks * (plan.k if plan.counts == "negative binomial" else 1.0) > 1.0
    reached = told & (lines.low >= 0.0) & (lines.high <= looks * plan.most_per_look)
    high, low = (plan.chance_above(looks, line)[reached] for line in (lines.high, lines.low))
    assert high == pytest.approx(plan.sure, abs=1e-6)
    assert low == pytest.approx(1 - plan.sure, abs=1e-6)
    assert (lines.low < lines.high).all()


def test_before_the_first_look_a_share_is_as_likely_above_as_below():
    assert BayesPlan(0.05).chance_above(0, 0) == pytest.approx(0.5)
    assert decided(BayesPlan(0.05), [0])[0] == INSPECT_MORE


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: BayesPlan(1.2), "below 1"),
        (lambda: BayesPlan(0.2, sure=0.4), "between 0.5 and 1"),
        (lambda: BayesPlan(2, "negative binomial"), "clustering k"),
        (lambda: WaldPlan(0.2, 0.1), "must rise from above 0 to below 1"),
        (lambda: WaldPlan(0.2, 1.1), "must rise"),
        (lambda: WaldPlan(2, 4, "negative binomial"), "clustering k"),
        (lambda: WaldPlan(0.1, 0.2, treats_wrongly=0.6), "treats wrongly must lie between 0"),
        (lambda: IwaoPlan(1.2), "below 1"),
        (lambda: IwaoPlan(0.2, z=0.0), "z must be above 0"),
    ],
)
def test_plans_that_cannot_be_are_refused(made, said):
    with pytest.raises(SettingError, match=said):
        made()


# of the vignette of sequential.pops 0.1.1: leafminers on tomatoes, whose counts cluster by Taylor's
# law with a = 1.83 and b = 1.21, at a threshold of nine larvae a plant
LEAFMINERS = 9.0**2 / (1.83 * 9.0**1.21 - 9.0)


@pytest.mark.parametrize(
    ("plan", "begins", "rises"),
    [
        (SPREAD, 5.128255, 2.841808),
        (WaldPlan(8, 10, "negative binomial", k=LEAFMINERS), 28.45668, 8.93856),
        (WaldPlan(0.35, 0.45), 5.251888, 0.3992989),
    ],
)
def test_stop_lines_are_those_that_sequential_pops_publishes(plan, begins, rises):
    """To the digits printed: where each line begins, and how it rises from look to look."""
    for line, side in zip(plan.lines(2), (-1.0, 1.0), strict=True):
        assert line[1] - line[0] == pytest.approx(rises, rel=1e-6)
        assert 2.0 * line[0] - line[1] == pytest.approx(side * begins, rel=1e-6)


def test_walds_test_ends_where_the_vignette_of_sequential_pops_says():
    counts = [2, 2, 5, 1, 7, 17, 4, 6, 5, 11, 7, 5, 4, 5, 4, 5, 8, 6, 4, 5]
    plan = WaldPlan(8, 10, "negative binomial", k=LEAFMINERS)
    assert decided(plan, counts) == (LEAVE, 9)
    found = [int(one) for one in "0111100111101010110001001010101101110000"]
    assert decided(WaldPlan(0.35, 0.45), found) == (TREAT, 34)


def bout_by_bout(counts, plan):
    """Return the chance at which their Bayesian test stops, and after how many counts ``(m, n)``.

    Theirs takes each bout by itself and multiplies the odds; `BayesPlan` takes all counts together.
    """
    above = plan.chance_above(1.0, np.arange(counts.max() + 1))[counts]
    chance = 1.0 / (1.0 + np.exp(-np.cumsum(np.log(above) - np.log1p(-above), axis=1)))
    ended = np.argmax((chance < 1.0 - plan.sure) | (chance > plan.sure), axis=1)
    return chance[np.arange(len(chance)), ended], ended + 1


def test_their_bayesian_test_is_ours_bout_by_bout():
    plan = BayesPlan(9, "negative binomial", k=4.5, sure=0.99)
    counts = [7, 3, 9, 3, 4, 4, 4, 4, 6, 3, 4, 3, 5, 1, 4, 5, 2, 9, 4, 1]
    chance, bouts = bout_by_bout(np.array([counts]), plan)
    assert (round(float(chance[0]), 5), int(bouts[0])) == (0.00548, 11)


def test_the_published_curve_of_their_bayesian_test_comes_out_within_its_error():
    """Twenty simulations a mean were published, from 3 to 12 larvae: bouts, and how often H."""
    bouts = [4.05, 5.60, 9.75, 14.05, 10.20, 7.95, 6.15, 5.70, 3.95, 3.15]
    accepts = [0.0, 0.0, 0.05, 0.5, 0.85, 1.0, 1.0, 1.0, 1.0, 1.0]
    plan = BayesPlan(9, "negative binomial", k=4.5, sure=0.99)
    draws = np.random.default_rng(1)
    for mean, said, accepted in zip(range(3, 13), bouts, accepts, strict=True):
        counts = draws.negative_binomial(4.5, 4.5 / (4.5 + mean), (200, 150))
        chance, looks = bout_by_bout(counts, plan)
        assert abs(looks.mean() - said) <= 3.5 * looks.std() / np.sqrt(20.0)
        share = (chance > 0.5).mean()
        assert abs(share - accepted) <= 3.5 * np.sqrt(max(share * (1 - share), 0.01) / 20.0)
