"""One map by itself: what it makes of treatments, scales and arrivals."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.ancestry.origins import ANYWHERE, BY_EDGE
from fieldmon.infestation.chance_bounds import bounded_pair_chance
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from tests.infestation.tracing.traced_maps import FEW, FLAT, GRID, N, mid_season


def test_a_treatment_leaves_its_share():
    belief = TracedPairs.of(GRID, FLAT)
    after = belief.treated(np.full(N, 0.25))
    assert after.chance == pytest.approx(0.005)
    assert after.pair_chance == pytest.approx(belief.pair_chance / 16.0)


def test_known_finds_keep_their_chance_and_others_are_scaled_up_to_what_is_unknown():
    belief = mid_season()
    chance = belief.chance.copy()
    chance[[3, 7]] = 0.995, 0.985
    scale = np.linspace(0.2, 9.0, 12)
    after = replace(belief, chance=chance).times(scale)
    for i in range(12):
        most = max(chance[i], 0.95)
        wanted = 0.995 if i == 3 else min(chance[i] * scale[i], most)
        assert after.chance[i] == pytest.approx(wanted)
    start, other = FEW.adjacent
    own = np.repeat(np.arange(12), np.diff(start))
    scale[3] = 1.0
    both = belief.pair_chance * np.sqrt(scale[own] * scale[other])
    # as far as two such chances allow
    each = zip(both, after.chance[own], after.chance[other], strict=True)
    assert after.pair_chance == pytest.approx([bounded_pair_chance(*one) for one in each])


def test_finds_from_outside_are_those_that_arrived():
    belief = mid_season()
    found = belief.counts.found
    assert belief.arrivals_found == pytest.approx(found[ANYWHERE] + found[BY_EDGE])
