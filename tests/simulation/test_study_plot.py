"""A plot of a study: about how large it is, and what tells it from others."""

from dataclasses import replace

from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.simulation.study_plot import as_written
from tests.simulation.study_plots import plot
from tests.simulation.test_design import SQUARE


def test_the_guess_of_plants_is_near_what_is_laid():
    for one in (SQUARE, plot(40.0), plot(120.0)):
        laid = len(Plot.of(one.field, one.planting).grid)
        assert 0.7 * one.about_plants < laid < 1.3 * one.about_plants


def test_a_plot_planted_or_seen_otherwise_is_another():
    other = replace(SQUARE, planting=Planting(plant_spacing_m=2.5))
    later = replace(SQUARE, day=SQUARE.day + 1)
    assert len({SQUARE.digest, other.digest, later.digest}) == 3
    assert replace(SQUARE).digest == SQUARE.digest


def test_what_a_later_version_asks_changes_no_plot_of_which_it_is_not_said():
    assert b"half_canopy_m" not in as_written(Planting())
    assert as_written(Planting(half_canopy_m=0.4)) != as_written(Planting())
