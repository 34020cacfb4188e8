"""Seasons of the thesis's chapter 5 in scenario C: 91 x 91 plants, 25 days."""

import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS
from fieldmon.studies.thesis.chapter5.seasons import PriorTrial, SeedKeys, play
from fieldmon.studies.thesis.chapter5.sites import square
from fieldmon.studies.thesis.chapter5.study import run_prior


@pytest.mark.parametrize("name", SAMPLERS)
def test_season_of_chapter_5_in_scenario_c(benchmark, name):
    trial, keys = PriorTrial(name, CALIBRATED, 10.0), SeedKeys.of(RandomStreams(1))
    assert len(benchmark(play, square(10.0), trial, keys)) == 25


def test_all_of_chapter_5_with_4_seeds(benchmark):
    made = benchmark.pedantic(run_prior, kwargs={"seeds": 4}, rounds=1, warmup_rounds=1)
    assert len(made.parts) == 7
