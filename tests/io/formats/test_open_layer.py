"""From a source and what was chosen to one layer, or to the question which."""

import io
import json
import re
import zipfile

import geopandas as gpd
import pandas as pd
import pyogrio
import pytest
from shapely import Point

from fieldmon.errors import ChoiceNeeded, FieldmonError, FileProblem
from fieldmon.io.formats.open_layer import layers_of, open_layer
from fieldmon.io.options import PlotOptions, ReadOptions, Upload
from fieldmon.io.readers.plots import plots_of
from fieldmon.io.sandbox.workroom import Workroom
from tests.io.tables_of_cells import sentences

POINTS = gpd.GeoDataFrame({"name": ["a", "b"]}, geometry=[Point(1, 2), Point(3, 4)], crs=4326)
NOTHING = ReadOptions()


@pytest.fixture
def room(tmp_path):
    (tmp_path / "room").mkdir()
    return Workroom(tmp_path / "room")


def zipped(**contents):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, content in contents.items():
            archive.writestr(name.replace("__", "."), content)
    return Upload("estate.zip", data.getvalue())


@pytest.mark.parametrize("ending", ["geojson", "gpkg", "fgb", "parquet", "csv", "xlsx", "shp"])
def test_the_one_layer_of_a_file_is_opened_whatever_its_kind(tmp_path, room, ending):
    path = tmp_path / f"x.{ending}"
    if ending == "csv":
        pd.DataFrame({"name": ["a", "b"], "lat": [2, 4]}).to_csv(path, index=False)
    elif ending == "xlsx":
        pd.DataFrame({"name": ["a", "b"], "lat": [2, 4]}).to_excel(path, index=False)
    elif ending == "parquet":
        POINTS.to_parquet(path)
    else:
        POINTS.to_file(path)
    layer = open_layer(path, NOTHING, room)
    assert sorted(layer.columns["name"].tolist()) == ["a", "b"]
    assert (layer.geometry is None) == (ending in {"csv", "xlsx"})
    (listed,) = layers_of(path, room)
    assert listed.member == path.name


def estate(tmp_path, *names):
    path = tmp_path / "estate.gpkg"
    for name in names:
        POINTS.to_file(path, layer=name)
    return path


def test_of_several_layers_one_is_asked_for(tmp_path, room):
    path = estate(tmp_path, "peppers", "vines")
    with pytest.raises(ChoiceNeeded) as asked:
        open_layer(path, NOTHING, room)
    assert (asked.value.option, asked.value.choices) == ("layer", ("peppers", "vines"))
    assert len(open_layer(path, ReadOptions(layer="vines"), room)) == 2
    with pytest.raises(ChoiceNeeded, match="none is called 'wheat'"):
        open_layer(path, ReadOptions(layer="wheat"), room)
    assert [info.layer for info in layers_of(path, room)] == ["peppers", "vines"]


def test_the_only_layer_with_anything_in_it_is_read_and_that_is_said(tmp_path, room):
    path = estate(tmp_path, "vines")
    POINTS.iloc[:0].to_file(path, layer="empty")
    layer = open_layer(path, NOTHING, room)
    assert len(layer) == 2
    assert "Layer vines was read; 1 other holds nothing." in sentences(layer)


def test_layers_that_hold_nothing_are_refused(tmp_path, room):
    path = tmp_path / "x.gpkg"
    for name in ("a", "b"):
        POINTS.iloc[:0].to_file(path, layer=name)
    with pytest.raises(FileProblem, match="something in it, but holds none"):
        open_layer(path, NOTHING, room)


def test_a_plain_table_beside_maps_is_read_only_by_its_name(tmp_path, room):
    path = estate(tmp_path, "vines")
    pyogrio.write_dataframe(pd.DataFrame({"n": [1, 2, 3]}), path, layer="notes", append=True)
    assert len(open_layer(path, NOTHING, room)) == 2
    assert len(open_layer(path, ReadOptions(layer="notes"), room)) == 3


def test_of_an_archive_maps_come_before_tables_and_tables_before_notes(room):
    point = POINTS.to_json()
    table = "lon,lat\n1,2\n"
    several = zipped(plots__geojson=point, list__csv=table, readme__txt="a b\nc d\n")
    assert open_layer(several, NOTHING, room).geometry is not None
    tables = zipped(list__csv=table, readme__txt="a b\nc d\n")
    assert list(open_layer(tables, NOTHING, room).columns) == ["lon", "lat"]
    notes = zipped(readme__txt="lon lat\n1 2\n")
    assert len(open_layer(notes, NOTHING, room)) == 1


def test_of_several_files_one_is_asked_for_and_named(room):
    both = zipped(a__geojson=POINTS.to_json(), b__geojson=POINTS.iloc[:1].to_json())
    with pytest.raises(ChoiceNeeded) as asked:
        open_layer(both, NOTHING, room)
    assert (asked.value.option, asked.value.choices) == ("member", ("a.geojson", "b.geojson"))
    assert len(open_layer(both, ReadOptions(member="b.geojson"), room)) == 1


def test_features_are_chosen_before_anything_else_is_done(tmp_path, room):
    POINTS.to_file(tmp_path / "x.geojson")
    layer = open_layer(tmp_path / "x.geojson", ReadOptions(where="name=b"), room)
    assert [g.x for g in layer.geometry] == [3.0]


def test_a_raster_alone_holds_no_plots(room):
    with pytest.raises(FileProblem, match="is a raster"):
        open_layer(Upload("x.tif", b"II*\x00" + b"\x00" * 40), NOTHING, room)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("foo.geojson", '{"type": "Feature"'),
        ("foo.geojson", '{"type": "FeatureCollection", "features": []}'),
        ("foo.csv", "lon;lat\n"),
        ("foo.csv", "lon;lat;plot\n35.1;30.1;a\n35.2;30.2;a\n"),
        ("TASKDATA.XML", "<ISO11783_TaskData>"),
        ("foo.gpx", '<gpx version="1.1"><wpt lat="1" lon="2"/><wpt'),
    ],
    ids=["broken json", "empty", "no records", "no area", "isoxml", "gpx"],
)
def test_a_sentence_names_the_file_as_it_is_called(name, text, room):
    """foo.csv and foo.geojson would read alike otherwise."""
    with pytest.raises(FieldmonError) as problem:
        plots_of(open_layer(Upload(name, text.encode()), NOTHING, room), PlotOptions())
    assert re.search(rf"(^|[^\w.]){re.escape(name)}\b", str(problem.value)), problem.value


def test_a_plot_is_called_as_its_file_without_the_ending(room):
    square = [[35.0, 30.0], [35.001, 30.0], [35.001, 30.001], [35.0, 30.001], [35.0, 30.0]]
    data = {"type": "Polygon", "coordinates": [square]}
    layer = open_layer(Upload("foo.geojson", json.dumps(data).encode()), NOTHING, room)
    (plot,) = plots_of(layer, PlotOptions()).value
    assert plot.name == "foo"


@pytest.mark.parametrize(
    "bad",
    [
        {"a.docx": b"PK\x03\x04junk", "b.pdf": b"%PDF-1.4", "c.csv": b""},
        {"a.geojson": b"{", "b.geojson": b"[", "c.pdf": b"%PDF-1.4"},
        {"a.geojson": b"{", "b.pdf": b"%PDF-1.4"},
    ],
)
def test_of_several_bad_files_brought_at_once_all_are_named(room, bad):
    with pytest.raises(FileProblem) as refused:
        open_layer(tuple(Upload(*one) for one in bad.items()), NOTHING, room)
    said = str(refused.value)
    assert [name for name in bad if said.count(f"{name} ") == 1] == [*bad]


def test_of_many_bad_files_the_first_ten_are_named_and_the_rest_counted(room):
    bad = tuple(Upload(f"{n}.pdf", b"%PDF-1.4") for n in range(12))
    with pytest.raises(FileProblem, match="2 more files cannot be read"):
        open_layer(bad, NOTHING, room)


def test_a_bad_file_beside_several_good_ones_leaves_them_a_question(room):
    good = POINTS.to_json().encode()
    files = (Upload("a.geojson", b"{"), Upload("b.geojson", good), Upload("c.geojson", good))
    with pytest.raises(ChoiceNeeded, match="holds 3 files"):
        open_layer(files, NOTHING, room)
