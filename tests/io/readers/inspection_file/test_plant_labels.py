"""How cells name plants: by numbers, or by rows and plants in them; never both without a word."""

import numpy as np
import pytest

from fieldmon.io.readers.inspection_file.plant_labels import plants_called


def called(*cells, alone=False):
    column = np.empty(len(cells), object)
    column[:] = cells
    return plants_called(column, alone=alone)


@pytest.mark.parametrize(
    ("cell", "place"),
    [
        ("R3/12", (3, 12, 0)),
        ("3/12", (3, 12, 0)),
        ("3-12", (3, 12, 0)),
        ("Reihe 3, Rebe 12", (3, 12, 0)),
        ("fila 3 planta 12b", (3, 12, 2)),
        ("row no. 3 plant no. 12", (3, 12, 0)),
        ("שורה 3 עץ 12", (3, 12, 0)),
        ("3.12", (3, 12, 0)),
        ("3.12a", (3, 12, 1)),
        ("3 12", (3, 12, 0)),
    ],
)
def test_a_row_and_a_plant_in_one_cell_are_taken_apart(cell, place):
    assert called(cell) == ({}, {0: place}, {})


@pytest.mark.parametrize(
    "cell", ["Block 2-15", "Plot 3/12", "Trap 4.7", "leaf 1-5", "-12.5", "\u221212.5", "tree", "R3"]
)
def test_numbers_of_another_thing_name_no_plant(cell):
    assert called(cell) == ({}, {}, {})


@pytest.mark.parametrize("typed", [1.1, 12.5, np.float64(2.3)])
def test_what_is_typed_as_a_number_and_is_not_whole_names_no_plant(typed):
    assert called(typed) == ({}, {}, {})
    assert called(typed, 7) == ({1: 7}, {}, {})


@pytest.mark.parametrize("cell", ["1,001", "1.001", "12.345", "1 001"])
def test_what_may_be_a_thousand_or_row_and_plant_is_neither_unless_told(cell):
    assert called(cell) == ({}, {}, {0: cell})
    assert called(cell, "988") == ({1: 988}, {}, {0: cell})
    whole = int("".join(c for c in cell if c.isdecimal()))
    assert called(cell, alone=True) == ({0: whole}, {}, {})


def test_points_are_rows_and_plants_where_one_of_them_can_be_no_thousand():
    assert called("1.99", "1.100", "2.0").labels == {0: (1, 99, 0), 1: (1, 100, 0), 2: (2, 0, 0)}


def test_beside_whole_numbers_a_point_is_no_row_and_plant():
    assert called("988", "12.5", "7.0") == ({0: 988, 2: 7}, {}, {})


def test_apostrophes_set_thousands_apart_and_nothing_else():
    assert called("1'001") == ({0: 1001}, {}, {})
