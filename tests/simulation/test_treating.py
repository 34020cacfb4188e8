"""Seasons treated by a rule: without one nothing changes, with one fewer plants stay infested."""

from functools import cache

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.decisions.sprayer import TreatmentCosts
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from fieldmon.simulation.treating import WHOLE, ZONES, TreatmentRule

AISLES = Aisles.of(rectangle(15, 15))
COSTS = TreatmentCosts(per_ha=20.0, per_zone=0.1)


@cache  # nobody changes them
def days(rule=None, name="dynamic", visit_every=1):
    infested = np.zeros(225, bool)
    infested[100:106] = True
    first = Start(infested, np.where(infested, 0.6, 0.01))
    settings = SimulationSettings(
        n_days=6, spread=Spread(0.3), treating=rule, visit_every=visit_every
    )
    robot = Robot(hours=0.12)
    streams = RandomStreams(4)
    return list(simulated_days(AISLES, robot, sampler(name), first, settings, streams))


@pytest.mark.parametrize(
    ("name", "treats"),
    [
        *(("dynamic", ZONES), ("dynamic", WHOLE), ("naive", WHOLE)),
        *(("decide", ZONES), ("adaptive", WHOLE)),
    ],
)
def test_treated_seasons_lose_less_whoever_looks(name, treats):
    plain, treated = days(None, name), days(TreatmentRule(0.02, treats, costs=COSTS), name)
    assert sum(day.left for day in treated) < sum(day.left for day in plain)
    evenings = [day.number for day in treated if day.sprayed is not None]
    assert evenings
    assert (np.diff(evenings) >= 7).all()


def test_zones_spray_less_than_the_whole_plot_and_the_figures_add_up():
    whole, zones = (
        season_metrics(days(TreatmentRule(0.02, treats, costs=COSTS))) for treats in (WHOLE, ZONES)
    )
    assert 0.0 < zones.sprayed_m2.sum() < 0.5 * whole.sprayed_m2.sum()
    assert zones.spent.sum() < whole.spent.sum()
    assert season_metrics(days()).spent.sum() == 0.0


def test_a_rule_that_never_treats_changes_nothing():
    never = days(TreatmentRule(0.99, WHOLE, costs=COSTS))
    for one, other in zip(never, days(), strict=True):
        assert one.work.plant.tolist() == other.work.plant.tolist()
        assert one.chance.tobytes() == other.chance.tobytes()


def test_only_sprayed_plants_are_cleaned_and_the_map_hears_of_it():
    made = days(TreatmentRule(0.02, ZONES, costs=COSTS))
    day = next(day for day in made if day.sprayed is not None)
    zones = day.sprayed.zones
    assert not (day.sprayed.cleaned & ~zones.treated).any()
    after = made[day.number + 1].chance
    plain = days()[day.number + 1].chance
    assert after[zones.treated].mean() < 0.5 * plain[zones.treated].mean()


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: TreatmentRule(0.0), "level must be (above 0|below 1), but"),
        (lambda: TreatmentRule(1.0), "level must be (above 0|below 1), but"),
        (lambda: TreatmentRule(1.2), "level must be (above 0|below 1), but"),
        (lambda: TreatmentRule(treats="half"), "'zones' or 'whole'"),
        (lambda: TreatmentRule(every_days=0), "every_days must be 1 or more"),
    ],
)
def test_rules_that_cannot_be_are_refused(made, said):
    with pytest.raises(SettingError, match=said):
        made()


@pytest.mark.parametrize("every_days", [1, 2, 3])
def test_where_all_evenings_call_for_it_it_is_treated_as_often_as_the_rule_lets(every_days):
    made = days(TreatmentRule(1e-9, WHOLE, costs=COSTS, every_days=every_days))
    evenings = [day.number for day in made if day.sprayed is not None]
    assert evenings == list(range(0, len(made), every_days))
    assert len(evenings) > 1


def test_the_first_evening_of_the_rule_treats_and_then_not_for_its_days():
    made = days(TreatmentRule(0.02, WHOLE, costs=COSTS, every_days=2))
    evenings = [day.number for day in made if day.sprayed is not None]
    assert evenings[0] <= 1
    assert (np.diff(evenings) >= 2).all()
    for day in made:
        if day.sprayed is not None:  # who is cleaned is infested no more, who is not stays
            assert not (day.in_the_evening & day.sprayed.cleaned).any()
            kept = day.infested & ~day.sprayed.cleaned
            kept[day.work.plant[day.work.found]] = False
            assert (day.in_the_evening == kept).all()


def test_between_visits_nothing_is_treated():
    rule = TreatmentRule(0.001, WHOLE, every_days=1)
    sprayed = [day.sprayed is not None for day in days(rule, visit_every=3)]
    assert sprayed == [True, False, False, True, False, False]
