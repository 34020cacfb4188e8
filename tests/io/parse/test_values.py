"""Cells as people write them: what a number, a count, a place or a day looks like to them."""

from datetime import date, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import SettingError
from fieldmon.infestation.observations import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.parse.values import (
    MISSING,
    all_degrees,
    could_be_thousands,
    counted,
    dates,
    dates_of_parts,
    decimal_mark,
    degrees,
    hemispheres,
    is_missing,
    is_written_as_day,
    number,
    numbers,
    plain_numbers,
    positions_in_cells,
    presence,
    told_number,
)


def cells(*values):
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column


# --- numbers -----------------------------------------------------------------------------------


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


# --- counts ------------------------------------------------------------------------------------


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


# --- positions ---------------------------------------------------------------------------------


@given(st.integers(0, 179), st.integers(0, 59), st.floats(0.0, 59.99), st.sampled_from("NSEW"))
def test_degrees_minutes_and_seconds_are_sixtieths(whole, minutes, seconds, letter):
    sign = -1 if letter in "SW" else 1
    value = sign * (whole + minutes / 60 + round(seconds, 2) / 3600)
    for cell in (
        f"{whole}°{minutes}'{seconds:.2f}\"{letter}",
        f"{letter} {whole} {minutes} {seconds:.2f}",
        f"{whole}:{minutes}:{seconds:.2f} {letter}",
    ):
        assert degrees(cell) == pytest.approx(value, abs=1e-9)


@pytest.mark.parametrize(
    ("cell", "value"),
    [("30.5", 30.5), ("-30,5", -30.5), ("30.5°", 30.5), ("S 31.25", -31.25), ("-7°30'", -7.5)],
)
def test_decimal_degrees_are_read_with_signs_and_letters(cell, value):
    assert degrees(cell, "," if "," in cell else ".") == value


@pytest.mark.parametrize("cell", ["30°61'0\"", "30°0'75\"", "07.16.5046", "30 15.5 30", "O 7", ""])
def test_what_is_no_coordinate_is_not_guessed(cell):
    assert np.isnan(degrees(cell))


def test_a_column_of_coordinates_may_mix_what_people_write():
    read = all_degrees(cells("30°30'", "30.25", None, "x"))
    np.testing.assert_array_equal(read, [30.5, 30.25, np.nan, np.nan])
    assert hemispheres(["N 30", "35 E", "12"]) == {"N", "E"}


@pytest.mark.parametrize(
    ("cell", "lonlat", "is_certain"),
    [
        ("30.36, 35.15", (35.15, 30.36), False),
        ("N 30.36 E 35.15", (35.15, 30.36), True),
        ("E35,15; N30,36", (35.15, 30.36), True),
        ("POINT (35.15 30.36)", (35.15, 30.36), True),
        ("30°21'36\"N 35°9'0\"E", (35.15, 30.36), True),
        ("30.36 35.15", (35.15, 30.36), False),
    ],
)
def test_two_coordinates_in_a_cell_are_told_apart_where_they_can_be(cell, lonlat, is_certain):
    read = positions_in_cells([cell])
    assert read.values[0] == pytest.approx(lonlat)
    assert read.is_certain == is_certain


def test_a_first_number_beyond_90_settles_the_order_of_all_cells():
    read = positions_in_cells(["30.0, 35.0", "120.5, 36.0", "nothing"])
    assert read.values[:2].tolist() == [[30.0, 35.0], [120.5, 36.0]]
    assert read.is_certain
    assert np.isnan(read.values[2]).all()


# --- dates -------------------------------------------------------------------------------------

some_days = st.dates(date(1970, 1, 1), date(2069, 12, 31))


@given(some_days)
def test_a_day_is_the_same_however_it_is_written(day):
    written = [
        day.isoformat(),
        f"{day:%Y/%m/%d}",
        f"{day:%Y%m%d}",
        f"{day:%d %B %Y}",
        f"{day:%B %d, %Y}",
        f"{day:%Y-%m-%d}T08:30:00Z",
    ]
    for cell in written:
        assert dates(cells(cell)).day.tolist() == [day], cell


@pytest.mark.parametrize(
    "cell",
    [
        "5 de mayo de 2026", "5 de may. de 2026", "5 de mayo del 2026", "mayo 5 de 2026",
        "martes 5 de mayo de 2026 08:30", "martes, 5/5/2026", "mar. 5 mai 2026", "le 5 mai 2026",
        "5º de maio de 2026", "terça-feira, 5 de maio de 2026", "5° maggio 2026", "5 mag 2026",
        "Tuesday 5 May 2026", "Tue May 5 2026", "5th of May, 2026", "TUESDAY 5 MAY 2026",
        "Di, 5. Mai 2026", "Di., 05.05.2026", "Dienstag, den 5. Mai 2026", "Tue 2026-05-05",
        "5 במאי 2026", "ה-5 במאי 2026", "יום ג' 5/5/2026", "ביום שלישי, 5 במאי 2026",
    ],
)  # fmt: skip
def test_a_day_in_words_is_read_with_its_weekday_and_its_small_words(cell):
    read = dates(cells(cell))
    assert read.day.tolist() == [date(2026, 5, 5)]
    assert is_written_as_day(cell)


def test_the_first_of_a_month_may_be_an_ordinal_and_what_names_no_day_is_none():
    read = dates(
        cells("1er mai 2026", "1.º de mayo de 2026", "1.º de mayo", "martes", "mar 1 2026")
    )
    assert read.day.astype(str).tolist() == ["2026-05-01", "2026-05-01", *["NaT"] * 2, "2026-03-01"]
    assert read.broken == ("1.º de mayo", "martes")


def test_a_weekday_takes_no_doubt_away_of_day_and_month():
    assert dates(cells("martes 5/6/2026", "Fri, 03/04/2026")).is_ambiguous
    assert dates(cells("martes 5/6/2026", "mié 20/5/2026", "Thu 5/21/2026")).n_mixed == 1
    assert dates(cells("Fri 5/6/2026", "Thu 5/21/2026")).order == "mdy"


@given(some_days, st.sampled_from("./- "))
def test_day_first_and_month_first_are_read_as_told(day, mark):
    day_first = mark.join((f"{day:%d}", f"{day:%m}", f"{day:%Y}"))
    month_first = mark.join((f"{day:%m}", f"{day:%d}", f"{day:%y}"))
    assert dates(cells(day_first), "dmy").day.tolist() == [day]
    assert dates(cells(month_first), "mdy").day.tolist() == [day]


def test_the_only_order_that_fits_all_is_taken_and_else_the_doubt_is_told():
    sure = dates(cells("03/04/2026", "03/17/2026"))
    assert (sure.order, sure.is_ambiguous) == ("mdy", False)
    assert sure.day.tolist() == [date(2026, 3, 4), date(2026, 3, 17)]
    open_yet = dates(cells("03/04/2026", "05/06/2026"))
    assert (open_yet.order, open_yet.is_ambiguous) == ("dmy", True)
    assert open_yet.day.tolist() == [date(2026, 4, 3), date(2026, 6, 5)]
    assert not dates(cells("04/04/2026")).is_ambiguous


def test_numbers_of_days_as_spreadsheets_have_them_are_days():
    read = dates(cells("46113", "46113.75", "99", "12345678901"))
    assert read.day.tolist()[:2] == [date(1899, 12, 30) + timedelta(days=46_113)] * 2
    assert (read.n_serial, len(read.unread)) == (2, 2)


def test_what_is_no_day_is_counted_and_shown_but_not_what_is_missing():
    read = dates(cells("soon", "31.02.2026", "", None, "2026-01-01"))
    assert np.isnat(read.day).tolist() == [True, True, True, True, False]
    assert read.unread == {0: "soon", 1: "31.02.2026"}
    assert read.broken == ("soon", "31.02.2026")


def test_a_day_in_three_columns_is_put_together():
    read = dates_of_parts(
        np.array([2026.0, 2026.0, np.nan]), np.array([4.0, 13.0, 1.0]), np.array([6.0, 1.0, 1.0])
    )
    assert read.day[0] == np.datetime64("2026-04-06")
    assert np.isnat(read.day[1:]).all()
    assert read.unread == {1: "2026-13-1"}


@pytest.mark.parametrize(
    ("column", "mixed"),
    [
        (["18/11/2026", "11/15/2026", "11/06/2026", "06/06/2026"], 1),
        (["18/11/2026", "11/06/2026"], 0),
        (["11/15/2026", "11/06/2026"], 0),
        (["18/11/2026", "11/15/2026", "11/06/2026", "11/06/2026"], 2),
        (["2026-11-18"], 0),
    ],
)
def test_where_neither_order_fits_all_it_is_counted_what_could_be_either(column, mixed):
    assert dates(cells(*column)).n_mixed == mixed
    assert dates(cells(*column), "dmy").n_mixed == 0


@pytest.mark.parametrize("cell", ["5-.", "1 to ,", "5-3e12", "<3e12", "3000000000+", "2e9"])
def test_a_count_whose_end_is_no_number_or_beyond_counting_is_unknown_and_never_clean(cell):
    assert counted(cell).present == UNKNOWN
