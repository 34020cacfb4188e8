"""A press waits until it is carried out, or until a whole page without its button was drawn."""

import pytest

from app.state import button_presses
from app.state.button_presses import Press


@pytest.mark.usefixtures("session")
def test_a_press_waits_until_it_is_forgotten():
    button_presses.waiting()["record_one"] = Press(("plot", "day"))
    assert button_presses.waiting() == {"record_one": Press(("plot", "day"))}
    button_presses.forget()
    assert not button_presses.waiting()


@pytest.mark.usefixtures("session")
def test_the_press_that_was_done_last_is_known_and_one_that_failed_is_not():
    press = Press(("plot", "day"), 2)
    for done in (False, True):
        button_presses.waiting()["record_one"] = press
        button_presses.end("record_one", done=done)
        assert not button_presses.waiting()
        assert button_presses.is_done("record_one", press) is done
    assert not button_presses.is_done("record_one", Press(("plot", "day"), 3))
    assert not button_presses.is_done("record_route", press)
