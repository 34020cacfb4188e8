"""What a file says row by row, and which of its layers it says it in."""

import geopandas as gpd
import numpy as np
import pytest
from shapely import LineString, MultiPoint, Point

from fieldmon.errors import ChoiceNeeded
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.formats.layer import Layer
from fieldmon.io.readers.inspection_file.rows import rows_in, rows_of
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.sandbox.workroom import Workroom
from tests.io.tables_of_cells import column, sentences, table

NOTHING = InspectionOptions()


def test_only_rows_that_say_anything_are_kept_with_their_numbers_in_the_file():
    read = rows_in(
        table(plant=[7, 8, 9], found=["x", None, "no"], who=["Noa", "Noa", None]), NOTHING
    )
    rows = read.value
    assert rows.plant.tolist() == [7, 9]
    assert rows.result.tolist() == [PRESENT, ABSENT]
    assert rows.who.tolist() == ["Noa", ""]
    assert rows.source_row.tolist() == [1, 3]
    columns = [column for column in vars(rows).values() if isinstance(column, np.ndarray)]
    assert {len(column) for column in columns} == {2}
    assert rows.n_silent == 1
    assert "1 of 3 records left unknown: not filled in" in sentences(read)


@pytest.mark.parametrize("column", ["stop", "arrive_s"])
def test_results_without_times_come_in_the_order_of_stops_unless_lines_have_times(column):
    cells = {"plant": [7, 8, 9], "found": ["x", "no", "no"], column: [30.5, 4.25, 12.5]}
    rows = rows_in(table(**cells), NOTHING).value
    assert rows.plant.tolist() == [8, 9, 7]
    assert rows.source_row.tolist() == [2, 3, 1]
    timed = table(**cells, time=["08:00", None, None], date=["2026-11-30"] * 3)
    assert rows_in(timed, NOTHING).value.plant.tolist() == [7, 8, 9]
    days = table(**cells, date=["2026-11-29", "2026-11-30", "2026-11-30"])
    assert rows_in(days, NOTHING).value.plant.tolist() == [7, 8, 9]


def test_a_result_that_cannot_be_read_is_not_said_to_be_empty():
    said = sentences(rows_in(table(plant=[7, 8, 9], found=["maybe", None, "no"]), NOTHING))
    assert "1 record says neither clean nor found" in said
    assert "1 of 3 records left unknown: not filled in." in said
    said = sentences(rows_in(table(plant=[7, 9], found=["maybe", "no"]), NOTHING))
    assert "not filled in" not in said


@pytest.mark.parametrize("word", ["gone", "Pulled out", "arrancada", "נעקר"])
def test_a_plant_that_is_gone_could_not_be_inspected_and_its_note_says_why(word):
    cells = {"found": [word, "skipped", "no", word], "notes": [None, "locked", None, "rotten"]}
    read = rows_in(table(plant=[6, 7, 8, 9], **cells), NOTHING)
    assert read.value.result.tolist() == [UNKNOWN, UNKNOWN, ABSENT, UNKNOWN]
    assert read.value.notes.tolist() == ["gone", "locked", "", "gone: rotten"]
    assert not any("neither clean nor found" in said for said in sentences(read))


def test_a_note_without_a_result_is_doubtful():
    read = rows_in(table(plant=[7, 8], found=[None, "no"], notes=["thorns", None]), NOTHING)
    assert len(read.value) == 1
    assert "1 record has a note, but no result" in sentences(read)


def test_what_a_season_marks_as_undone_is_passed_over():
    layer = table(plant=[7, 8, 9], result=["found"] * 3, undone=[0, 1, None])
    assert rows_in(layer, NOTHING).value.plant.tolist() == [7, 9]


def test_the_driven_line_of_a_file_given_out_is_passed_over():
    shapes = column([LineString([(35, 30), (35.1, 30.1)]), Point(35, 30)])
    cells = table(plant=[None, 7], found=[None, "x"])
    read = rows_in(Layer("route", cells.columns, shapes, "OGC:CRS84"), NOTHING)
    assert read.value.plant.tolist() == [7]
    assert "1 line beside the points" in sentences(read)


def test_each_of_several_points_in_one_record_is_a_record_and_that_is_said():
    shapes = column([MultiPoint([(35, 30), (35.1, 30.1)]), Point(35, 30.2), MultiPoint([(36, 31)])])
    cells = table(found=["x", "no", "no"])
    read = rows_in(Layer("q", cells.columns, shapes, "OGC:CRS84"), NOTHING)
    assert read.value.lonlat.tolist() == [[35, 30], [35.1, 30.1], [35, 30.2], [36, 31]]
    assert read.value.result.tolist() == [PRESENT, PRESENT, ABSENT, ABSENT]
    assert "1 record holds several points: each was taken as a record." in sentences(read)


@pytest.fixture
def room(tmp_path):
    (tmp_path / "room").mkdir()
    return Workroom(tmp_path / "room")


def season(path, **layers):
    """Write layers of plants 7 to 9 with results, or None for a layer without any."""
    for name, results in layers.items():
        frame = gpd.GeoDataFrame({"plant": [7, 8, 9]}, geometry=[Point(35, 30)] * 3, crs=4326)
        if results is not None:
            frame["result"] = results
        frame.to_file(path, layer=name)
    return path


def test_of_the_layers_given_out_the_first_that_reports_anything_is_read(tmp_path, room):
    path = season(
        tmp_path / "s.gpkg",
        plots=None,
        plants=["found", None, None],
        inspections=[None, None, None],
        stops=["clean", "found", None],
    )
    read = rows_of(path, NOTHING, room)
    assert read.value.plant.tolist() == [7, 8]
    assert "read from layer stops" in sentences(read)


def test_a_layer_named_by_hand_is_read_whatever_the_others_say(tmp_path, room):
    path = season(tmp_path / "s.gpkg", plants=["found", None, None], stops=["clean"] * 3)
    named = rows_of(path, InspectionOptions(layer="plants"), room)
    np.testing.assert_array_equal(named.value.result, [PRESENT])


def test_where_none_of_ours_reports_anything_the_first_of_them_is_read(tmp_path, room):
    path = season(tmp_path / "s.gpkg", stops=[None] * 3, plants=[None] * 3)
    read = rows_of(path, NOTHING, room)
    assert len(read.value) == 0
    assert "3 of 3 records left unknown: not filled in" in sentences(read)


def test_layers_of_others_are_asked_for(tmp_path, room):
    path = season(tmp_path / "s.gpkg", north=["found"] * 3, south=["clean"] * 3)
    with pytest.raises(ChoiceNeeded) as asked:
        rows_of(path, NOTHING, room)
    assert asked.value.option == "layer"
