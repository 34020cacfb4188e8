"""Wald's test on a chance map: the plain one where it is flat, and no news from neighbours."""

import numpy as np
import pytest

from fieldmon.decisions.map_plan import MapPlan, overstep
from fieldmon.decisions.sequential import WaldPlan
from fieldmon.decisions.stopping import decided
from fieldmon.errors import SettingError
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting

GRID = rectangle(30, 30, Planting(90.0, 4.0, 2.0))
FLAT = np.full(len(GRID), 0.05)
PLAN = MapPlan.about(0.05)
# far enough apart to tell nothing of each other
FAR = np.arange(len(GRID)).reshape(30, 30)[::6, ::6].ravel().astype(np.int32)


def test_on_a_flat_map_it_is_walds_own_test_with_the_line_lowered_by_what_finds_overstep():
    rng = np.random.default_rng(3)
    plain = WaldPlan(0.025 * 0.8, 0.1 * 0.8)
    one_more, look = plain.evidence
    for _ in range(20):
        found = rng.random(len(FAR)) < 0.1
        evidence = PLAN.evidence(GRID, FLAT, (FAR, found), 0.8)
        walds = np.cumsum(found) * one_more + look * np.arange(1, len(FAR) + 1)
        np.testing.assert_allclose(evidence.log_ratio, walds, atol=1e-9)
        np.testing.assert_allclose(evidence.overstep, evidence.overstep[0])
        as_wald = evidence._replace(overstep=np.zeros(len(FAR)))
        assert PLAN.verdicts(as_wald) == decided(plain, found)
        assert PLAN.verdicts(evidence)[1] <= decided(plain, found)[1]


def ends(looked, lines):
    """Return how often independent looks end with treating, without, and their mean number.

    Exact, at each true chance ``(m,)`` of a find: forward over all counts there are.
    """
    low, high = lines
    counts, looks = np.arange(len(low) + 1), np.zeros(len(looked))
    treats, leaves = np.zeros(len(looked)), np.zeros(len(looked))
    alive = np.zeros((len(looked), len(counts)))
    alive[:, 0] = 1.0
    for n in range(len(low)):
        looks += alive.sum(axis=1)
        found = np.pad(alive[:, :-1], ((0, 0), (1, 0))) * looked[:, None]
        alive = alive * (1.0 - looked[:, None]) + found
        told = counts >= high[n], counts <= low[n]
        treats, leaves = (
            of + alive[:, ends].sum(axis=1) for of, ends in zip((treats, leaves), told, strict=True)
        )
        alive[:, told[0] | told[1]] = 0.0
    return treats, leaves, looks


def lowered(q_low, q_high, n, wrong=0.1):
    """Return the lines of Wald's test, that for treating lowered by what finds overstep."""
    one_more, look = WaldPlan(q_low, q_high).evidence
    high = np.log((1 - wrong) / wrong) - overstep(np.array([q_low]), np.array([q_high]))[0]
    steps = look * np.arange(1, n + 1)
    return (-np.log((1 - wrong) / wrong) - steps) / one_more, (high - steps) / one_more


@pytest.mark.parametrize("level", [0.01, 0.05, 0.15, 0.3, 0.45])
def test_with_the_line_lowered_mistakes_are_as_frequent_as_tolerated_and_no_more(level):
    plan = MapPlan.about(level)
    shares = np.array([plan.low, plan.high])
    treats, leaves, _ = ends(shares, lowered(*shares, round(12 / level)))
    assert treats[0] < 0.104
    assert leaves[1] < 0.104
    if level <= 0.05:
        assert treats[0] > 0.095


def test_no_plan_of_independent_looks_needs_less_than_54_percent_of_the_whole_w_and_this_56():
    """The bound is Lagrange's: the least of looks + what two mistakes cost, over all plans.

    Truths as in the study: evenly, as a logarithm, from a quarter of 5 % to four times it; a look
    finds 84 % of what is there; 10 % of either mistake are tolerated at half and at twice it.
    """
    truths = 0.84 * 0.05 * 4.0 ** np.linspace(-1.0, 1.0, 41)
    q_low, q_high = 0.84 * 0.025, 0.84 * 0.1
    costs = np.array([145.0, 173.0])
    n, whole = 250, 74
    counts = np.arange(n + 1)
    cheapest = np.zeros(n + 1)  # whoever is not done by then is let go for nothing
    for looks in range(n - 1, -1, -1):
        some = counts[: looks + 1]

        def chance(q, some=some, looks=looks):
            return q**some * (1.0 - q) ** (looks - some)

        wrong = np.minimum(costs[0] * chance(q_low), costs[1] * chance(q_high))
        look = np.mean([chance(q) for q in truths], axis=0)
        cheapest = np.minimum(wrong, look + cheapest[:-1] + cheapest[1:])[: looks + 1]
    least = cheapest[0] - 0.1 * costs.sum()
    *_, looks = ends(truths, lowered(q_low, q_high, 400))
    assert 0.54 < least / whole < 0.55
    assert least < looks.mean() < 0.57 * whole


def test_a_clean_look_where_many_were_to_be_expected_says_more():
    chance = np.full(len(GRID), 0.01)
    chance[FAR[0]] = 0.5
    clean = np.zeros(2, bool)
    said = PLAN.evidence(GRID, chance, (FAR[:2], clean), 0.8)
    steps = np.diff(said.log_ratio, prepend=0.0)
    assert steps[0] < 5 * steps[1] < 0.0


def test_a_second_find_beside_the_first_is_hardly_news():
    beside = np.array([400, 401], np.int32)
    apart = np.array([400, 100], np.int32)
    found = np.ones(2, bool)
    near, far = (
        np.diff(PLAN.evidence(GRID, FLAT, (plants, found), 0.8).log_ratio)[0]
        for plants in (beside, apart)
    )
    assert 0.0 < near < 0.5 * far


def test_its_mistakes_are_no_more_frequent_than_tolerated_on_scattered_plots():
    rng = np.random.default_rng(8)
    wrong = []
    for share, right in ((0.025, "do not treat"), (0.1, "treat")):
        answers = []
        for _ in range(150):
            infested = rng.random(len(GRID)) < share
            order = rng.permutation(len(GRID))[:200].astype(np.int32)
            said = PLAN.verdicts(PLAN.evidence(GRID, FLAT, (order, infested[order]), 1.0))
            answers.append(said[0] != right)
        wrong.append(np.mean(answers))
    assert max(wrong) < 0.1 + 3 * np.sqrt(0.09 / 150)


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: MapPlan(0.1, 0.05), "must rise"),
        (lambda: MapPlan(0.1, 0.2, leaves_wrongly=0.7), "between 0 and 0.5"),
    ],
)
def test_plans_that_cannot_be_are_refused(made, said):
    with pytest.raises(SettingError, match=said):
        made()
