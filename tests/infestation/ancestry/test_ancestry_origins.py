"""Origins that are drawn are possible ones."""

import pytest

from fieldmon.infestation.cell_squares import NOBODY
from tests.infestation.ancestry.moved_ancestry import moved


@pytest.mark.parametrize("delay", [0, 2])
def test_parents_have_grown_before_their_children_begin_and_end_no_sooner(delay):
    made, there, _, grown, _ = moved(delay)
    with_parent = [i for i in there if made.parent[i] != NOBODY]
    assert with_parent
    for i in with_parent:
        parent = made.parent[i]
        assert made.there[parent]
        assert grown[made.begins[parent]] < made.begins[i] <= made.ends[parent]
