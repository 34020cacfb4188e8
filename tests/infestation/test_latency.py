"""For how many nights infestations hide, learnt from inspections of made-up seasons."""

import numpy as np
import pytest

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.latency import HIDDEN_NIGHTS, NIGHTS, Latency
from fieldmon.infestation.spread import Spread, night
from fieldmon.infestation.traced_pairs import TracedPairs
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


def test_that_nothing_hides_is_never_settled():
    assert season(0).latency.likely[0] < 0.99


def test_a_clean_look_leaves_what_hides():
    came = np.full(N, 0.1)
    fresh = Latency.none(np.full(N, 1e-6)).overnight(np.zeros(N), came)
    looked = fresh.inspected(EVERY, NONE, np.full(N, 0.84), np.ones(N))
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
    found = latency.inspected(EVERY[:1], np.ones(1, np.bool_), np.full(1, 0.84), np.ones(N))
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
