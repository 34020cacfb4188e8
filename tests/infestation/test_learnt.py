"""What inspections tell, in words."""

import numpy as np
import pytest

from fieldmon.infestation.learnt import learnt_from
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.plot.layout import rectangle

GRID = rectangle(9, 9)
FLAT = np.full(81, 0.02)


def test_at_first_it_is_what_was_believed_with_wide_intervals():
    told = {one.name: one for one in learnt_from(TracedPairs.of(GRID, FLAT), 0.84)}
    assert told["detection"].value == 0.84
    assert told["infested at the start"].value == pytest.approx(1.62)
    assert all(one.low <= one.value <= one.high for one in told.values())
    assert told["infested at the start"].sentence() == "infested at the start 1.6 (0.1 to 4.9)"
    assert told["jumps beyond neighbours"].is_share
    assert 1.0 <= told["length of jumps"].low < 4.0 < told["length of jumps"].high + 1.0


def test_infested_at_the_start_are_those_suspected_and_the_others():
    chance = np.where(np.arange(81) < 27, 0.1, 0.01)
    told = {one.name: one for one in learnt_from(TracedPairs.of(GRID, chance), 0.84)}
    assert told["infested at the start"].value == pytest.approx(chance.sum())


def test_a_belief_that_traces_nothing_has_learnt_nothing():
    assert learnt_from(PairApproximation.of(GRID, FLAT), 0.84) == ()
