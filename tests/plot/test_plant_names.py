"""What people call rows and plants are their numbers here, where it tells them apart."""

import numpy as np
import pytest

from fieldmon.errors import PlotError, SettingError
from fieldmon.plot.grid import plant_at, plant_numbers, row_in_block, rows_listed
from fieldmon.plot.named_rows import plant_meant, plants_in_rows, rows_meant
from fieldmon.plot.plant_names import PlantNames, doubts_of_numbers, said_of_numbers
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import plot_around
from fieldmon.plot.projection import Frame

FRAME = Frame(34.9, 31.5, 90.0)
# six rows of ten, 3 m and 2 m apart: the first is the southernmost
ROW, PLANT = np.divmod(np.arange(60), 10)
XY_M = np.stack([2.0 * PLANT, 3.0 * ROW], axis=1)


def named(rows, plants=None, blocks=None, **planting):
    """Return the plot of the plants with names."""
    names = (None if one is None else np.array(one, np.str_) for one in (rows, blocks, plants))
    return plot_around("own", FRAME.lonlat(XY_M), Planting(**planting), names=PlantNames(*names))


def labels(plot):
    """Return the row and the number of each plant, in the order in which they were measured."""
    numbered = plant_numbers(plot.grid)
    found = plot.grid.tree.query(plot.grid.frame.xy_m(FRAME.lonlat(XY_M)))[1]
    return numbered.line[found].tolist(), numbered.number[found].tolist()


def signs(plot):
    """Return what stands at each row of a plot on maps."""
    return list(plot.grid.line_signs.values())


def test_names_say_of_how_many_plants_they_are():
    assert repr(PlantNames()) == "<PlantNames: 0 plants>"
    assert repr(PlantNames(np.array(["1", "2", "2"]))) == "<PlantNames: 3 plants>"


@pytest.mark.parametrize("faces", [1, 2])
@pytest.mark.parametrize(
    ("row", "plant"),
    [
        (ROW + 1, PLANT + 1),
        (6 - ROW, PLANT + 1),
        (ROW + 1, 10 - PLANT),
        (6 - ROW, 10 - PLANT),
        (101 + 2 * ROW, 5 * PLANT + 5),
        (np.array([4, 1, 9, 2, 7, 3])[ROW], np.arange(60) + 1),
        (5 - ROW, PLANT),
    ],
)
def test_rows_and_plants_have_the_numbers_of_their_file(row, plant, faces):
    plot = named(row, plant, faces=faces)
    assert labels(plot) == (row.tolist(), plant.tolist())
    for at in (0, 17, 59):
        place = FRAME.lonlat(XY_M)[at]
        there = plant_at(plot.grid, int(row[at]), int(plant[at]))
        assert plot.grid.lonlat(np.array([there]))[0] == pytest.approx(place, abs=1e-9)


@pytest.mark.parametrize("name", ["{}", "{:02d}", "{}.0", "ROW{:02d}", "Pinot-{}", "B2 / {}"])
def test_a_number_is_one_at_the_end_of_a_name(name):
    row, plant = labels(named([name.format(6 - k) for k in ROW], [f"V{k}" for k in PLANT + 1]))
    assert row == (6 - ROW).tolist()
    assert plant == (PLANT + 1).tolist()


@pytest.mark.parametrize("names", ["FEDCBA", ["2.1", "2.2", "2.3", "2.4", "2.5", "2.6"],
                                   ["A1", "B1", "A2", "B2", "A3", "B3"],
                                   ["1", "2", "A", "B", "C", "D"],
                                   [f"{10**7 + k}" for k in range(6)]])  # fmt: skip
def test_rows_that_their_names_do_not_number_count_from_one(names):
    row, plant = labels(named([names[k] for k in ROW], 10 - PLANT))
    assert row == labels(named(None))[0]
    assert plant == (10 - PLANT).tolist()


@pytest.mark.parametrize(
    ("names", "numbers"),
    [(["1", "2", "5A", "3", "Top", "4"], [1, 2, 101, 3, 102, 4]),
     (["7", "Top 5", "6", "5", "4", "3"], [7, 101, 6, 5, 4, 3]),
     (["1", "2", "", "3", "101A", "120"], [1, 2, 1001, 3, 1002, 120])],
)  # fmt: skip
def test_a_row_without_a_number_of_its_own_leaves_the_others_theirs(names, numbers):
    plot = named([names[k] for k in ROW], 10 - PLANT)
    assert labels(plot)[0] == [numbers[k] for k in ROW]
    for name, number in zip(names, numbers, strict=True):
        if name:
            for said in (name, f"{number}"):
                meant = plant_numbers(plot.grid).line[plants_in_rows(plot.grid, said)]
                assert set(meant.tolist()) == {number}


def test_a_row_without_a_number_of_its_own_is_beyond_those_of_all_blocks():
    block = np.where(ROW < 3, "east", "west")
    plot = named([["1", "2", "5A", "2", "1", "Top"][k] for k in ROW], None, block)
    assert labels(plot)[0] == [[1, 2, 101, 4, 3, 102][k] for k in ROW]
    assert list(plot.grid.line_signs.values()) == ["1", "2", "101 · 5A", "4", "3", "102 · Top"]
    assert "5A is row 101, Top is row 102" in said_of_numbers(plot.grid)[-1]


def test_rows_up_to_one_without_a_number_of_its_own_are_refused():
    grid = named([["1", "2", "5A", "3", "4", "5"][k] for k in ROW]).grid
    with pytest.raises(SettingError, match="but 5A has none in the file of plants"):
        plants_in_rows(grid, "5 - 5A")
    with pytest.raises(SettingError, match="but 101 has none"):
        plants_in_rows(grid, "5-101")
    assert set(plant_numbers(grid).line[plants_in_rows(grid, "4-5,5a")].tolist()) == {4, 5, 101}


def test_rows_are_listed_with_those_without_a_number_of_their_own_by_name():
    grid = named([["1", "2", "5A", "3", "4", "Top"][k] for k in ROW]).grid
    assert rows_listed(grid, np.array([1, 2, 3, 101])) == "1–3, 101 · 5A"
    assert [rows_listed(grid, np.array(one)) for one in ([4, 4], [102])] == ["4", "102 · Top"]


def test_rows_typed_from_one_to_another_have_numbers_of_their_own_or_are_one():
    grid = named([["1", "2", "5A", "3", "4", "5"][k] for k in ROW]).grid
    typed = [(None, None), ("2", None), ("5a", "5A"), (None, "4")]
    assert [rows_meant(grid, *both) for both in typed] == [(1, 101), (2, 101), (101, 101), (1, 4)]
    for both in (("5A", "5"), (None, "5A"), ("1", "101")):
        with pytest.raises(SettingError, match="has none in the file of plants"):
            rows_meant(grid, *both)
    with pytest.raises(SettingError, match=r"of 1–5, 101 \(in .*: 5A\) on this plot, but it is 6"):
        rows_meant(grid, "6", None)


def test_a_plant_typed_by_a_number_that_is_the_name_of_another_is_refused():
    grid = named(ROW + 1, np.where((PLANT == 3) & (ROW == 1), 3, PLANT + 1)).grid
    assert plant_meant(grid, "1", 4) == plant_at(grid, 1, 4)
    with pytest.raises(SettingError, match="3 may be any of plants 3–4 of row 2 here"):
        plant_meant(grid, "2", 3)
    with pytest.raises(PlotError, match="but it is 11"):
        plant_meant(grid, "2", 11)


def test_plants_of_a_row_that_have_one_name_count_from_one():
    row, plant = labels(named(6 - ROW, np.where(PLANT == 3, 4, PLANT)))
    assert row == (6 - ROW).tolist()
    assert plant == labels(named(None))[1]


def test_rows_of_blocks_that_have_the_same_names_are_counted_on():
    block = np.where(ROW < 3, "east", "west")
    in_block = np.where(ROW < 3, 3 - ROW, ROW - 2)
    plot = named(in_block, None, block)
    assert labels(plot)[0] == np.where(ROW < 3, in_block, in_block + 3).tolist()
    found = plot.grid.tree.query(plot.grid.frame.xy_m(FRAME.lonlat(XY_M)))[1]
    assert row_in_block(plot.grid)[found].tolist() == in_block.tolist()


def test_what_is_left_keeps_its_numbers():
    plot = named(6 - ROW, 10 - PLANT)
    numbered = plant_numbers(plot.grid)
    missing = (numbered.line == 4) | (numbered.number == 2)
    left = plant_numbers(plot.without(missing).grid)
    assert left.line.tolist() == numbered.line[~missing].tolist()
    assert left.number.tolist() == numbered.number[~missing].tolist()
    with pytest.raises(PlotError, match="one of 1–3, 5–6 on this plot, but it is 4"):
        plant_at(plot.without(missing).grid, 4, 1)


def test_what_rows_and_plants_are_called_here_is_said_where_it_is_no_number():
    assert said_of_numbers(named(6 - ROW, 10 - PLANT).grid) == []
    letters = np.array(["F", "E", "D", "C", "B", "A"])[ROW], np.array(list("abcdefghij"))[PLANT]
    rows, plants = said_of_numbers(named(*letters).grid)
    assert "since no numbers in their names tell them apart: F is row 1, E is row 2, D" in rows
    assert "Plants count from 1 in each row: a is plant 1 of row 1, b is plant 2 of" in plants
    numbers = [f"ROW{k + 1:02d}" for k in ROW], [f"V{10 - k}" for k in PLANT]
    rows, plants = said_of_numbers(named(*numbers).grid)
    assert rows == "Rows have the numbers in their names: ROW01 is row 1, ROW02 is row 2, ...."
    assert "Plants have the numbers in their names: V10 is plant 10 of row 1, V9 is" in plants
    block = np.where(ROW < 3, "east", "west")
    blocks, said = said_of_numbers(named(np.where(ROW < 3, 3 - ROW, ROW - 2), None, block).grid)
    assert blocks == "Blocks count from 1: east is block 1, west is block 2."
    assert "row 1 of block 2 is row 4, row 2 of block 2 is row 5" in said


def test_rows_that_are_called_by_numbers_of_other_rows_are_doubted():
    (doubt,) = doubts_of_numbers(named(np.array(["2", "1", "A", "B", "C", "D"])[ROW]).grid)
    assert "Rows are called 2, 1 in the file, which are numbers of other rows" in doubt
    for rows in (ROW, ROW + 1, 6 - ROW, np.array(list("FEDCBA"))[ROW], None):
        assert doubts_of_numbers(named(rows).grid) == []


@pytest.mark.parametrize(("odd", "said"), [("7", "7 in row 1"), ("", "? in row 1"), ("x", "x in")])
@pytest.mark.parametrize("faces", [1, 2])
def test_one_number_that_tells_no_plant_apart_takes_them_from_its_row_alone(odd, said, faces):
    plants = np.array([f"{2 * k + 3}" for k in PLANT], "<U3")
    plants[4] = odd
    plot = named(ROW + 1, plants, faces=faces)
    rows, numbers = labels(plot)
    assert rows == (ROW + 1).tolist()
    assert numbers[10:] == (2 * PLANT + 3)[10:].tolist()
    assert numbers[:10] == [*range(1, 11)]
    (doubt,) = plot.doubts
    assert doubt.startswith("Plants count from 1 in 1 row, not by the numbers in their names")
    assert said in doubt
    assert "5 is plant 2 of row 1" not in " ".join(said_of_numbers(plot.grid))


def test_numbers_that_tell_few_plants_apart_are_no_numbers():
    plot = named(ROW + 1, PLANT // 2 + 1)
    assert labels(plot)[1] == (PLANT + 1).tolist()
    (doubt,) = plot.doubts
    assert doubt.startswith("Plants count from 1 in all rows, not by the numbers in their names")
    clones = np.array([f"clone {one}" for one in PLANT // 2])  # of which a number is only a part
    assert named(ROW + 1, clones).doubts == ()
    (doubt,) = named(ROW + 1, np.where(PLANT == 4, 8, PLANT + 3)).doubts
    assert doubt.startswith("Plants count from 1 in all rows")


def test_what_stands_at_rows_on_maps_has_their_names_where_these_are_no_numbers():
    assert signs(named(6 - ROW)) == ["6", "5", "4", "3", "2", "1"]
    assert signs(named([f"R{6 - k}" for k in ROW])) == ["6", "5", "4", "3", "2", "1"]
    assert signs(named(np.array(list("FEDCBA"))[ROW]))[:2] == ["1 · F", "2 · E"]
    odd = named([["R1", "R2", "5A", "R03", "Top", "R4"][k] for k in ROW])
    assert signs(odd) == ["1", "2", "101 · 5A", "3", "102 · Top", "4"]


def test_names_that_are_not_those_of_rows_are_kept_and_never_taken_for_other_rows():
    across = named(PLANT + 1, ROW + 1)
    assert "rows were found instead" in " ".join(across.rows.doubts)
    for row in ("1", "6", "9"):
        with pytest.raises(SettingError, match="may be any of rows 1–6 here"):
            plants_in_rows(across.grid, row)
    assert signs(across) == ["1", "2", "3", "4", "5", "6"]
    assert "Rows are called 2, 3, 4, 5, 6, 1 in the file" in doubts_of_numbers(across.grid)[0]
    assert "1, 10, 2, ... is row 1, 1, 10, 2, ... is row 2" in said_of_numbers(across.grid)[0]


def test_plants_whose_row_nobody_named_are_of_the_row_they_stand_in():
    rows = (6 - ROW).astype(np.str_)
    rows[[3, 14, 55]] = ""
    assert labels(named(rows, 10 - PLANT)) == ((6 - ROW).tolist(), (10 - PLANT).tolist())
    rows[ROW == 2] = ""
    plot = named(rows)
    assert signs(plot) == ["6", "5", "101", "3", "2", "1"]
    assert "a row without a name is row 101" in said_of_numbers(plot.grid)[-1]
    assert set(plant_numbers(plot.grid).line[plants_in_rows(plot.grid, "6")].tolist()) == {6}
