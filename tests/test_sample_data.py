"""The made-up estate is what its script draws, and looks like an estate."""

import importlib.util
import itertools
import zipfile
from pathlib import Path

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
import rasterio

HERE = Path(__file__).resolve().parents[1] / "sample_data"
SHAPEFILE = HERE / "paran_estate.zip"


@pytest.fixture(scope="module")
def plots():
    return gpd.read_file(SHAPEFILE)


@pytest.fixture(scope="module")
def drawn_again(tmp_path_factory):
    folder = tmp_path_factory.mktemp("estate")
    spec = importlib.util.spec_from_file_location("make", HERE / "make.py")
    make = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(make)
    make.main(folder)
    return folder


@pytest.mark.parametrize(
    "name", ["paran_estate.geojson", "tracks.geojson", "gates.geojson", "mite_records.csv"]
)
def test_the_script_draws_the_same_text_again(drawn_again, name):
    assert (drawn_again / name).read_bytes() == (HERE / name).read_bytes()


def test_the_script_draws_the_same_shapefile_and_picture_again(drawn_again):
    with zipfile.ZipFile(SHAPEFILE) as ours, zipfile.ZipFile(drawn_again / SHAPEFILE.name) as again:
        assert ours.namelist() == again.namelist()
        assert ours.read("paran_estate.shp") == again.read("paran_estate.shp")
        assert ours.read("paran_estate.dbf") == again.read("paran_estate.dbf")
    with (
        rasterio.open(HERE / "backdrop.tif") as ours,
        rasterio.open(drawn_again / "backdrop.tif") as again,
    ):
        assert ours.transform == again.transform
        assert np.abs(ours.read().astype(int) - again.read()).mean() < 1.0


def test_plots_are_valid_apart_from_each_other_and_of_likely_sizes(plots):
    assert plots.crs == "EPSG:2039"
    assert plots.is_valid.all()
    assert not any(a.intersects(b) for a, b in itertools.combinations(plots.geometry, 2))
    hectares = plots.area / 1e4
    assert 0.25 < hectares.min() < 0.5
    assert 9 < hectares.max() < 11


def test_shapes_hold_a_hole_and_two_parts(plots):
    shapes = plots.set_index("name").geometry
    assert len(shapes["Pond"].interiors) == 1
    assert len(shapes["Two halves"].geoms) == 2


def test_hebrew_names_survive_in_both_formats(plots):
    other = gpd.read_file(HERE / "paran_estate.geojson")
    assert plots["name_he"].tolist() == other["name_he"].tolist()
    assert plots["name_he"][0] == "שער"


def test_both_formats_lie_in_the_same_place(plots):
    other = gpd.read_file(HERE / "paran_estate.geojson").to_crs(2039)
    assert plots.geometry.hausdorff_distance(other.geometry).max() < 0.02


def test_records_lie_on_the_plots_they_name(plots):
    table = pd.read_csv(HERE / "mite_records.csv")
    points = gpd.GeoSeries.from_xy(table.longitude, table.latitude, crs=4326).to_crs(2039)
    named = gpd.GeoSeries(plots.set_index("name").geometry[table["plot"]].to_numpy(), crs=2039)
    assert points.within(named).mean() > 0.95
    assert points.distance(named).max() < 20


def test_mites_spread_in_two_plots_and_hardly_anywhere_else():
    table = pd.read_csv(HERE / "mite_records.csv")
    found = (table["count"] > 0).groupby(table["plot"]).mean()
    assert found[["Gate", "Terrace"]].min() > 0.15
    assert found.drop(["Gate", "Terrace"]).max() < 0.05
    gate = table[table["plot"] == "Gate"].groupby("date")["count"].sum()
    assert gate.iloc[-3:].mean() > gate.iloc[:3].mean()


def test_everything_says_that_it_is_made_up(plots):
    assert plots["note"].str.contains("made up").all()
    assert "made-up" in (HERE / "README.md").read_text(encoding="utf-8")
