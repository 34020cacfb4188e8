"""Spread foretold on maps: what fits a half of a plot is asked of the other."""

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.infestation.dispersal import Dispersal, settle
from fieldmon.infestation.kernels import DistanceKernel
from fieldmon.plot.layout import rectangle
from fieldmon.studies.map_spread import Interval, intervals_in, scores


def made(reach_m, rate, seed):
    """Return an interval in which plants were infested by a kernel."""
    grid, draws = rectangle(24, 24), np.random.default_rng(seed)
    before = draws.random(576) < 0.04
    kernel = Dispersal.of(grid, DistanceKernel("exponential", reach_m))
    after = settle(before, kernel.landed(rate * before), np.uint64(seed))
    return Interval("made", grid, before, after, np.arange(576) % 24 >= 12)


def test_the_kernel_that_spread_foretells_better_than_the_others():
    told = [scores(made(4.5, 4.0, seed)) for seed in range(3)]
    for one in told:
        assert one.kernel < one.evenly
        assert one.kernel < one.no_change
    assert np.mean([one.kernel for one in told]) < np.mean([one.thesis for one in told])


def test_scores_of_nothing_and_of_evenly_are_as_by_hand():
    interval = made(4.5, 4.0, 1)
    told = scores(interval)
    assert told.no_change == pytest.approx(
        -(told.new * np.log(1e-3) + (told.clean - told.new) * np.log(1 - 1e-3)) / told.clean
    )
    clean, by_hand = ~interval.before, 0.0
    for half in (False, True):
        fits, asked = clean & (interval.half == half), clean & (interval.half != half)
        rate = interval.after[fits].mean()
        seen = interval.after[asked]
        by_hand -= np.log(np.where(seen, rate, 1 - rate)).sum()
    assert told.evenly == pytest.approx(by_hand / told.clean, rel=1e-3)
    assert told.sentence().startswith("made ")


def test_a_folder_without_dated_maps_is_told(tmp_path):
    with pytest.raises(FileProblem, match="must hold one of"):
        intervals_in(tmp_path)
