"""Wald's test on a chance map: the plain one where it is flat, and no news from neighbours."""

import numpy as np
import pytest

from fieldmon.decisions.map_plan import MapPlan
from fieldmon.decisions.sequential import WaldPlan, decided
from fieldmon.errors import SettingError
from fieldmon.plot.layout import Planting, rectangle

GRID = rectangle(30, 30, Planting(90.0, 4.0, 2.0))
FLAT = np.full(len(GRID), 0.05)
PLAN = MapPlan.about(0.05)
# far enough apart to tell nothing of each other
FAR = np.arange(len(GRID)).reshape(30, 30)[::6, ::6].ravel().astype(np.int32)


def test_on_a_flat_map_it_is_walds_own_test():
    rng = np.random.default_rng(3)
    plain = WaldPlan(0.025 * 0.8, 0.1 * 0.8)
    for _ in range(20):
        found = rng.random(len(FAR)) < 0.1
        said = PLAN.verdicts(PLAN.evidence(GRID, FLAT, (FAR, found), 0.8))
        assert said == decided(plain, found)


def test_a_clean_look_where_many_were_to_be_expected_says_more():
    chance = np.full(len(GRID), 0.01)
    chance[FAR[0]] = 0.5
    clean = np.zeros(2, bool)
    steps = np.diff(PLAN.evidence(GRID, chance, (FAR[:2], clean), 0.8), prepend=0.0)
    assert steps[0] < 5 * steps[1] < 0.0


def test_a_second_find_beside_the_first_is_hardly_news():
    beside = np.array([400, 401], np.int32)
    apart = np.array([400, 100], np.int32)
    found = np.ones(2, bool)
    near, far = (
        np.diff(PLAN.evidence(GRID, FLAT, (plants, found), 0.8))[0] for plants in (beside, apart)
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
