"""The advice on paper."""

from fieldmon.compute.units import Units
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.reports.advice import advice_report
from fieldmon.reports.content import Table
from fieldmon.reports.html import html_text
from fieldmon.reports.pdf import pdf_bytes


def test_the_answer_the_zones_and_the_assumptions_are_on_one_page(worked, last):
    asked = AdviceSettings(0.02, costs=TreatmentCosts(per_ha=1.0, per_zone=0.0))
    advice = worked.advice(last, asked)
    assert len(advice.zones)
    report = advice_report(worked, last, advice, Units(), "soap")
    words = " ".join(report.words())
    for said in (*advice.sentences(), "soap", "Chance that it is enough"):
        assert said in words
    page = html_text(report)
    assert "<svg" in page
    assert "zones to treat" in page
    assert "hot spot" not in page
    assert pdf_bytes(report, "a4").startswith(b"%PDF")


def test_of_many_zones_all_are_on_the_page_that_has_room_for_them(worked, last):
    costs = TreatmentCosts(per_ha=1.0, per_zone=0.0)
    advice = worked.advice(last, AdviceSettings(0.02, sprayer=Sprayer(0), costs=costs))
    report = advice_report(worked, last, advice, Units())
    (zones,) = (block for block in report.sheets[0].blocks if isinstance(block, Table))
    assert len(zones.rows) == len(advice.zones) > 25
