"""GeoJSON feature by feature: what is good comes in, what is bad is named."""

import json

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from shapely import (
    GeometryCollection,
    LineString,
    MultiLineString,
    MultiPoint,
    MultiPolygon,
    Point,
    box,
)

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.geojson import read_geojson
from tests.io.tables_of_cells import sentences

HOLED = box(0, 0, 4, 4).difference(box(1, 1, 2, 2))


def read(folder, root):
    path = folder / "x.geojson"
    path.write_text(root if isinstance(root, str) else json.dumps(root), encoding="utf-8")
    return read_geojson(path, "x", None)


def feature(shape, **properties):
    stated = None if shape is None else json.loads(shapely.to_geojson(shape))
    return {"type": "Feature", "geometry": stated, "properties": properties}


def collection(*features, **members):
    return {"type": "FeatureCollection", "features": [*features]} | members


@pytest.mark.parametrize(
    "shape",
    [
        Point(1, 2),
        MultiPoint([(1, 2), (3, 4)]),
        LineString([(0, 0), (1, 1)]),
        MultiLineString([[(0, 0), (1, 1)], [(2, 2), (3, 3)]]),
        HOLED,
        MultiPolygon([HOLED, box(9, 9, 10, 10)]),
        GeometryCollection([Point(1, 2), box(0, 0, 1, 1)]),
        Point(1, 2, 3),
    ],
    ids=lambda shape: shape.geom_type,
)
def test_every_kind_of_geometry_comes_back_as_it_was(tmp_path, shape):
    layer = read(tmp_path, collection(feature(shape)))
    assert shapely.to_wkb(layer.geometry[0]) == shapely.to_wkb(shape)
    assert layer.crs == "OGC:CRS84"


def test_a_collection_a_feature_a_geometry_a_list_and_lines_of_them_are_the_same(tmp_path):
    one = feature(Point(1, 2), name="a")
    for root in (collection(one), one, [one], json.dumps(one) + "\n" + json.dumps(one)):
        layer = read(tmp_path, root)
        assert layer.geometry[0].equals(Point(1, 2))
        assert layer.columns["name"][0] == "a"
    assert len(read(tmp_path, "\x1e" + json.dumps(one) + "\n\x1e" + json.dumps(one) + "\n")) == 2
    assert read(tmp_path, one["geometry"]).geometry[0].equals(Point(1, 2))


def test_a_broken_feature_is_left_out_by_its_number_and_the_rest_is_kept(tmp_path):
    bad = [
        {"type": "Polygon", "coordinates": [[[0, 0], [1, "x"]]]},
        {"type": "Point", "coordinates": [1]},
        {"type": "Circle", "coordinates": [1, 2]},
        {"type": "Polygon"},
    ]
    features = [feature(Point(1, 2)), *({"geometry": g} for g in bad), feature(None)]
    layer = read(tmp_path, collection(*features))
    assert [g is None for g in layer.geometry] == [False, *[True] * 5]
    assert [m.feature for m in layer.messages] == [f"feature {i}" for i in range(2, 6)]


def test_properties_become_columns_with_what_a_feature_lacks_missing(tmp_path):
    layer = read(
        tmp_path,
        collection(
            feature(Point(1, 2), n=1, tags=["a"]),
            feature(Point(1, 2), name="ע") | {"id": 7},
            {"geometry": None, "properties": None},
        ),
    )
    assert layer.columns["n"].tolist() == [1, None, None]
    assert layer.columns["tags"].tolist() == ['["a"]', None, None]
    assert layer.columns["name"].tolist() == [None, "ע", None]
    assert layer.columns["id"].tolist() == [None, 7, None]


def test_a_system_is_taken_as_it_is_stated(tmp_path):
    named = {"type": "name", "properties": {"name": "EPSG:2039"}}
    assert read(tmp_path, collection(feature(Point(1, 2)), crs=named)).crs == "EPSG:2039"
    unknown = read(tmp_path, collection(feature(Point(1, 2)), crs={"type": "name"}))
    assert unknown.crs is None
    assert "unknown" in sentences(unknown)
    with pytest.raises(ChoiceNeeded, match="another file or address") as asked:
        read(tmp_path, collection(crs={"type": "link"}))
    assert asked.value.option == "crs"


@pytest.mark.parametrize(
    ("root", "says"),
    [
        ('{"type": "FeatureCollection", "features": [', "breaks off"),
        ("7", "holds no object"),
        ({"type": "Topology"}, "TopoJSON"),
        ({"geometryType": "esriGeometryPolygon"}, "Esri JSON"),
        ({"type": "Feat"}, "type is 'Feat'"),
        ("[" * 100_000, "beyond reason|breaks off"),
    ],
)
def test_what_is_no_geojson_is_refused_with_what_it_is(tmp_path, root, says):
    with pytest.raises(FileProblem, match=says):
        read(tmp_path, root)


points = st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=3)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(points, min_size=2, max_size=8))
def test_lines_keep_every_corner_with_or_without_heights(tmp_path, corners):
    stated = {"type": "LineString", "coordinates": corners}
    (line,) = read(tmp_path, stated).geometry
    flat = np.array([corner[:2] for corner in corners])
    np.testing.assert_array_equal(shapely.get_coordinates(line), flat)
