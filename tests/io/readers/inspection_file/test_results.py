"""What was found, as cells say it, in the words, signs and counts that people write."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.import_report import Severity
from fieldmon.io.readers.inspection_file.columns import columns_of
from fieldmon.io.readers.inspection_file.results import results_in
from fieldmon.io.readers.inspection_options import InspectionOptions
from tests.io.tables_of_cells import sentences, table


def read(options=None, **columns):
    layer, chosen = table(**columns), options or InspectionOptions()
    return results_in(layer, columns_of(layer, chosen), chosen)


@pytest.mark.parametrize(
    ("word", "result"),
    [
        *((w, PRESENT) for w in ("yes", "TRUE", "1", "found", "x", "✓", "ja", "sí", "oui", "כן")),
        *((w, PRESENT) for w in ("30%", "0,5 %")),
        *((w, ABSENT) for w in ("0%", "0.0 %")),
        *((w, PRESENT) for w in ("+", "+3", "7", "<5", "3-5", "befall", "נגוע", "gefunden")),
        *((w, ABSENT) for w in ("no", "False", "0", "clean", "nein", "לא", "נקי", "not found")),
        *((w, UNKNOWN) for w in ("not inspected", "could_not_inspect", "skipped", "לא נבדק")),
    ],
)
def test_results_are_read_in_many_spellings(word, result):
    seen = read(plant=[7, 8], found=[word, "clean"])
    assert seen.result.tolist() == [result, ABSENT]
    assert seen.said.all()


def test_a_decimal_comma_alone_is_a_number():
    seen = read(plant=[7, 8], found=["0,5", "0,0"])
    assert seen.result.tolist() == [PRESENT, ABSENT]
    assert "such as '0,5' are taken as finds" in sentences(seen)


@pytest.mark.parametrize("blank", ["", "  ", "NA", "?", "nan", "-", None])
def test_what_is_not_filled_in_says_nothing(blank):
    seen = read(plant=[7, 8], found=[blank, "no"])
    assert seen.said.tolist() == [False, True]


def test_words_that_may_be_of_the_plant_have_one_answer():
    seen = read(plant=[7, 8, 9], found=["missing", "dead", "no"])
    (doubt,) = [m for m in seen.messages if m.severity == Severity.DOUBTFUL]
    assert doubt.sentence.startswith("2 records say 'missing', 'dead', which may be of the plant")
    answered = InspectionOptions().choose("gone", doubt.remedy.value)
    again = read(answered, plant=[7, 8, 9], found=["missing", "dead", "no"])
    assert again.gone.tolist() == [True, True, False]


def test_a_minus_is_clean_only_in_a_column_with_a_plus():
    assert read(plant=[7, 8], found=["-", "+"]).result.tolist() == [ABSENT, PRESENT]
    assert read(plant=[7, 8], found=["-", "x"]).said.tolist() == [False, True]


@pytest.mark.parametrize(
    ("word", "option"),
    [
        ("maybe", "found"),
        ("?", "found"),
        ("yes, lots", "found"),
        *((w, "gone") for w in ("missing", "Dead.", "falta")),
    ],
)
def test_a_word_that_says_nothing_is_named_with_what_it_may_be(word, option):
    seen = read(plant=[7, 8, 9], found=[word, "no", None])
    assert seen.said.tolist() == [False, True, False]
    assert seen.unread.tolist() == [True, False, False]
    (doubt,) = [m for m in seen.messages if m.severity == Severity.DOUBTFUL]
    assert f"'{word}'" in doubt.sentence
    assert (doubt.remedy.option, doubt.remedy.value) == (option, word.replace(",", r"\,"))
    answered = InspectionOptions().choose(option, doubt.remedy.value)
    again = read(answered, plant=[7, 8, 9], found=[word, "no", None])
    assert again.said.tolist() == [True, True, False]
    assert again.gone.tolist() == [option == "gone", False, False]
    assert not [m for m in again.messages if m.severity == Severity.DOUBTFUL]


@pytest.mark.parametrize(
    ("cell", "result", "count"),
    [
        ("0", ABSENT, 0.0),
        ("4", PRESENT, 4.0),
        ("+2", PRESENT, 2.0),
        ("<5", PRESENT, np.nan),
        ("2-6", PRESENT, np.nan),
        ("skipped", UNKNOWN, np.nan),
    ],
)
def test_a_count_says_whether_and_how_many_but_a_range_is_no_number(cell, result, count):
    seen = read(plant=[7], count=[cell])
    assert seen.result[0] == result
    np.testing.assert_equal(seen.how_many[0], count)


def test_a_number_in_the_column_of_results_is_a_count_but_one_is_yes():
    seen = read(plant=[1, 2, 3, 4], found=["7", "1", "+2", "yes"], count=[None, None, None, "9"])
    np.testing.assert_array_equal(seen.how_many, [7, np.nan, 2, 9])


def test_a_result_and_a_count_that_contradict_are_a_find_in_doubt():
    seen = read(
        plant=[1, 2, 3, 4, 5],
        found=["clean", "7", "", "skipped", "clean"],
        count=["4", "0", "0", "0", "0"],
    )
    assert seen.result.tolist() == [PRESENT, PRESENT, ABSENT, UNKNOWN, ABSENT]
    assert [bool(doubt) for doubt in seen.doubt] == [True, True, True, False, False]


def test_a_find_with_a_count_of_zero_is_a_find_that_nobody_counted_and_that_is_said():
    seen = read(plant=[1, 2, 3], found=["found", "found", "clean"], count=["0", "3", "0"])
    assert seen.result.tolist() == [PRESENT, PRESENT, ABSENT]
    assert not any(seen.doubt)
    (said,) = [str(one) for one in seen.messages if "found, but" in str(one)]
    assert "1 record is found, but its count is 0: taken as found, not counted." in said


@given(st.lists(st.sampled_from(("", "0")), min_size=1, max_size=5))
def test_in_a_file_without_results_zeros_are_clean_plants(counts):
    seen = read(plant=list(range(len(counts))), count=counts)
    assert seen.said.tolist() == [bool(cell) for cell in counts]
    assert not any(seen.doubt)


@pytest.mark.parametrize(
    ("name", "result", "count"),
    [
        ("+3", PRESENT, 3.0),
        ("+", PRESENT, np.nan),
        ("-", ABSENT, np.nan),
        ("0", ABSENT, np.nan),
        ("012 R3/17 0", ABSENT, np.nan),
        ("clean", ABSENT, np.nan),
        ("R1/9 +2", PRESENT, 2.0),
        ("012 R3/17 found", PRESENT, np.nan),
        ("not inspected", UNKNOWN, np.nan),
    ],
)
def test_the_name_of_a_waypoint_can_be_a_result(name, result, count):
    seen = read(name=[name])
    assert (seen.result[0], seen.said[0]) == (result, True)
    np.testing.assert_equal(seen.how_many[0], count)


@pytest.mark.parametrize("name", ["001", "R3/17", "17", "Gate", "", "7 R1/2a"])
def test_the_name_of_a_waypoint_need_not_be_one(name):
    assert not read(name=[name]).said[0]


@pytest.mark.parametrize("word", ["clean", "not found", "skipped", "0"])
def test_a_name_that_says_clean_or_skipped_and_counts_is_a_find_in_doubt(word):
    seen = read(name=[f"R1/1 {word} +7", "R1/2 found +3", "R1/3 clean"])
    assert seen.result.tolist() == [PRESENT, PRESENT, ABSENT]
    assert [bool(one) for one in seen.doubt] == [True, False, False]
    assert "contradict each other" in seen.doubt[0]


def test_a_name_that_says_otherwise_than_a_column_of_counts_is_doubted():
    names = ["R1/1 clean", "R1/2 found", "R1/3", "R1/4 clean", "Gate", "R1/6 found"]
    seen = read(name=names, count=["7", "3", "2", "0", "1", "0"])
    doubted = [True, False, False, False, False, True]
    assert [bool(one) for one in seen.doubt] == doubted


def test_where_results_and_counts_were_found_is_said():
    told = sentences(read(plant=[1], found=["x"], count=["2"]))
    assert "Results are in column 'found'." in told
    assert "Counts are in column 'count'." in told


def test_a_decimal_mark_told_by_hand_is_taken():
    options = InspectionOptions(decimal=",")
    assert read(options, plant=[1], count=["1,5"]).how_many[0] == 1.5


@pytest.mark.parametrize("column", ["Mittelwert", "mites per leaf", "Promedio"])
def test_averages_that_could_be_thousands_are_decimals_and_that_is_said(column):
    options = InspectionOptions(columns=(("count", column),))
    seen = read(options, plant=[7, 8], **{column: ["1.250", "2.333"]})
    assert seen.how_many.tolist() == [1.25, 2.333]
    (guess,) = [m for m in seen.messages if m.severity == Severity.GUESSED]
    assert "1.250 were read as decimals" in guess.sentence


@pytest.mark.parametrize(
    ("cells", "more", "first", "said"),
    [
        (["1.250", "2.000"], {}, 1250.0, "1.250 were read as thousands"),
        (["1.250", "7"], {"lat": ["30.35", "30.36"]}, 1250.0, "1.250 were read as thou"),
        (["1.250", "2,000"], {}, 1.25, "1.250 were read as decimals"),
        (["1,250", "7"], {}, 1250.0, "1,250 were read as thousands"),
        (["1.250", "2,5"], {}, 1250.0, None),
        (["1.250", "7"], {"lat": ["30,35", "30,36"]}, 1250.0, "1.250 were read as thou"),
        (["1,250", "7"], {"lat": ["30.35", "30.36"]}, 1250.0, "1,250 were read as thou"),
        (["1.250", "0,500"], {}, 1250.0, None),
    ],
)
@pytest.mark.parametrize("column", ["found", "count"])
def test_a_count_that_could_be_thousands_is_told_by_its_table_or_said_to_be_guessed(
    column, cells, more, first, said
):
    seen = read(plant=[7, 8], **{column: cells}, **more)
    assert seen.how_many[0] == first
    guesses = [m for m in seen.messages if m.severity == Severity.GUESSED]
    assert len(guesses) == (said is not None)
    for guess in guesses:
        assert said in guess.sentence
        options = InspectionOptions().choose(guess.remedy.option, guess.remedy.value)
        other = read(options, plant=[7, 8], **{column: cells}, **more)
        assert other.how_many[0] == {1.25: 1250.0, 1250.0: 1.25}[first]


def test_a_count_that_often_stands_for_no_value_is_doubted_and_others_are_not():
    seen = read(plant=[1, 2, 3], count=["12", "9999", "0"])
    assert "its count is 9999, which often stands for no value" in seen.doubt[1]
    assert seen.doubt.tolist()[::2] == ["", ""]
    assert set(read(plant=[1, 2], count=["2000", "9999"]).doubt.tolist()) == {""}


def test_numbers_that_are_typed_as_such_have_no_thousands_marks():
    seen = read(plant=[1, 2], count=[1.25, 2.333])
    assert seen.how_many.tolist() == [1.25, 2.333]
    assert not any("thousands" in one.sentence for one in seen.messages)
