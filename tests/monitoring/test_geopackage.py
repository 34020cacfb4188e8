"""Geometries as GeoPackages hold them, in and out, bit for bit."""

import sqlite3
from contextlib import closing

import numpy as np
import pyogrio
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from shapely import LineString, MultiPolygon, Point, box

from fieldmon.monitoring import geopackage
from fieldmon.monitoring.geopackage import (
    GeoPackageTable,
    blob,
    geometry,
    insert,
    point_blobs,
    touch,
)

TABLE = GeoPackageTable("spots", ("number INTEGER", "name TEXT NOT NULL"), "POINT", "Some spots.")
degrees = st.floats(-180.0, 180.0)


@given(st.integers(0, 20).flatmap(lambda n: arrays(np.float64, (n, 2), elements=degrees)))
def test_points_written_together_are_those_written_one_by_one(lonlat):
    assert point_blobs(lonlat) == [blob(Point(x, y)) for x, y in lonlat.tolist()]


@pytest.mark.parametrize(
    "shape",
    [
        Point(35.15, 30.36),
        LineString([(0, 0), (1.1, 2.2)]),
        MultiPolygon([box(0, 0, 1, 1).difference(box(0.2, 0.2, 0.3, 0.3))]),
        Point(),
        MultiPolygon(),
    ],
    ids=lambda shape: shape.geom_type,
)
def test_a_geometry_comes_back_bit_for_bit_and_says_whether_it_is_empty(shape):
    packed = blob(shape)
    assert shapely.to_wkb(geometry(packed)) == shapely.to_wkb(shape)
    assert (packed[:3], bool(packed[3] & 0x10)) == (b"GP\x00", shape.is_empty)
    assert int.from_bytes(packed[4:8], "little") == 4326


@pytest.mark.parametrize(("code", "length"), [(1, 32), (2, 48), (3, 48), (4, 64)])
def test_geometries_of_other_programs_are_read_whatever_envelope_they_have(code, length):
    packed = b"GP\x00" + bytes([0x01 | code << 1]) + (4326).to_bytes(4, "little")
    shape = LineString([(0, 0), (1, 2)])
    assert geometry(packed + b"\x00" * length + shapely.to_wkb(shape)).equals(shape)


@pytest.fixture
def spots(tmp_path):
    path = tmp_path / "spots.gpkg"
    with closing(sqlite3.connect(path, isolation_level=None)) as db:
        geopackage.found(db)
        geopackage.create(db, TABLE)
        insert(db, TABLE, [(blob(Point(35.0, 30.0)), 7, "a"), (None, 8, "b")])
        touch(db, "spots", (35.0, 30.0, 35.0, 30.0))
    return path


def test_gdal_reads_what_was_written_and_where_it_is(spots):
    frame = pyogrio.read_dataframe(spots, layer="spots")
    assert frame["number"].tolist() == [7, 8]
    assert frame.geometry.iloc[0].equals(Point(35.0, 30.0))
    assert frame.geometry.iloc[1] is None
    assert frame.crs.to_epsg() == 4326
    info = pyogrio.read_info(spots, layer="spots")
    assert info["total_bounds"] == (35.0, 30.0, 35.0, 30.0)


def test_a_table_names_its_geometry_first():
    assert TABLE.names == ("geom", "number", "name")
    assert GeoPackageTable("notes", ("text TEXT",), None, "Notes.").names == ("text",)
