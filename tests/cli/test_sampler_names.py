"""The names of the samplers."""

from fieldmon.cli.sampler_names import SamplerName
from fieldmon.samplers import SAMPLERS


def test_the_names_of_the_samplers_are_those_of_the_program():
    assert {name.value for name in SamplerName} == set(SAMPLERS)
