"""Maps of plants in rows and columns."""

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.studies.plant_maps import (
    PUBLIC_MAPS,
    MapColumns,
    not_read,
    read_plant_map,
    read_plant_maps,
)

DATED = MapColumns("row", "plant", "state", 4.0, 3.0, date="year")


def write(path, *lines):
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_states_stand_where_row_and_plant_say(tmp_path):
    head = "plant,row,year,state"
    seen = {("3", "1", "2001"): "1", ("1", "2", "2002"): "1", ("2", "1", "2002"): "NA"}
    rows = [
        f"{p},{r},{t},{seen.get((p, r, t), '0')}" for t in ("2001", "2002") for r in "12"
        for p in "321"
    ]  # fmt: skip
    (made,) = read_plant_map(write(tmp_path / "a.csv", head, *rows), DATED)
    assert (made.n_rows, made.n_plants, made.dates) == (2, 3, ("2001", "2002"))
    assert made.infested.tolist() == [
        [False, False, True, False, False, False],
        [False, False, False, True, False, False],
    ]
    xy_m = made.aisles().grid.xy_m
    assert np.allclose(np.diff(xy_m[:3, 0]), 3.0)
    assert np.isclose(xy_m[3, 1] - xy_m[0, 1], 4.0)


def test_dates_that_are_numbers_are_in_their_order(tmp_path):
    rows = ["1,1,100,1", "1,1,9,0", "1,1,20,0"]
    (made,) = read_plant_map(write(tmp_path / "a.csv", "row,plant,year,state", *rows), DATED)
    assert made.dates == ("9", "20", "100")
    assert made.infested[:, 0].tolist() == [False, False, True]


def test_dates_of_a_calendar_are_in_their_order(tmp_path):
    rows = ["1,1,2026-10-01,1", "1,1,2025-12-31,0", "1,1,2026-09-30,0"]
    (made,) = read_plant_map(write(tmp_path / "a.csv", "row,plant,year,state", *rows), DATED)
    assert made.dates == ("2025-12-31", "2026-09-30", "2026-10-01")
    assert made.infested[:, 0].tolist() == [False, False, True]


@pytest.mark.parametrize(
    "written",
    [("1.10.2026", "31.12.2025", "30.09.2026"), ("1.10.26", "31.12.25", "30.9.26"),
     ("1 Oct 2026", "31 Dec 2025", "30 Sep 2026"),
     ("2026-10-01 09:00", "2025-12-31 9:00", "2026-09-30T17:00")],
)  # fmt: skip
def test_dates_are_written_as_in_records(tmp_path, written):
    rows = [f"1,1,{when},{k}" for k, when in enumerate(written)]
    (made,) = read_plant_map(write(tmp_path / "a.csv", "row,plant,year,state", *rows), DATED)
    assert made.dates == ("2025-12-31", "2026-09-30", "2026-10-01")
    assert made.infested[:, 0].tolist() == [True, True, False]


def test_a_time_with_each_plant_leaves_it_one_date(tmp_path):
    rows = [f"1,{k},2026-05-0{d} 09:0{k},1" for d in "21" for k in (1, 2)]
    (made,) = read_plant_map(write(tmp_path / "a.csv", "row,plant,year,state", *rows), DATED)
    assert made.dates == ("2026-05-01", "2026-05-02")


@pytest.mark.parametrize("days", [("2.5", "12.5", "30.4"), ("4.30", "5.4", "5.12")])
def test_days_and_months_without_a_year_are_no_numbers(tmp_path, days):
    rows = [f"1,1,{when},0" for when in days]
    path = write(tmp_path / "a.csv", "row,plant,year,state", *rows)
    with pytest.raises(FileProblem, match=r"may be numbers, or days and months without a year"):
        read_plant_map(path, DATED)
    # in the order that both give there is no doubt
    path = write(tmp_path / "a.csv", "row,plant,year,state", "1,1,2.5,0", "1,1,1.5,0")
    assert read_plant_map(path, DATED)[0].dates == ("1.5", "2.5")


@pytest.mark.parametrize("first", ["05/06/2026", "May", "9/1", "2026-13-01", ""])
def test_dates_whose_order_nobody_knows_are_refused(tmp_path, first):
    rows = [f"1,1,{first},1", "1,1,07/06/2026,0"]
    path = write(tmp_path / "a.csv", "row,plant,year,state", *rows)
    with pytest.raises(FileProblem, match=r"must tell the order of its maps by numbers .* holds"):
        read_plant_map(path, DATED)
    # of a single one there is no order
    single = write(tmp_path / "b.csv", "row,plant,year,state", rows[0])
    assert read_plant_map(single, DATED)[0].dates == (first,)


def test_several_plots_in_a_file_are_several_maps(tmp_path):
    columns = MapColumns("row", "plant", "state", 1.0, 1.0, part="field")
    rows = ["F1\t1\t1\tY", "F1\t1\t2\tN", "F2\t1\t1\tN"]
    made = read_plant_map(write(tmp_path / "p.txt", "field\trow\tplant\tstate", *rows), columns)
    assert [each.name for each in made] == ["p F1", "p F2"]
    assert [each.infested.tolist() for each in made] == [[[True, False]], [[False]]]


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        (["row,plant,state", "1,1,1"], "year is missing"),
        (["row,plant,year,state", "x,1,2001,1"], "whole numbers"),
        (["row,plant,year,state", "0,1,2001,1"], "from 1"),
        (["row,plant,year,state", "99999,99999,2001,1"], "at most"),
        (["row,plant,year,state", "1.5,1,2001,1"], r"whole numbers .* holds '1\.5'\. Positions"),
        (["row,plant,year,state", f"{10**20},1,2001,1"], "whole numbers"),
        (["row,plant,year,state", "1,1,2001,-1"], "holds '-1'"),
        (["row,plant,year,state", "1,1,2001,perhaps"], "holds 'perhaps'"),
        (["row,plant,year,state", "1,1,1,1", "2,2,1,0"], r"row 1, plant 2 on 1 has 0\. Write NA"),
        (["row,plant,year,state", "1,1,1,1", "1,1,1,0"], "row 1, plant 1 on 1 has 2"),
    ],
)
def test_files_that_are_no_maps_are_refused_in_a_sentence(tmp_path, lines, says):
    with pytest.raises(FileProblem, match=says):
        read_plant_map(write(tmp_path / "a.csv", *lines), DATED)


def test_a_folder_without_maps_is_refused(tmp_path):
    with pytest.raises(FileProblem, match="hold a map"):
        read_plant_maps(tmp_path)
    with pytest.raises(FileProblem, match=r"a folder that exists, but .*none does not exist"):
        read_plant_maps(tmp_path / "none")
    file = write(tmp_path / "a.map.csv", "row")
    with pytest.raises(FileProblem, match=r"a folder that exists, but .*a\.map\.csv is a file"):
        read_plant_maps(file)


def test_known_maps_are_found_by_name_in_folders(tmp_path):
    (tmp_path / "deep").mkdir()
    name = next(iter(PUBLIC_MAPS))
    write(tmp_path / "deep" / name, "x,y,t,i", "1,1,1991,1", "2,1,1991,0")
    write(tmp_path / "other.csv", "a", "b")
    (made,) = read_plant_maps(tmp_path)
    assert made.name == "deep/citrus_ctv_IVI3and4"
    assert made.infested.tolist() == [[True, False]]


@pytest.mark.parametrize(
    ("state", "infested"),
    [("0.0", False), ("0", False), ("clean", False), ("N", False), ("0%", False), ("-", False),
     ("3", True), ("0.5", True), ("infested", True), ("Y", True), ("12%", True), ("+", True)]
    + [(unknown, None) for unknown in ("NA", "", ".", "?", "null", "nd", "missing", "dead",
                                       "skipped", "gone", "-9999")],
)  # fmt: skip
def test_a_state_is_a_number_or_a_word_as_in_records(tmp_path, state, infested):
    lines = f"1;1.0;2001;{state}", "1;2;2001;+"
    (made,) = read_plant_map(write(tmp_path / "a.csv", "row;plant;year;state", *lines), DATED)
    assert made.known.tolist() == [[infested is not None, True]]
    assert made.infested.tolist() == [[bool(infested), True]]


OWN = ("row,plant,infested,row_m,plant_m,plot,date", "1,1,1,3.5,1.2,A,2025", "1,1,0,3.5,1.2,B,2025")


def test_a_map_of_ones_own_is_read_with_its_distances(tmp_path):
    write(tmp_path / "vines.map.csv", *OWN)
    write(tmp_path / "other.csv", *OWN)
    made = read_plant_maps(tmp_path)
    assert [each.name for each in made] == ["vines A", "vines B"]
    assert (made[0].row_m, made[0].plant_m, made[0].dates) == (3.5, 1.2, ("2025",))
    assert [each.infested.tolist() for each in made] == [[[True]], [[False]]]


def test_maps_are_called_by_their_folder_and_all_of_their_name(tmp_path):
    for name in ("a/field", "b/field", "block.1", "block.2"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        write(tmp_path / f"{name}.map.csv", OWN[0], OWN[1])
    names = [each.name_on("2025") for each in read_plant_maps(tmp_path)]
    assert names == ["a/field A 2025", "b/field A 2025", "block.1 A 2025", "block.2 A 2025"]


def test_tables_that_are_not_read_are_named(tmp_path):
    write(tmp_path / "vines.map.CSV", *OWN)
    write(tmp_path / "citrus_ctv_IVI3and4.csv", "x,y,t,i", "1,1,1991,1")
    assert [each.name for each in read_plant_maps(tmp_path, ())] == ["vines A", "vines B"]
    said = "Not read as a map: citrus_ctv_IVI3and4.csv (1). A map of your own is called"
    assert not_read(tmp_path, ()).startswith(said)
    assert not_read(tmp_path) == ""
    write(tmp_path / "north.csv", *OWN)
    (tmp_path / "east.map.xlsx").touch()
    (tmp_path / "README.md").touch()
    assert not_read(tmp_path).startswith("Not read as maps: east.map.xlsx, north.csv (2). A map")


def test_a_map_without_a_name_is_refused(tmp_path):
    write(tmp_path / ".map.csv", *OWN)
    with pytest.raises(FileProblem, match=r"must have a name, as NAME\.map\.csv, but .* none"):
        read_plant_maps(tmp_path)


def test_two_maps_of_one_name_are_refused(tmp_path):
    write(tmp_path / "north A.map.csv", *(line.replace(",A,", ",B,") for line in OWN[:2]))
    write(tmp_path / "north.map.csv", *(line.replace(",A,", ",A B,") for line in OWN[:2]))
    with pytest.raises(FileProblem, match=r"different names, .* 2 are called 'north A B 2025'"):
        read_plant_maps(tmp_path)


def test_a_map_is_read_with_decimal_commas_and_columns_in_any_case(tmp_path):
    lines = ["ROW;Plant;infested;row_M;plant_m", "1;1;0,5;2,5;1,25", "1;2;0,0;2,5;1,25"]
    write(tmp_path / "vines.map.csv", *lines)
    (made,) = read_plant_maps(tmp_path)
    assert (made.row_m, made.plant_m) == (2.5, 1.25)
    assert made.infested.tolist() == [[True, False]]


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ([OWN[0], OWN[1].replace("1.2", "wide")], "one distance in metres, .* it holds wide"),
        ([OWN[0], OWN[1].replace("1.2", "")], "it holds an empty cell"),
        (["row,plant,infested", "1,1,1"], "row_m, plant_m are missing"),
        ([*OWN[:2], OWN[2].replace("3.5", "3.6")], r"one distance .* it holds 3\.5, 3\.6"),
        ([OWN[0], OWN[1].replace("1.2", "0")], "one distance in metres"),
        ([OWN[0], OWN[1].replace("3.5", "350")], r"row_m of vines.map.csv must be .* it is 350\."),
        ([OWN[0], OWN[1].replace("1.2", "0.01")], "plant_m .* must be 0.05 to 1000 m.* it is 0.01"),
    ],
)
def test_a_map_of_ones_own_that_lacks_something_is_a_sentence(tmp_path, lines, says):
    write(tmp_path / "vines.map.csv", *lines)
    with pytest.raises(FileProblem, match=says):
        read_plant_maps(tmp_path)
