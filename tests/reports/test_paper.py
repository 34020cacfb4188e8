"""What is written in one file in several scripts and fonts."""

from dataclasses import replace
from datetime import date

import pytest
from fpdf import FPDF
from fpdf.fonts import TTFFont
from fpdf.line_break import Fragment
from pypdf.generic import ContentStream

from app.words.language import for_reports
from fieldmon.compute.units import Units
from fieldmon.compute.wording import LANGUAGES
from fieldmon.decisions.sprayer import TreatmentCosts
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.reports import paper
from fieldmon.reports.advice import advice_report
from fieldmon.reports.certification import certification_report
from fieldmon.reports.content import Paragraph, Report, Sheet, Table
from fieldmon.reports.pdf import pdf_bytes
from tests.reports.reading import opened

ARABIC = for_reports("ar")


def written(monkeypatch, report):
    """Return a file, and font and size of each run of glyphs that went into it."""
    runs, trials = [], []
    made, cell = Fragment.render_pdf_text, FPDF.multi_cell

    def noted(self, *told):
        text = made(self, *told)
        if not trials:
            runs.extend(text.count(") Tj") * [(f"/F{self.font.i}", round(self.font_size_pt, 2))])
        return text

    def tried(self, *told, **also):
        trials.extend(["trial"] if also.get("dry_run") else [])
        lines = cell(self, *told, **also)
        if also.get("dry_run"):
            trials.pop()
        return lines

    with monkeypatch.context() as patch:
        patch.setattr(Fragment, "render_pdf_text", noted)
        patch.setattr(FPDF, "multi_cell", tried)
        return pdf_bytes(report), runs


def shown(data):
    """Return font and size of each run of glyphs on pages, as any reader must take them."""
    file = opened(data)
    for page in file.pages:
        font, kept = None, []
        for told, operator in ContentStream(page.get_contents(), file).operations:
            if operator == b"q":
                kept.append(font)
            elif operator == b"Q":
                font = kept.pop()
            elif operator == b"Tf":
                font = str(told[0]), round(float(told[1]), 2)
            elif operator == b"Tj":
                yield font


@pytest.fixture(scope="module")
def reports(worked, last, of_day, of_season):
    asked = AdviceSettings(0.02, costs=TreatmentCosts(per_ha=1.0, per_zone=0.0))
    advice = advice_report(worked, last, worked.advice(last, asked), Units())
    made = of_season, of_day, advice, certification_report([worked], Units())
    return [replace(one, plot="دفيئة 3") for one in made]


@pytest.mark.parametrize("code", LANGUAGES)
def test_every_run_of_glyphs_is_shown_in_the_font_that_chose_them(reports, monkeypatch, code):
    # the plot's name is Arabic in each; all are set as one of them is, which has all scripts
    for report in reports if code == "ar" else reports[1:2]:
        data, chosen = written(monkeypatch, report.said_in(for_reports(code)))
        assert list(shown(data)) == chosen


def drawn(monkeypatch, *blocks, language=None, plot="x"):
    """Return the runs of letters of a page in the order in which they stand, from the left."""
    runs = []
    made = Fragment.render_pdf_text

    def noted(self, *told):
        runs.append((told[3], "".join(self.characters)))
        return made(self, *told)

    report = Report(plot, "y", date(2026, 1, 1), (Sheet("z", blocks),))
    with monkeypatch.context() as patch:
        patch.setattr(Fragment, "render_pdf_text", noted)
        pdf_bytes(report.said_in(language) if language else report)
    return [text for _, text in runs]


def test_a_mark_over_a_letter_does_not_part_its_word(monkeypatch):
    table = Table("a", ("فُحصت", "b"), (("1", "2"),), (0.5, 0.5))
    assert "فُحصت" in drawn(monkeypatch, table, language=ARABIC)


def test_a_list_of_names_runs_as_the_page_is_read_whichever_comes_first(monkeypatch):
    names = "\u2068دفيئة\u2069, \u2068Olivar\u2069"
    spanish = "".join(drawn(monkeypatch, Paragraph(names), language=for_reports("es")))
    arabic = "".join(drawn(monkeypatch, Paragraph(names), language=ARABIC))
    assert spanish.index("دفيئة") < spanish.index("Olivar")
    assert arabic.index("دفيئة") > arabic.index("Olivar")


def test_a_number_stays_in_its_name_beside_words_of_the_other_direction(monkeypatch):
    text = Paragraph("Zona \u2068دفيئة 3\u2069, Olivar")
    for language in (for_reports("es"), ARABIC):
        said = "".join(drawn(monkeypatch, text, language=language))
        assert 0 < said.index("دفيئة") - said.index("3") < len("3 \u2068\u2069")


@pytest.mark.parametrize("code", ["es", "ar"])
def test_a_file_is_the_same_whether_widths_are_remembered_or_worked_out_again(monkeypatch, code):
    text = Paragraph("\u2068دفيئة 3\u2069 (Olivar 12, 14) كرم فُحصت. Zona fi 3 office AVAT. " * 4)
    table = Table("فُحصت", ("fila 1", "b"), (("1", "دفيئة"), ("Olivar 3", "2")), (0.5, 0.5))
    report = Report("دفيئة 3", "y", date(2026, 1, 1), (Sheet("z", (text, table)),))
    report = report.said_in(for_reports(code))
    remembered = pdf_bytes(report)
    monkeypatch.setattr(paper._Font, "shaped_text_width", TTFFont.shaped_text_width)
    assert pdf_bytes(report) == remembered
