"""By which columns plants, their rows and their blocks are called."""

import pytest

from fieldmon.plot.plant_columns import column_called, plain, plant_columns


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"Row": "12", "Plant": "34"}, {"row": "Row", "plant": "Plant"}),
        ({"שורה": "12", "עץ": "34"}, {"row": "שורה", "plant": "עץ"}),
        ({"row": "1122", "plant": "3456", "number": "1212"}, {"row": "row", "plant": "number"}),
        ({"row": "1122", "plant": "ABCD", "number": "1212"}, {"row": "row", "plant": "plant"}),
        ({"number": "34"}, {"plant": "number"}),
        ({"plant": "34", "number": "11"}, {"plant": "plant"}),
        ({"block": "11", "row": "12", "name": "AB"},
         {"block": "block", "row": "row", "plant": "name"}),
        ({"row": "12", "name": "AA"}, {"row": "row"}),
        ({"height": "12"}, {}),
    ],
)  # fmt: skip
def test_columns_are_found_by_their_names(table, said):
    columns = plant_columns(list(table), lambda name: list(table[name]))
    assert (columns.said, columns.doubts) == (said, ())


@pytest.mark.parametrize("name", ["number", "plant"])
def test_numbers_that_tell_no_plants_apart_are_not_taken_and_said(name):
    table = {"row": "111222", name: "111111"}
    columns = plant_columns(list(table), lambda name: list(table[name]))
    assert columns.said == {"row": "row"}
    (said,) = columns.doubts
    assert said.startswith(f"Column {name!r} was not taken for the numbers of plants")


def test_what_was_told_goes_before_names():
    table = {"row": "12", "line": "34", "number": "56"}
    told = {"row": "line", "plant": "row"}
    assert plant_columns(list(table), lambda name: list(table[name]), told).said == told


def test_a_name_cut_to_ten_characters_or_with_a_word_for_numbering_is_recognised():
    assert plain("Número (m)") == "numero"
    assert column_called(["numberinrow"], ["numberinro"]) == "numberinro"
    assert column_called(["row"], ["ROW_NUM"], numbered=["row"]) == "ROW_NUM"
    assert column_called(["row"], ["ROW_NUM"]) is None
