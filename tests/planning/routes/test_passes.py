"""A walk drives every pass once, from where it begins."""

import itertools
from collections import Counter

import numpy as np
import pytest

from fieldmon.planning.routes.passes import Passes


def driven(path):
    return Counter(frozenset(pair) for pair in itertools.pairwise(path))


@pytest.mark.parametrize("seed", range(20))
def test_every_pass_of_a_closed_drive_is_driven_once(seed):
    rng = np.random.default_rng(seed)
    # a closed walk between few ends: what it drives can be driven
    ends = [(0, 0), *((int(k), int(side)) for k, side in rng.integers(0, (5, 2), (30, 2))), (0, 0)]
    ends = [end for k, end in enumerate(ends) if k == 0 or end != ends[k - 1]]
    passes = Passes()
    for a, b in itertools.pairwise(ends):
        passes.link(a, b, 1)
    path = passes.walk((0, 0))
    assert path[0] == path[-1] == (0, 0)
    assert driven(path) == driven(ends)


def test_a_drive_that_ends_elsewhere_ends_at_the_other_odd_node():
    passes = Passes()
    passes.link((-1, 0), (0, 0), 1)
    passes.link((0, 0), (0, 1), 2)
    passes.link((0, 0), (1, 0), 1)
    path = passes.walk((-1, 0))
    assert (path[0], path[-1]) == ((-1, 0), (1, 0))
    assert len(path) == 1 + 4


def test_where_nothing_is_driven_one_stays():
    assert Passes().walk((0, 0)) == [(0, 0)]
