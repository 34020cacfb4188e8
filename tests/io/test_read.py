"""Ordinary files of every kind come in through the same doors."""

import io
import zipfile

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
from shapely import LineString, MultiPolygon, Point, Polygon, box

from fieldmon.errors import ChoiceNeeded, FileProblem, ObservationError
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.options import PlotOptions, RecordOptions, Upload
from fieldmon.io.read import list_layers, read_lines, read_plants, read_plots, read_records
from fieldmon.plot.field import Field

PARAN = (35.1500, 30.3600)
SQUARE = box(35.15, 30.36, 35.152, 30.362)
NAMES = ["חלקה א", "חלקה ב"]


def two_plots():
    shapes = [SQUARE, box(35.154, 30.36, 35.156, 30.362)]
    return gpd.GeoDataFrame({"name": NAMES}, geometry=shapes, crs=4326)


def packed(folder, arcname=""):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for path in sorted(folder.iterdir()):
            archive.write(path, f"{arcname}{path.name}")
    return data.getvalue()


def assert_two_plots(imported, tolerance=1e-8):
    fields = {field.name: field for field in imported.value}  # FlatGeobuf sorts by place
    assert set(fields) == set(NAMES)
    bounds = fields[NAMES[0]].boundary.bounds
    np.testing.assert_allclose(bounds, SQUARE.bounds, atol=tolerance)
    assert isinstance(imported.value[0].boundary, MultiPolygon)


@pytest.mark.parametrize("ending", ["shp", "gpkg", "geojson", "fgb", "kml", "gml", "parquet"])
@pytest.mark.parametrize("crs", [4326, 2039])
def test_plots_come_in_from_every_format_and_system(tmp_path, ending, crs):
    if ending == "kml" and crs != 4326:
        pytest.skip("KML is always WGS 84")
    path = tmp_path / f"plots.{ending}"
    frame = two_plots().to_crs(crs)
    if ending == "parquet":
        frame.to_parquet(path)
    else:
        frame.to_file(path, driver={"kml": "LIBKML", "gml": "GML"}.get(ending))
    tolerance = 1e-8 if crs == 4326 else 2e-8
    assert_two_plots(read_plots(path), tolerance)
    if ending != "shp":
        assert_two_plots(read_plots(Upload(path.name, path.read_bytes())), tolerance)


def test_a_zipped_shapefile_with_a_folder_inside_comes_in_from_bytes(tmp_path):
    two_plots().to_crs(2039).to_file(tmp_path / "plots.shp", encoding="utf-8")
    assert_two_plots(read_plots(Upload("estate.zip", packed(tmp_path, "estate/2026/"))), 2e-8)


def test_the_parts_of_a_shapefile_can_be_uploaded_side_by_side(tmp_path):
    two_plots().to_file(tmp_path / "plots.shp", encoding="utf-8")
    parts = tuple(Upload(p.name, p.read_bytes()) for p in sorted(tmp_path.iterdir()))
    assert_two_plots(read_plots(parts))


def test_one_plot_of_several_is_chosen_by_name_or_number(tmp_path):
    path = tmp_path / "plots.gpkg"
    two_plots().to_file(path)
    for feature in (NAMES[1], 2, "2", "ב"):
        (field,) = read_plots(path, PlotOptions(feature=feature)).value
        assert field.name == NAMES[1]
    with pytest.raises(ChoiceNeeded, match="Choose one of") as asked:
        read_plots(path, PlotOptions(feature="none such"))
    assert (asked.value.option, asked.value.choices) == ("feature", tuple(NAMES))


def test_several_layers_are_asked_for_and_listed(tmp_path):
    path = tmp_path / "estate.gpkg"
    two_plots().to_file(path, layer="peppers")
    two_plots().to_file(path, layer="vines")
    with pytest.raises(ChoiceNeeded) as asked:
        read_plots(path)
    assert (asked.value.option, asked.value.choices) == ("layer", ("peppers", "vines"))
    assert_two_plots(read_plots(path, PlotOptions().choose("layer", "vines")))
    assert [info.layer for info in list_layers(path)] == ["peppers", "vines"]
    assert "season" not in str(asked.value)
    for name in ("fieldmon", "batches", "inspections"):
        two_plots().to_file(path, layer=name)
    with pytest.raises(ChoiceNeeded, match="as the file of a season"):
        read_plots(path)


RECORDS = "longitude,latitude,date,count,species\n" + "\n".join(
    f"{35.1501 + i * 1e-4:.6f},30.3601,2026-03-0{i + 1},{count},T. urticae"
    for i, count in enumerate([3, 0, "NA"])
)


def test_records_come_in_from_csv_with_zero_apart_from_missing():
    records = read_records(Upload("mites.csv", RECORDS.encode())).value
    np.testing.assert_allclose(records.lonlat[1], (35.1502, 30.3601), atol=1e-12)
    assert records.present.tolist() == [PRESENT, ABSENT, UNKNOWN]
    np.testing.assert_array_equal(records.count, [3, 0, np.nan])
    assert records.day.astype(str).tolist() == ["2026-03-01", "2026-03-02", "2026-03-03"]
    assert records.species[0] == "T. urticae"


def test_records_come_in_from_excel_and_from_vector_files(tmp_path):
    table = pd.read_csv(io.StringIO(RECORDS))
    table.to_excel(tmp_path / "mites.xlsx", index=False)
    points = gpd.points_from_xy(table.longitude, table.latitude)
    layer = gpd.GeoDataFrame(table[["date", "count", "species"]], geometry=points, crs=4326)
    layer.to_crs(2039).to_file(tmp_path / "mites.gpkg")
    layer.to_crs(2039).to_file(tmp_path / "mites.shp")
    layer.to_file(tmp_path / "mites.geojson")
    for name in ("mites.xlsx", "mites.gpkg", "mites.shp", "mites.geojson"):
        records = read_records(tmp_path / name).value
        np.testing.assert_allclose(records.lonlat[0], (35.1501, 30.3601), atol=2e-8)
        assert records.day.astype(str).tolist() == ["2026-03-01", "2026-03-02", "2026-03-03"]
        assert records.present.tolist()[:2] == [PRESENT, ABSENT]


def test_darwin_core_names_are_known():
    text = (
        "scientificName,decimalLatitude,decimalLongitude,coordinateUncertaintyInMeters,eventDate,"
        "individualCount,occurrenceStatus,lifeStage\n"
        "Tetranychus urticae,30.360123,35.150123,4,2026-03-01T08:00:00Z,,absent,adult\n"
    )
    records = read_records(Upload("dwc.csv", text.encode())).value
    np.testing.assert_allclose(records.lonlat[0], (35.150123, 30.360123))
    assert records.present.tolist() == [ABSENT]
    assert (records.accuracy_m[0], records.stage[0]) == (4.0, "adult")


def test_projected_columns_need_a_system_and_land_with_it():
    point = gpd.GeoSeries([Point(PARAN)], crs=4326).to_crs(2039)[0]
    data = Upload("itm.csv", f"x,y,count\n{point.x},{point.y},4\n".encode())
    with pytest.raises(ChoiceNeeded) as asked:
        read_records(data, RecordOptions(country="Israel"))
    assert asked.value.option == "crs"
    assert asked.value.choices[0] == "EPSG:2039"
    records = read_records(data, RecordOptions(crs="EPSG:2039")).value
    np.testing.assert_allclose(records.lonlat[0], PARAN, atol=1e-8)


def test_columns_can_be_named_by_hand():
    data = Upload("odd.csv", b"a;b;c;d\n30,3601;35,1501;7;01.03.2026\n30,3602;35,1502;0;17.03.2026")
    options = RecordOptions().naming(lat="a", lon="b", count="c", date="d")
    records = read_records(data, options).value
    np.testing.assert_allclose(records.lonlat[0], (35.1501, 30.3601))
    assert records.count.tolist() == [7, 0]
    assert records.day.astype(str).tolist() == ["2026-03-01", "2026-03-17"]


def test_records_elsewhere_are_kept_apart_and_told():
    plot = Field("home", MultiPolygon([SQUARE]))
    far = RECORDS + "\n35.3,30.36,2026-03-05,1,T. urticae"
    imported = read_records(Upload("mites.csv", far.encode()), near=plot)
    assert len(imported.value) == 3
    assert any("1 of 4 records lies outside home" in f.sentence for f in imported.messages)
    with pytest.raises(ObservationError, match="km away"):
        read_records(Upload("m.csv", b"lon,lat,count\n34.8,31.2,1"), near=plot)
    with pytest.raises(ChoiceNeeded) as asked:
        read_records(Upload("m.csv", b"lon,lat,count\n30.361,35.151,1"), near=plot)
    assert (asked.value.option, asked.value.choices) == ("swap_axes", ("yes",))


def test_plants_and_lines_come_in(tmp_path):
    points = [Point(35.15 + i * 1e-5, 30.36) for i in range(3)]
    gpd.GeoDataFrame({"row": [1, 1, 2], "plant": [1, 2, 1]}, geometry=points, crs=4326).to_file(
        tmp_path / "plants.gpkg"
    )
    plants = read_plants(tmp_path / "plants.gpkg").value
    assert plants.row.tolist() == ["1", "1", "2"]
    np.testing.assert_allclose(plants.lonlat[2], (35.15002, 30.36))
    line = LineString([PARAN, (35.151, 30.361)])
    gpd.GeoSeries([line], crs=4326).to_file(tmp_path / "road.geojson")
    lines = read_lines(tmp_path / "road.geojson").value
    np.testing.assert_allclose(lines.geoms[0].coords[1], (35.151, 30.361))


def test_lines_and_points_are_offered_as_what_they_can_be(tmp_path):
    gpd.GeoSeries([Point(PARAN)], crs=4326).to_file(tmp_path / "points.geojson")
    with pytest.raises(ChoiceNeeded, match="point") as asked:
        read_plots(tmp_path / "points.geojson")
    assert (asked.value.option, asked.value.choices) == ("kind", ("plants",))


def test_a_bow_tie_is_repaired_and_said(tmp_path):
    tie = Polygon([(35.15, 30.36), (35.152, 30.362), (35.152, 30.36), (35.15, 30.362)])
    gpd.GeoDataFrame({"name": ["tie"]}, geometry=[tie], crs=4326).to_file(tmp_path / "t.geojson")
    imported = read_plots(tmp_path / "t.geojson")
    assert imported.value[0].boundary.is_valid
    assert len(imported.value[0].boundary.geoms) == 2
    assert any("outline crosses itself" in f.sentence for f in imported.messages)


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("none.geojson", b'{"type":"FeatureCollection","features":[]}', "but it is empty"),
        ("empty.csv", b"", "is empty"),
        ("cut.geojson", b'{"type":"FeatureCollection","features":[', "breaks off"),
        ("page.kml", b"<!DOCTYPE html><html></html>", "web page"),
        ("old.xls", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "workbook of Excel or LibreOffice"),
        ("noise.gpkg", b"SQLite format 3\x00" + b"\x01" * 4000, "cannot be read"),
    ],
)
def test_unusable_files_are_refused_with_a_sentence(name, data, said):
    with pytest.raises(FileProblem, match=said):
        read_plots(Upload(name, data))


def test_a_missing_path_is_said():
    with pytest.raises(FileProblem, match="there is none"):
        read_plots("/no/such/file.gpkg")
