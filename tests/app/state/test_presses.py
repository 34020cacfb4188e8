"""A press waits until it is carried out, or until a whole page without its button was drawn."""

import pytest

from app.state import presses


@pytest.mark.usefixtures("session")
def test_a_press_waits_until_it_is_forgotten():
    presses.waiting()["record_one"] = False
    assert presses.waiting() == {"record_one": False}
    presses.forget()
    assert not presses.waiting()
