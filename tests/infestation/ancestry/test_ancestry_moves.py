"""Moves leave an ancestry of finds in order."""

import numpy as np
import pytest

from fieldmon.infestation.cell_squares import NOBODY
from tests.infestation.ancestry.moved_ancestry import moved


@pytest.mark.parametrize("delay", [0, 2])
def test_what_was_not_found_stands_where_it_is_noted_and_all_begin_in_time(delay):
    made, there, at, _, drawn = moved(delay)
    for i in there:
        assert made.earliest[i] <= made.begins[i] <= made.seen[i] <= made.ends[i]
    hidden = there[~made.found[there]]
    assert len(hidden) > 0
    assert (at[made.plant[hidden]] == hidden).all()
    assert np.count_nonzero(at != NOBODY) == len(hidden)
    assert "30 found" in repr(made)
    assert repr(drawn).startswith("<Drawn: ")
