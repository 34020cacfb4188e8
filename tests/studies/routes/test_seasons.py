"""Seasons with the best route of the morning beside Adaptive's."""

import numpy as np

from fieldmon.infestation.insects.spread import Spread
from fieldmon.planning.workday import plan_work
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.studies.routes.seasons import (
    AS_IT_IS,
    BEST,
    MORNING,
    BestRouteSampler,
    MorningAdaptive,
    season_sentences,
    seasons,
    worth,
)
from fieldmon.studies.samplers.scenarios import Scenario


def scene(seconds):
    aisles = Aisles.of(rectangle(9, 12))
    chance = np.random.default_rng(2).random(108) * 0.2
    never = np.full(108, NEVER, np.int32)
    return Scene(aisles, Robot(), chance, never, seconds_left=seconds)


def test_the_best_route_is_worth_no_less_than_adaptives_and_fits_the_hours():
    morning = scene(2000.0)
    found = plan_work(morning, BestRouteSampler())
    other = plan_work(morning, MorningAdaptive())
    assert found.end_s <= 2000.0
    assert worth(morning)[found.plant].sum() >= worth(morning)[other.plant].sum()


def test_a_find_changes_nothing_before_tomorrow():
    morning = scene(2000.0)
    for sampler in (BestRouteSampler(), MorningAdaptive()):
        clean = sampler.walk(morning, np.zeros(108, np.bool_))
        found = sampler.walk(morning, np.ones(108, np.bool_))
        assert (clean.plant == found.plant).all()


def test_all_three_meet_the_same_insects_and_are_told_apart():
    made = list(seasons(Scenario("A", Spread(0.3, "one")), range(2), hours=0.5))
    assert [one.who for one in made] == [AS_IT_IS, MORNING, BEST] * 2
    assert [one.seed for one in made] == [0, 0, 0, 1, 1, 1]
    sentences = season_sentences(made)
    assert sentences[0].startswith("adaptive: ")
    assert len(sentences) == 5
