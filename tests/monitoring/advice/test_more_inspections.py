"""After how many looks a verdict can come: no look less would do."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from fieldmon.decisions.map_verdict import verdict_of
from fieldmon.decisions.sequential import LEAVE, TREAT
from fieldmon.decisions.sprayer import TreatmentCosts
from fieldmon.infestation.belief import Learning
from fieldmon.monitoring.advice.more_inspections import _first
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.samplers.decide import Decide
from tests.monitoring.seasons import BEGINS, of_a_corner

CHEAP = TreatmentCosts(per_ha=20.0, per_zone=0.1)


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    """Return a season in which a corner of the plot was found infested, and nothing else."""
    return of_a_corner(tmp_path_factory.mktemp("advice") / "season.gpkg")


def test_the_fewest_looks_are_those_that_trying_one_after_another_finds():
    for most, fewest in product(range(24), range(1, 30)):
        asked = []
        found = _first(lambda k, seen=asked, least=fewest: seen.append(k) or k >= least, most)
        assert found == (fewest if fewest <= most else None)
        assert all(1 <= k <= most for k in asked)
        assert len(asked) <= 2 * most.bit_length() + 2


def test_one_look_less_would_not_decide(season):
    level = float(season.evening(BEGINS).mean())
    asked, scene = AdviceSettings(level, costs=CHEAP), season.scene(BEGINS)
    more = season.advice(BEGINS, asked).more
    evening = season.history.in_hindsight(season.history.first_morning, 0)
    order = Decide().walk(replace(scene, seconds_left=1e6), np.zeros(len(scene.chance), bool)).plant
    learning = Learning(scene.robot.detects, treated=False)
    for looks, found, verdict in ((more.if_clean, False, LEAVE), (more.if_found, True, TREAT)):
        for k in (looks - 1, looks):
            after = evening.learn(order[:k], np.full(k, found), learning)
            said = verdict_of(scene.grid, after, level, asked.sure)
            assert (said.verdict == verdict) == (k == looks)
