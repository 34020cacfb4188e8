"""What comes back from the field finds its plants, once, whatever it is written in."""

import json
import re

import geopandas as gpd
import numpy as np
import pandas as pd
import pyogrio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldmon.errors import ChoiceNeeded, FieldmonError, FileProblem, ObservationError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED
from fieldmon.io.formats.layer import Layer
from fieldmon.io.import_report import Severity
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspection_file.rows import rows_in
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspections import dated, look_up, read_inspections
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.layout import rectangle

GRID = rectangle(6, 10)


def upload(text, name="found.csv"):
    return Upload(name, text.encode())


def read(text, options=None, grid=GRID, name="found.csv"):
    return read_inspections(upload(text, name), grid, options)


def when(inspections):
    """Return local times, datetime64[s]; NaT where there is none."""
    since = np.where(np.isnan(inspections.second), 0, inspections.second).astype("timedelta64[s]")
    noted = inspections.date.astype("datetime64[s]") + since
    return np.where(np.isnan(inspections.second), np.datetime64("NaT"), noted)


def test_counts_alone_say_whether_and_how_many():
    findings = read("plant,count\n1,0\n2,4\n3,<5\n4,\n5,2-6\n").value
    assert findings.plant.tolist() == [1, 2, 3, 5]
    assert findings.result.tolist() == [CLEAN, FOUND, FOUND, FOUND]
    np.testing.assert_array_equal(findings.count, [np.nan, 4, np.nan, np.nan])


def test_what_inspections_find_is_read_with_each_and_may_be_left_out():
    said = read("plant,found,detects\n1,yes,0.3\n2,no,\n3,no,0.84\n").value
    assert said.detects.tolist()[::2] == [0.3, 0.84]
    assert np.isnan(said.detects[1])
    assert np.isnan(read("plant,found\n1,yes\n").value.detects[0])
    # as a spreadsheet saves it where decimals have a comma
    said = read("plant;found;detects\n1;yes;0,375\n2;no;0,3\n").value
    assert said.detects.tolist() == [0.375, 0.3]
    # whether something was detected is a result, as ever
    assert read("plant,detection\n1,yes\n2,no\n").value.result.tolist() == [FOUND, CLEAN]


@pytest.mark.parametrize("cell", ["30", "30 %", "0", "-0.3", "1.01", "often", "inf"])
def test_what_is_no_chance_to_see_anything_is_refused_with_file_record_and_value(cell):
    with pytest.raises(ObservationError) as refused:
        read(f"plant,found,detects\n1,yes,0.3\n2,no,{cell}\n", name="rex.csv")
    said = str(refused.value)
    assert "must be above 0, and 1 at most" in said
    assert f"record 2 of rex.csv says {cell!r}" in said


def test_result_and_count_that_contradict_are_left_out_unless_one_asks():
    text = "plant,found,count\n1,clean,4\n2,7,0\n3,,0\n4,skipped,0\n5,clean,0\n6,,3\n"
    imported = read(text)
    assert imported.value.plant.tolist() == [4, 5, 6]
    assert imported.value.result.tolist() == [SKIPPED, CLEAN, FOUND]
    doubts = imported.of(Severity.DOUBTFUL)
    assert [f.feature for f in doubts] == ["record 1", "record 2", "record 3"]
    assert {f.remedy.option for f in doubts} == {"take_doubtful"}
    taken = read(text, InspectionOptions().choose("take_doubtful", "yes")).value
    assert taken.result.tolist() == [FOUND, FOUND, CLEAN, SKIPPED, CLEAN, FOUND]
    np.testing.assert_array_equal(taken.count[:2], [4, np.nan])
    asked = read("plant,found,count\n1,found,0\n").value
    assert (asked.result.tolist(), np.isnan(asked.count).tolist()) == ([FOUND], [True])


def test_plants_are_named_by_row_and_number_in_every_dialect():
    for text in (
        "row,number,found\n2,3,x\n",
        "row;plant;found\n2;3;x\n",
        "שורה\tעץ\tנמצא\n2\t3\tכן\n",
        "Reihe;Pflanze;Befall\n2;3;ja\n",
        "plant,found\nR2/3,x\n",
        "No,row,plant,found\n1,2,3,x\n",
        "row,nr,found\n2,3,x\n",
    ):
        findings = read(text).value
        numbered = plant_numbers(GRID, findings.plant)
        assert (numbered.line.tolist(), numbered.number.tolist()) == ([2], [3])


# --- times -------------------------------------------------------------------------------------


def test_without_a_time_the_day_is_the_planned_one_or_the_one_told():
    told = InspectionOptions(day=np.datetime64("2026-11-20"))
    planned = read("plant,arrive,found\n7,2026-11-18T08:30:00,x\n8,,x\n", told).value
    assert np.isnan(planned.second).all()
    assert planned.date.astype(str).tolist() == ["2026-11-18", "2026-11-20"]
    assert np.isnat(read("plant,found\n7,x\n").value.date).all()
    dated = read("plant,found,date\n7,x,17.11.2026\n", told).value
    assert np.isnan(dated.second).all()
    assert dated.date.astype(str).tolist() == ["2026-11-17"]


# --- the same finding --------------------------------------------------------------------------


# --- the formats -------------------------------------------------------------------------------

TABLE = pd.DataFrame(
    {
        "plant": [7, 8, 9, 10],
        "result": ["found", "clean", None, "not inspected"],
        "count": [3.0, np.nan, np.nan, np.nan],
        "who": ["נועה", "נועה", None, None],
        "notes": ["leaf", None, None, "thorns"],
        "time": ["2026-11-18T08:30:00", "2026-11-18T08:31:00", None, None],
    }
)


def layer():
    lonlat = GRID.lonlat(TABLE.plant.to_numpy())
    return gpd.GeoDataFrame(TABLE, geometry=gpd.points_from_xy(*lonlat.T), crs=4326)


def assert_table(findings):
    assert findings.plant.tolist() == [7, 8, 10]
    assert findings.result.tolist() == [FOUND, CLEAN, SKIPPED]
    np.testing.assert_array_equal(findings.count, [3, np.nan, np.nan])
    assert findings.who.tolist() == ["נועה", "נועה", ""]
    assert findings.notes.tolist() == ["leaf", "", "thorns"]
    assert when(findings).astype(str).tolist()[:2] == TABLE.time.tolist()[:2]


@pytest.mark.parametrize("ending", ["csv", "tsv", "xlsx", "geojson", "gpkg", "shp"])
def test_findings_come_in_from_every_format(tmp_path, ending):
    path = tmp_path / f"found.{ending}"
    if ending == "xlsx":
        TABLE.to_excel(path, index=False)
    elif ending in {"csv", "tsv"}:
        path.write_text(TABLE.to_csv(index=False, sep="," if ending == "csv" else "\t"))
    else:
        layer().to_file(path)
    assert_table(read_inspections(path, GRID).value)


@pytest.mark.parametrize("ending", ["xlsx", "gpkg", "geojson", "parquet"])
def test_a_day_is_no_time_in_formats_that_store_it_with_one(tmp_path, ending):
    frame = layer()[["plant", "result", "geometry"]].assign(date=pd.Timestamp("2026-11-18"))
    path = tmp_path / f"found.{ending}"
    if ending == "xlsx":
        pd.DataFrame(frame.drop(columns="geometry")).to_excel(path, index=False)
    elif ending == "parquet":
        frame.to_parquet(path)
    else:
        frame.to_file(path)
    read = read_inspections(path, GRID, InspectionOptions(zone="America/Los_Angeles")).value
    assert np.isnan(read.second).all()
    assert set(read.date.astype(str).tolist()) == {"2026-11-18"}


def test_an_edited_layer_is_found_among_the_others_of_a_project(tmp_path):
    path = tmp_path / "season.gpkg"
    frame = layer()
    frame[["plant", "geometry"]].to_file(path, layer="rows")
    frame.assign(result=None, count=np.nan).to_file(path, layer="inspections")
    frame.to_crs(2039).to_file(path, layer="plants")
    assert_table(read_inspections(path, GRID).value)
    named = InspectionOptions(layer="inspections")
    unknown = read_inspections(path, GRID, named)
    assert len(unknown.value) == 0
    assert any("2 records have a note, but no result" in f.sentence for f in unknown.messages)


def test_a_season_file_edited_in_qfield_gives_what_was_added_and_not_what_was_undone(tmp_path):
    path = tmp_path / "season.gpkg"
    lonlat = GRID.lonlat(np.array([7, 8, 9]))
    kept = pd.DataFrame(
        {
            "plant": pd.Series([7, 8, None], dtype="Int32"),
            "line": pd.Series([1, 1, None], dtype="Int32"),
            "number": pd.Series([8, 9, None], dtype="Int32"),
            "day": pd.Series([0, 0, None], dtype="Int32"),
            "date": pd.to_datetime(["2026-11-18", "2026-11-18", "2026-11-19"]),
            "time": ["08:30:00", None, "09:15"],
            "result": ["clean", "found", "found"],
            "count": [None, 3, 2],
            "undone": [0, 1, 0],
        }
    )
    shapes = gpd.points_from_xy(*lonlat.T)
    bare = gpd.GeoDataFrame(
        {"plant": [7, 8, 9], "line": 1, "number": [8, 9, 10]}, geometry=shapes, crs=4326
    )
    bare.to_file(path, layer="plants")
    bare.to_file(path, layer="stops")
    gpd.GeoDataFrame(kept, geometry=shapes, crs=4326).to_file(path, layer="inspections")
    findings = read_inspections(path, GRID).value
    assert findings.plant.tolist() == [7, 9]
    assert when(findings).astype(str).tolist() == ["2026-11-18T08:30:00", "2026-11-19T09:15:00"]
    emptied = tmp_path / "emptied.gpkg"
    bare.to_file(emptied, layer="stops")
    gpd.GeoDataFrame(kept[:0], geometry=[], crs=4326).to_file(emptied, layer="inspections")
    bare.assign(result=["found", None, None]).to_file(emptied, layer="plants")
    assert read_inspections(emptied, GRID).value.plant.tolist() == [7]


def test_a_table_without_shapes_is_read_where_it_is_named(tmp_path):
    path = tmp_path / "season.gpkg"
    layer()[["plant", "geometry"]].to_file(path, layer="plots")
    pyogrio.write_dataframe(TABLE, path, layer="inspections", append=True)
    assert_table(read_inspections(path, GRID).value)


def test_waypoints_are_read_by_their_names():
    names = ["+3", "-", "+", "0", "clean", "found", "001", "R1/9 +2", "Gate", "not inspected"]
    xy = GRID.lonlat(np.array([*range(20, 27), 9, 28, 29]))  # R1/9 was taken one plant further on
    points = "".join(
        f'<wpt lat="{lat:.9f}" lon="{lon:.9f}"><time>2026-11-18T06:30:00Z</time>'
        f"<name>{name}</name><desc>by the dripper</desc></wpt>"
        for name, (lon, lat) in zip(names, xy, strict=True)
    )
    gpx = f'<gpx xmlns="http://www.topografix.com/GPX/1/1" version="1.1" creator="x">{points}</gpx>'
    imported = read(gpx, InspectionOptions(zone="+02:00"), name="way.gpx")
    findings = imported.value
    assert findings.plant.tolist() == [20, 21, 22, 23, 24, 25, 8, 29]
    assert findings.result.tolist() == [
        *(FOUND, CLEAN, FOUND, CLEAN, CLEAN, FOUND, FOUND, SKIPPED),
    ]
    np.testing.assert_array_equal(findings.count, [3, *[np.nan] * 5, 2, np.nan])
    assert set(when(findings).astype(str)) == {"2026-11-18T08:30:00"}
    assert any(
        "2 of 10 records left unknown: no result in the name" in f.sentence
        for f in imported.messages
    )


def test_a_file_that_says_nothing_of_findings_asks_for_its_columns():
    with pytest.raises(ChoiceNeeded, match="what was found") as asked:
        read("plant,height\n7,3\n")
    assert (asked.value.option, asked.value.choices) == (
        "columns",
        ("present=height", "count=height"),
    )
    named = InspectionOptions().choose("columns", "present=height")
    assert read("plant,height\n7,3\n", named).value.plant.tolist() == [7]
    with pytest.raises(ChoiceNeeded, match="which plants"):
        read("found,colour\nyes,red\n")


@given(st.binary(max_size=300))
@settings(max_examples=25)
def test_any_bytes_end_in_findings_or_in_a_sentence(data):
    refused = []
    for start in (b"", b"plant,found\n", b'{"type":"FeatureCollection","features":['):
        try:
            findings = read_inspections(Upload("found.csv", start + data), GRID).value
        except (ChoiceNeeded, FileProblem) as problem:
            refused.append(str(problem))
            continue
        assert (findings.plant >= 0).all()
        assert (findings.plant < len(GRID)).all()
    assert all(one.endswith((".", "?")) for one in refused)


def test_geojson_properties_of_every_type_are_read():
    features = [
        {
            "type": "Feature",
            "geometry": None,
            "properties": {"plant": plant, "found": found, "count": count},
        }
        for plant, found, count in ((1, True, 2), ("2", False, None), (3.0, 1, None), (4, None, 0))
    ]
    text = json.dumps({"type": "FeatureCollection", "features": features})
    findings = read(text, InspectionOptions(take_doubtful=True), name="a.geojson").value
    assert findings.plant.tolist() == [1, 2, 3, 4]
    assert findings.result.tolist() == [FOUND, CLEAN, FOUND, CLEAN]


CELLS = st.one_of(
    st.none(),
    st.sampled_from(["", "x", "+", "-", "0", "1e400", "inf", "nan", "-3", "24:61", "99/99/2026"]),
    st.sampled_from(["2026-11-18T08:30:00+25:00", "31.12.2026 8:30 pm", "12345.678", "R1/2b"]),
    st.sampled_from([True, 3, -1, 2**40, 35.0, 0.5, float("inf")]),
    st.text(max_size=8),
)
COLUMNS = (
    *("plant", "row", "number", "lon", "lat", "accuracy", "found", "count", "time", "date", "face"),
    *("name", "arrive", "who", "notes", "x", "y", "position"),
)


@given(
    st.dictionaries(st.sampled_from(COLUMNS), st.lists(CELLS, min_size=3, max_size=3), min_size=1),
    st.booleans(),
)
def test_whatever_stands_in_cells_ends_in_findings_or_in_a_sentence(columns, take_doubtful):
    cells = {name: np.array(values, dtype=object) for name, values in columns.items()}
    options = InspectionOptions(zone="+02:00", take_doubtful=take_doubtful)
    try:
        reported = rows_in(Layer("cells", cells), options).value
        findings, said = look_up(reported, GRID, options)
    except FieldmonError as problem:
        sentences = [str(problem)]
    else:
        sentences = [finding.sentence for finding in said]
        assert len(findings) <= 3
        assert ((findings.plant >= 0) & (findings.plant < len(GRID))).all()
        assert set(findings.result.tolist()) <= {FOUND, CLEAN, SKIPPED}
    assert all(one.endswith((".", "?")) for one in sentences)


def test_a_record_without_a_date_is_left_out_and_said_where_others_have_one():
    brought = dated(read("plant,result,date\n1,found,2026-04-06\n2,clean,\n3,clean,2026-04-07\n"))
    assert brought.value.plant.tolist() == [1, 3]
    assert any("1 record has no date" in str(one) for one in brought.messages)
    none = read("plant,result\n1,found\n")
    assert dated(none) is none
    unread = read(
        "plant,result,date\n1,found,5 xyz 2026\n2,clean,June 10th\n",
        InspectionOptions(work_day=np.datetime64("2026-06-10")),
    )
    said = "2 records have a date that is none (record 1: '5 xyz 2026', record 2: 'June 10th')"
    with pytest.raises(ObservationError, match=re.escape(said)):
        dated(unread)


def test_a_file_that_contradicts_itself_says_with_which_records_and_what_became_of_all():
    told = read("row,plant,found,confidence\n1,1,x,.3\n1,2,no,.9\n1,1,no,.8\n99,1,no,.2\n")
    said = [message.sentence for message in told.messages]
    shown = (
        "In this file 1 plant is both found and clean on one day: row 1, plant 1 (records 1, 3)."
    )
    assert shown in said
    assert "Of 4 records 3 were taken, of 2 plants; 1 was left out." in said
    assert "It is not used: each record counts in full as its result says." in said


def test_what_became_of_all_records_adds_up_to_the_rows_of_the_file():
    lines = ["1,1,no,P", "1,2,no,P", "1,3,no,P", "1,4,,P", "1,5,,P", "99,1,no,P", "1,7,no,Q"]
    text = "\n".join(["row,plant,found,plot", *lines])
    told = read_inspections(upload(text), GRID, InspectionOptions(), ("P",))
    (said,) = [one.sentence for one in told.messages if one.sentence.startswith("Of ")]
    assert said == "Of 7 records 3 were taken, of 3 plants; 2 were left out, and 2 say no result."


@pytest.mark.parametrize("elsewhere", [7, 8])
def test_several_species_are_a_question(elsewhere):
    text = "plant,date,species,count\n7,2026-11-18,mite,3\n{},2026-11-18,thrips,1\n"
    with pytest.raises(ChoiceNeeded, match="but column 'species' names 2: mite, thrips") as asked:
        read(text.format(elsewhere))
    assert asked.value.choices == ("species=mite", "species=thrips")
    options = InspectionOptions().choose(asked.value.option, asked.value.choices[0])
    assert read(text.format(elsewhere), options).value.plant.tolist() == [7]
    spelt = read(text.format(elsewhere).replace("thrips", "Mites"))
    assert spelt.value.plant.tolist() == [7, elsewhere]
    assert any("Mites and mite were taken for one pest" in m.sentence for m in spelt.messages)
    as_one = read(text.format(elsewhere), InspectionOptions().choose("columns", "species="))
    assert as_one.value.plant.tolist() == [7, elsewhere]
