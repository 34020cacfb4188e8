"""Samplers and strategies are called what the boxes call them."""

import pytest

from app.words import texts
from app.words.strategies import sampler_does, sampler_name, strategy_name
from fieldmon.samplers import SAMPLERS


@pytest.mark.parametrize("sampler", texts.SAMPLERS)
def test_a_name_and_what_is_done_make_up_the_whole_text(sampler):
    assert f"{sampler_name(sampler)}: {sampler_does(sampler)}" == texts.SAMPLERS[sampler]
    assert sampler in SAMPLERS


def test_no_two_samplers_are_called_the_same():
    names = {sampler_name(sampler) for sampler in texts.SAMPLERS}
    assert len(names) == len(texts.SAMPLERS)


def test_a_strategy_says_sampler_hours_and_seconds_without_idle_zeros():
    assert strategy_name("naive", 12.0, 40.0) == "Naive · 12 h · 40 s"
    assert strategy_name("snake-random", 7.5, 12.5) == "Snake-random · 7.5 h · 12.5 s"


def test_several_robots_are_counted_before_the_name():
    assert strategy_name("naive", 12.0, 40.0, 2) == "2 × Naive · 12 h · 40 s"
