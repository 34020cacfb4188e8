"""What boxes hold stays the same length, and the same cost of an area, in whichever unit."""

import pytest

from app.state import chosen_language, deciding, unit_boxes, widget_memory
from app.words.units import UnitsInLanguage
from fieldmon.monitoring.settings.advice_settings import AdviceSettings


@pytest.mark.usefixtures("session")
def test_costs_of_an_area_and_lengths_stay_what_they_are():
    widget_memory.first("decide per_ha", 120.0)
    widget_memory.first("decide on", 6.0)
    widget_memory.first("decide per_zone", 3.0)
    before = deciding.asked()
    widget_memory.first("area", "acre")
    widget_memory.first("length", "ft")
    unit_boxes.carry_over(UnitsInLanguage())
    assert widget_memory.value("decide per_ha") == pytest.approx(48.562277)
    assert widget_memory.value("decide on") == pytest.approx(19.685)
    assert widget_memory.value("decide per_zone") == 3.0
    assert deciding.asked() == before
    assert before.costs.per_ha == 120.0


@pytest.mark.usefixtures("session")
def test_a_session_in_dunams_is_asked_and_assumes_the_same():
    widget_memory.first("area", "dunam")
    usual = AdviceSettings()
    assert deciding.asked() == usual
    assert deciding.shown("decide rate", usual.rate_l_ha) == pytest.approx(usual.rate_l_ha / 10)
    widget_memory.first("decide rate", 25.0)
    assert deciding.asked().rate_l_ha == 250.0


@pytest.mark.usefixtures("session")
def test_a_language_brings_its_units_and_no_cost_changes(monkeypatch, speaking):
    speaking("en")
    widget_memory.first("area", "ha")
    widget_memory.first("decide per_ha", 120.0)
    monkeypatch.setattr(chosen_language, "chosen", lambda: "he")
    chosen_language.carry_over("en")
    assert widget_memory.value("area") == "dunam"
    assert widget_memory.value("decide per_ha") == 12.0
    assert deciding.asked().costs.per_ha == 120.0
