"""Fields as a belief: right where a handful of fields can be."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import coin
from fieldmon.infestation import ensemble
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.ensemble import Ensemble
from fieldmon.infestation.spread import Spread
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
