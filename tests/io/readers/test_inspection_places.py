"""Which plant a record means: by its number, by its row, or by its position."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import MultiPolygon, Polygon

from fieldmon.io.import_report import Severity
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.grid import plant_at, plant_numbers
from fieldmon.plot.layout import lay
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import plot_around
from tests.io.readers.test_inspections import GRID, read
from tests.io.tables_of_cells import sentences


def two_faced():
    corners = np.array([(0, 0), (0, 30), (40, 30), (40, 0)]) / 111_320
    field = Field("faces", MultiPolygon([Polygon(corners + np.array([35.0, 30.0]))]))
    return lay(field, Planting(faces=2, row_spacing_m=3.0, plant_spacing_m=2.0))


def test_a_file_of_another_plot_is_noticed():
    lon, lat = GRID.lonlat(np.array([7]))[0]
    text = f"plant,row,number,lon,lat,found\n7,1,8,{lon},{lat},x\n7,1,8,{lon + 0.001},{lat},x\n"
    text += f"7,3,8,{lon},{lat},x\n7,1,8,{lon + 90},{lat},x\n,2,8,{lon + 0.001},{lat},x\n"
    imported = read(text)
    assert len(imported.value) == 1
    doubts = imported.of(Severity.DOUBTFUL)
    assert [f.feature for f in doubts[:-1]] == [f"record {i}" for i in range(2, 6)]
    assert doubts[-1].sentence == "Of 5 records 1 was taken, of 1 plant; 4 were left out."


@given(
    st.lists(st.integers(0, len(GRID) - 1), min_size=1, max_size=30, unique=True), st.integers(0)
)
@settings(max_examples=15)
def test_positions_within_half_the_spacing_come_back_to_their_plant(plants, seed):
    rng = np.random.default_rng(seed)
    half = np.array([GRID.plant_spacing_m, GRID.row_spacing_m]) / 2
    xy = GRID.xy_m[plants] + rng.uniform(-0.95, 0.95, (len(plants), 2)) * half
    lonlat = GRID.frame.lonlat(xy)
    rows = "\n".join(f"{lon:.9f},{lat:.9f},yes" for lon, lat in lonlat)
    findings = read(f"lon,lat,found\n{rows}\n").value
    assert findings.plant.tolist() == plants


def test_a_position_between_two_plants_is_doubtful_as_far_as_it_is_inaccurate():
    a, b = GRID.xy_m[12], GRID.xy_m[13]
    at = a + 0.3 * (b - a)  # 0.2 of the spacing before the middle
    (lon, lat), gap_m = GRID.frame.lonlat(at)[0], 0.2 * GRID.plant_spacing_m
    for accuracy_m, is_sure in ((0.9 * gap_m, True), (1.1 * gap_m, False)):
        text = f"lon,lat,accuracy,found\n{lon:.9f},{lat:.9f},{accuracy_m},yes\n"
        imported = read(text)
        assert imported.value.plant.tolist() == ([12] if is_sure else [])
        told = read(text, InspectionOptions(take_doubtful=True))
        assert told.value.plant.tolist() == [12]
        bare = f"lon,lat,found\n{lon:.9f},{lat:.9f},yes\n"
        by_hand = read(bare, InspectionOptions(accuracy_m=accuracy_m))
        assert by_hand.value.plant.tolist() == ([12] if is_sure else [])
    (doubt,) = read(text).of(Severity.DOUBTFUL)
    assert "row 2, number 3 or row 2, number 4" in doubt.sentence


def test_a_position_off_the_plants_is_doubtful_and_one_far_away_is_none():
    lon, lat = GRID.frame.lonlat(GRID.xy_m[0] - (0.6 * GRID.plant_spacing_m, 0))[0]
    text = f"lon,lat,found\n{lon:.9f},{lat:.9f},yes\n{lon + 5:.9f},{lat:.9f},yes\n"
    imported = read(text)
    assert len(imported.value) == 0
    assert "more than half the spacing" in imported.of(Severity.DOUBTFUL)[0].sentence
    assert "far from the plot" in imported.of(Severity.DROPPED)[0].sentence
    assert read(text, InspectionOptions(take_doubtful=True)).value.plant.tolist() == [0]


@pytest.mark.parametrize("named", ["", "7"])
def test_positions_that_would_lie_on_the_plot_with_their_axes_exchanged_are_offered_so(named):
    lon, lat = GRID.lonlat(np.array([7]))[0]
    text = f"plant,lon,lat,found\n{named},{lat:.9f},{lon:.9f},yes\n"
    imported = read(text)
    assert len(imported.value) == 0
    (hint,) = [one for one in imported.messages if one.remedy and one.remedy.option == "swap_axes"]
    assert "1 record would lie on the plot with longitude and latitude exchanged" in hint.sentence
    assert "inf" not in " ".join(one.sentence for one in imported.messages)
    mended = read(text, InspectionOptions().choose("swap_axes", hint.remedy.value))
    assert mended.value.plant.tolist() == [7]


def test_both_faces_of_a_plant_are_told_apart_by_number_or_by_face():
    grid = two_faced()
    twin = int(grid.twin[3])
    numbered = plant_numbers(grid, np.array([3]))
    place = f"{numbered.line[0]},{numbered.number[0]}"
    imported = read(
        f"plant,row,number,face,found\n3,,,,x\n{twin},,,,x\n,{place},1,no\n,{place},2,no\n"
        f",{place},,skipped\n",
        grid=grid,
    )
    first, second = sorted((3, twin))
    assert imported.value.plant.tolist() == [3, twin, first, second, first]
    assert any("1 record does not say which face" in f.sentence for f in imported.messages)
    words = read(f"row,number,face,found\n{place},east,x\n{place},west,no\n", grid=grid)
    assert not len(words.value)
    assert any("its face is 'east', but faces are called 1 and 2" in str(f) for f in words.messages)
    lon, lat = grid.lonlat(np.array([twin]))[0]
    snapped = read(f"lon,lat,accuracy,found\n{lon:.9f},{lat:.9f},0.1,x\n", grid=grid)
    assert snapped.value.plant.tolist() == [first]


@pytest.fixture(scope="module")
def two_blocks():
    """Return two blocks whose rows run north in one and east in the other."""
    west, east = shapely.box(5.0, 45.0, 5.0003, 45.0003), shapely.box(5.0003, 45.0, 5.001, 45.0003)
    blocks = Block("", MultiPolygon([west]), 0.0), Block("", MultiPolygon([east]), 90.0)
    field = Field("two", MultiPolygon([shapely.box(5.0, 45.0, 5.001, 45.0003)]), blocks=blocks)
    return lay(field, Planting(row_spacing_m=3.0, plant_spacing_m=2.0))


def test_rows_of_a_named_block_may_be_counted_from_one_and_how_is_said(two_blocks):
    grid = two_blocks
    rows = int(grid.row_line[np.asarray(grid.block) == 0].max()) + 1
    within = read("block,row,plant,found\n2,1,3,x\n1,2,1,x\n", grid=grid)
    there = [plant_at(grid, rows + 1, 3), plant_at(grid, 2, 1)]
    assert within.value.plant.tolist() == there
    assert "counted from 1 in each block" in within.messages[-1].sentence
    on = read(f"block,row,plant,found\n2,{rows + 1},3,x\n1,2,1,x\n", grid=grid)
    assert on.value.plant.tolist() == there
    unnamed = read(f"row,plant,found\n{rows + 1},3,x\n2,1,x\n", grid=grid)
    assert unnamed.value.plant.tolist() == there
    assert "2 records name no block" in unnamed.messages[-1].sentence
    wrong = read("block,row,plant,found\n7,1,1,x\n1,1,1,x\n", grid=grid)
    assert wrong.value.plant.tolist() == [plant_at(grid, 1, 1)]
    assert "row 1 of block 7 (blocks are 1 to 2" in wrong.of(Severity.DROPPED)[0].sentence


def test_rows_and_plants_are_those_of_the_file_of_plants():
    k, j = np.divmod(np.arange(60), 10)
    xy_m = np.stack([2.0 * j, 3.0 * k], axis=1)
    lonlat = GRID.frame.lonlat(xy_m)
    names = PlantNames((6 - k).astype(np.str_), None, (20 - j).astype(np.str_))
    grid = plot_around("own", lonlat, names=names).grid
    text = "".join(f"{6 - k[i]},{20 - j[i]},x\n" for i in (0, 15, 59))
    imported = read(f"row,plant,found\n{text}", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[0, 15, 59]], abs=1e-9)


def test_rows_of_blocks_are_those_of_the_file_of_plants():
    k, j = np.divmod(np.arange(60), 10)
    block, row = np.where(k < 3, "1", "2"), np.where(k < 3, 3 - k, k - 2)
    lonlat = GRID.frame.lonlat(np.stack([2.0 * j, 3.0 * k], axis=1))
    names = PlantNames(row.astype(np.str_), block, (10 - j).astype(np.str_))
    grid = plot_around("own", lonlat, names=names).grid
    text = "".join(f"{block[i]},{row[i]},{10 - j[i]},x\n" for i in (0, 25, 30, 59))
    imported = read(f"block,row,plant,found\n{text}", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[0, 25, 30, 59]], abs=1e-9)


def own_names(row, plant):
    """Return six rows of ten with names, and where each plant was measured."""
    k, j = np.divmod(np.arange(60), 10)
    lonlat = GRID.frame.lonlat(np.stack([2.0 * j, 3.0 * k], axis=1))
    names = (np.array([name(*at) for at in zip(k, j, strict=True)]) for name in (row, plant))
    rows, plants = names
    return plot_around("own", lonlat, names=PlantNames(rows, None, plants)).grid, lonlat


def test_rows_and_plants_may_be_named_as_their_file_has_them():
    grid, lonlat = own_names(lambda k, _: "FEDCBA"[k], lambda k, j: f"{'FEDCBA'[k]}v{10 - j:02d}")
    for text in (
        "row,plant,found\nF,Fv10,x\nb,bv1,x\nA,1,x\n",
        "vine_id,found\nFv10,x\nBv01,x\nAV01,x\n",
    ):
        imported = read(text, grid=grid)
        assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[0, 49, 59]], abs=1e-9)
    wrong = read("row,plant,found\nF,Av01,x\nG,1,x\nF,Fv11,x\n", grid=grid)
    assert not len(wrong.value)
    no_plant, no_row, _ = (one.sentence for one in wrong.of(Severity.DROPPED))
    assert "row F has no plant Av01 here" in no_plant
    assert "no row is called G here" in no_row
    assert "Rows of this plot are 1–6 (in the file of plants: F, E, D, C, B, ...)" in no_row


def test_a_plant_alone_is_the_one_that_its_file_names_so_and_that_is_said():
    grid, lonlat = own_names(lambda k, _: f"{k + 1}", lambda k, j: f"{10 * k + 10 - j}")
    imported = read("tree,found\n10,x\n25,x\n", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[0, 25]], abs=1e-9)
    (said,) = imported.of(Severity.GUESSED)
    assert "2 records name plants alone: taken as the plot's file calls them" in said.sentence
    given_out = read("row,number,plant,found\n1,10,0,x\n", grid=grid)
    assert given_out.value.plant.tolist() == [0]


def test_a_name_of_one_row_that_is_the_number_of_another_is_refused():
    rows = ["3", "A", "B", "C", "D", "1"]
    grid, lonlat = own_names(lambda k, _: rows[k], lambda _, j: f"{j + 1}")
    imported = read("row,plant,found\nA,3,x\n3,3,x\n", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[12]], abs=1e-9)
    assert "3 may be any of rows 1, 3 here" in imported.of(Severity.DROPPED)[0].sentence


def test_a_row_without_a_number_of_its_own_is_meant_by_its_name_and_takes_none_of_the_others():
    rows = ["5a", "5", "4", "3", "2", "1"]
    grid, lonlat = own_names(lambda k, _: rows[k], lambda _, j: f"{j + 1}")
    imported = read("row,plant,found\n5A,3,x\n3,3,x\n101,4,x\n", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[2, 32, 3]], abs=1e-9)


def test_a_name_of_one_plant_that_is_the_number_of_another_is_refused():
    grid, lonlat = own_names(lambda k, _: f"{k + 1}", lambda k, j: f"{j + (j < 3 or k > 0)}")
    imported = read("row,plant,found\n1,3,x\n1,1,x\n2,3,x\n", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[0, 12]], abs=1e-9)
    (why,) = imported.of(Severity.DROPPED)
    assert "plant 3 may be any of plants 3–4 of row 1 here" in why.sentence


def test_rows_and_plants_may_count_from_zero_where_their_file_does():
    grid, lonlat = own_names(lambda k, _: f"{5 - k}", lambda _, j: f"{j}")
    imported = read("row,plant,found\n5,3,x\n0,3,x\n3,0,x\n0,0,x\n", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[3, 53, 20, 50]], abs=1e-9)
    assert imported.of(Severity.DOUBTFUL) == ()


def test_row_0_is_held_against_the_plant_that_is_named_beside_it():
    grid, _ = own_names(lambda k, _: f"{5 - k}", lambda _, j: f"{j}")
    first = plant_at(grid, 0, 0)
    given_out = read(f"plant,row,number,found\n{first},0,0,x\n", grid=grid)
    assert given_out.value.plant.tolist() == [first]
    for of in (grid, GRID):
        other = read("plant,row,number,found\n25,0,3,x\n", grid=of)
        assert not len(other.value)
        assert "but the record says row 0, number 3" in other.of(Severity.DOUBTFUL)[0].sentence


def test_rows_of_blocks_may_be_named_as_their_file_has_them():
    k, j = np.divmod(np.arange(60), 10)
    block, row = np.where(k < 3, "1", "2"), np.where(k < 3, 3 - k, k - 2)
    lonlat = GRID.frame.lonlat(np.stack([2.0 * j, 3.0 * k], axis=1))
    rows = np.array([f"R{one}" for one in row])
    grid = plot_around("own", lonlat, names=PlantNames(rows, block, (j + 1).astype(np.str_))).grid
    text = "".join(f"{block[i]},R{row[i]},{j[i] + 1},x\n" for i in (0, 25, 30, 59))
    imported = read(f"block,row,plant,found\n{text}", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[0, 25, 30, 59]], abs=1e-9)
    unnamed = read("row,plant,found\nR1,1,x\n", grid=grid)
    assert not len(unnamed.value)
    assert "R1 may be any of rows 1, 4 here" in unnamed.of(Severity.DROPPED)[0].sentence


def test_blocks_are_those_of_the_file_of_plants():
    k, j = np.divmod(np.arange(60), 10)
    lonlat = GRID.frame.lonlat(np.stack([2.0 * j, 3.0 * k], axis=1))
    row, plant = np.where(k < 3, 3 - k, k - 2).astype(np.str_), (j + 1).astype(np.str_)
    for names in (("west", "east"), ("3", "4"), ("2", "10")):
        block = np.where(k < 3, *names)
        grid = plot_around("own", lonlat, names=PlantNames(row, block, plant)).grid
        text = "".join(f"{block[i]},{row[i]},{plant[i]},x\n" for i in (0, 25, 30, 59))
        imported = read(f"block,row,plant,found\n{text}", grid=grid)
        assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[0, 25, 30, 59]], abs=1e-9)
    block = np.where(k < 3, "2", "3")
    grid = plot_around("own", lonlat, names=PlantNames(row, block, plant)).grid
    imported = read("block,row,plant,found\n3,1,1,x\n2,1,1,x\n", grid=grid)
    assert grid.lonlat(imported.value.plant) == pytest.approx(lonlat[[30]], abs=1e-9)
    assert "row 1 of block 2" in imported.of(Severity.DROPPED)[0].sentence


def test_how_far_a_position_is_off_is_measured_along_its_row_and_across(two_blocks):
    grid = two_blocks
    for block, (east_m, north_m) in ((0, (1.3, 0.0)), (1, (0.0, 1.3))):
        plant = int(np.flatnonzero(np.asarray(grid.block)[grid.row] == block)[40])
        lon, lat = grid.lonlat(np.array([plant]))[0]
        lon += east_m / (111_320 * np.cos(np.deg2rad(lat)))
        lat += north_m / 111_132
        read_one = read(f"lon,lat,found\n{lon:.9f},{lat:.9f},x\n", grid=grid)
        assert read_one.value.plant.tolist() == [plant]
        assert not read_one.of(Severity.DOUBTFUL)


@pytest.mark.parametrize(
    ("below", "other"),
    [("0,3", "1,4"), ("3,0", "4,1"), ("0,0", "1,1"), ("-1,2", "2,2"), ("0/3", "1/4")],
)
def test_rows_or_plants_counted_from_zero_put_nobody_next_door(below, other):
    head = "row,plant" if "," in below else "tree"
    text = f"{head},count\n{below},2\n{other},2\n"
    told = read(text)
    assert not len(told.value)
    dropped, doubted = (str(one) for one in told.messages if "record" in str(one.feature))
    assert "counted from 1, but it says 0 or less" in dropped
    assert "Add 1 where they were counted from 0" in doubted
    assert len(read(text, InspectionOptions(take_doubtful=True)).value) == 1


@pytest.mark.parametrize(
    ("away_m", "accuracy_m", "taken"),
    [(90.0, "", True), (110.0, "", False), (110.0, 60.0, True), (9000.0, 60.0, False)],
)
def test_no_plant_is_meant_farther_off_than_records_are_kept_apart(away_m, accuracy_m, taken):
    (lon, lat) = GRID.frame.lonlat(GRID.xy_m[[0]] - (away_m, 0.0))[0]
    text = f"lon,lat,accuracy,found\n{lon:.9f},{lat:.9f},{accuracy_m},yes\n"
    told = read(text, InspectionOptions(take_doubtful=True))
    assert told.value.plant.tolist() == ([0] if taken else [])
    assert ("cannot be placed: it lies" in sentences(told)) != taken


def test_a_plot_on_the_date_line_takes_positions_of_both_sides():
    corners = np.array([(-60, 0), (-60, 30), (60, 30), (60, 0)]) / 111_320
    field = Field("date line", MultiPolygon([Polygon(corners + np.array([180.0, -17.0]))]))
    grid = lay(field, Planting(row_spacing_m=3.0, plant_spacing_m=2.0))
    lonlat = grid.lonlat()
    assert (lonlat[:, 0] > 0).any()
    assert (lonlat[:, 0] < 0).any()
    named = "".join(f"{k},{lon:.9f},{lat:.9f},no\n" for k, (lon, lat) in enumerate(lonlat))
    for head, cut in (("plant,lon,lat,found", 0), ("lon,lat,found", 1)):
        lines = [",".join(line.split(",")[cut:]) for line in named.splitlines()]
        found = read("\n".join([head, *lines]), grid=grid)
        assert found.value.plant.tolist() == list(range(len(grid)))
