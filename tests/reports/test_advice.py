"""The advice on paper."""

from fieldmon.compute.units import Units
from fieldmon.decisions.zones import TreatmentCosts
from fieldmon.monitoring.advice import AdviceSettings
from fieldmon.reports.advice import advice_report
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
    assert pdf_bytes(report, "a4").startswith(b"%PDF")
