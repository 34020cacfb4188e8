"""Treated seasons, and the area at which zones leave about as much as treating all."""

import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.pests.pest import Movement, Pest
from fieldmon.simulation.treating import WHOLE
from fieldmon.studies.samplers.scenarios import Scenario
from fieldmon.studies.verdicts.treated_seasons import (
    NOTHING,
    RULES,
    TreatedSeason,
    against_nothing,
    area_at_equal_left,
    treated_scenarios,
    treated_seasons,
)


def test_every_rule_meets_the_same_insects_and_money_is_what_was_spent_and_lost():
    made = treated_seasons(Scenario("A", hours=0.4), 1, ["naive"], n_days=5)
    assert [one.rule for one in made] == list(RULES)
    nothing = made[0]
    assert (nothing.rule, nothing.sprayed_ha, nothing.spent) == (NOTHING, 0.0, 0.0)
    for one in made:
        assert one.cost == pytest.approx(one.spent + 0.1 * one.plant_days)
        assert one.plant_days <= nothing.plant_days


def test_a_rule_is_held_against_nothing_seed_by_seed():
    """Two seasons, half and a fifth of the plant-days: their geometric mean."""
    days = {(1, NOTHING): 100.0, (2, NOTHING): 50.0, (1, WHOLE): 50.0, (2, WHOLE): 10.0}
    made = [TreatedSeason("a", s, "naive", r, lost, 0, 0, 0) for (s, r), lost in days.items()]
    of = against_nothing(made, WHOLE)
    assert of.mean == pytest.approx(0.1**0.5)
    assert of.low < of.mean < of.high
    assert against_nothing(made, NOTHING).mean == 1.0
    with pytest.raises(SettingError, match="a season treated by"):
        against_nothing(made, "zones")


@pytest.mark.parametrize("scenario", treated_scenarios(), ids=lambda one: one.start)
def test_once_all_was_looked_at_zones_spray_at_least_60_percent_less(scenario):
    """The goal, where the map is as good as looking can make it: a whole round of the plot."""
    made = [area_at_equal_left(scenario, seed, looked_at=1.0) for seed in range(2)]
    assert max(one.share for one in made) < 0.4
    assert max(one.left for one in made) < 3.0
    # who may spray each plant alone needs no more than strips; who knows all, hardly anything
    assert all(one.by_plant <= one.share + 1e-9 for one in made)
    assert all(one.all_known < 0.4 for one in made)


def test_a_pest_lives_in_a_treated_season_by_its_own_nights():
    """One that goes nowhere and is never found stays where it is, day by day."""
    still = Pest("still", movement=Movement(per_day=0.0), detection=0.0)
    scenario = Scenario("A", hours=0.4, pest_in_weather=PestInWeather(still))
    nothing = treated_seasons(scenario, 1, ["naive"], n_days=5)[0]
    infested = scenario.draw_start(RandomStreams(1)).infested
    assert nothing.plant_days == 5 * infested.sum()
