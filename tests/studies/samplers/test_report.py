"""The report of the study of samplers."""

from fieldmon.studies.samplers.contenders import NAMES
from fieldmon.studies.samplers.report import report_html
from fieldmon.studies.samplers.seasons import SeasonOutcome


def test_the_report_names_every_contender_and_scenario():
    made = [
        SeasonOutcome(f"plot {k} <b>", seed, name, 10.0, 5.0, 6.0, 100.0, 20.0, 50.0)
        for k in range(2)
        for seed in range(3)
        for name in NAMES
    ]
    page = report_html(made)
    assert all(name in page for name in NAMES)
    assert "plot 1 &lt;b&gt;" in page
    assert "<b>" not in page
    assert "3 seasons" in page
