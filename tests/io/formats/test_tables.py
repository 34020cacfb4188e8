"""Text tables and workbooks in the dialects in which people save them."""

import csv
import io

import openpyxl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.tables import read_sheet, read_text_table
from fieldmon.io.formats.workbooks import sheet_names
from fieldmon.io.options import ReadOptions
from tests.io.tables_of_cells import sentences

LETTERS = st.characters(codec="utf-8", exclude_categories=("Cs", "Cc", "Zs"))
WORDS = st.text(LETTERS, min_size=1, max_size=8)


def read(folder, content, **options):
    path = folder / "table.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_text_table(path, "table", ReadOptions(**options))


def rows_of(layer):
    return [list(layer.columns), *map(list, zip(*layer.columns.values(), strict=True))]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(WORDS, WORDS, WORDS), min_size=3, max_size=6), st.sampled_from(",;\t|"))
def test_cells_come_back_whatever_parts_them_and_stands_in_them(tmp_path, rows, mark):
    written = io.StringIO(newline="")
    csv.writer(written, delimiter=mark).writerows([("lon", "lat", "count"), *rows])
    layer = read(tmp_path, written.getvalue())
    assert rows_of(layer) == [["lon", "lat", "count"], *map(list, rows)]


@pytest.mark.parametrize(
    "content",
    [
        "lon,lat\n1,2\n",
        "lon;lat\r\n1;2\r\n",
        "sep=|\nlon|lat\n1|2\n",
        "\ufefflon\tlat\n1\t2\n",
        '"lon","lat"\n" 1 ","2"\n\n,\n',
    ],
)
def test_dialects_come_to_the_same(tmp_path, content):
    assert rows_of(read(tmp_path, content)) == [["lon", "lat"], ["1", "2"]]


def test_a_mark_told_by_hand_is_taken(tmp_path):
    content = "a;b,c\n1;2,3\n"
    assert list(read(tmp_path, content, delimiter=";").columns) == ["a", "b,c"]
    assert list(read(tmp_path, content, delimiter=",").columns) == ["a;b", "c"]


def test_lines_of_title_above_the_names_are_passed_over_and_said(tmp_path):
    layer = read(tmp_path, "Estate Paran\nspring 2026\nlon,lat,count\n35,30,4\n")
    assert rows_of(layer) == [["lon", "lat", "count"], ["35", "30", "4"]]
    assert "2 lines above the column names were passed over" in sentences(layer)


def test_the_last_remark_as_wide_as_a_table_names_its_columns_and_the_others_stand_above(tmp_path):
    layer = read(tmp_path, "# a; b; c;\n# x = one, two, 3\n# STN,date,T\n#\n260,2026-11-18,5\n")
    assert rows_of(layer) == [["# STN", "date", "T"], ["260", "2026-11-18", "5"]]
    assert layer.above == "# a; b; c;\n# x = one, two, 3"
    assert layer.take([0]).above == layer.above


def test_numbers_with_a_hash_are_no_remarks(tmp_path):
    layer = read(tmp_path, "#,lon,lat\n#1,35,30\n#2,36,31\n3,37,32\n")
    assert rows_of(layer)[0] == ["#", "lon", "lat"]
    assert len(layer) == 3


def test_a_table_begins_below_two_lines_about_its_place(tmp_path):
    layer = read(tmp_path, "latitude,longitude\n30,35\n\ntime,a (C),b (mm)\n2026-11-18,1,2\n")
    assert rows_of(layer) == [["time", "a (C)", "b (mm)"], ["2026-11-18", "1", "2"]]
    # records after an empty line are records
    assert len(read(tmp_path, "lat,lon\n30,35\n\n31,36\n32,37\n")) == 3


@pytest.mark.parametrize("again", ["lon,lat,count", "Lon,LAT,", ",lat,mites"])
def test_a_line_that_repeats_the_names_is_left_out_and_said(tmp_path, again):
    layer = read(tmp_path, f"lon,lat,count\n35,30,4\n{again}\n36,31,5\n")
    assert rows_of(layer)[1:] == [["35", "30", "4"], ["36", "31", "5"]]
    assert "1 line that repeats the column names was left out" in sentences(layer)
    assert len(read(tmp_path, "name,result\nlat,found\nrow,clean\n")) == 2


def test_names_in_two_lines_are_read_as_of_one(tmp_path):
    names = ["date", "lat", "lon", "count", "eggs"]
    for above in ("date,position,,mites,", "date,,,mites,", "date,aa,bb,mites,"):
        layer = read(tmp_path, f"{above}\n,lat,lon,count,eggs\n2026-10-01,30,35,0,1\n")
        assert rows_of(layer) == [names, ["2026-10-01", "30", "35", "0", "1"]]


def test_columns_without_a_name_are_numbered_and_repeated_ones_told_apart(tmp_path):
    layer = read(tmp_path, "lon,,lat,lon\n1,2,3,4\n5\n")
    assert rows_of(layer) == [
        ["lon", "column 2", "lat", "lon_2"],
        ["1", "2", "3", "4"],
        ["5", None, None, None],
    ]


def test_cells_beyond_the_last_column_are_left_out_and_said(tmp_path):
    layer = read(tmp_path, "lon,lat\n1,2,3\n4,5,\n")
    assert rows_of(layer)[1:] == [["1", "2"], ["4", "5"]]
    assert "1 line has more cells" in sentences(layer)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"\n \n", "line of column names"),
        (b"lon,lat\n\n", "records below its column names"),
        (b"lon,lat\n1,\x00\n", "no text"),
        (b'sep=,\nlon,lat\n"1,2\n3,4\n', "table, line 3: a quote"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path, content, says):
    with pytest.raises(FileProblem, match=says):
        read(tmp_path, content)


def a_workbook(path):
    book = openpyxl.Workbook()
    book.active.title = "plots"
    book.active.append(["name", None, "area"])
    book.active.append(["north", None, 2.5])
    book.active.append([None, None, None])
    book.create_sheet("empty")
    book.save(path)
    return path


def test_a_sheet_is_read_with_its_numbers_as_numbers(tmp_path):
    path = a_workbook(tmp_path / "b.xlsx")
    assert sheet_names(path, "b") == ("plots", "empty")
    layer = read_sheet(path, "b", "plots", ReadOptions())
    assert rows_of(layer) == [["name", "column 2", "area"], ["north", None, 2.5]]


def test_a_sheet_that_there_is_not_is_a_question(tmp_path):
    with pytest.raises(ChoiceNeeded, match="no sheet 'rows'") as asked:
        read_sheet(a_workbook(tmp_path / "b.xlsx"), "b", "rows", ReadOptions())
    assert (asked.value.option, asked.value.choices) == ("layer", ("plots", "empty"))


def test_a_workbook_that_is_none_is_refused(tmp_path):
    (tmp_path / "b.xlsx").write_bytes(b"PK\x03\x04 no workbook")
    with pytest.raises(FileProblem, match="must be a workbook of Excel"):
        sheet_names(tmp_path / "b.xlsx", "b")


def test_columns_of_one_name_are_told_apart_and_said(tmp_path):
    layer = read(tmp_path, "lon,lat,count,count\n1,2,3,4\n")
    assert list(layer.columns) == ["lon", "lat", "count", "count_2"]
    assert "Several columns are called count" in sentences(layer.messages)
    assert "Several" not in sentences(read(tmp_path, "lon,lat,,\n1,2,3,4\n").messages)
