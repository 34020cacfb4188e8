"""Rows that a person names hold the plants that people count in them."""

import re
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.layout import rectangle
from fieldmon.plot.named_rows import place_in_words, plants_in_rows
from tests.app.chosen import a_plot


@pytest.fixture(scope="module")
def grid():
    return a_plot().grid


@pytest.mark.parametrize(
    ("said", "rows"), [("2", {2}), ("3-5,8", {3, 4, 5, 8}), (" 5 - 3 , 3", {3, 4, 5})]
)
def test_all_plants_of_the_rows_are_meant_and_no_others(grid, said, rows):
    line = plant_numbers(grid).line
    assert plants_in_rows(grid, said).tolist() == [one in rows for one in line.tolist()]


def test_rows_are_named_as_in_the_file_of_their_plants(grid):
    called = 101 + 2 * np.arange(len(grid.line_number))[::-1]
    named = replace(grid, line_called=np.stack([called, called], axis=1))
    assert (
        plants_in_rows(named, "101-103").tolist()
        == plants_in_rows(grid, f"{grid.n_rows - 1}-{grid.n_rows}").tolist()
    )
    with pytest.raises(SettingError, match="but row 102 is named"):
        plants_in_rows(named, "101-102")


@pytest.mark.parametrize(
    ("said", "says"),
    [("a", "must be such as 3-5,8, but they are a"), ("3-", "such as"), ("", "such as"),
     ("0", "row 0 is named"), ("2-9999999999", "row 9999999999 is named")],
)  # fmt: skip
def test_what_is_no_row_of_the_plot_is_said(grid, said, says):
    with pytest.raises(SettingError, match=says):
        plants_in_rows(grid, said)


ROWS = np.array(["Pinot-1", "Pinot-2", "Merlot", "B", "ROW05"])


@pytest.mark.parametrize(
    ("said", "rows"),
    [("Pinot-2", {2}), ("pinot-01,b", {1, 4}), ("Pinot-1 - Merlot", {1, 2, 3}), ("row5-Pinot-2",
     {2, 3, 4, 5}), ("Pinot-1-Pinot-2", {1, 2}), ("2-B", {2, 3, 4}), ("3", {3})],
)  # fmt: skip
def test_rows_are_named_as_their_file_has_them(said, rows):
    grid = replace(rectangle(5, 4), line_named=ROWS)
    assert set(plant_numbers(grid).line[plants_in_rows(grid, said)].tolist()) == rows


def test_a_name_that_is_another_rows_number_is_refused():
    grid = replace(rectangle(5, 4), line_named=np.arange(5).astype(np.str_))
    assert plants_in_rows(grid, "0").tolist() == plants_in_rows(rectangle(5, 4), "1").tolist()
    with pytest.raises(SettingError, match="but 3 may be any of rows 3–4 here"):
        plants_in_rows(grid, "3")


def test_whoever_names_no_row_hears_what_rows_are_called():
    named = replace(rectangle(5, 4), line_named=ROWS)
    for says in (
        "such as 3-5,8, but they are Malbec. Rows of this plot are 1–5 (in the file",
        "(in the file of plants: Pinot-1, Pinot-2, Merlot, B, ROW05).",
    ):
        with pytest.raises(SettingError, match=re.escape(says)):
            plants_in_rows(named, "Malbec")
    called = np.array([1, 2, 101, 3, 4])
    names = np.array(["1", "2", "5A", "03", "4"])
    odd = replace(rectangle(5, 4), line_named=names, line_called=np.stack([called, called], axis=1))
    with pytest.raises(SettingError, match=r"are 1–4, 101 \(in the file of plants: 5A\)\."):
        plants_in_rows(odd, "Malbec")
    with pytest.raises(SettingError, match=r"Rows of this plot are 1–5\."):
        plants_in_rows(rectangle(5, 4), "Malbec")


def test_a_place_is_called_by_the_rows_that_it_fills_else_by_how_many_plants_of_which():
    grid = rectangle(3, 4)
    row, n = grid.row, len(grid)
    said = {
        "the whole plot": np.ones(n, bool), "row 2": row == 1, "rows 2–3": row > 0,
        "1 plant in row 1": np.arange(n) == 2, "5 plants in rows 1–2": np.arange(n) < 5,
    }  # fmt: skip
    assert [place_in_words(grid, plants) for plants in said.values()] == [*said]
