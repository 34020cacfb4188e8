"""Which plants a file names, and where it says they are."""

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.readers.inspection_file.columns import columns_of
from fieldmon.io.readers.inspection_file.inspection_rows import UNSAID
from fieldmon.io.readers.inspection_file.plants import named_plants, positions_in
from fieldmon.io.readers.inspection_options import InspectionOptions
from tests.io.tables_of_cells import table

NOTHING = InspectionOptions()


def named(**columns):
    layer = table(**columns)
    found = named_plants(layer, columns_of(layer, NOTHING), NOTHING)
    return [each.tolist() for each in found[:4]]


def positions(layer, options=NOTHING):
    return positions_in(layer, columns_of(layer, options), options)


@pytest.mark.parametrize(
    ("label", "place"),
    [
        ("R2/3", (2, 3, 0)),
        ("2-3", (2, 3, 0)),
        ("row 12, plant 7b", (12, 7, 2)),
        ("שורה 2 עץ 3", (2, 3, 0)),
        ("2.3a", (2, 3, 1)),
    ],
)
def test_a_label_that_holds_row_and_number_is_taken_apart(label, place):
    plant, line, number, face = named(plant=[label], found=["x"])
    assert (plant, (line[0], number[0], face[0])) == ([-1], place)


@pytest.mark.parametrize("label", ["7", 7, 7.0])
def test_a_whole_number_is_the_plants_own(label):
    plant, line, *_ = named(plant=[label], found=["x"])
    assert (plant, line) == ([7], [UNSAID])


@pytest.mark.parametrize("label", ["", None, "tree", 2.0**40])
def test_what_is_neither_names_no_plant(label):
    plant, line, *_ = named(plant=[label], found=["x"])
    assert (plant, line) == ([-1], [UNSAID])


def test_a_row_counts_only_with_a_number_in_it():
    _, line, number, face = named(
        row=[2, 2, 0, None], number=[3, None, 3, 3], found=["x"] * 4, side=["b", 1, "A", "?"]
    )
    assert (line, number) == ([2, UNSAID, 0, UNSAID], [3, UNSAID, 3, UNSAID])
    assert face == [2, 1, 1, 0]


def test_the_name_of_a_waypoint_given_out_holds_its_plant():
    _, line, number, face = named(name=["012 R3/17b found", "001", "R1/2"])
    assert (line, number, face) == ([3, UNSAID, 1], [17, UNSAID, 2], [2, 0, 0])


def test_accuracies_are_read_with_their_units():
    _, accuracy_m, _, messages = positions(
        table(
            lon=[35.1234567] * 3, lat=[30.1234567] * 3, accuracy=["25 m", 4, "?!"], found=["x"] * 3
        )
    )
    assert accuracy_m == pytest.approx([25.0, 4.0, np.nan], nan_ok=True)
    assert any("but 1 is not: '?!'" in one.sentence for one in messages)


def test_a_file_that_names_plants_needs_no_positions():
    lonlat, accuracy_m, _, messages = positions(table(plant=[7], found=["x"]))
    assert np.isnan(lonlat).all()
    assert np.isnan(accuracy_m).all()
    assert messages == ()


def test_positions_that_cannot_be_read_do_not_matter_where_plants_are_named():
    lonlat, *_ = positions(table(plant=[7], x=["207000"], y=["470000"], found=["x"]))
    assert np.isnan(lonlat).all()


def test_a_file_that_says_neither_is_a_question():
    with pytest.raises(ChoiceNeeded, match="which plants") as asked:
        positions(table(found=["yes"], colour=["red"]))
    assert asked.value.choices == ("plant=colour", "plot=colour")


def test_a_thousand_that_may_be_row_and_plant_is_said_with_both_ways_to_write_it():
    layer = table(plant=["988", "1.001"], found=["x", "x"])
    found = named_plants(layer, columns_of(layer, NOTHING), NOTHING)
    (said,) = found.messages
    assert "('1.001')" in said.sentence
    assert "Write 1001 for the first, 1/1 for the second" in said.sentence
    told = NOTHING.choose(said.remedy.option, said.remedy.value)
    found = named_plants(layer, columns_of(layer, told), told)
    assert (found.plant.tolist(), found.messages) == ([988, 1001], ())


def test_row_and_number_of_their_own_columns_stand_before_a_label():
    _, line, number, _ = named(row=[12], number=[40], plant=["1.5"], found=["x"])
    assert (line, number) == ([12], [40])
