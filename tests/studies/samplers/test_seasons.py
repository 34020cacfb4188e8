"""Samplers side by side: paired on the same insects, and bounded by who knows the truth."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Memory, run
from fieldmon.studies.samplers.contenders import CLAIRVOYANT, CONTENDERS, NAMES, NO_TRAVEL, SOME
from fieldmon.studies.samplers.scenarios import Scenario
from fieldmon.studies.samplers.seasons import outcomes, season, study_of

SMALL = Scenario("A", Spread(0.5, "one"))
ALWAYS = [contender.name for contender in CONTENDERS if contender.every == 1]


@pytest.fixture(scope="module")
def made():
    return [outcome for seed in (0, SOME, 1) for outcome in outcomes(SMALL, seed)]


def test_every_contender_gets_one_outcome_a_seed_and_bounds_are_in_every_tenth(made):
    for seed, who in ((0, NAMES), (SOME, NAMES), (1, ALWAYS)):
        assert [o.contender for o in made if o.seed == seed] == list(who)


def test_who_knows_the_truth_loses_least(made):
    for seed in (0, SOME):
        loss = {o.contender: o.infested_plant_days for o in made if o.seed == seed}
        assert loss[CLAIRVOYANT] == min(loss.values())


def test_a_study_makes_the_outcomes_of_each_scenario_and_seed_whoever_works(made):
    study = study_of([SMALL], range(2))
    with executor.threads(2) as threads:
        for workers in (executor.here(), threads):
            memory = Memory({(SMALL.name, 0): "done before"})
            run(study, workers, memory)
            assert memory == {(SMALL.name, 0): "done before", (SMALL.name, 1): made[-len(ALWAYS) :]}


def test_a_study_goes_through_all_scenarios_with_a_seed_before_the_next():
    study = study_of([SMALL, Scenario("A"), Scenario("B")], range(3))
    assert [chunk.key for chunk in study.chunks()] == [
        (name, seed)
        for seed in range(3)
        for name in (SMALL.name, Scenario("A").name, Scenario("B").name)
    ]
    assert len(study) == 9


def test_all_contenders_meet_the_same_insects_on_the_first_morning():
    streams = RandomStreams(4)
    start = SMALL.draw_start(streams)
    mornings = [next(season(SMALL, each, start, streams)).infested for each in CONTENDERS]
    assert all((morning == start.infested).all() for morning in mornings)


def test_who_pays_for_no_driving_inspects_as_many_plants_as_looks_fit_into_a_day():
    bound = next(each for each in CONTENDERS if each.name == NO_TRAVEL)
    streams = RandomStreams(1)
    day = next(season(Scenario("C"), bound, Scenario("C").draw_start(streams), streams))
    robot = Scenario("C").robot
    most = int(robot.day_s / robot.visit_s)
    assert most - 1 <= len(day.work) <= most


def test_a_believed_detection_is_not_the_true_one():
    flawed, streams = replace(SMALL, flaw="detection"), RandomStreams(2)
    naive = next(each for each in CONTENDERS if each.name == "naive")
    found, there = 0, 0
    for day in season(flawed, naive, flawed.draw_start(streams), streams):
        found += day.found
        there += int(np.count_nonzero(day.infested[day.work.plant]))
    assert found / there == pytest.approx(0.5, abs=0.06)
