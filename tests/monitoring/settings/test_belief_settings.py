"""How the chance map follows from what is done and found: the first morning, evenings, nights."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.pests.pest import Pest
from fieldmon.plot.layout import rectangle

GRID = rectangle(8, 8)
CHANCE = np.full(len(GRID), 0.02)
MORNING = TracedPairs.of(GRID, CHANCE)


def test_only_where_finds_are_traced_anything_is_made_of_a_pest():
    mite = Pest("mite")
    untraced = BeliefSettings(traces=False).first_morning(GRID, CHANCE, mite)
    assert isinstance(untraced, PairApproximation)
    assert untraced.pest is None
    assert BeliefSettings().first_morning(GRID, CHANCE, mite).pest is mite
    assert BeliefSettings().first_morning(GRID, CHANCE).pest is None


def test_a_chance_map_of_another_plot_is_refused():
    with pytest.raises(SettingError, match="first morning"):
        BeliefSettings().first_morning(GRID, CHANCE[:-1])


@pytest.mark.parametrize("detection", [0.8, np.array([0.8, 0.6, 0.7])])
@pytest.mark.parametrize("treated", [True, False])
def test_where_finds_are_treated_a_second_look_after_the_find_is_no_news(treated, detection):
    plants, found = np.array([5, 5, 9], np.int32), np.array([FOUND, CLEAN, CLEAN]) == FOUND
    evening = BeliefSettings(treated=treated).evening(MORNING, plants, found, detection)
    which = [0, 2] if treated else [0, 1, 2]
    told = np.broadcast_to(detection, 3)[which]
    wanted = MORNING.learn(plants[which], found[which], Learning(told, treated=treated))
    np.testing.assert_array_equal(evening.chance, wanted.chance)


def test_an_evening_without_inspections_is_its_morning_and_a_night_goes_by_the_spread():
    settings, none = BeliefSettings(Spread(0.1, "one")), np.zeros(0, np.int32)
    assert settings.evening(MORNING, none, none > 0, 0.8) is MORNING
    wanted = MORNING.overnight(Spread(0.1, "one")).chance
    np.testing.assert_array_equal(settings.overnight(MORNING).chance, wanted)
