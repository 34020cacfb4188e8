"""How likely infestations are overlooked, by hand."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.infestation_course import BEFORE, Course
from fieldmon.infestation.ancestry.inspected_infestations import overlooked_until_last, until_found
from fieldmon.infestation.ancestry.unseen_offspring import Unseen


def test_nights_are_mixed_as_they_are_likely():
    """By hand: one plant, one inspection a day; what began before the season shows at once."""
    t = BEFORE + 5
    missed = np.zeros((t, 1))
    missed[BEFORE:-1, 0] = np.log(0.2) * np.arange(4, 0, -1)
    missed[:BEFORE] = missed[BEFORE]
    hiding = np.array([0.5, 0.3, 0.15, 0.05])
    course = Course.that_may_hide(t, hiding)
    overlooked = overlooked_until_last(missed, course)[:, 0]
    assert overlooked[: BEFORE + 1] == pytest.approx(0.2**4)
    for began in range(1, 5):
        # as many inspections as it could have been seen by
        many = [max(4 - began - nights, 0) for nights in (0, 2, 4, 7)]
        assert overlooked[BEFORE + began] == pytest.approx(hiding @ 0.2 ** np.array(many))
    # the same until a find on the last day but one, where it must show by then
    finds = np.array([BEFORE + 3]), np.array([BEFORE + 3]), np.array([0])
    ones = np.ones((t, 1))
    until = until_found(missed, Unseen(ones, ones, ones), finds, course)[0]
    assert until[: BEFORE + 1] == pytest.approx(0.2**3)
    for began in range(1, 4):
        each = [0.2 ** (3 - began - k) if k <= 3 - began else 0.0 for k in (0, 2, 4, 7)]
        assert until[BEFORE + began] == pytest.approx(hiding @ each)
    assert until[BEFORE + 4] == 0.0
