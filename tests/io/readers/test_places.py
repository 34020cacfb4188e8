"""Places that records may name."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.errors import ObservationError
from fieldmon.io.options import RecordOptions, Upload
from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.read import read_records
from fieldmon.io.readers.places import (
    NamedPlaces,
    Plants,
    by_plant,
    by_plot,
    by_plot_and_plant,
    labelled,
    plots_called,
)
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.grid import plant_at
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import plot_around

NORTH, SOUTH, EAST = (
    Field(name, MultiPolygon([shapely.box(5.0 + east, 45.0, 5.001 + east, 45.001)]))
    for name, east in (("North 1", 0.0), ("South", 0.01), ("East 2", 0.02))
)
FIELDS = (NORTH, SOUTH, EAST)


def plants(east):
    """Return three plants: 1 and 2 in row 1, 1 in row 2."""
    lonlat = np.array([(5.0 + east + k * 1e-5, 45.0005) for k in range(3)])
    return Plants(lonlat, np.array(["1", "1", "2"]), np.array(["1", "2", "1"]))


def cells(*values):
    return np.array(values, dtype=object)


def test_a_plant_is_known_by_its_row_and_number_and_no_other():
    known = plants(0.0)
    named = by_plant(cells("2", 1, "9", None), cells(1, "2", 1, 1), known)
    np.testing.assert_array_equal(named.lonlat[:2], known.lonlat[[2, 1]])
    assert np.isnan(named.lonlat[2:]).all()
    assert [message.sentence for message in named.messages] == [
        "1 record names 1 plant not known: 9/1.",
        "1 record names no plant at all.",
    ]


def test_numbers_as_tables_write_them_are_the_same_numbers_and_that_is_said():
    """Also beside others: what is known as it stands does not leave the rest unknown."""
    known = plants(0.0)
    named = by_plant(cells("02", "1", "1.0", "1.5"), cells("001", "2", 1.0, 1), known)
    np.testing.assert_array_equal(named.lonlat[:3], known.lonlat[[2, 1, 0]])
    assert np.isnan(named.lonlat[3]).all()
    assert [message.sentence for message in named.messages] == [
        "Names were compared as numbers: 03 and 3.0 are 3.",
        "1 record names 1 plant not known: 1.5/1.",
    ]
    apart = replace(known, row=np.array(["1", "01", "2"]), plant=np.array(["1", "1", "1"]))
    named = by_plant(cells("01", "1", "02"), cells("1", "1", "1"), apart)
    np.testing.assert_array_equal(named.lonlat[:2], known.lonlat[[1, 0]])
    assert np.isnan(named.lonlat[2]).all()


def test_a_record_that_names_a_plot_is_as_far_off_as_the_plot_is_wide():
    named = by_plot(cells("South", "Moon"), NamedPlaces(FIELDS))
    assert SOUTH.boundary.contains(shapely.Point(named.lonlat[0]))
    assert named.accuracy_m[0] == pytest.approx(np.sqrt(area_m2(SOUTH.boundary) / np.pi))
    assert np.isnan(named.lonlat[1]).all()


def test_rows_are_those_of_the_plot_that_is_named():
    places = NamedPlaces(FIELDS, plants_of={"North 1": plants(0.0), "South": plants(0.01)})
    plot = cells("South", "North 1", "South", "East 2", "Moon", "")
    named = by_plot_and_plant(plot, cells(1, 1, 7, 1, 1, 1), cells(2, 2, 7, 1, 1, 1), places)
    np.testing.assert_array_equal(named.lonlat[0], places.plants_of["South"].lonlat[1])
    np.testing.assert_array_equal(named.lonlat[1], places.plants_of["North 1"].lonlat[1])
    assert np.isnan(named.lonlat[2:]).all()
    assert named.plot.tolist() == ["South", "North 1", "South", "East 2", "", ""]
    assert {(message.feature, message.sentence) for message in named.messages} == {
        (None, "1 record names 1 plot not known: Moon."),
        (None, "1 record names no plot at all."),
        (None, "1 record is of 1 other plot: East 2."),
        ("South", "1 record names 1 plant not known: 7/7."),
    }


def test_plots_are_called_in_any_way_of_writing_but_alike_for_all():
    assert plots_called(["north-1", "SOUTH"], FIELDS) == (NORTH, SOUTH)
    assert plots_called(["2"], (NORTH, EAST)) == (EAST,)
    assert plots_called(["South", "EAST 2"], FIELDS) == (SOUTH,)
    assert plots_called(["Moon"], FIELDS) == plots_called([], FIELDS) == ()


def test_the_only_plots_plants_are_its_own_also_by_its_name():
    grid = rectangle(3, 4)
    places = NamedPlaces.of((NORTH,), grid, plot="North 1")
    assert places.plants_of == {"North 1": places.plants}
    assert NamedPlaces.of((), grid).plants_of == {}
    np.testing.assert_array_equal(labelled(grid).lonlat, places.plants.lonlat)


@pytest.fixture(scope="module")
def two_blocks():
    """Return a plot of two blocks, the second with more rows, and its plants."""
    halves = [shapely.box(5.0, 45.0, 5.0003, 45.0003), shapely.box(5.0003, 45.0, 5.001, 45.0003)]
    blocks = tuple(
        Block(name, MultiPolygon([half]), bearing)
        for name, half, bearing in zip(("North", "Hill"), halves, (0.0, 0.0), strict=True)
    )
    field = Field("two", MultiPolygon([shapely.box(5.0, 45.0, 5.001, 45.0003)]), blocks=blocks)
    return field, lay(field, Planting(row_spacing_m=3.0, plant_spacing_m=2.0))


def plant_of(grid, row, number):
    return grid.lonlat(np.array([plant_at(grid, row, number)]))[0]


def test_rows_of_a_block_that_is_named_may_be_counted_from_one(two_blocks):
    field, grid = two_blocks
    first_rows = int(grid.row_line[np.asarray(grid.block) == 0].max()) + 1
    places = NamedPlaces.of((field,), grid, None, "two")
    for block in ("2", "Hill"):
        within = by_plant(cells(1, 2), cells(3, 4), places.plants, cells(block, block))
        there = [plant_of(grid, first_rows + row, row + 2) for row in (1, 2)]
        assert within.lonlat == pytest.approx(np.array(there))
        assert [m.sentence for m in within.messages] == [
            "Rows were taken as counted from 1 in each block."
        ]
        on = by_plant(cells(first_rows + 1), cells(3), places.plants, cells(block))
        assert on.lonlat == pytest.approx(np.array(there[:1]))
        assert "counted on from block to block" in on.messages[0].sentence


def test_rows_without_a_block_are_said_to_be_counted_on(two_blocks):
    field, grid = two_blocks
    plants = labelled(grid, None, field.blocks)
    named = by_plant(cells(1, 2), cells(3, 4), plants)
    assert named.lonlat == pytest.approx(np.array([plant_of(grid, 1, 3), plant_of(grid, 2, 4)]))
    (said,) = named.messages
    assert "2 records name no block" in said.sentence
    assert "give a column of blocks" in said.sentence


def test_names_of_rows_that_several_blocks_have_are_refused_without_the_block():
    lonlat = np.array([(5.0 + k * 1e-5, 45.0005) for k in range(4)])
    row, plant = np.array(["1", "2", "1", "2"]), np.array(["1", "1", "1", "1"])
    plants = Plants(lonlat, row, plant, np.array(["A", "A", "B", "B"]))
    with pytest.raises(ObservationError, match=r"must name the block.*2 blocks \(A, B\)"):
        by_plant(cells(1), cells(1), plants)
    named = by_plant(cells(1), cells(1), plants, cells("B"))
    np.testing.assert_array_equal(named.lonlat, lonlat[[2]])
    unknown = by_plant(cells(1, 1), cells(1, 1), plants, cells("B", "C"))
    assert "C/1/1" in unknown.messages[0].sentence


def test_records_of_a_file_are_put_into_the_block_they_name(two_blocks):
    field, grid = two_blocks
    places = NamedPlaces.of((field,), grid, None, "two")
    table = Upload("found.csv", b"block,row,plant,count\n2,1,3,4\n2,2,4,0\n1,1,1,2\n")
    read = read_records(table, RecordOptions(), places=places)
    rows = int(grid.row_line[np.asarray(grid.block) == 0].max()) + 1
    there = [plant_of(grid, rows + 1, 3), plant_of(grid, rows + 2, 4), plant_of(grid, 1, 1)]
    assert read.value.lonlat == pytest.approx(np.array(there))


def test_rows_and_plants_may_be_named_by_their_numbers_here_as_well():
    known = replace(
        plants(0.0), row=np.array(["A", "A", "B"]), plant=np.array(["x", "y", "z"]),
        numbers=(np.array(["1", "1", "2"]), np.array(["1", "2", "1"])),
    )  # fmt: skip
    for row, plant in (("A", "B"), ("y", "z")), (("A", "B"), (2, 1)), ((1, 2), (2, 1)):
        named = by_plant(cells(*row), cells(*plant), known)
        np.testing.assert_array_equal(named.lonlat, known.lonlat[[1, 2]])
        assert named.messages == ()


def test_the_numbers_of_measured_plants_are_those_of_the_plot():
    k, j = np.divmod(np.arange(60), 10)
    lonlat = np.stack([5 + 2e-5 * j, 45 + 3e-5 * k], axis=1)
    rows, names = np.array(list("FEDCBA"))[k], np.array([f"v{10 - one}" for one in j])
    grid = plot_around("own", lonlat, names=PlantNames(rows, None, names)).grid
    row, number = labelled(grid, Plants(lonlat, rows, names)).numbers
    assert number.tolist() == [f"{10 - one}" for one in j]
    there = [plant_at(grid, int(r), int(n)) for r, n in zip(row, number, strict=True)]
    assert grid.lonlat(np.array(there)) == pytest.approx(lonlat, abs=1e-9)


def test_blocks_may_be_named_as_their_file_has_them():
    k, j = np.divmod(np.arange(60), 10)
    lonlat = np.stack([5 + 2e-5 * j, 45 + 3e-5 * k], axis=1)
    row, block = np.where(k < 3, k + 1, k - 2).astype(np.str_), np.where(k < 3, "west", "east")
    known = labelled(plot_around("own", lonlat, names=PlantNames(row, block)).grid)
    named = by_plant(cells("1", "2"), cells("1", "1"), known, cells("west", "east"))
    assert named.lonlat[:, 1] == pytest.approx(lonlat[[0, 40], 1], abs=1e-9)


def test_rows_counted_from_zero_are_refused_but_where_rows_are_called_so():
    with pytest.raises(ObservationError, match=r"counted from 1, but 1 record says 0: 0/1\."):
        by_plant(cells(0, 1), cells(1, 2), plants(0))
    with pytest.raises(ObservationError, match=r"says 0: 1/0\."):
        by_plant(cells(1, 1), cells(0, 2), plants(0))
    known = plants(0)
    called = Plants(known.lonlat, np.array(["0", "0", "1"]), known.plant)
    there = by_plant(cells(0, 1), cells(1, 1), called)
    np.testing.assert_array_equal(there.lonlat, known.lonlat[[0, 2]])
