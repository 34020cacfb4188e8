"""The made-up estate is what its script draws, and looks like an estate."""

import importlib.util
import itertools
import json
import sys
import zipfile

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
import rasterio
import rasterio.features
import shapely

from tests.paths import SAMPLE_DATA

HERE = SAMPLE_DATA
SHAPEFILE = HERE / "paran_estate.zip"
HEBREW = {
    "Gate": "שער",
    "Pond": "בריכה",
    "Wadi": "ואדי",
    "Big field": "השדה הגדול",
    "Elbow": "מרפק",
    "Terrace": "טרסה",
    "Two halves": "שני חצאים",
    "Bend": "עיקול",
    "Nursery": "משתלה",
}
INFESTED = ["Gate", "Terrace"]


@pytest.fixture(scope="module")
def plots():
    return gpd.read_file(SHAPEFILE).set_index("name")


@pytest.fixture(scope="module")
def degrees():
    return gpd.read_file(HERE / "paran_estate.geojson").set_index("name")


@pytest.fixture(scope="module")
def records():
    table = pd.read_csv(HERE / "mite_records.csv", parse_dates=["date"])
    points = gpd.points_from_xy(table.longitude, table.latitude, crs=4326)
    return gpd.GeoDataFrame(table, geometry=points).to_crs(2039)


@pytest.fixture(scope="module")
def drawn_again(tmp_path_factory):
    folder = tmp_path_factory.mktemp("estate")
    spec = importlib.util.spec_from_file_location("make_sample_data", HERE / "make.py")
    make = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = make
    spec.loader.exec_module(make)
    make.main(folder)
    return folder


@pytest.mark.parametrize(
    "name", ["paran_estate.geojson", "tracks.geojson", "gates.geojson", "mite_records.csv"]
)
def test_the_script_draws_the_same_text_again(drawn_again, name):
    assert (drawn_again / name).read_bytes() == (HERE / name).read_bytes()


def test_the_script_draws_the_same_shapefile_again(drawn_again):
    with zipfile.ZipFile(SHAPEFILE) as ours, zipfile.ZipFile(drawn_again / SHAPEFILE.name) as again:
        assert ours.namelist() == again.namelist()
        for part in (".shp", ".shx", ".dbf", ".cpg", ".prj"):
            assert ours.read(f"paran_estate{part}") == again.read(f"paran_estate{part}")
        assert {one.date_time for one in again.infolist()} == {(2026, 11, 21, 0, 0, 0)}


def test_the_script_paints_the_same_picture_again(drawn_again):
    with (
        rasterio.open(HERE / "backdrop.tif") as ours,
        rasterio.open(drawn_again / "backdrop.tif") as again,
    ):
        assert ours.transform == again.transform
        assert ours.shape == again.shape
        # a JPEG library may round otherwise, but no more than that
        assert np.abs(ours.read().astype(int) - again.read()).mean() < 1.0


def test_plots_are_valid_apart_from_each_other_and_of_likely_sizes(plots):
    assert plots.crs == "EPSG:2039"
    assert plots.is_valid.all()
    pairs = itertools.combinations(plots.geometry, 2)
    assert min(a.distance(b) for a, b in pairs) > 15
    hectares = plots.area / 1e4
    assert 0.25 < hectares.min() < 0.5
    assert 9 < hectares.max() < 11


def test_the_estate_lies_by_paran_and_west_of_the_border(degrees):
    west, south, east, north = degrees.total_bounds
    # the border runs at 35.16 here
    assert 35.13 < west < east < 35.155
    assert 30.34 < south < north < 30.36


def test_awkward_shapes_are_among_the_plots(plots):
    shapes = plots.geometry
    assert len(shapes["Pond"].interiors) == 1
    assert len(shapes["Two halves"].geoms) == 2
    assert len(shapes["Bend"].exterior.coords) > 20
    filled = plots.area / shapes.map(lambda shape: shape.minimum_rotated_rectangle.area)
    assert filled["Gate"] == pytest.approx(1.0, abs=1e-3)
    assert filled["Elbow"] < 0.75
    assert filled["Wadi"] < 0.75
    box = np.array(shapes["Wadi"].minimum_rotated_rectangle.exterior.coords)
    sides = np.hypot(*np.diff(box[:3], axis=0).T)
    assert max(sides) > 5 * min(sides)


def test_no_plot_is_planted_along_north_and_edges_follow_the_rows(plots):
    assert plots["bearing"].between(1, 179).all()
    for shape, bearing in zip(plots.geometry, plots["bearing"], strict=True):
        edges = np.concatenate(
            [np.diff(np.array(part.exterior.coords), axis=0) for part in shapely.get_parts(shape)]
        )
        runs = np.rad2deg(np.arctan2(edges[:, 0], edges[:, 1]))
        off = np.abs((runs - bearing + 90) % 180 - 90)
        assert np.hypot(*edges.T)[off < 6].sum() > 0.15 * shape.length


def test_hebrew_names_survive_in_both_formats(plots, degrees):
    assert plots["name_he"].to_dict() == HEBREW
    assert degrees["name_he"].to_dict() == HEBREW


def test_both_formats_say_the_same_of_the_same_places(plots, degrees):
    apart = plots.geometry.hausdorff_distance(degrees.to_crs(2039).geometry)
    assert apart.max() < 0.02
    names = {"row_m": "row_spacing_m", "plant_m": "plant_spacing_m", "bearing": "row_bearing_deg"}
    for short, full in names.items():
        assert plots[short].to_dict() == degrees[full].to_dict()
    assert plots["crop"].to_dict() == degrees["crop"].to_dict()


@pytest.mark.parametrize("name", ["paran_estate", "tracks", "gates"])
def test_geojson_is_in_degrees_without_a_crs_and_winds_outer_rings_left(name):
    found = json.loads((HERE / f"{name}.geojson").read_text(encoding="utf-8"))
    assert "crs" not in found
    for feature in found["features"]:
        shape = shapely.geometry.shape(feature["geometry"])
        for part in shapely.get_parts(shape):
            if part.geom_type == "Polygon":
                assert part.exterior.is_ccw
                assert not any(hole.is_ccw for hole in part.interiors)


def test_tracks_pass_between_the_plots_and_meet(plots):
    tracks = gpd.read_file(HERE / "tracks.geojson").to_crs(2039)
    driven = tracks.buffer(tracks["width_m"] / 2)
    assert not any(driven.intersects(plot).any() for plot in plots.geometry)
    assert shapely.union_all(driven.to_numpy()).geom_type == "Polygon"


def test_every_plot_has_its_gate_at_its_edge_near_a_track(plots):
    gates = gpd.read_file(HERE / "gates.geojson").to_crs(2039).set_index("plot").geometry
    tracks = gpd.read_file(HERE / "tracks.geojson").to_crs(2039).union_all()
    assert set(gates.index) == set(plots.index)
    for name, gate in gates.items():
        assert gate.distance(plots.geometry[name].boundary) < 0.05
        assert gate.distance(tracks) < 25


def test_records_lie_on_the_plots_they_name(plots, records):
    named = gpd.GeoSeries(plots.geometry[records["plot"]].to_numpy(), crs=2039)
    inside = records.within(named).mean()
    assert 0.95 < inside < 1.0
    assert records.distance(named).max() < 10


def test_every_plot_is_scouted_in_ten_weeks_up_to_now(records, plots):
    assert records["date"].min() == pd.Timestamp("2026-09-14")
    assert records["date"].max() == pd.Timestamp("2026-11-17")
    visits = records.groupby("plot")["date"].nunique()
    assert visits.to_dict() == dict.fromkeys(plots.index, 10)
    assert (records["leaves_sampled"] > 0).all()
    assert records["stage"].notna().eq(records["count"] > 0).all()


def test_mites_spread_in_two_plots_and_hardly_anywhere_else(records):
    found = (records["count"] > 0).groupby(records["plot"]).mean()
    assert found[INFESTED].min() > 0.25
    assert (records.loc[~records["plot"].isin(INFESTED), "count"] > 0).mean() < 0.03
    for name in INFESTED:
        weeks = records[records["plot"] == name].groupby("date")["count"].mean()
        assert weeks.iloc[0] == 0
        assert weeks.iloc[-3:].mean() > 5 * weeks.iloc[:4].mean()


def test_mites_come_in_from_the_edge_by_a_track(records, plots):
    tracks = gpd.read_file(HERE / "tracks.geojson").to_crs(2039).union_all()
    for name in INFESTED:
        mine = records[(records["plot"] == name) & (records["count"] > 0)].sort_values("date")
        away_m = mine.distance(tracks).to_numpy()
        assert np.median(away_m[:6]) < 40
        assert np.max(away_m) > 70
        assert plots.geometry[name].distance(tracks) < 20


def test_the_picture_covers_the_plots_and_shows_them_green(plots):
    with rasterio.open(HERE / "backdrop.tif") as tif:
        assert tif.crs == "EPSG:2039"
        assert tif.dtypes == ("uint8",) * 3
        assert shapely.box(*tif.bounds).contains(shapely.box(*plots.total_bounds))
        red, green, blue = tif.read().astype(int)
        inside = rasterio.features.geometry_mask(
            plots.buffer(-5), tif.shape, tif.transform, invert=True
        )
    assert (green > red)[inside].mean() > 0.6
    assert (green < red)[~inside].mean() > 0.9
    assert (blue < red)[~inside].mean() > 0.9


def test_all_files_together_stay_small():
    sizes = {path.name: path.stat().st_size for path in HERE.iterdir() if path.is_file()}
    assert sizes["backdrop.tif"] <= 400_000
    assert sum(sizes.values()) < 1_500_000


def test_everything_says_that_it_is_made_up(plots, records):
    assert plots["note"].str.contains("made up").all()
    assert records["source"].eq("made up").all()
    for name in ("paran_estate", "tracks", "gates"):
        found = json.loads((HERE / f"{name}.geojson").read_text(encoding="utf-8"))
        assert "made up" in found["description"]
        assert all("made up" in one["properties"]["note"] for one in found["features"])
    with rasterio.open(HERE / "backdrop.tif") as tif:
        assert "made up" in tif.tags()["TIFFTAG_IMAGEDESCRIPTION"]
    assert "made-up" in (HERE / "README.md").read_text(encoding="utf-8")
