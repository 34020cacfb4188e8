"""Which column of a file of inspections holds what, in the files that people bring."""

import pytest

from fieldmon.errors import ChoiceNeeded, SettingError
from fieldmon.io.readers.inspection_file.columns import (
    _NAMES,
    columns_of,
    own_column,
    texts_in,
    who_in,
)
from fieldmon.io.readers.inspection_options import InspectionOptions
from tests.io.tables_of_cells import table


def found(*names, **chosen):
    layer = table(**{name: ["1"] for name in names})
    return columns_of(layer, InspectionOptions().naming(**chosen))


@pytest.mark.parametrize(
    ("names", "line", "number", "plant"),
    [
        (("row", "number", "found"), "row", "number", None),
        (("row", "plant", "found"), "row", "plant", None),
        (("Reihe", "Pflanze", "Befall"), "Reihe", "Pflanze", None),
        (("שורה", "עץ", "נמצא"), "שורה", "עץ", None),
        (("plant", "found"), None, None, "plant"),
        (("stop", "row", "number", "plant", "found"), "row", "number", "plant"),
        (("row", "nr", "found"), "row", "nr", None),
        (("No", "row", "plant", "found"), "row", "plant", None),
        (("ROW_NUM", "PLANT_NO", "found"), "ROW_NUM", "PLANT_NO", None),
        (("ROWNUM", "PLANTNUM", "found"), "ROWNUM", "PLANTNUM", None),
        (("plant_id", "found"), None, None, "plant_id"),
        (("Line No", "plant", "found"), None, None, "plant"),
    ],
)
def test_plants_are_named_by_number_or_by_row_and_number_in_it(names, line, number, plant):
    columns = found(*names)
    assert (columns.line, columns.number, columns.plant) == (line, number, plant)


@pytest.mark.parametrize(
    ("names", "result", "number_found", "marks"),
    [
        (("plant", "found", "count"), "found", "count", None),
        (("plant", "result", "found"), "result", None, None),
        (("plant", "mites"), None, "mites", None),
        (("plant", "Befall", "Anzahl"), "Befall", "Anzahl", None),
        (("name", "lon", "lat"), None, None, "name"),
        (("Title", "lon", "lat"), None, None, "Title"),
    ],
)
def test_what_was_found_is_a_result_a_count_or_the_name_of_a_waypoint(
    names, result, number_found, marks
):
    columns = found(*names)
    assert (columns.result, columns.number_found, columns.marks) == (result, number_found, marks)


def test_ids_of_plants_beside_rows_are_a_question():
    with pytest.raises(ChoiceNeeded, match="may be its number in the row or on") as asked:
        found("Row No", "Plant ID", "found")
    assert asked.value.choices == ("plant=Plant ID", "row=")
    in_row = found("Row No", "Plant ID", "found", plant="Plant ID")
    assert (in_row.line, in_row.number, in_row.plant) == ("Row No", "Plant ID", None)
    whole_plot = found("Row No", "Plant ID", "found", row="")
    assert (whole_plot.line, whole_plot.number, whole_plot.plant) == (None, None, "Plant ID")


def test_columns_named_by_hand_go_before_all_others():
    columns = found("plant", "found", "height", "mites", present="height", count="mites")
    assert (columns.result, columns.number_found) == ("height", "mites")


def test_a_file_that_says_nothing_of_what_was_found_is_a_question():
    with pytest.raises(ChoiceNeeded, match="what was found") as asked:
        found("height")
    assert (asked.value.option, asked.value.choices) == (
        "columns",
        ("present=height", "count=height"),
    )


def test_a_column_that_looks_like_results_is_suggested_first():
    layer = table(rangée=[1, 1, 2, 2], stick=[1, 2, 1, 2], kl=[0, 3, None, "NA"], datum=["x"] * 4)
    with pytest.raises(ChoiceNeeded) as asked:
        columns_of(layer, InspectionOptions())
    assert asked.value.choices[0] == "present=kl"


@pytest.mark.parametrize(
    "told",
    [
        {"plant": "rangée"},
        {"present": "pied"},
        {"present": "rangée"},
        {"plant": "x", "row": "x"},
        {"plant": "x", "present": "x"},
    ],
)
def test_one_column_plays_no_two_roles(told):
    layer = table(rangée=[1, 2], pied=[3, 4], x=[1, 2], found=[0, 1])
    with pytest.raises(SettingError, match="must be in two columns, but both are said to be"):
        columns_of(layer, InspectionOptions().naming(**told))


@pytest.mark.parametrize("role", sorted(_NAMES))
def test_roles_that_only_inspections_have_are_known_by_each_of_their_names(role):
    for name in _NAMES[role].split():
        assert own_column(role, table(**{"other": [1], name.title(): [2]})) == name.title()
    assert own_column(role, table(other=[1])) is None


def test_a_column_taken_already_plays_no_second_role():
    layer = table(name=[1], notes=[2], comment=[3])
    assert own_column("notes", layer, {"notes"}) == "comment"


def test_texts_are_empty_where_a_cell_holds_nothing_or_there_is_no_column():
    layer = table(notes=["leaf", None, float("nan"), "NaT", " <NA> ", "none"])
    assert texts_in(layer, "notes").tolist() == ["leaf", "", "", "", "", ""]
    assert texts_in(layer, None).tolist() == [""] * 6


def test_who_inspected_is_as_the_file_says_or_as_told():
    layer = table(plant=[1, 2], found=["x", "x"], scout=["Noa", None])
    options = InspectionOptions(who="Ann")
    assert who_in(layer, columns_of(layer, options), options).tolist() == ["Noa", "Ann"]
    unsaid = InspectionOptions()
    assert who_in(layer, columns_of(layer, unsaid), unsaid).tolist() == ["Noa", ""]


@pytest.mark.parametrize("name", ["Row label", "VineyardRow", "שורה בכרם", "row_code"])
def test_a_column_that_may_be_of_rows_beside_plants_alone_is_a_question(name):
    with pytest.raises(ChoiceNeeded, match="the row is not clear") as asked:
        found(name, "plant", "found")
    assert asked.value.choices == (f"row={name}", "row=")
    assert found(name, "plant", "found", row=name).number == "plant"
    whole_plot = found(name, "plant", "found", row="")
    assert (whole_plot.line, whole_plot.plant) == (None, "plant")
    for other in ("row spacing", "Row orientation", "row_length", "Row side", "row_hash"):
        assert found(other, "plant", "found").line is None
    assert found(name, "plant", present=name).line is None


@pytest.mark.parametrize(
    ("cells", "result"),
    [
        (["infested", "healthy"], "class"),
        (["infested", ""], "class"),
        (["found", "clean"], "class"),
        (["1", "0"], None),
        (["yes", "no"], None),
        (["ok", "x"], None),
        (["infested", "Arachnida"], None),
    ],
)
def test_one_column_of_words_for_results_is_taken_whatever_its_name(cells, result):
    columns = table(**{"name": ["img 1", "img 2"], "class": cells})
    assert columns_of(columns, InspectionOptions()).result == result
    told = InspectionOptions().naming(plot="class")
    assert columns_of(columns, told).result is None
    two = table(**{"plant": ["1", "2"], "class": cells, "as before": cells})
    with pytest.raises(ChoiceNeeded, match="says what was found"):
        columns_of(two, InspectionOptions())
