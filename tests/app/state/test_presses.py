"""A press waits until it is carried out, or until a whole page without its button was drawn."""

import pytest

from app.state import presses
from app.state.presses import Press


@pytest.mark.usefixtures("session")
def test_a_press_waits_until_it_is_forgotten():
    presses.waiting()["record_one"] = Press(("plot", "day"))
    assert presses.waiting() == {"record_one": Press(("plot", "day"))}
    presses.forget()
    assert not presses.waiting()


@pytest.mark.usefixtures("session")
def test_the_press_that_was_done_last_is_known_and_one_that_failed_is_not():
    press = Press(("plot", "day"), 2)
    for done in (False, True):
        presses.waiting()["record_one"] = press
        presses.end("record_one", done=done)
        assert not presses.waiting()
        assert presses.is_done("record_one", press) is done
    assert not presses.is_done("record_one", Press(("plot", "day"), 3))
    assert not presses.is_done("record_route", press)
