"""Spread foretold on maps: what fits a half of a plot is asked of the other."""

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.infestation.insects.dispersal import Dispersal, settle
from fieldmon.infestation.insects.kernels import DistanceKernel
from fieldmon.plot.layout import rectangle
from fieldmon.studies.map_spread import Interval, intervals_in, scores


def made(reach_m, rate, seed):
    """Return an interval in which plants were infested by a kernel."""
    grid, draws = rectangle(24, 24), np.random.default_rng(seed)
    before = draws.random(576) < 0.04
    kernel = Dispersal.of(grid, DistanceKernel("exponential", reach_m))
    after = settle(before, kernel.landed(rate * before), np.uint64(seed))
    return Interval("made", grid, before, after, np.arange(576) % 24 >= 12)


@pytest.fixture(scope="module")
def told():
    """Return the scores of three plots in which a kernel spread."""
    return [scores(made(4.5, 4.0, seed)) for seed in range(3)]


def test_the_kernel_that_spread_foretells_better_than_the_others(told):
    for one in told:
        assert one.kernel < one.evenly
        assert one.kernel < one.no_change
    assert np.mean([one.kernel for one in told]) < np.mean([one.thesis for one in told])


def test_kernels_weighed_foretell_nearly_as_well_as_whichever_way_is_right(told):
    """Where the stand tells where new ones come, and where it tells nothing."""
    assert sum(one.weighed for one in told) < sum(one.evenly for one in told) - 0.02
    grid, draws = rectangle(24, 24), np.random.default_rng(1)
    before = draws.random(576) < 0.04
    after = before | (draws.random(576) < 0.05)
    anywhere = scores(Interval("anywhere", grid, before, after, np.arange(576) % 24 >= 12))
    assert anywhere.weighed < anywhere.evenly + 0.005


def test_earlier_dates_tell_which_kernel_it_is():
    first, now = made(4.5, 4.0, 1), made(4.5, 1.0, 2)
    alone, informed = scores(now), scores(now._replace(earlier=(first,)))
    assert informed.weighed < alone.weighed + 0.01
    assert informed.kernel == alone.kernel


def test_scores_of_nothing_and_of_evenly_are_as_by_hand(told):
    interval, told = made(4.5, 4.0, 1), told[1]
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
    with pytest.raises(FileProblem, match="must hold a map of plants"):
        intervals_in(tmp_path)


def test_plants_unknown_on_either_date_are_left_out_and_counted(tmp_path):
    """As if they stood there without ever having been clean."""
    interval = made(4.5, 4.0, 1)
    unknown = np.random.default_rng(0).random(576) < 0.3
    lines = ["row,plant,date,infested,row_m,plant_m"]
    for day, states in (("1", interval.before), ("2", interval.after)):
        gone = unknown & (day == "1")
        of_day = np.where(gone, "NA", states.astype(int).astype(str)).tolist()
        lines += [f"{k // 24 + 1},{k % 24 + 1},{day},{s},4,3" for k, s in enumerate(of_day)]
    (tmp_path / "a.map.csv").write_text("\n".join(lines))
    (one,) = intervals_in(tmp_path)
    told = scores(one)
    known = ~interval.before & ~unknown
    assert (told.clean, told.new) == (known.sum(), (known & interval.after).sum())
    assert told.unknown == unknown.sum()
    assert told.sentence().endswith(f"; {unknown.sum()} plants of unknown state left out")
    assert not one.before[unknown].any()
