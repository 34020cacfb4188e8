"""A report in another language: every text is said in it, and pages turn about."""

import re

import numpy as np

from app.words.language import for_reports
from fieldmon.compute.units import Units
from fieldmon.compute.wording import figure, worded
from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel
from fieldmon.decisions.sprayer import TreatmentCosts
from fieldmon.monitoring import Application
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.reports import words
from fieldmon.reports.advice import advice_report
from fieldmon.reports.certification import certification_report
from fieldmon.reports.content import Illustration, TickList
from fieldmon.reports.html import html_text
from fieldmon.reports.language import ENGLISH, ReportLanguage
from fieldmon.reports.pdf import pdf_bytes
from fieldmon.reports.season import season_report
from tests.monitoring.seasons import BEGINS, a_season
from tests.reports.reading import opened

LOUD = ReportLanguage("xx", str.upper, letters="ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789")
BACK = ReportLanguage("he", str, right_to_left=True, letters=ENGLISH.letters)


def test_every_text_is_said_but_the_plot_s_name(of_season):
    said = of_season.said_in(LOUD)
    assert said.plot == of_season.plot
    spoken = list(said.words())[1:]
    assert spoken == [one.upper() for one in list(of_season.words())[1:]]
    pictures = [b for sheet in said.sheets for b in sheet.blocks if isinstance(b, Illustration)]
    assert all(text.isupper() or not text.isalpha() for p in pictures
               for text in p.draw((180.0, 100.0)).words())  # fmt: skip


def test_english_is_the_report_itself(of_day):
    assert html_text(of_day.said_in(ENGLISH)) == html_text(of_day)
    assert pdf_bytes(of_day.said_in(ENGLISH)) == pdf_bytes(of_day)


def test_what_is_read_from_the_right_begins_there(of_day):
    def left_edges(report):
        places = []
        opened(pdf_bytes(report)).pages[0].extract_text(
            visitor_text=lambda text, _, at, *__: places.append((text.strip(), at[4]))
        )
        return dict(places)

    heading = words.STOPS
    usual, turned = left_edges(of_day), left_edges(of_day.said_in(BACK))
    assert usual[heading] < 100
    assert turned[heading] > 300
    page = html_text(of_day.said_in(BACK))
    assert 'dir="rtl"' in page
    assert 'lang="he"' in page


def test_a_language_writes_every_number_in_one_way(worked, last, of_day, of_worked_day, tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    rows = np.arange(len(season.plot.grid)) < 30
    for water, dose in ((1250.0, Dose(1.5, "l/ha")), (1250.5, Dose(0.11, "%"))):
        season.treat(BEGINS, 0.8, plants=rows, application=Application("P", dose, water))
    season.keep_labels([ProductLabel("P", max_dose=Dose(0.5, "l/ha"))])
    asked = AdviceSettings(0.02, costs=TreatmentCosts(per_ha=1.0, per_zone=0.0))
    advice = worked.advice(last, asked)
    reports = [
        of_day, of_worked_day, season_report(worked, last, Units()),
        certification_report([season], Units()), advice_report(worked, last, advice, Units()),
    ]  # fmt: skip
    written = [
        text
        for report in reports
        for said in [report.said_in(for_reports("es"))]
        for text in [
            *said.words(), *(cell for sheet in said.sheets for block in sheet.blocks
                             if isinstance(block, TickList) for row in block.rows for cell in row),
            *(word for sheet in said.sheets for block in sheet.blocks
              if isinstance(block, Illustration) for word in block.draw((180.0, 100.0)).words()),
        ]
    ]  # fmt: skip
    english = re.compile(r"\d[.](\d{1,2}|\d{4,})(?!\d)|\d,\d{3}[.,]")
    assert [text for text in written if english.search(text)] == []
    assert {"1.250 l/ha", "1.250,5 l/ha", "1,5 l/ha", "0,11\u00a0%"} <= set(written)
    assert any("1,5 l/ha, es más" in text for text in written)


def test_a_number_is_words_without_words():
    said = figure(1234.5, ",.1f", " %")
    assert said == "1,234.5 %"
    assert (said.words, said.values) == ("{n:,.1f} %", {"n": 1234.5})
    assert worded("{n} m", n=figure(2.0, "g")) == "2 m"
