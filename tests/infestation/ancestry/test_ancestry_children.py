"""Children of infestations after many moves."""

import numpy as np
import pytest

from tests.infestation.ancestry.moved_ancestry import moved


@pytest.mark.parametrize("delay", [0, 2])
def test_each_has_as_many_children_as_it_says_and_nobody_hangs_on_nothing(delay):
    made, there, *_ = moved(delay)
    children = np.bincount(made.parent[there] + 1, minlength=len(made.plant) + 1)[1:]
    assert (made.children[there] == children[there]).all()
    assert (made.found[there] | (children[there] > 0)).all()
