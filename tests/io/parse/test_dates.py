"""Days as people write them."""

from datetime import date, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.io.parse.dates import dates, dates_of_parts, is_written_as_day
from tests.io.tables_of_cells import cells

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
