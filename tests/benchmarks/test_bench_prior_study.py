"""Seasons of the thesis's chapter 5 in scenario C: 91 x 91 plants, 25 days."""

import pytest

from fieldmon.chance import Chance
from fieldmon.thesis.with_prior.choices import SAMPLERS
from fieldmon.thesis.with_prior.defaults import CALIBRATED
from fieldmon.thesis.with_prior.seasons import Luck, Trial, play
from fieldmon.thesis.with_prior.sites import square
from fieldmon.thesis.with_prior.studies import run_prior


@pytest.mark.parametrize("name", SAMPLERS)
def test_season_of_chapter_5_in_scenario_c(benchmark, name):
    trial, luck = Trial(name, CALIBRATED, 10.0), Luck.of(Chance(1))
    assert len(benchmark(play, square(10.0), trial, luck)) == 25


def test_all_of_chapter_5_with_4_seeds(benchmark):
    made = benchmark.pedantic(run_prior, kwargs={"seeds": 4}, rounds=1, warmup_rounds=1)
    assert len(made.parts) == 7
