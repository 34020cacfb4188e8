"""Fields as a belief: right where a handful of fields can be."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import coin
from fieldmon.infestation import ensemble
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.ensemble import Ensemble
from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.layout import rectangle

GRID = rectangle(8, 8)
LOOK = np.array([27], np.int32)


def test_the_fields_have_the_chances_they_were_drawn_from():
    chance = np.linspace(0.05, 0.6, 64)
    belief = Ensemble.of(GRID, chance, clustering=0.0)
    assert belief.chance == pytest.approx(chance, abs=0.12)
    assert belief.chance.mean() == pytest.approx(chance.mean(), abs=0.02)


def test_a_clean_look_follows_bayes_rule():
    belief = Ensemble.of(GRID, np.full(64, 0.4), clustering=0.0)
    p = belief.fields[:, 27].mean()
    after = belief.learn(LOOK, np.array([False]), Learning(detection=0.84))
    assert after.fields[:, 27].mean() == pytest.approx(p * 0.16 / (1 - 0.84 * p), abs=0.06)


def test_a_find_is_certain_until_treated_and_raises_its_neighbours():
    belief = Ensemble.of(GRID, np.full(64, 0.2), clustering=0.6)
    flagged = belief.learn(LOOK, np.array([True]), Learning(treated=False))
    assert flagged.fields[:, 27].all()
    treated = belief.learn(LOOK, np.array([True]), Learning())
    assert not treated.fields[:, 27].any()
    assert treated.chance[[19, 26, 28, 35]].mean() > 2 * belief.chance[[19, 26, 28, 35]].mean()


@pytest.mark.parametrize("found", [[False, True], [True, False], [False, False]])
def test_no_coin_is_tossed_twice(found, monkeypatch):
    """Chances that are drawn of one coin would hang on each other."""
    tossed = []

    def told(key, k):
        tossed.append(int(k))
        return coin(key, k)

    monkeypatch.setattr(ensemble, "coin", told)
    belief = Ensemble.of(GRID, np.full(64, 0.4), clustering=0.3)
    fields, plants = belief.fields[:40].copy(), np.array([27, 50], np.int32)
    rule = np.full(2, 0.5), False
    ensemble._learn.py_func(fields, GRID.adjacent, (plants, np.array(found)), rule, np.uint64(3))
    assert len(tossed) > 40
    assert len(set(tossed)) == len(tossed)


def test_a_night_adds_infested_plants_and_takes_none():
    belief = Ensemble.of(GRID, np.full(64, 0.1))
    after = belief.overnight(Spread(0.5))
    assert (after.fields >= belief.fields).all()
    assert after.chance.sum() > 1.5 * belief.chance.sum()


def test_the_chance_of_two_is_the_share_of_fields_in_which_both_are_infested():
    belief = Ensemble.of(GRID, np.full(64, 0.3), clustering=0.5)
    start, neighbour = GRID.adjacent
    own = np.repeat(np.arange(64), np.diff(start))
    both = (belief.fields[:, own] & belief.fields[:, neighbour]).mean(axis=0)
    assert belief.pair_chance == pytest.approx(both)


def test_the_estimate_counts_the_fields():
    belief = Ensemble.of(GRID, np.full(64, 0.1))
    ahead = belief.estimate()
    counts = belief.fields.sum(axis=1)
    assert ahead.expected == pytest.approx(counts.mean())
    assert np.mean((counts >= ahead.low) & (counts <= ahead.high)) >= 0.9


def test_the_plot_is_clean_in_as_many_of_the_fields_as_hold_no_infested_plant():
    belief = Ensemble.of(GRID, np.full(64, 0.02))
    fields = [[*field] for field in belief.fields.tolist()]
    clean = sum(not any(field) for field in fields) / len(fields)
    assert 0.1 < clean < 0.9
    assert belief.estimate().chance_clean == pytest.approx(clean)


def test_a_chance_is_the_share_of_fields_and_one_more_field_that_is_as_the_plot():
    belief = Ensemble.of(GRID, np.linspace(0.01, 0.9, 64))
    fields = belief.fields.tolist()
    share = sum(map(sum, fields)) / (len(fields) * 64)
    for plant in range(64):
        infested = sum(field[plant] for field in fields)
        assert belief.chance[plant] == pytest.approx((infested + share) / (len(fields) + 1))
    full = Ensemble(GRID, np.ones((30, 64), bool), belief.chances)
    assert (full.chance < 1.0).all()


@pytest.mark.parametrize("plant", [0, 27, 60])
def test_plants_up_to_three_steps_from_a_look_come_along_and_each_once(plant):
    block = np.empty(64, np.int64)
    size = ensemble._about.py_func(GRID.adjacent, plant, block)
    across, along = np.divmod(np.arange(64), 8)
    steps = np.abs(across - across[plant]) + np.abs(along - along[plant])
    assert sorted(block[:size].tolist()) == np.flatnonzero(steps <= 3).tolist()
    assert (np.diff(steps[block[:size]]) >= 0).all()
    # no more than there is room for
    few = np.empty(5, np.int64)
    assert ensemble._about.py_func(GRID.adjacent, plant, few) == 5
    assert few.tolist() == block[:5].tolist()


@pytest.mark.parametrize("wanted", [True, False])
def test_a_field_that_says_the_same_is_the_next_from_where_the_draw_falls(wanted):
    was = np.array([True, False, False, True, False])
    for draw in np.linspace(0.0, 0.999, 11):
        turn = [(int(5 * draw) + k) % 5 for k in range(5)]
        expected = next(k for k in turn if was[k] == wanted)
        assert ensemble._donor.py_func(was, wanted, draw) == expected
    assert ensemble._donor.py_func(np.full(5, not wanted), wanted, 0.5) == -1


def test_a_treatment_leaves_of_each_plant_s_fields_the_share_that_outlives_it():
    belief = Ensemble(GRID, np.ones((300, 64), bool), Ensemble.of(GRID, np.full(64, 0.1)).chances)
    left = np.linspace(0.0, 1.0, 64)
    after = belief.treated(left)
    assert after.fields.mean(axis=0) == pytest.approx(left, abs=0.12)
    assert after.fields.mean() == pytest.approx(left.mean(), abs=0.02)
    # the next treatment has coins of its own
    again = after.treated(left)
    assert again.fields.mean() == pytest.approx((left**2).mean(), abs=0.02)
    clean = Ensemble(GRID, np.zeros((9, 64), bool), belief.chances)
    assert not clean.treated(left).fields.any()


@pytest.mark.parametrize("detection", [0.3, 0.84])
@pytest.mark.parametrize("treated", [True, False])
def test_after_looks_fields_say_of_each_plant_what_was_seen_and_keep_what_was_overlooked(
    detection, treated
):
    belief = Ensemble.of(GRID, np.full(64, 0.4), clustering=0.0)
    plants, found = np.array([3, 60], np.int32), np.array([True, False])
    after = belief.learn(plants, found, Learning(detection, treated=treated))
    assert after.fields[:, 3].mean() == (0.0 if treated else 1.0)
    p = belief.fields[:, 60].mean()
    kept = p * (1.0 - detection) / (1.0 - detection * p)
    assert after.fields[:, 60].mean() == pytest.approx(kept, abs=0.09)
    # nobody says anything of plants farther than three steps from both
    across, along = np.divmod(np.arange(64), 8)
    far = np.ones(64, bool)
    for plant in plants:
        far &= np.abs(across - across[plant]) + np.abs(along - along[plant]) > 3
    assert (after.fields[:, far] == belief.fields[:, far]).all()
    assert (after.steps, belief.steps) == (1, 0)
