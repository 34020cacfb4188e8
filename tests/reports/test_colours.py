"""Colours on paper: readable in grey, and the app's."""

import numpy as np
import pytest

from fieldmon.reports import colours


def grey(colour):
    """Return the lightness of a colour, CIE 1976, from 0 to 100."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
              for c in np.array(colour) / 255]  # fmt: skip
    y = float(np.dot([0.2126, 0.7152, 0.0722], linear))
    return 116 * np.cbrt(y) - 16


def test_the_classes_darken_in_even_steps():
    lightness = [grey(one) for one in colours.CHANCE]
    steps = -np.diff(lightness)
    assert (steps > 7).all()
    assert lightness[0] < grey(colours.PAPER) - 12
    assert lightness[0] < grey(colours.GROUND) - 8


def test_the_three_states_differ_in_grey_too():
    never, clean, found = (grey(one) for one in colours.STATES)
    assert never - clean > 8
    assert clean - found > 15


@pytest.mark.parametrize(
    ("chance", "rank"), [(0.0, 0), (0.0099, 0), (0.01, 1), (0.3, 5), (0.5, 6), (1.0, 6)]
)
def test_a_chance_falls_into_the_class_that_begins_at_or_below_it(chance, rank):
    assert colours.ranks(np.array([chance])).tolist() == [rank]


def test_each_class_is_named_by_its_lower_end():
    assert colours.chance_names() == ["0 %", "1 %", "2 %", "5 %", "10 %", "25 %", "50 %+"]
