import struct
import warnings
from dataclasses import replace

import numpy as np
import pytest
import rasterio
from hypothesis import given, settings
from hypothesis import strategies as st
from pyproj import Transformer
from scipy.spatial import cKDTree

from fieldmon.errors import FileProblem, PlotError
from fieldmon.io.rasters.read import read_raster
from fieldmon.io.writers.chance_raster import NODATA, _paint, chance_raster, write_chance_raster
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from tests.crooked import crooked_grids
from tests.io.rasters.raster_files import PLOT
from tests.thorough import seeds


def chances(grid, seed=1):
    return np.random.default_rng(seed).random(len(grid)).astype(np.float32).astype(float)


def opened(path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return rasterio.open(path)


def directories(data):
    """Return the tags of every picture in a TIFF, and where each directory begins."""
    assert data[:4] == b"II*\x00"
    (at,) = struct.unpack_from("<I", data, 4)
    sizes = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 12: 8}
    kinds = {3: "H", 4: "I"}
    while at:
        (n,) = struct.unpack_from("<H", data, at)
        tags = {}
        for k in range(n):
            tag, kind, count, value = struct.unpack_from("<HHII", data, at + 2 + 12 * k)
            if kind not in kinds:
                continue
            where = at + 10 + 12 * k if sizes[kind] * count <= 4 else value
            tags[tag] = struct.unpack_from(f"<{count}{kinds[kind]}", data, where)
        yield at, tags
        (at,) = struct.unpack_from("<I", data, at + 2 + 12 * n)


def test_the_chance_map_is_a_cloud_optimised_geotiff(tmp_path):
    grid = rectangle(60, 300)
    path = tmp_path / "chance.tif"
    write_chance_raster(grid, chances(grid), path)
    assert [p.name for p in tmp_path.iterdir()] == ["chance.tif"]
    data = path.read_bytes()
    found = list(directories(data))
    widths = [tags[256][0] for _, tags in found]
    assert len(found) >= 2
    assert widths == sorted(widths, reverse=True)
    assert widths[-1] <= 512
    # what a reader needs to find its way comes first, then the coarsest picture, the finest last
    firsts = [min(offset for offset in tags[324] if offset) for _, tags in found]
    assert max(at for at, _ in found) < min(firsts)
    assert firsts == sorted(firsts, reverse=True)
    with opened(path) as tif:
        assert tif.tags(ns="IMAGE_STRUCTURE")["LAYOUT"] == "COG"
        assert tif.overviews(1) == [2 ** (k + 1) for k in range(len(found) - 1)]
        assert tif.block_shapes == [(512, 512)]
        assert (tif.dtypes, tif.nodata, tif.descriptions) == (
            ("float32",), NODATA, ("chance of infestation",)
        )  # fmt: skip


@pytest.mark.parametrize(("bearing", "faces"), [(0.0, 1), (33.0, 2), (90.0, 1)])
def test_every_plant_finds_its_chance_where_it_stands(tmp_path, bearing, faces):
    grid = lay(PLOT, Planting(bearing, 3.0, 1.5, faces=faces))
    chance = chances(grid)
    path = tmp_path / "chance.tif"
    made = write_chance_raster(grid, chance, path)
    assert made.pixel_m == 0.75
    with opened(path) as tif:
        assert tif.crs == "EPSG:32636"
        a, b, _, d, e, _ = tif.transform[:6]
        assert (a, b, d, e) == (0.75, 0.0, 0.0, -0.75)
        xy = Transformer.from_crs("OGC:CRS84", tif.crs.to_wkt(), always_xy=True).transform(
            *grid.lonlat().T
        )
        found = np.array([value[0] for value in tif.sample(zip(*xy, strict=True))])
    shown = np.maximum(chance, np.where(grid.twin >= 0, chance[grid.twin], 0.0))
    np.testing.assert_array_equal(found, shown.astype(np.float32))
    # the door in says the same
    again = read_raster(path, near=PLOT).value.of_plants(grid, "nearest")
    np.testing.assert_array_equal(again, shown)


@settings(max_examples=8)
@given(crooked_grids(40.0, faces=(1,), max_plants=3000), st.integers(0, 99))
def test_on_any_plot_every_plant_fills_its_own_ground_and_no_more(grid, seed):
    chance = chances(grid, seed)
    made = chance_raster(grid, chance)
    to_map = Transformer.from_crs("OGC:CRS84", made.crs, always_xy=True)
    east, north = to_map.transform(*grid.lonlat().T)
    columns = ((east - made.west_m) / made.pixel_m).astype(int)
    rows = ((made.north_m - north) / made.pixel_m).astype(int)
    np.testing.assert_array_equal(made.values[rows, columns], chance.astype(np.float32))
    filled_m2 = np.count_nonzero(made.values != NODATA) * made.pixel_m**2
    own_m2 = len(grid) * grid.row_spacing_m * grid.plant_spacing_m
    rim_m2 = 2 * made.pixel_m * (grid.row_spacing_m + grid.plant_spacing_m) * len(grid)
    assert 0.4 * own_m2 < filled_m2 < own_m2 + rim_m2
    edges = np.concatenate([made.values[[0, -1]].ravel(), made.values[:, [0, -1]].ravel()])
    assert (edges == NODATA).all()


def test_plants_closer_than_a_pixel_show_the_higher_chance():
    from dataclasses import replace

    grid = rectangle(1, 2)
    close = replace(grid, xy_m=np.array([[0.0, 0.0], [0.01, 0.0]]))
    for chance in ([0.2, 0.9], [0.9, 0.2]):
        values = chance_raster(close, np.array(chance)).values
        assert values.max() == np.float32(0.9)


def test_south_of_the_equator_and_at_the_date_line_there_is_a_zone():
    zones = {
        (35.0, -30.0): "EPSG:32736",
        (179.999, 10.0): "EPSG:32660",
        (-179.999, -10.0): "EPSG:32701",
    }
    for centre, crs in zones.items():
        assert chance_raster(rectangle(2, 2, centre=centre), np.full(4, 0.5)).crs == crs


def test_a_map_of_other_plants_or_without_end_is_refused(tmp_path):
    grid = rectangle(2, 3)
    with pytest.raises(PlotError, match="one chance a plant"):
        write_chance_raster(grid, np.zeros(5), tmp_path / "c.tif")
    with pytest.raises(FileProblem, match="must exist"):
        write_chance_raster(grid, np.zeros(6), tmp_path / "none" / "c.tif")
    from dataclasses import replace

    far = replace(grid, xy_m=np.where(np.arange(6)[:, None] == 0, 50_000.0, grid.xy_m))
    with pytest.raises(FileProblem, match="pixels at most"):
        chance_raster(far, np.zeros(6))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("seed", seeds(2, 4))
def test_each_pixel_is_the_nearest_plants_on_whose_ground_it_lies_by_trying_all(seed):
    rng = np.random.default_rng(seed)
    turn, shape, halves = rng.uniform(0.0, np.pi), (14, 17), np.array([1.4, 2.3])
    to_rows = 0.9 * np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    # every other plant is the other face of the one before
    anywhere = rng.uniform(0.0, 1.0, (4, 2)) * [17.0, 14.0]
    places = np.repeat(np.vstack([anywhere, [[0.4, 0.4], [16.6, 13.6]]]), 2, axis=0)
    chance = rng.random(12).astype(np.float32)
    painted = np.full(shape, NODATA, np.float32)
    _paint(painted, places, chance, to_rows, halves)
    for r, c in np.ndindex(shape):
        own = [i for i in range(12) if (int(places[i, 1]), int(places[i, 0])) == (r, c)]
        away = (np.array([c + 0.5, r + 0.5]) - places) @ to_rows.T
        on_ground = np.flatnonzero((np.abs(away) <= halves).all(axis=1))
        if own:
            expected = max(chance[own])
        elif on_ground.size:
            apart = (away[on_ground] ** 2).sum(axis=1)
            expected = max(chance[on_ground[apart == apart.min()]])
        else:
            expected = NODATA
        assert painted[r, c] == np.float32(expected), (r, c)


@pytest.mark.parametrize(
    ("lon", "zone"), [(-180.0, 1), (-0.5, 30), (0.5, 31), (179.9, 60), (180.0, 60)]
)
def test_the_zone_is_that_of_the_longitude_and_the_last_one_ends_the_world(lon, zone, tmp_path):
    for lat, north in ((30.0, 6), (-30.0, 7)):
        grid = replace(rectangle(3, 4), frame=Frame(lon, lat))
        write_chance_raster(grid, chances(grid), tmp_path / "map.tif")
        with opened(tmp_path / "map.tif") as picture:
            assert picture.crs.to_epsg() == 32_000 + 100 * north + zone


@pytest.mark.parametrize("bearing", [0.0, 33.0])
def test_a_pixel_is_filled_where_its_middle_lies_on_a_plants_ground(bearing):
    grid = lay(PLOT, Planting(bearing, 4.0, 1.5))
    made = chance_raster(grid, chances(grid))
    rows, columns = np.indices(made.values.shape)
    east = made.west_m + (columns.ravel() + 0.5) * made.pixel_m
    north = made.north_m - (rows.ravel() + 0.5) * made.pixel_m
    back = Transformer.from_crs(made.crs, "OGC:CRS84", always_xy=True)
    xy_m = grid.frame.xy_m(np.stack(back.transform(east, north), axis=1))
    # how far beyond a plant's half spacings each pixel is, of the nearest plant so measured
    half_m = np.array([grid.plant_spacing_m, grid.row_spacing_m]) / 2
    beyond, _ = cKDTree(grid.xy_m / half_m).query(xy_m / half_m, p=np.inf)
    filled = made.values.ravel() != NODATA
    own = np.zeros(made.values.shape, bool)
    to_map = Transformer.from_crs("OGC:CRS84", made.crs, always_xy=True)
    at = np.stack(to_map.transform(*grid.lonlat().T), axis=1)
    own[((made.north_m - at[:, 1]) / made.pixel_m).astype(int),
        ((at[:, 0] - made.west_m) / made.pixel_m).astype(int)] = True  # fmt: skip
    clear = np.abs(beyond - 1.0) > 0.02
    assert (filled == ((beyond < 1.0) | own.ravel()))[clear].all()
