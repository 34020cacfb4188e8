"""Cells as people write them: what a number or a count looks like to them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import SettingError
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.parse.values import (
    MISSING,
    codes_among,
    could_be_thousands,
    counted,
    decimal_mark,
    is_missing,
    number,
    numbers,
    plain_numbers,
    presence,
    told_number,
)
from tests.io.tables_of_cells import cells


@given(st.floats(-1e9, 1e9), st.sampled_from(".,"), st.sampled_from(("", " ", "\u00a0", "'", "_")))
def test_a_number_is_read_with_either_mark_and_any_gap_between_thousands(value, mark, gap):
    written = f"{value:_.4f}".replace(".", "@").replace("_", gap).replace("@", mark)
    assert number(written, mark) == pytest.approx(value, abs=1e-4)


@pytest.mark.parametrize(
    ("cell", "decimal", "value"),
    [
        ("1.234,5", ",", 1234.5),
        ("1,234", ".", 1234.0),
        ("\u22123", ".", -3.0),
        ("1e3", ".", 1000.0),
    ],
)
def test_groups_of_thousands_are_none_of_the_decimals(cell, decimal, value):
    assert number(cell, decimal) == value


@pytest.mark.parametrize("cell", ["", "12,34", "1,2345", "abc", "3 km", "--4", "1.2.3"])
def test_what_is_no_number_is_none_rather_than_a_guess(cell):
    assert np.isnan(number(cell, "."))


@pytest.mark.parametrize(
    ("column", "mark"),
    [
        (["1,5", "2,25"], ","),
        (["1.5", "2,250.75"], "."),
        (["1.234,5"], ","),
        (["12", "x"], None),
        (["1,5", "2,5", "3.5"], ","),
    ],
)
def test_the_decimal_mark_is_the_one_most_cells_speak_for(column, mark):
    assert decimal_mark(column) == mark


def test_a_column_is_read_with_the_mark_of_all_its_cells():
    np.testing.assert_array_equal(
        numbers(cells("1,5", "2", "n/a", None)), [1.5, 2.0, np.nan, np.nan]
    )
    np.testing.assert_array_equal(numbers(cells("1.234", "x"), ","), [1234.0, np.nan])
    assert plain_numbers(cells(1, 2.5, None)).tolist()[:2] == [1.0, 2.5]
    assert plain_numbers(cells("1,5")) is None


def test_a_group_of_three_digits_behind_a_mark_could_be_either():
    assert could_be_thousands("1,234")
    assert not could_be_thousands("1,2345")


@pytest.mark.parametrize(
    ("cell", "value"),
    [("1,5", 1.5), ("1.5", 1.5), ("0,500", 0.5), ("1.500,5", 1500.5), ("1 500", 1500), ("7", 7)],
)
def test_a_number_that_is_told_alone_is_read_with_either_mark(cell, value):
    assert told_number(cell, "level") == value


@pytest.mark.parametrize("cell", ["1,500", "1.500", "-1.500"])
def test_a_number_that_is_told_alone_and_may_be_thousands_is_asked_about(cell):
    with pytest.raises(SettingError, match=r"level is .*: is that -?1500 or -?1.5\?"):
        told_number(cell, "level")
    assert abs(told_number(cell, "level", most=180.0)) == 1.5


@pytest.mark.parametrize("cell", ["", "much", "nan", "inf", "1,5,5", "1e999"])
def test_what_is_told_alone_and_no_number_is_refused(cell):
    with pytest.raises(SettingError, match="level must be a number"):
        told_number(cell, "level")


@pytest.mark.parametrize("word", sorted(MISSING))
def test_words_for_nothing_known_are_missing_in_any_case(word):
    assert is_missing(word.upper()) or is_missing(word)
    assert counted(word).present == presence(word) == UNKNOWN


@pytest.mark.parametrize(
    ("cell", "how_many", "present"),
    [
        ("7", 7.0, PRESENT),
        ("0", 0.0, ABSENT),
        ("none", 0.0, ABSENT),
        ("many", np.nan, PRESENT),
        ("3-5", 4.0, PRESENT),
        ("0 - 0", 0.0, ABSENT),
        (">100", 100.0, PRESENT),
        ("ca. 12", 12.0, PRESENT),
        ("<5", np.nan, PRESENT),
        ("<1", np.nan, UNKNOWN),
        ("0-5", np.nan, UNKNOWN),
        ("0 to 1", np.nan, UNKNOWN),
        ("1-0", np.nan, UNKNOWN),
        ("5-2", np.nan, UNKNOWN),
        ("≤1", np.nan, PRESENT),
        ("-3", np.nan, UNKNOWN),
        ("1e308", np.nan, UNKNOWN),
        (f"3-{10**30}", np.nan, UNKNOWN),
        (f">{10**30}", np.nan, UNKNOWN),
        ("some day", np.nan, UNKNOWN),
    ],
)
def test_a_count_says_whether_and_how_many(cell, how_many, present):
    read = counted(cell)
    assert read.present == present
    np.testing.assert_equal(read.number, how_many)
    assert presence(cell) == present


@given(st.integers(0, 10**6))
def test_zero_is_absence_and_any_other_count_presence(count):
    assert counted(str(count)) == (float(count), PRESENT if count else ABSENT, False)


@pytest.mark.parametrize("cell", ["5-.", "1 to ,", "5-3e12", "<3e12", "3000000000+", "2e9"])
def test_a_count_whose_end_is_no_number_or_beyond_counting_is_unknown_and_never_clean(cell):
    assert counted(cell).present == UNKNOWN


@pytest.mark.parametrize(
    ("counts", "codes"),
    [
        ([12, 9999], {9999}),
        ([0, 3, 999, 999], {999}),
        ([150, 999], set()),
        ([9999], set()),
        ([12, 998], set()),
        ([np.nan, 5, 999, 99999], {999, 99999}),
    ],
)
def test_a_code_for_no_value_is_one_only_where_all_other_counts_are_far_lower(counts, codes):
    assert codes_among(map(float, counts)) == codes
