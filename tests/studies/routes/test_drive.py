"""Walks step by step: what is a walk, what it costs and what it holds."""

import numpy as np

from fieldmon.studies.routes.drive import Walker, driven


def test_a_walk_holds_what_it_passes_once_however_often_it_comes_by():
    reward = np.arange(12.0).reshape(3, 4)
    walker = Walker(4)
    for row in (0, 1, 2):
        walker.through(row)
    walker.excursion(2, 2)
    walked = driven(walker.home(), reward)
    # at the right: row 2 two plants deep again, then home along it and down two rows
    assert walked.reward == reward.sum()
    assert walked.steps == 3 * 5 + 2 + 2 * 2 + 5 + 2


def test_an_excursion_goes_in_from_the_headland_where_one_stands():
    reward = np.arange(1.0, 9.0).reshape(2, 4)
    left, right = Walker(4), Walker(4)
    left.excursion(1, 2)
    right.through(0)
    right.excursion(1, 2)
    right.to_row(0)
    assert driven(left.home(), reward).reward == 5 + 6
    assert driven(right.home(), reward).reward == reward[0].sum() + 7 + 8
