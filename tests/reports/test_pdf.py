"""A report as PDF, read back by another program's reader."""

from collections import Counter
from dataclasses import replace
from datetime import date

import numpy as np
import pytest
from fpdf import FPDF

from app.words.language import for_reports
from fieldmon.compute.wording import LANGUAGES, worded
from fieldmon.errors import SettingError
from fieldmon.reports import maps, words
from fieldmon.reports.content import (
    Illustration,
    KeyFigure,
    KeyFigures,
    Listing,
    NoteLines,
    Paragraph,
    Report,
    Sheet,
    Table,
    TickList,
)
from fieldmon.reports.drawing import Areas, Drawing, Lettering, Strokes
from fieldmon.reports.pdf import PAPERS, pdf_bytes
from tests.reports.reading import opened, plain, sizes_mm, texts


def made(*blocks, plot="Gate", title="Day"):
    return Report(plot, title, date(2026, 11, 18), (Sheet("Work", blocks),))


def rows(n):
    return Table("Rows", ("row", "plants"), tuple((f"r{k}", f"p{k}") for k in range(n)),
                 (0.5, 0.5), flow=2, rest="and {n} more")  # fmt: skip


@pytest.fixture(scope="module")
def season_file(of_season):
    """Return a season's report as a file, written once for all who only read it."""
    return pdf_bytes(of_season)


@pytest.fixture(scope="module")
def day_file(of_day):
    """Return a day's report as a file."""
    return pdf_bytes(of_day)


def test_a_season_has_four_pages_and_a_day_one_of_the_paper_s_size(
    season_file, day_file, of_season, of_day
):
    assert sizes_mm(season_file) == [PAPERS["a4"]] * 4
    assert sizes_mm(day_file) == [PAPERS["a4"]]
    assert sizes_mm(pdf_bytes(of_season, "letter")) == [PAPERS["letter"]] * 4
    assert sizes_mm(pdf_bytes(of_day, "letter")) == [PAPERS["letter"]]


def test_a_paper_that_is_not_there_is_refused(of_day):
    with pytest.raises(SettingError, match="must be one of a4, letter, but it is 'a5'"):
        pdf_bytes(of_day, "a5")


@pytest.fixture(scope="module")
def season_texts(season_file):
    """Return the text of each page of that file."""
    return texts(season_file)


def test_every_page_says_its_plot_heading_and_number(of_season, season_texts):
    for number, (page, sheet) in enumerate(
        zip(season_texts, of_season.sheets, strict=True), start=1
    ):
        assert "Paran" in page
        assert sheet.heading in page
        assert f"{number} / 4" in page


def test_every_sentence_and_figure_is_on_its_page(of_season, of_day, season_texts, day_file):
    for report, pages in ((of_season, season_texts), (of_day, texts(day_file))):
        for page, sheet in zip(pages, report.sheets, strict=True):
            for block in sheet.blocks:
                if isinstance(block, Paragraph):
                    assert plain(block.text) in page
                if isinstance(block, KeyFigures):
                    assert all(plain(one.value) in page for one in block.figures)
                if isinstance(block, Listing):
                    assert all(plain(said) in page for said in block.sentences)


def test_the_same_report_is_the_same_file(of_day, day_file):
    assert pdf_bytes(of_day) == day_file


def test_the_file_s_date_is_that_of_the_report(of_day, day_file):
    about = opened(day_file).metadata
    assert about.creation_date.date() == of_day.on
    assert plain(about.title) == plain(f"{of_day.plot}: {of_day.title}")


@pytest.mark.parametrize("name", ["כרם הזית", "حقل العنب", "Ängsö Ωμέγα Поле", "Gate"])
def test_a_name_in_any_of_these_scripts_has_its_letters(name):
    (page,) = texts(pdf_bytes(made(plot=name)))
    # a reader may turn words from right to left about, but each letter is there once
    beside = Counter("DayWorkfieldmon1/1")
    assert Counter(page.replace(" ", "")) - beside == Counter(name.replace(" ", "")) - Counter()
    assert "cannot be printed" not in page


def test_letters_that_cannot_be_printed_are_said():
    (page,) = texts(pdf_bytes(made(plot="葡萄 field")))
    assert "?? field" in page
    assert "2 characters of names cannot be printed" in page
    assert "U+8404 U+8461" in page


def test_a_table_longer_than_the_page_says_how_many_rows_are_missing():
    (page,) = texts(pdf_bytes(made(rows(1000))))
    shown = page.count(" p")
    assert 80 < shown < 1000
    assert f"and {1000 - sum(f'r{k} ' in page for k in range(1000))} more" in page


def test_words_that_are_too_wide_are_set_smaller_before_they_are_cut():
    table = Table("Days", ("day", "share found so far"), (("1", "58 %"),), (0.88, 0.12))
    figures = KeyFigures((KeyFigure("Infested plants inside the zones", "1"),) * 5)
    (page,) = texts(pdf_bytes(made(table, figures)))
    assert "share found so far" in page
    assert "Infested plants inside the zones" in page


def test_a_column_that_needs_more_room_has_it_from_one_that_needs_less():
    long = "Two-spotted spider mite, by degree-days"
    table = Table("Days", ("a", "b"), (("1", long),), (0.9, 0.1), flow=2, left=(0, 1))
    sizes = []
    opened(pdf_bytes(made(table))).pages[0].extract_text(
        visitor_text=lambda said, *of: sizes.append(of[-1]) if long in said else None
    )
    assert sizes == [7.5]


def test_a_table_that_fits_is_whole():
    (page,) = texts(pdf_bytes(made(rows(37))))
    assert all(f"p{k}" in page for k in range(37))
    assert "more" not in page


def test_nothing_lies_below_the_foot_however_much_there_is():
    text = "A sentence that goes on for a while, and on. " * 12
    picture = Illustration("", "", lambda size: Drawing(*size, ()), (75.0, 190.0))
    report = made(Paragraph(text, lead=True), picture, rows(300), NoteLines("Notes"))
    lowest = []
    opened(pdf_bytes(report)).pages[0].extract_text(
        visitor_text=lambda said, cm, tm, *_: lowest.append(cm[5] + tm[5]) if said.strip() else None
    )
    assert min(lowest) >= 12.0 * 72 / 25.4 - 1


def test_a_map_takes_what_others_leave():
    seen = []

    def draw(size):
        seen.append(size)
        return Drawing(*size, (Strokes((np.array([[0, 0], size]),), (0, 0, 0), 0.2),))

    picture = Illustration("", "", draw, (75.0, 190.0))
    pdf_bytes(made(picture))
    pdf_bytes(made(picture, rows(60)))
    (wide, alone), (_, shared) = seen
    assert wide == pytest.approx(210 - 24)
    assert alone == pytest.approx(190.0)
    assert 75.0 <= shared < alone


def test_a_long_name_is_cut_before_it_meets_the_title():
    (page,) = texts(pdf_bytes(made(plot="Very long name of a plot " * 8)))
    assert "..." in page
    assert "Day" in page


def test_a_list_to_tick_is_left_to_pages_without_an_end():
    ticks = TickList("Every stop", ("stop",), (("nine",),))
    (page,) = texts(pdf_bytes(made(ticks)))
    assert "nine" not in page


def test_words_of_drawings_and_notes_of_figures_are_written():
    words = Illustration(
        "Chart", "", lambda size: Drawing(*size, (Lettering(9, 9, "12 m"),)), (20, 20)
    )
    (page,) = texts(pdf_bytes(made(words, KeyFigures((KeyFigure("Left", "7.5", "5 to 9"),)))))
    assert "Chart" in page
    assert "12 m" in page
    assert "5 to 9" in page


def test_a_report_of_a_plot_can_be_made_twice_at_once(of_day, day_file):
    other = replace(of_day, plot="Other")
    assert "Other" in texts(pdf_bytes(other))[0]
    assert "Other" not in texts(day_file)[0]


def test_what_must_be_whole_takes_its_room_from_longer_tables():
    whole = replace(rows(24), title="Settings", whole=True,
                    rows=tuple((f"s{k}", f"v{k}") for k in range(24)))  # fmt: skip
    (page,) = texts(pdf_bytes(made(rows(500), whole)))
    assert all(f"v{k}" in page for k in range(24))


@pytest.mark.parametrize("code", LANGUAGES)
def test_what_stands_in_tables_and_figures_is_not_cut_in_any_language(code):
    learnt = words.DETECTS_LEARNT, "62 %", words.FROM_LEARNT
    found = words.TREATED, words.TREATED_VALUES[True], words.FROM_NOBODY
    settings = Table(
        words.SETTINGS, words.SETTING_COLUMNS, (learnt, found) * 2, (0.46, 0.2, 0.34), flow=2,
        left=(0, 1, 2), whole=True,
    )  # fmt: skip
    hidden = worded(words.OF_HIDDEN, n="1,178", seen="1,176")
    of_day = KeyFigures(4 * (KeyFigure(words.FINDS, "1", hidden),))
    of_season = KeyFigures(6 * (KeyFigure(words.SHARE_FOUND, "–", words.NOTHING_INSPECTED),))
    report = made(settings, of_day, of_season)
    (page,) = texts(pdf_bytes(report.said_in(for_reports(code))))
    assert "..." not in page


def test_signs_of_a_legend_do_not_touch_the_words_before_them():
    pdf = FPDF()
    pdf.set_font("helvetica", "", 7)
    legend = maps.legend(186.0, by_state=True)
    said = [one for one in legend.parts if isinstance(one, Lettering)][:2]
    boxes = [one.rings[0][:, 0].min() for one in legend.parts if isinstance(one, Areas)]
    text = for_reports("es").say(said[0].text)
    # Open Sans is a tenth wider
    assert said[0].x + 1.1 * pdf.get_string_width(text) + 1.0 < boxes[1]


def test_whence_records_come_is_said_in_the_language():
    assert for_reports("es").say(words.SOURCES["phone"]) == "teléfono"
