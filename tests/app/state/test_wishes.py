"""Wishes and picked plants are kept for one plot, wishes for one day of it."""

import pytest

from app.state import wishes
from fieldmon.planning.wishes import Wishes


@pytest.mark.usefixtures("session")
def test_wishes_are_of_one_day_and_one_plot():
    wishes.want("here", "2026-11-16", Wishes((1,)))
    assert wishes.of("here", "2026-11-16") == Wishes((1,))
    assert not wishes.of("here", "2026-11-17")
    assert not wishes.of("there", "2026-11-16")
    wishes.pick("here", (1, 2))
    assert wishes.picked("here") == (1, 2)
    assert wishes.picked("there") == ()
