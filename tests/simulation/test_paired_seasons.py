"""Seasons of several on the same insects, and which seeds all of them have been through."""

import numpy as np

from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Memory, run
from fieldmon.simulation.library import draw_start, simulate
from fieldmon.simulation.paired_seasons import SameInsects, met_by_all, paired
from fieldmon.simulation.season import SimulationSettings
from fieldmon.simulation.team_season import Team
from tests.simulation.test_library import CHANCE, PLOT, ROBOT

SHORT = SimulationSettings(n_days=3, spread=Spread(0.2))
INSECTS = SameInsects(PLOT, CHANCE, 0.1, SHORT)


def test_a_season_is_that_of_the_library():
    season = INSECTS.season(sampler("naive"), ROBOT, 4)
    start = draw_start(PLOT, CHANCE, 0.1, seed=4)
    np.testing.assert_array_equal(
        season.left, simulate(PLOT, start, "naive", robot=ROBOT, settings=SHORT, seed=4).left
    )
    assert repr(INSECTS) == "<SameInsects: 10.0% of <Plot Square: 126 plants in 9 rows>>"


def test_a_team_meets_the_insects_that_one_alone_meets():
    alone, two = (
        INSECTS.season(sampler("naive"), Robot(hours=0.3), 4, Team(robots)) for robots in (1, 2)
    )
    infested = draw_start(PLOT, CHANCE, 0.1, seed=4).infested.sum()
    assert alone.new[0] == two.new[0] == infested
    assert two.visited_pct[0] > alone.visited_pct[0]


def test_all_meet_a_seed_before_any_meets_the_next():
    experiment = paired("ab", range(3), lambda who, seed: (who, seed))
    assert [(one.setting, one.seeds.start) for one in experiment.chunks()] == [
        ("a", 0), ("b", 0), ("a", 1), ("b", 1), ("a", 2), ("b", 2),
    ]  # fmt: skip
    made = Memory()
    run(experiment, executor.here(), made)
    assert met_by_all(experiment, made) == {k: [("a", k), ("b", k)] for k in range(3)}


def test_a_seed_counts_once_all_have_been_through_it_in_whatever_order_they_end():
    experiment = paired("ab", range(3), lambda who, _: who)
    # of several threads one may be behind
    made = Memory({("a", 0): "a", ("a", 1): "a", ("b", 1): "b", ("b", 2): "b"})
    assert met_by_all(experiment, made) == {1: ["a", "b"]}


def test_what_is_kept_goes_by_a_key_of_the_callers():
    experiment = paired("a", range(2), lambda who, _: who, lambda who, seeds: f"{who}{seeds.start}")
    assert [chunk.key for chunk in experiment.chunks()] == ["a0", "a1"]
