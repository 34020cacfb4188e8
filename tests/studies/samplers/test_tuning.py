"""Dynamic's open choices, searched."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.simulation.metrics import season_metrics
from fieldmon.studies.samplers import tuning
from fieldmon.studies.samplers.contenders import CONTENDERS, TUNED, Contender
from fieldmon.studies.samplers.scenarios import Scenario, usual_scenarios
from fieldmon.studies.samplers.seasons import season
from fieldmon.studies.samplers.tuning import CHOICES, SEEDS, losses, tuning_scenarios


def test_every_one_of_dynamics_choices_is_tried():
    told = []
    tried = losses([Scenario("B", start="scattered")], range(1), lambda *n: told.append(n))
    assert list(tried) == list(CHOICES)
    assert min(tried.values()) > 0
    assert len(set(tried.values())) > len(CHOICES) / 4
    assert told[-1] == (len(CHOICES), len(CHOICES))


def test_a_loss_is_the_geometric_mean_over_scenarios_of_the_mean_over_seeds(monkeypatch):
    monkeypatch.setattr(tuning, "CHOICES", ((0.1, 0.3),))
    scenarios, seeds = [Scenario("A"), Scenario("A", start="edge")], range(3)

    def lost(scenario, seed):
        streams = RandomStreams(seed)
        contender = Contender("dynamic", Dynamic(0.1, 0.3))
        days = season(scenario, contender, scenario.draw_start(streams), streams)
        return season_metrics(days).infested_plant_days

    means = [np.mean([lost(scenario, seed) for seed in seeds]) for scenario in scenarios]
    assert losses(scenarios, seeds) == {(0.1, 0.3): pytest.approx(np.sqrt(np.prod(means)))}


def test_choices_are_tried_on_seeds_and_scenarios_of_the_study_but_not_on_its_seasons():
    assert set(tuning_scenarios()) <= set(usual_scenarios())
    assert min(SEEDS) >= 1000
    tuned = next(each for each in CONTENDERS if each.name == TUNED).sampler
    assert (tuned.suspicious, tuned.at_once) in CHOICES
