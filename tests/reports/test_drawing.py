"""A drawing is parts in order."""

import numpy as np

from fieldmon.reports.drawing import Discs, Drawing, Lettering


def test_a_drawing_s_words_are_those_of_its_letterings_in_order():
    parts = (Lettering(0, 0, "one"), Discs(np.zeros((1, 2)), 1.0), Lettering(0, 0, "two"))
    assert Drawing(10, 10, parts).words() == ["one", "two"]
