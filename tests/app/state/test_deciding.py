"""What the boxes of Decide ask of a season."""

import pytest

from app.state import deciding
from fieldmon.monitoring.settings.advice_settings import AdviceSettings


@pytest.mark.usefixtures("session")
def test_boxes_that_were_never_touched_ask_the_librarys_own_question():
    assert deciding.asked() == AdviceSettings()
    assert deciding.product() == ""


def test_what_a_box_says_is_asked(session):
    session["decide level"], session["decide rows"] = 12.0, 0.0
    session["decide reserve"], session["decide product"] = 30.0, " soap "
    asked = deciding.asked()
    assert asked.level == pytest.approx(0.12)
    assert (asked.sprayer.rows, asked.costs.reserve) == (0, pytest.approx(0.3))
    assert deciding.product() == "soap"
