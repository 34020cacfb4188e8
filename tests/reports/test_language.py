"""A report in another language: every text is said in it, and pages turn about."""

from fieldmon.compute.wording import figure, worded
from fieldmon.reports import words
from fieldmon.reports.content import Illustration
from fieldmon.reports.html import html_text
from fieldmon.reports.language import ENGLISH, ReportLanguage
from fieldmon.reports.pdf import pdf_bytes
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


def test_a_number_is_words_without_words():
    said = figure(1234.5, ",.1f", " %")
    assert said == "1,234.5 %"
    assert (said.words, said.values) == ("{n:,.1f} %", {"n": 1234.5})
    assert worded("{n} m", n=figure(2.0, "g")) == "2 m"
