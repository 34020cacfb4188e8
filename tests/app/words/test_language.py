"""A language: its texts, its plurals and numbers, and the library's sentences in it."""

import unicodedata

import pytest

from app.words import language, texts
from app.words.units import UnitsInLanguage
from fieldmon.compute.wording import counted, figure, joined, worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED
from fieldmon.io.formats.signatures import kind_of
from fieldmon.io.options import Upload
from fieldmon.io.parse.result_words import is_gone
from fieldmon.io.readers.inspection_file.columns import is_own
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.writers.field_sheet import WORDS
from fieldmon.plot.layout import rectangle
from fieldmon.reports import words


@pytest.mark.parametrize("code", language.LANGUAGES)
def test_a_sheet_that_was_typed_in_as_it_was_printed_is_read(code, speaking):
    speaking(code)
    say, grid = language.for_reports(code).say, rectangle(2, 5)
    heads = [say(WORDS[name]) for name in ("row", "plant", "time", "how_many")]
    printed = [[say(WORDS[name]) for name in ("clean", "found", "skipped")]]
    # what the app, its reports and the phone call results
    printed += [[str(texts.HISTORY_RESULTS[k]) for k in range(3)]]
    printed += [[str(texts.SCOUT_PAGE[name]) for name in ("clean", "found", "skipped")]]
    printed += [[say(one) for one in [*words.RESULTS.values()][:3]]]
    for said in printed:
        lines = [f"1,{n},10:0{n},{one},{'3' * (n == 2)}" for n, one in enumerate(said, 1)]
        text = "\n".join([",".join([*heads[:3], "result", heads[3]]), *lines])
        read = read_inspections(Upload("sheet.csv", text.encode()), grid).value
        assert read.plant.tolist() == [0, 1, 2], said
        assert read.result.tolist() == [CLEAN, FOUND, SKIPPED], said
        assert read.count[1] == 3
    assert is_own("time", heads[2])
    gone = say(WORDS["gone"]).replace(".", "").replace(",", "")
    assert any(is_gone(word) for word in gone.split())


@pytest.mark.parametrize("code", language.LANGUAGES)
def test_a_plant_by_its_number_alone_is_of_no_language(code, speaking):
    speaking(code)
    assert language.plant_in_words(rectangle(2, 5), 0, 6) == "6"


def test_a_text_is_read_in_the_language_that_is_spoken(speaking):
    assert texts.MENU["today"] == "Today"
    speaking("he")
    assert texts.MENU["today"] == "היום"
    assert texts.COMPASS[0] == "צפונה"
    assert texts.TITLE == "fieldmon"


def test_a_count_takes_the_form_that_the_language_asks_for(speaking):
    assert [texts.PLOTS_TITLE.format(n=n) for n in (1, 2)] == ["1 plot", "2 plots"]
    speaking("ar")
    said = [texts.PLOTS_TITLE.format(n=n) for n in (1, 2, 5, 12, 100)]
    assert said == ["قطعة واحدة", "قطعتان", "5 قطع", "12 قطعة", "100 قطعة"]


def test_a_second_count_of_a_text_takes_its_own_form(speaking):
    speaking("es")
    said = [texts.CHANGED_FINDS.format(found=n, inspected=5, day="hoy") for n in (1, 2)]
    assert [one.partition(" en ")[0] for one in said] == ["1 hallazgo", "2 hallazgos"]
    assert texts.OUT_DONE.format(done=1, all=9) == "1 de 9 registrada"


def test_numbers_in_a_text_are_written_as_in_the_language(speaking):
    verdict = {"best": "A", "second": "B", "loss": 12_345, "percent": 3, "low": 1, "high": 9}
    assert texts.VERDICT.format(**verdict).startswith("**A** is best: 12,345 infested")
    speaking("es")
    assert "12.345 días-planta" in texts.VERDICT.format(**verdict)
    assert UnitsInLanguage().metres(1234.5) == "1,23\u00a0km"
    assert language.number(0.125, ".1%") == "12,5\u00a0%"


def test_a_worded_sentence_of_the_library_is_said_in_the_language(speaking):
    said = worded("{plants} {where}: never inspected yet.", plants=counted(1, "plant"),
                  where=worded("in row {row}", row=7))  # fmt: skip
    speaking("he")
    assert language.in_words(said) == "צמח אחד בשורה 7: עדיין לא נבדקו מעולם."
    assert language.in_words(joined("; ", [said, said])).count("צמח אחד") == 2


def test_a_sentence_that_nobody_translated_stays_english_and_says_so(speaking):
    assert language.in_words("Something.") == "Something."
    speaking("he")
    assert language.in_words("Something.") == "\u2066Something.\u2069 [English]"
    assert language.in_words(worded("Nobody knows {n}.", n=3)) == (
        "\u2066Nobody knows 3.\u2069 [English]"
    )


def test_the_app_s_own_words_in_a_problem_are_not_taken_for_english(speaking):
    speaking("he")
    said = language.of_error(SettingError(texts.SEASON_NAMED.format(name="a/b")))
    assert said == str(texts.SEASON_NAMED.format(name="a/b"))
    assert language.of_error(SettingError(texts.ONE_UNSAID)) == str(texts.ONE_UNSAID)


def test_a_sentence_that_begins_with_a_latin_name_is_laid_out_as_its_language_is(speaking):
    said = worded("{path} is damaged ({why}). Save what can be saved into a new "
                  'file with: fieldmon salvage "{path}" --output rescued.gpkg',
                  path="a.gpkg", why="why")  # fmt: skip
    assert language.in_words(said)[0] == "a"
    for code in ("he", "ar"):
        speaking(code)
        first = language.in_words(said)[0]
        assert unicodedata.bidirectional(first) in {"R", "AL"}
        assert language.in_words(figure(3.0))[0] == "3", "a figure is one"
    speaking("es")
    assert unicodedata.bidirectional(language.in_words(said)[0]) == "L"


def test_an_estimate_is_as_precise_as_it_is_worth_saying_in_each_language(speaking):
    assert [language.about(one) for one in (1645.9, 9.96, 4.593)] == ["1,646", "10", "4.6"]
    speaking("es")
    assert [language.about(one) for one in (1645.9, 9.96, 4.593)] == ["1.646", "10", "4,6"]


def test_a_share_has_its_sign_apart_where_the_language_sets_it_so(speaking):
    verdict = worded("{share:.0%} of the plot", share=0.845)
    assert verdict == "84 % of the plot"
    assert (
        language.number(0.125, ".1%")
        == language.Text("{share:.1%}").format(share=0.125)
        == "12.5\u00a0%"
    )
    for code, said in (("es", "12,5\u00a0%"), ("he", "12.5%")):
        speaking(code)
        assert language.number(0.125, ".1%") == said
        assert language.Text("{share:.1%}", code).format(share=0.125) == said


def test_a_figure_has_its_sign_as_the_sentences_around_it(speaking):
    for code, said in (("es", "12,5\u00a0%"), ("he", "12.5%"), ("ar", "12.5%")):
        speaking(code)
        assert language.in_words(figure(12.5, ".1f", " %")) == said
        assert language.in_words(figure(0.125, ".1%")) == said


@pytest.mark.parametrize("code", language.LANGUAGES)
def test_no_line_ends_between_a_number_that_is_filled_in_and_its_sign(speaking, code):
    """The percent sign stands in the text, the number is filled in."""
    speaking(code)
    for text in (texts.IN_PERCENT, texts.ASSUMED_WHAT["background_chance"]):
        said = text.format(value="12")
        assert "12 %" not in said
        assert "12\u00a0%" in said or "12%" in said


@pytest.mark.parametrize(("code", "counted"), [("en", "1,009"), ("he", "1,009"), ("es", "1.009")])
def test_thousands_of_a_day_or_a_hot_spot_are_written_as_everywhere(speaking, code, counted):
    speaking(code)
    many = {"found": 1009, "inspected": 1009, "plants": 1009, "n": 1, "day": "x"}
    for text in (texts.TIP_HOT, texts.STEP_FOUND, texts.CHANGED_FINDS, texts.TODAY_DONE,
                 texts.DAY_DONE, texts.SCOUT_DONE):  # fmt: skip
        assert text.format(**many).count(counted) == 2
    hot = worded(words.HOT_MEANS, rows="", expected="7", p="", **many)
    assert language.in_words(hot).count(counted) == 3


def test_words_side_by_side_have_the_comma_of_their_language(speaking):
    library = joined(", ", [counted(1320, "plant"), counted(3, "plant")])
    assert language.listed(["1", "2"]) == "1, 2"
    speaking("ar")
    assert language.listed(["1", "2"]) == "1، 2"
    assert language.in_words(library).count("،") == 1
    speaking("he")
    assert language.listed(["1", "2"]) == "1, 2"


@pytest.mark.parametrize("code", ["he", "ar", "es"])
@pytest.mark.parametrize(
    ("head", "name"),
    [(b"\xff\xd8\xff", "a.jpg"), (b"%PDF", "a.pdf"), (b"<svg>", "a.svg"), (b"text", "a.dbf"),
     (b"\x01\x00\x02", "a.dat")],
)  # fmt: skip
def test_what_a_file_is_that_cannot_be_read_is_said_in_the_language(speaking, code, head, name):
    with pytest.raises(FileProblem) as refused:
        kind_of(head, name)
    english = language.of_error(refused.value)
    speaking(code)
    said = language.of_error(refused.value)
    assert not {"is", "holds", "Choose", "none", "workbook"} & set(said.replace(".", " ").split())
    assert {"is", "holds"} & set(english.split())
