"""The belief in use says chances that come true; the others are measured beside it."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.samplers.sweeps import Naive
from fieldmon.studies.samplers.calibration import (
    BELIEFS,
    EDGES,
    calibration,
    report_html,
)
from fieldmon.studies.samplers.scenarios import Scenario


@pytest.fixture(scope="module")
def made():
    return {
        name: calibration([Scenario("B")], Naive(), BELIEFS[name], seeds=2, n_days=8)
        for name in ("independent plants", "pairs", "traced pairs")
    }


def test_pairs_score_better_than_independent_plants_and_than_suspicious_or_not(made):
    pairs, independent = made["pairs"], made["independent plants"]
    assert pairs.log_score < 0.8 * independent.log_score
    assert pairs.log_score < 0.8 * pairs.suspicious_log_score
    assert pairs.brier < independent.brier


def test_of_plants_given_a_chance_about_that_share_is_infested(made):
    pairs = made["pairs"]
    many = np.flatnonzero((pairs.count >= 400) & (np.array(EDGES[:-1]) >= 0.01))
    assert len(many) > 1
    for k in many:
        assert 0.5 * EDGES[k] <= pairs.was[k] <= 1.5 * EDGES[k + 1]


def test_the_interval_for_the_number_infested_holds_it_mostly(made):
    assert made["pairs"].covered >= 0.75
    assert made["pairs"].covered > made["independent plants"].covered


def test_a_belief_that_never_learns_scores_as_the_share_it_says():
    class Stubborn:
        def __init__(self, chance):
            self.chance, self.pair_chance, self.traces = chance, None, None
            self.doubt, self.doubt_of_rates, self.pest = 0.0, 0.0, None
            self.since_inspected = None

        def learn(self, *_):
            return self

        def overnight(self, _):
            return self

    scenario = Scenario("B")
    blind = calibration([scenario], Naive(), lambda _, chance: Stubborn(chance), seeds=1, n_days=2)
    assert blind.count.sum() == 2 * 4096
    said = scenario.draw_start(RandomStreams(0)).chance[0]
    share = np.average(blind.was, weights=blind.count)
    assert blind.brier == pytest.approx(share * (1 - said) ** 2 + (1 - share) * said**2)
    assert blind.seconds_a_day < 0.01
    # of the first morning the number was told, and an interval that holds it tells nothing
    told = calibration([scenario], Naive(), lambda _, chance: Stubborn(chance), seeds=1, n_days=1)
    assert np.isnan(told.covered)
    assert np.isnan(told.half_covered)


def test_on_days_of_rest_nothing_is_inspected():
    days = []

    class Noting(Naive):
        def walk(self, scene, would_find):
            days.append(scene.day)
            return super().walk(scene, would_find)

    pairs = BELIEFS["pairs"]
    resting = calibration([Scenario("A", visit_every=3)], Noting(), pairs, seeds=1, n_days=8)
    assert days == [0, 3, 6]
    daily = calibration([Scenario("A")], Naive(), pairs, seeds=1, n_days=8)
    assert resting.log_score > daily.log_score


def test_the_report_shows_every_belief(made):
    page = report_html(made, "B, for a test")
    assert all(name in page for name in made)
    assert "B, for a test" in page
