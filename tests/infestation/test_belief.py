"""What every belief promises."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.ensemble import Ensemble
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.plot.layout import rectangle

GRID = rectangle(8, 9)
N = len(GRID)
BELIEFS = {"independent": IndependentPlants, "pairs": PairApproximation.of, "fields": Ensemble.of}
PLANTS = np.array([3, 30, 31, 60], np.int32)
FOUND = np.array([False, True, False, False])


@pytest.fixture(params=BELIEFS)
def belief(request):
    return BELIEFS[request.param](GRID, np.linspace(0.05, 0.4, N))


def test_a_belief_never_changes_each_step_returns_another(belief):
    chance = belief.chance.copy()
    pair_chance = None if belief.pair_chance is None else belief.pair_chance.copy()
    belief.learn(PLANTS, FOUND, Learning())
    belief.overnight(Spread(0.5, arrivals_per_day=0.01))
    belief.treated(np.zeros(N))
    np.testing.assert_array_equal(belief.chance, chance)
    if pair_chance is not None:
        np.testing.assert_array_equal(belief.pair_chance, pair_chance)


def test_chances_stay_chances_and_those_of_pairs_below_both_of_theirs(belief):
    start, neighbour = GRID.adjacent
    own = np.repeat(np.arange(N), np.diff(start))
    for _ in range(4):
        belief = belief.learn(PLANTS, FOUND, Learning(treated=False)).overnight(Spread(0.5))
        assert ((belief.chance >= 0.0) & (belief.chance <= 1.0)).all()
        if belief.pair_chance is not None:
            most = np.minimum(belief.chance[own], belief.chance[neighbour])
            assert (belief.pair_chance >= 0.0).all()
            assert (belief.pair_chance <= most + 0.02).all()


def test_a_clean_inspection_lowers_and_a_find_left_alone_is_certain(belief):
    after = belief.learn(PLANTS, FOUND, Learning(treated=False)).chance
    assert (after[PLANTS[~FOUND]] < belief.chance[PLANTS[~FOUND]]).all()
    assert after[30] > 0.99


def test_nobody_inspected_is_nothing_learnt(belief):
    after = belief.learn(np.empty(0, np.int32), np.empty(0, np.bool_), Learning())
    np.testing.assert_allclose(after.chance, belief.chance, atol=1e-12)


def test_a_night_of_spread_raises_what_is_expected_and_a_treatment_lowers_it(belief):
    assert belief.overnight(Spread(0.5)).chance.sum() > belief.chance.sum()
    left = np.where(np.arange(N) < 40, 0.25, 1.0)
    after = belief.treated(left).chance
    assert after[:40].sum() == pytest.approx(0.25 * belief.chance[:40].sum(), rel=0.2)
    assert after[40:].sum() == pytest.approx(belief.chance[40:].sum(), rel=0.02)


@pytest.mark.parametrize("bad", [{"detection": 2}, {"beside_find": -1}])
def test_impossible_settings_are_refused(bad):
    with pytest.raises(SettingError, match=r"in 0\.\.1"):
        Learning(**bad)


def test_a_detection_is_that_of_each_inspection():
    assert Learning(0.7).detects(3).tolist() == [0.7] * 3
    assert Learning(np.array([0.5, 0.9])).detects(2).tolist() == [0.5, 0.9]
