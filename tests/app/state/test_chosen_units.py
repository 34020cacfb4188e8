"""UnitsInLanguage are those of the session's boxes, else the first ones."""

import pytest

from app.state import chosen_units, widget_memory
from app.words.units import UnitsInLanguage


@pytest.mark.usefixtures("session")
def test_boxes_not_shown_yet_leave_the_usual_units():
    assert chosen_units.units() == UnitsInLanguage()


def test_each_box_says_one_unit(session):
    for key, value in zip(chosen_units.KEYS, ("ft", "acre", "11/16/2026"), strict=True):
        widget_memory.first(key, value)
    assert chosen_units.units() == UnitsInLanguage("ft", "acre", "11/16/2026")
    session["length"] = "m"
    assert chosen_units.units() == UnitsInLanguage("m", "acre", "11/16/2026")
