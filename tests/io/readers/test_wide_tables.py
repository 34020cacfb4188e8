"""A column for each day: each filled cell is a record, and nothing else changes."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.io.options import RecordOptions
from fieldmon.io.readers.wide_tables import by_day, by_plant
from tests.io.tables_of_cells import sentences, table

DAYS = ("2026-03-01", "2026-03-08", "2026-03-15")
counts = st.lists(st.one_of(st.none(), st.integers(0, 99)), min_size=3, max_size=3)


@given(st.lists(counts, min_size=1, max_size=6))
def test_every_filled_cell_is_one_record_of_its_row_and_day(rows):
    cells = {day: [row[i] for row in rows] for i, day in enumerate(DAYS)}
    long = by_day(table(tree=list(range(len(rows))), **cells), RecordOptions())
    got = list(
        zip(*(long.columns[name].tolist() for name in ("tree", "date", "count")), strict=True)
    )
    expected = [(i, d, n) for i, row in enumerate(rows) for d, n in zip(DAYS, row, strict=True)]
    assert got == [one for one in expected if one[2] is not None]


def test_words_become_results_and_totals_are_passed_over():
    long = by_day(table(**{DAYS[0]: ["sano"], DAYS[1]: ["-"], "Total": [7]}), RecordOptions())
    assert long.columns["result"].tolist() == ["sano", "-"]
    assert "Total" not in long.columns
    assert "these were passed over: Total" in sentences(long)


def test_a_grid_of_rows_and_numbered_plants_is_a_record_a_cell():
    grid = table(**{"row": [1, 2], "1": [0, 1], "2": [None, 0], "3": [1, 1]})
    long = by_plant(grid, RecordOptions())
    got = zip(*(long.columns[name].tolist() for name in ("row", "plant", "count")), strict=True)
    assert [*got] == [(1, "1", 0), (1, "3", 1), (2, "1", 1), (2, "2", 0), (2, "3", 1)]
    assert "3 columns are called by numbers from 1: each cell is one plant of its row." in (
        sentences(long)
    )


def test_numbers_above_columns_are_plants_only_where_nothing_else_says_which():
    numbers = {"1": [0], "2": [1], "3": [0]}
    for columns in (
        numbers,
        {"row": [1], "tree": [4], **numbers},
        {"row": [1], "found": [1], **numbers},
        {"row": [1], "number": [5], **numbers},
        {"row": [1], "lon": [35.1], "lat": [30.3], **numbers},
        {"row": [1], "1": [0], "2": [1]},
        {"row": [1], "1": [0], "2": [1], "4": [1]},
    ):
        layer = table(**columns)
        assert by_plant(layer, RecordOptions()) is layer
    grid = table(row=[1], **numbers)
    assert by_plant(grid, RecordOptions().naming(row="")) is grid


def test_a_table_with_a_date_or_with_one_day_stays_as_it_is():
    for columns in ({DAYS[0]: [1]}, {"date": [DAYS[0]], "count": [1]}):
        layer = table(**columns)
        assert by_day(layer, RecordOptions()) is layer
    wide = table(**{DAYS[0]: [1], DAYS[1]: [2], "seen": ["2026-04-01"]})
    assert by_day(wide, RecordOptions().naming(date="seen")) is wide


def test_the_order_of_day_and_month_is_the_one_told():
    wide = table(**{"03/04/2026": [1], "10/04/2026": [2]})
    read = by_day(wide, RecordOptions(date_order="mdy"))
    np.testing.assert_array_equal(read.columns["date"], ["2026-03-04", "2026-10-04"])
