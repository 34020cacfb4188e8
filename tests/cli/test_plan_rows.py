"""`fieldmon plan` where rows bend and blocks turn, end posts and contours tell of rows."""

import csv
import json
import re

import geopandas as gpd
import numpy as np
import pytest
import rasterio
import shapely
from pyproj import Transformer
from rasterio.transform import from_origin

from fieldmon.monitoring import Season
from tests.bent import FRAME
from tests.cli.estate import square


def arcs(radius_m, n_rows, n_plants, east_m=0.0):
    k, j = np.divmod(np.arange(n_rows * n_plants), n_plants)
    at = radius_m + 2.5 * k
    turn = 1.4 * (j - n_plants / 2) / at
    return np.stack([at * np.sin(turn) + east_m, at * np.cos(turn) - radius_m], axis=1)


@pytest.fixture
def two_blocks(tmp_path):
    """Write the plants of two blocks, one bent and one across."""
    xy_m = np.concatenate([arcs(80.0, 10, 40), arcs(400.0, 8, 30)[:, ::-1] + [48.0, 0.0]])
    rows = [f"{lon:.9f},{lat:.9f}" for lon, lat in FRAME.lonlat(xy_m)]
    (tmp_path / "vines.csv").write_text("\n".join(["lon,lat", *rows]))
    return tmp_path / "vines.csv"


def area(path, low=-50.0, high=50.0):
    shape = FRAME.geometry_lonlat(shapely.box(low, -30, high, 30))
    gpd.GeoDataFrame({"name": ["home"]}, geometry=[shape], crs=4326).to_file(path)
    return path


def test_bent_rows_and_blocks_are_said_and_stops_carry_their_block(run, tmp_path, two_blocks):
    code, out, err, _ = run(
        "plan", "--no-bound", "--plants", two_blocks, "--hours", 3, "-o", "day.csv"
    )
    assert code == 0, err
    assert "640 plants in 18 rows of 2 blocks, as they bend" in err
    assert "640 plants in 18 rows, which run as they bend, in 2 blocks" in out
    table = list(csv.DictReader((tmp_path / "day.csv").read_text("utf-8-sig").splitlines()))
    assert list(table[0])[:4] == ["stop", "block", "row", "number"]
    block_of = {int(stop["row"]): int(stop["block"]) for stop in table}
    assert all(block == (1 if row <= 10 else 2) for row, block in block_of.items())


@pytest.mark.parametrize("ending", ["geojson", "gpkg", "kml"])
def test_other_route_files_carry_the_block_too(run, tmp_path, two_blocks, ending):
    assert (
        run("plan", "--no-bound", "--plants", two_blocks, "--hours", 1, "-o", f"day.{ending}")[0]
        == 0
    )
    if ending == "geojson":
        stops = json.loads((tmp_path / "day.geojson").read_text())["features"][1:]
        assert {stop["properties"]["block"] for stop in stops} <= {1, 2}
    elif ending == "gpkg":
        assert "block" in gpd.read_file(tmp_path / "day.gpkg", layer="stops").columns
    else:
        assert '<Data name="block">' in (tmp_path / "day.kml").read_text()


def test_a_season_on_bent_rows_comes_back_as_it_was(run, tmp_path, two_blocks):
    assert run("init", "vines.gpkg", "--plants", two_blocks)[0] == 0
    plot = Season(tmp_path / "vines.gpkg").plot
    assert (plot.grid.n_blocks, plot.grid.n_rows) == (2, 18)
    assert plot.grid.aisles_m is not None
    lines = gpd.read_file(tmp_path / "vines.gpkg", layer="rows").geometry
    assert max(len(line.coords) for line in lines) > 4
    assert run("plan", "--no-bound", "vines.gpkg", "-o", "again.geojson")[0] == 0


def test_trees_in_no_rows_are_said_and_not_called_rows(run, tmp_path):
    xy_m = np.random.default_rng(0).uniform(0, 120, (60, 2))
    rows = [f"{lon:.9f},{lat:.9f}" for lon, lat in FRAME.lonlat(xy_m)]
    (tmp_path / "trees.csv").write_text("\n".join(["lon,lat", *rows]))
    code, out, err, _ = run("plan", "--no-bound", "--plants", "trees.csv", "--hours", 1)
    assert code == 0
    assert "doubtful: No rows were found: the plants stand anyhow." in err
    assert "trees: 60 plants in no rows." in out


def test_trees_are_visited_by_nearness_where_it_is_said_that_they_stand_in_no_rows(run, tmp_path):
    xy_m = np.random.default_rng(0).uniform(0, 120, (60, 2))
    rows = [f"{lon:.9f},{lat:.9f}" for lon, lat in FRAME.lonlat(xy_m)]
    (tmp_path / "trees.csv").write_text("\n".join(["lon,lat", *rows]))
    words = ["--plants", "trees.csv", "--no-rows", "--hours", 1]
    code, out, err, _ = run(
        "plan", "--no-bound", *words, "-o", "a.csv", "-o", "a.geojson", "-o", "a.html"
    )
    assert code == 0, err
    assert "trees: 60 plants in no rows, visited by nearness." in out
    table = list(csv.DictReader((tmp_path / "a.csv").read_text("utf-8-sig").splitlines()))
    assert list(table[0])[:2] == ["stop", "number"]
    stops = json.loads((tmp_path / "a.geojson").read_text())["features"][1:]
    assert not any("row" in stop["properties"] for stop in stops)
    assert "<th>row</th>" not in (tmp_path / "a.html").read_text()
    assert "row" not in out.replace("no rows", "")
    assert run("init", "trees.gpkg", *words[:3])[0] == 0
    again = Season(tmp_path / "trees.gpkg").plot.grid
    assert not again.in_rows
    assert run("plan", "--no-bound", "trees.gpkg", "-o", "b.csv")[0] == 0
    assert run("plan", "--no-bound", "trees.csv", "--all", "--no-rows")[0] != 0


def test_plants_stand_between_end_posts(run, tmp_path):
    y = -24.0 + 3.5 * np.arange(14)
    ends = np.stack([np.stack([0.2 * y - 42, y], 1), np.stack([0.3 * y + 40, y], 1)], axis=1)
    lonlat = FRAME.lonlat(np.random.default_rng(1).permutation(ends.reshape(-1, 2)))
    posts = gpd.GeoDataFrame(geometry=gpd.points_from_xy(*lonlat.T), crs=4326)
    posts.to_file(tmp_path / "posts.geojson")
    home = area(tmp_path / "home.geojson")
    code, out, err, _ = run("plan", "--no-bound", home, "--rows", "posts.geojson", "--hours", 1)
    assert code == 0, err
    assert "28 points are the end posts of rows, paired as they lie in line." in err
    assert "Plants stand along the 14 rows that were drawn." in err
    assert "in 14 rows" in out
    assert "rows 3.50 m" in out
    assert "guessed: row spacing" not in err
    odd = posts.iloc[:27]
    odd.to_file(tmp_path / "odd.geojson")
    code, _, err, _ = run("plan", "--no-bound", home, "--rows", "odd.geojson")
    assert code != 0
    assert "two a row" in err


def write_hill(path):
    """Write heights of a cone, whose top is 120 m south of the frame's middle; return its place."""
    to_utm = Transformer.from_crs(4326, 32630, always_xy=True)
    east, north = to_utm.transform(FRAME.lon, FRAME.lat)
    x, y = np.meshgrid(east - 99.5 + np.arange(200), north + 99.5 - np.arange(200))
    height = (200 - 0.3 * np.hypot(x - east, y - north + 120)).astype(np.float32)
    profile = {"driver": "GTiff", "width": 200, "height": 200, "count": 1, "dtype": "float32"}
    place = from_origin(east - 100, north + 100, 1.0, 1.0)
    with rasterio.open(path, "w", crs=32630, transform=place, **profile) as tif:
        tif.write(height, 1)
    return FRAME.xy_m([to_utm.transform(east, north - 120, direction="INVERSE")])[0]


def test_rows_run_along_the_contours_of_a_raster(run, tmp_path):
    write_hill(tmp_path / "dem.tif")
    home = area(tmp_path / "home.geojson")
    words = ["--contours", "dem.tif", "--row-spacing", 3, "--plant-spacing", 1.5, "--hours", 1]
    code, out, err, _ = run("plan", "--no-bound", home, *words)
    assert code == 0, err
    assert "Rows run along the contour through the middle of the plot" in err
    assert "which run as they bend" in out
    assert "rows 3.00 m" in out


def test_measured_plants_and_drawn_rows_are_not_given_together(run, tmp_path, two_blocks):
    home = area(tmp_path / "home.geojson")
    code, _, err, _ = run("plan", "--no-bound", home, "--plants", two_blocks, "--rows", home)
    assert code != 0
    assert "not both" in err


def test_an_estate_is_planned_with_the_rows_and_blocks_of_its_plots(run, tmp_path):
    boxes = [shapely.box(-50, -30, -5, 30), shapely.box(5, -30, 50, 30)]
    shapes = [FRAME.geometry_lonlat(box) for box in boxes]
    estate = gpd.GeoDataFrame({"name": ["west", "east"]}, geometry=shapes, crs=4326)
    estate.to_file(tmp_path / "estate.geojson")
    bows = [shapely.LineString([(-48, y), (-27, y + 4), (-8, y)]) for y in range(-20, 21, 4)]
    cut = FRAME.geometry_lonlat(shapely.LineString([(0, -2), (55, 3)]))
    rows = gpd.GeoDataFrame(geometry=[FRAME.geometry_lonlat(bow) for bow in bows], crs=4326)
    rows.to_file(tmp_path / "rows.geojson")
    gpd.GeoDataFrame(geometry=[cut], crs=4326).to_file(tmp_path / "cut.geojson")
    words = ["--rows", "rows.geojson", "--blocks", "cut.geojson", "--hours", 1, "--no-bound"]
    code, out, err, _ = run("plan", "--no-bound", "estate.geojson", "--all", *words, "-o", "routes")
    assert code == 0, err
    assert "2 of 2 plots planned" in out
    assert "On 1 of 2 plots no rows were drawn; straight ones are laid." in err
    assert "1 line parts plots into 2 blocks." in err
    stops = {
        name: json.loads((tmp_path / "routes" / f"{name}.geojson").read_text())["features"][1:]
        for name in ("1-west", "2-east")
    }
    assert "block" not in stops["1-west"][0]["properties"]
    assert {stop["properties"]["block"] for stop in stops["2-east"]} <= {1, 2}


def test_each_plot_of_an_estate_follows_contours_of_its_own(run, tmp_path):
    top_m = write_hill(tmp_path / "dem.tif")
    boxes = {
        "west": shapely.box(-60, -30, -5, 30),
        "east": shapely.box(5, -30, 60, 30),
        "far": shapely.box(305, -30, 360, 30),
    }
    shapes = [FRAME.geometry_lonlat(box) for box in boxes.values()]
    estate = gpd.GeoDataFrame({"name": list(boxes)}, geometry=shapes, crs=4326)
    estate.to_file(tmp_path / "estate.geojson")
    words = ["--contours", "dem.tif", "--row-spacing", 3, "--plant-spacing", 1.5, "--hours", 1]
    code, out, err, _ = run("plan", "estate.geojson", "--all", *words, "--no-bound", "-o", "routes")
    assert code == 0, err
    assert "3 of 3 plots planned" in out
    assert "Rows run along the contour through the middle of the plot" in err
    assert "Straight rows are laid" in err
    for name in ("1-west", "2-east"):
        stops = gpd.read_file(tmp_path / "routes" / f"{name}.geojson")
        stops = stops[(stops.geom_type == "Point") & stops["row"].notna()]
        xy_m = FRAME.xy_m(np.stack([stops.geometry.x, stops.geometry.y], axis=1))
        away_m = np.hypot(*(xy_m - top_m).T)
        # one row, one level
        levels = [np.ptp(away_m[stops["row"] == row]) for row in stops["row"].unique()]
        assert max(levels) < 1.0


def test_a_plot_is_only_its_rows(run, tmp_path):
    bows = [shapely.LineString([(-40, y), (0, y + 4), (40, y)]) for y in range(-12, 13, 3)]
    rows = gpd.GeoDataFrame(geometry=[FRAME.geometry_lonlat(bow) for bow in bows], crs=4326)
    rows.to_file(tmp_path / "rows.geojson")
    code, out, err, _ = run("plan", "--no-bound", "--rows", "rows.geojson", "--hours", 1)
    assert code == 0, err
    assert "rows: 477 plants in 9 rows" in out or "in 9 rows, which run as they bend" in out
    assert "guessed: No boundary was given" in err
    assert run("init", "bow.gpkg", "--rows", "rows.geojson")[0] == 0


@pytest.mark.parametrize("planting", ["square", "triangular"])
def test_each_direction_of_a_planting_is_named_with_the_option_that_chooses_it(
    run, tmp_path, planting
):
    k, j = np.divmod(np.arange(10 * 24), 24)
    shift, apart = (0.0, 1.0) if planting == "square" else (0.5, np.sqrt(0.75))
    xy_m = 3.0 * np.stack([j + shift * (k % 2), apart * k], axis=1)
    rows = [f"{lon:.9f},{lat:.9f}" for lon, lat in FRAME.turned(20.0).lonlat(xy_m)]
    (tmp_path / "trees.csv").write_text("\n".join(["lon,lat", *rows]))
    asked = "plan", "--plants", "trees.csv", "--hours", 1, "--no-bound", "-o", "day.csv"
    code, out, err, _ = run(*asked)
    assert code == 0, err
    named = re.findall(r"could be: (\d+) rows along (\d+) degrees, .* \[--bearing ([\d.]+)\]", err)
    ways = [20, 110] if planting == "square" else [20, 80, 140]
    assert sorted(int(degrees) for _, degrees, _ in named) == ways
    assert f"240 plants in {named[0][0]} rows, bearing {named[0][2]} degrees" in out
    for n_rows, _, bearing in named:
        code, out, err, _ = run(*asked, "--bearing", bearing)
        assert code == 0, err
        assert f"240 plants in {n_rows} rows, bearing {bearing} degrees" in out
        assert "could be:" not in err


def test_a_bearing_of_the_file_that_cannot_be_is_refused_unless_another_is_given(run, tmp_path):
    square(row_bearing_deg=1000.0).to_file(tmp_path / "turned.geojson")
    plan = "plan", "turned.geojson", "--hours", "1", "--no-bound", "-o", "r.geojson"
    code, _, err, made = run(*plan)
    assert (code, made) == (2, set())
    assert "must be -360 to 360 degrees, but it is 1000" in err
    code, out, err, _ = run(*plan, "--bearing", "20")
    assert code == 0, err
    assert "bearing 20.0 degrees" in out


def test_a_single_plant_is_refused_with_what_plans_it(run, tmp_path):
    (tmp_path / "one.csv").write_text("lon,lat\n35.1512345,30.3612345\n")
    plan = "plan", "--plants", "one.csv", "--hours", "1", "--no-bound", "-o", "r.geojson"
    code, _, err, made = run(*plan)
    assert (code, made) == (2, set())
    assert "--no-rows" in err.splitlines()[-1]
    code, _, err, _ = run(*plan, "--no-rows")
    assert code == 0, err
