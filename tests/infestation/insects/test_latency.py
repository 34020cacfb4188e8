"""For how many nights infestations hide, learnt from inspections of made-up seasons."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.latency import HIDDEN_NIGHTS, NIGHTS, Latency
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.plot.layout import rectangle

GRID = rectangle(20, 20)
N = len(GRID)
EVERY = np.arange(N, dtype=np.int32)
NONE = np.zeros(N, np.bool_)
FLAT = np.full(N, 0.05)


def season(hidden_nights, days=9):
    """Inspect every second row each day on a plot where infestations hide for some nights."""
    rng, spread, learning = np.random.default_rng(3), Spread(0.6, "one"), Learning(0.84)
    infested, shows_on = rng.random(N) < 0.05, np.zeros(N)
    belief = TracedPairs.of(GRID, FLAT)
    plants = EVERY[GRID.row % 2 == 0]
    for day in range(days):
        seen = infested & (shows_on <= day) & (rng.random(N) < 0.84)
        belief = belief.learn(plants, seen[plants], learning).overnight(spread)
        left = infested.copy()
        left[plants[seen[plants]]] = False
        infested = night(GRID, left, spread, np.uint64(day))
        shows_on[infested & ~left] = day + 1 + hidden_nights
    return belief


def test_new_finds_at_plants_that_were_clean_the_day_before_say_that_nothing_hides():
    assert season(0).latency.nights < 0.5 * Latency.none(FLAT).nights


def test_few_finds_after_the_first_days_say_that_infestations_hide():
    hiding = season(4, days=5).latency.nights
    assert hiding > 1.5 * Latency.none(FLAT).nights
    assert hiding > 3.0 * season(0, days=5).latency.nights


def test_many_finds_at_plants_that_seemed_clean_for_days_make_hiding_likely():
    assert season(4).latency.likely[0] < 0.3


def test_that_nothing_hides_is_never_settled():
    assert season(0).latency.likely[0] < 0.99


def test_a_clean_look_leaves_what_hides():
    came = np.full(N, 0.1)
    fresh = Latency.none(np.full(N, 1e-6)).overnight(np.zeros(N), came)
    looked = fresh.inspected(EVERY, NONE, np.full(N, 0.84))
    assert looked.came[0] == pytest.approx(0.1)
    by_candidate = looked.shows[:, 0]
    assert by_candidate[0] == pytest.approx(0.1 * 0.16 / (1 - 0.1 * 0.84), rel=1e-3)
    assert (by_candidate[1:] < 1e-5).all()


def test_what_came_to_one_plant_last_night_is_reckoned_with():
    calm = Latency.none(FLAT)
    assert not calm.matters
    came = np.where(EVERY == 7, 0.1, 0.0)
    assert calm.overnight(FLAT, FLAT + came).matters
    assert not calm.overnight(FLAT, FLAT).matters


def test_what_came_shows_once_its_nights_are_over():
    latency = Latency.none(np.full(N, 1e-6)).overnight(np.zeros(N), np.full(N, 0.1))
    for nights in range(NIGHTS + 1):
        shows = np.array([hidden <= nights for hidden in HIDDEN_NIGHTS])
        assert latency.shows[:, 0] == pytest.approx(np.where(shows, 0.1, 0.0), abs=1e-4)
        latency = latency.overnight(np.full(N, 0.1), np.full(N, 0.1))


def test_the_chance_that_something_hides_is_a_share_of_the_plants_own():
    latency = Latency.none(FLAT).overnight(FLAT, FLAT + 0.02)
    share = latency.hidden(FLAT + 0.02)
    assert share == pytest.approx((1.0 - latency.likely[0]) * 0.02 / 0.07, rel=1e-3)
    assert latency.hidden(np.full(3, 0.07), EVERY[:3]) == pytest.approx(share[:3])


def test_a_find_and_a_treatment_take_what_hides_too():
    latency = Latency.none(FLAT).overnight(FLAT, FLAT + 0.02)
    found = latency.inspected(EVERY[:1], np.ones(1, np.bool_), np.full(1, 0.84))
    assert found.came[:, 0].max() == found.shows[:, 0].max() == 0.0
    left = latency.treated(np.full(N, 0.25))
    assert left.came[0] == pytest.approx(0.25 * latency.came[0])


def test_a_day_is_planned_by_what_can_be_seen():
    belief = TracedPairs.of(GRID, FLAT).overnight(Spread(0.6, "each"))
    seen = belief.in_sight
    assert (seen.chance < belief.chance).all()
    assert (seen.chance > 0.3 * belief.chance).all()


def test_it_matters_once_anything_came_that_may_hide():
    fresh = Latency.none(np.full(N, 1e-6))
    assert not fresh.matters
    # some nights hide nothing any more, and most plants got nothing
    came = np.where(EVERY == 7, 0.1, 0.0)
    assert (fresh.hides > 0).any()
    assert fresh.overnight(np.zeros(N), came).matters


def known(seed, n=6, evidence=(0.0, -0.4, -1.1, -2.0)):
    """Return some days into a season: what came in which night, and what shows."""
    rng = np.random.default_rng(seed)
    came = rng.uniform(0.0, 0.2, (NIGHTS, n)).astype(np.float32)
    shows = rng.uniform(0.01, 0.5, (len(HIDDEN_NIGHTS), n)).astype(np.float32)
    told = rng.integers(0, 3, n).astype(np.int8)
    return Latency(came, shows, np.array(evidence), told)


def test_candidates_are_weighed_by_bayes_rule_and_hide_what_came_within_their_nights():
    first = np.array([0.85, 0.05, 0.065, 0.035])
    assert first.sum() == pytest.approx(1.0)
    latency = known(1)
    likely = first * np.exp(latency.evidence)
    likely /= likely.sum()
    assert latency.likely == pytest.approx(likely)
    assert latency.nights == pytest.approx(likely @ [0, 2, 4, 7])
    for ago in range(NIGHTS):
        hiding = sum(p for p, nights in zip(likely, (0, 2, 4, 7), strict=True) if ago < nights)
        assert latency.hides[ago] == pytest.approx(hiding)
    hidden = latency.hidden(np.full(6, 2.0))
    assert hidden == pytest.approx(latency.hides @ latency.came / 2.0, rel=1e-5)
    assert latency.hidden(np.full(6, 0.01)) == pytest.approx(0.9), "some of it can be seen"


def likely_of(finds, found):
    """Return how likely results are of plants with these shares of a rate that is not known.

    Finds come by Poisson. The rate is taken to be 1, as if five finds had told so: a gamma
    distribution, summed here over all rates.
    """
    rates = np.linspace(1e-3, 40.0, 40_000)
    weight = rates**4 * np.exp(-5.0 * rates)
    each = finds[found].prod() * rates ** np.count_nonzero(found) * np.exp(-rates * finds.sum())
    return (weight * each).sum() / weight.sum()


@pytest.mark.parametrize("seed", range(4))
def test_a_day_s_results_at_plants_that_seemed_clean_weigh_the_candidates_by_bayes_rule(seed):
    rng, latency = np.random.default_rng(seed), known(seed)
    plants = rng.permutation(6)[:5].astype(np.int32)
    found, detects = rng.random(5) < 0.5, rng.uniform(0.5, 0.9, 5)
    after = latency.inspected(plants, found, detects)
    told = latency.told[plants] > 0
    shown = detects * latency.shows[:, plants]
    said = np.log([likely_of(one[told], found[told]) for one in shown])
    evidence = latency.evidence + 0.5 * said  # finds of one colony count half
    likely = np.array([0.85, 0.05, 0.065, 0.035]) * np.exp(evidence)
    likely = np.maximum(likely / likely.max(), np.exp(-5.0))  # nothing is settled for good
    assert after.likely == pytest.approx(likely / likely.sum(), abs=1e-3)
    # the next night tells for seven more, of a plant that seemed clean
    now = latency.told.copy()
    now[plants] = np.where(found, 0, NIGHTS)
    assert after.told.tolist() == now.tolist()
    assert (
        after.overnight(np.zeros(6), np.zeros(6)).told.tolist() == np.maximum(now - 1, 0).tolist()
    )


def test_a_clean_inspection_lowers_what_shows_and_a_find_takes_all():
    latency = known(2)
    plants, found = np.array([0, 4], np.int32), np.array([False, True])
    after = latency.inspected(plants, found, np.full(2, 0.8))
    others = [1, 2, 3, 5]
    assert (after.came[:, others] == latency.came[:, others]).all()
    assert (after.shows[:, others] == latency.shows[:, others]).all()
    shows = latency.shows[:, 0]
    assert after.came[:, 0] == pytest.approx(latency.came[:, 0])
    assert after.shows[:, 0] == pytest.approx(0.2 * shows / (1.0 - 0.8 * shows))
    assert (after.came[:, 4] == 0.0).all()
    assert (after.shows[:, 4] == 0.0).all()


def test_what_candidates_have_together_is_the_chance_of_the_map():
    latency = known(2)
    chance = np.linspace(0.001, 0.3, 6)
    levelled = latency.levelled(chance)
    together = levelled.likely @ levelled.shows + levelled.hides @ levelled.came
    assert together == pytest.approx(chance, rel=1e-5)
    # as much of it hides
    assert levelled.hidden(chance) == pytest.approx(
        latency.hidden(latency.likely @ latency.shows + latency.hides @ latency.came), rel=1e-5
    )
    assert (levelled.likely == latency.likely).all()


def test_a_find_beside_a_clean_plant_says_that_something_was_overlooked_there():
    """Not only that something came: else what was overlooked seems to have come last night."""
    belief = TracedPairs.of(GRID, FLAT)
    plants, found = np.array([209, 210], np.int32), np.array([True, False])
    evening = belief.learn(plants, found, Learning(0.84))
    far = np.array([15, 16], np.int32)
    alone = belief.learn(far, np.zeros(2, np.bool_), Learning(0.84))
    assert evening.chance[210] > 3.0 * alone.chance[16]
    for k in range(len(HIDDEN_NIGHTS)):
        assert evening.latency.shows[k, 210] == pytest.approx(evening.chance[210], rel=0.01)


def test_each_candidate_shows_what_came_so_many_nights_ago():
    latency = known(3)
    before, after = np.linspace(0.0, 0.5, 6), np.linspace(0.2, 0.4, 6)
    gain = np.clip(after - before, 0.0, 1.0)
    morning = latency.overnight(before, after)
    assert morning.came[0] == pytest.approx(gain, abs=1e-7)
    assert (morning.came[1:] == latency.came[:-1]).all()
    for k, nights in enumerate(HIDDEN_NIGHTS):
        more = gain if nights == 0 else latency.came[nights - 1]
        either = 1.0 - (1.0 - latency.shows[k]) * (1.0 - more)
        assert morning.shows[k] == pytest.approx(either, abs=1e-6)
    left = latency.treated(np.linspace(0.0, 1.0, 6))
    assert left.came == pytest.approx(latency.came * np.linspace(0.0, 1.0, 6), rel=1e-6)
    assert left.shows == pytest.approx(latency.shows * np.linspace(0.0, 1.0, 6), rel=1e-6)


def test_however_sure_it_is_that_nothing_hides_what_came_to_a_plant_is_reckoned_with():
    for evidence in ((0.0, -2.5, -2.5, -2.5), (-2.5, -2.5, -2.5, 0.0)):
        latency = known(4, evidence=evidence)
        assert (latency.hides > 0.002).all()
        one = np.zeros_like(latency.came)
        one[NIGHTS - 1, 2] = 0.1
        assert replace(latency, came=one).matters
        assert not replace(latency, came=np.zeros_like(one)).matters
