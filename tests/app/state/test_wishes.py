"""Wishes and picked plants are kept for one plot, wishes for one day of it."""

import json

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


def test_what_is_wanted_is_found_again_after_a_reload(session):
    wanted = Wishes((3, 1), (2,))
    wishes.want("here", "2026-11-16", wanted)
    wishes.want("here", "2026-11-17", Wishes())
    written = json.dumps(wishes.said())
    session.clear()
    wishes.take(json.loads(written))
    assert wishes.of("here", "2026-11-16") == wanted
    assert wishes.were_told("here", "2026-11-17")
