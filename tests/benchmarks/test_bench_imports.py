"""Imports that must be quick: many records, many plots, and one plot with far too many corners."""

import geopandas as gpd
import numpy as np
import pytest
from shapely import Polygon, box

from fieldmon.io.read import read_plots, read_records
from fieldmon.io.sandbox import process

ONCE = {"rounds": 3, "iterations": 1, "warmup_rounds": 1}


@pytest.fixture(autouse=True)
def warm():
    process.warm()


def records(folder):
    rng = np.random.default_rng(7)
    n = 100_000
    lon, lat = 35.15 + rng.random(n) / 100, 30.36 + rng.random(n) / 100
    day = np.datetime64("2026-03-01") + rng.integers(0, 90, n)
    count = rng.poisson(0.4, n)
    path = folder / "mites.csv"
    rows = zip(lon, lat, day.astype(str), count, strict=True)
    text = "".join(f"{x:.7f},{y:.7f},{d},{c},T. urticae\n" for x, y, d, c in rows)
    path.write_text("longitude,latitude,date,count,species\n" + text)
    return path, lon, lat


def test_bench_100_000_records(benchmark, tmp_path):
    path, lon, lat = records(tmp_path)
    read = benchmark.pedantic(read_records, (path,), **ONCE).value
    np.testing.assert_allclose(read.lonlat[[0, -1]], [(lon[0], lat[0]), (lon[-1], lat[-1])], 1e-6)


@pytest.mark.parametrize("ending", ["shp", "gpkg", "geojson"])
def test_bench_1_000_polygons(benchmark, tmp_path, ending):
    corners = [(35.0 + i % 40 / 100, 30.0 + i // 40 / 100) for i in range(1000)]
    rings = [box(x, y, x + 0.005, y + 0.005).segmentize(0.0001) for x, y in corners]
    names = [f"plot {i}" for i in range(1000)]
    frame = gpd.GeoDataFrame({"name": names}, geometry=rings, crs=4326).to_crs(2039)
    frame.to_file(tmp_path / f"plots.{ending}")
    read = benchmark.pedantic(read_plots, (tmp_path / f"plots.{ending}",), **ONCE).value
    assert len(read) == 1000
    np.testing.assert_allclose(read[999].boundary.bounds[:2], corners[999], atol=1e-6)


@pytest.mark.parametrize("ending", ["shp", "gpkg", "geojson"])
def test_bench_11_157_polygons(benchmark, tmp_path, ending):
    rng = np.random.default_rng(0)
    rings = []
    for lon, lat in rng.uniform((3, 44), (4, 45), (11_157, 2)):
        angle = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(5, 60)))
        far = rng.uniform(0.0005, 0.001, len(angle))
        rings.append(Polygon(np.stack([lon + far * np.cos(angle), lat + far * np.sin(angle)], 1)))
    gpd.GeoDataFrame(geometry=rings, crs=4326).to_file(tmp_path / f"plots.{ending}")
    read = benchmark.pedantic(read_plots, (tmp_path / f"plots.{ending}",), **ONCE)
    assert len(read.value) == 11_157
    assert len(read.messages) < 12


@pytest.mark.parametrize("ending", ["gpkg", "geojson"])
@pytest.mark.parametrize("crosses", [False, True], ids=["valid", "a bow-tie"])
def test_bench_a_polygon_of_two_million_corners(benchmark, tmp_path, ending, crosses):
    t = np.linspace(0, 2 * np.pi, 2_000_001)[:-1]
    waves = 1 + 0.1 * np.sin(1000 * t)
    x, y = waves * np.cos(t), waves * np.sin(2 * t if crosses else t)
    plot = Polygon(np.column_stack([35.15 + x / 100, 30.36 + y / 100]))
    gpd.GeoSeries([plot], crs=4326).to_file(tmp_path / f"p.{ending}")
    once = {"rounds": 1, "iterations": 1, "warmup_rounds": 0}
    (read,) = benchmark.pedantic(read_plots, (tmp_path / f"p.{ending}",), **once).value
    np.testing.assert_allclose(read.boundary.bounds, plot.bounds, atol=1e-8)
