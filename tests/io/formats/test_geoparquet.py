"""GeoParquet comes in with its system; a plain table of Parquet does not."""

import json

import geopandas as gpd
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pyproj
import pytest
from shapely import Point

from fieldmon.errors import FileProblem
from fieldmon.io.formats.geoparquet import read_parquet
from fieldmon.io.sandbox import limits

FRAME = gpd.GeoDataFrame(
    {"name": ["a", None], "day": pd.to_datetime(["2026-04-06", None]).date},
    geometry=[Point(1, 2), None],
    crs=2039,
)


def with_metadata(path, **changes):
    """Write the frame with some of its geographic metadata changed, or taken away (None)."""
    FRAME.to_parquet(path)
    table = pq.read_table(path)
    geo = json.loads(table.schema.metadata[b"geo"])
    for name, value in changes.items():
        if value is None:
            geo["columns"]["geometry"].pop(name)
        else:
            geo["columns"]["geometry"][name] = value
    metadata = table.schema.metadata | {b"geo": json.dumps(geo).encode()}
    pq.write_table(table.replace_schema_metadata(metadata), path)
    return path


def test_a_file_comes_with_its_shapes_its_cells_and_its_system(tmp_path):
    FRAME.to_parquet(tmp_path / "x.parquet")
    layer = read_parquet(tmp_path / "x.parquet", "x")
    assert layer.geometry[0].equals(Point(1, 2))
    assert layer.geometry[1] is None
    assert layer.columns["name"].tolist() == ["a", None]
    assert layer.columns["day"].tolist() == ["2026-04-06", None]
    assert pyproj.CRS(layer.crs).to_epsg() == 2039


def test_without_a_system_stated_it_is_wgs84(tmp_path):
    assert read_parquet(with_metadata(tmp_path / "x.parquet", crs=None), "x").crs == "OGC:CRS84"


def test_a_system_that_is_null_is_unknown(tmp_path):
    FRAME.set_crs(None, allow_override=True).to_parquet(tmp_path / "x.parquet")
    assert read_parquet(tmp_path / "x.parquet", "x").crs is None


def test_geometry_in_another_encoding_is_refused(tmp_path):
    path = with_metadata(tmp_path / "x.parquet", encoding="point")
    with pytest.raises(FileProblem, match="written as WKB, but it is point"):
        read_parquet(path, "x")


def test_a_table_without_geometry_is_refused(tmp_path):
    pq.write_table(pa.table({"a": [1]}), tmp_path / "x.parquet")
    with pytest.raises(FileProblem, match="names no column with geometry"):
        read_parquet(tmp_path / "x.parquet", "x")


def test_what_is_no_parquet_is_refused(tmp_path):
    (tmp_path / "x.parquet").write_bytes(b"PAR1 and nothing more")
    with pytest.raises(FileProblem, match="whole GeoParquet"):
        read_parquet(tmp_path / "x.parquet", "x")


def test_more_rows_than_may_be_are_refused(tmp_path, monkeypatch):
    FRAME.to_parquet(tmp_path / "x.parquet")
    monkeypatch.setattr(limits, "FEATURES", 1)
    with pytest.raises(FileProblem, match="1 features at most"):
        read_parquet(tmp_path / "x.parquet", "x")
