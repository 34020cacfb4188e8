"""Of all switchings of a section none gains more, and every stretch can be switched."""

from itertools import product

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.decisions.zones import best_zones
from tests.crooked import crooked_grids
from tests.decisions.test_zones import CHEAP, ROW


def value(on, gain, sprayer, per_zone, step_m=2.0):
    """Return what a switching of one row is worth, or None if it cannot be switched."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], on, [0]])))
    starts, ends = edges[::2], edges[1::2]
    whole = len(on) * step_m
    if any(
        (b - a) * step_m < min(sprayer.least_on_m, whole) for a, b in zip(starts, ends, strict=True)
    ):
        return None
    if any(
        (b - a) * step_m < sprayer.least_off_m for a, b in zip(ends[:-1], starts[1:], strict=True)
    ):
        return None
    return gain[on.astype(bool)].sum() - per_zone * len(starts)


@given(
    st.lists(st.floats(0.0, 0.9), min_size=9, max_size=9),
    st.sampled_from([0.0, 2.0, 5.0, 8.0, 40.0]),
    st.sampled_from([0.0, 2.0, 6.0]),
)
def test_no_other_switching_of_a_row_is_worth_more(chance, least_on_m, least_off_m):
    sprayer, chance = Sprayer(1, least_on_m, least_off_m), np.array(chance)
    zones = best_zones(ROW, chance, sprayer, CHEAP)
    gain = chance * CHEAP.per_infested_plant - CHEAP.per_ha * 8.0 / 10_000
    every = (np.array(on) for on in product([0, 1], repeat=9))
    best = max(v for on in every if (v := value(on, gain, sprayer, CHEAP.per_zone)) is not None)
    mine = value(zones.treated.astype(int), gain, sprayer, CHEAP.per_zone)
    assert mine is not None, "it cannot be switched so"
    assert mine == pytest.approx(best)
    assert zones.saved - zones.cost == pytest.approx(mine)


@given(crooked_grids(60), st.integers(0, 1000))
def test_a_stretch_is_one_section_and_long_enough_or_the_whole_plot(grid, seed):
    chance = np.random.default_rng(seed).random(len(grid)) ** 6
    sprayer = Sprayer(2, least_on_m=7.0, least_off_m=5.0)
    zones = best_zones(grid, chance, sprayer, TreatmentCosts(per_ha=200.0))
    assume(len(zones) > 1 or not zones.treated.all())  # else nothing is switched
    line = grid.row_line[grid.row]
    for k in range(len(zones)):
        mine = zones.zone == k
        assert np.ptp(line[mine] // 2) == 0
        section = line // 2 == line[mine][0] // 2
        long_m = np.ptp(grid.along_m[mine]) + grid.plant_spacing_m
        whole_m = np.ptp(grid.along_m[section]) + grid.plant_spacing_m
        # steps are a plant's spacing: ends may lie a step apart from the plants'
        assert long_m > min(sprayer.least_on_m, whole_m) - 2 * grid.plant_spacing_m
