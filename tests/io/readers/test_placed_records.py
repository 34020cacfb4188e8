"""Records are placed on the plot, and what is doubtful of their places is said."""

from fieldmon.io.import_report import Severity
from tests.io.readers.test_inspections import GRID, read


def test_plants_that_the_plot_does_not_have_are_named_and_left_out():
    imported = read(
        "plant,row,number,found\n60,,,x\n,9,1,x\n,1,11,x\n,2147483647,2147483647,x\n-4,,,x\n5,,,x\n"
    )
    assert imported.value.plant.tolist() == [5]
    said = " ".join(f.sentence for f in imported.of(Severity.DROPPED))
    assert "plant 60 is none of 0 to 59" in said
    assert "there is no plant 1 in row 9" in said
    assert "there is no plant 11 in row 1" in said


def test_a_mistyped_position_is_told_once():
    lon, lat = GRID.frame.lonlat(GRID.xy_m[:3]).T
    rows = [f"{x},{y},no" for x, y in zip(lon, [lat[0], 303.52, lat[2]], strict=True)]
    imported = read("\n".join(["lon,lat,found", *rows]))
    (left_out,) = imported.of(Severity.DROPPED)
    assert left_out.feature == "record 2"
    assert "/ 303.52 is no position" in left_out.sentence


def test_a_number_that_nothing_bears_out_is_said_to_count_from_zero():
    alone = "record names a plant by its number alone: taken as files given out count them, 0 to 59"
    assert any(alone in str(one) for one in read("plant,count\n1,2\n").messages)
    assert not any(alone in str(one) for one in read("plant,row,number,count\n1,1,2,2\n").messages)


def test_row_and_plant_in_one_cell_are_said_as_numbers_alone_are():
    told = [str(one) for one in read("tree,found\n3/2,x\nR1/2,x\n").messages]
    assert any("2 records name a row and a plant in one cell ('3/2')" in one for one in told)
    told = [str(one) for one in read("tree,found\n7,x\n").messages]
    assert not any("in one cell" in one for one in told)
    told = [str(one) for one in read("row,plant,found\n3,2,x\n").messages]
    assert not any("in one cell" in one for one in told)


def test_what_names_another_thing_is_not_placed_and_said():
    told = read("tree,found\nBlock 2-5,x\n7,x\n")
    assert told.value.plant.tolist() == [7]
    assert any("'Block 2-5' does not name a plant for certain" in str(one) for one in told.messages)
