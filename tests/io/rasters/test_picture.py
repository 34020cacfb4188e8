"""A raster as a picture for the map: bands, contrast, what is clear, and its corners."""

import re

import numpy as np
import pytest
import shapely
from rasterio.transform import Affine, from_origin

from fieldmon.io.import_report import Severity
from fieldmon.io.options import PlotOptions
from fieldmon.io.rasters.read import RasterOptions, read_backdrop, read_raster
from fieldmon.io.read import read_plots
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.plot import planting_of
from tests.io.rasters.raster_files import (
    PLOT,
    TO_UTM,
    corner,
    palette,
    ramp,
    said,
    shown,
    turned,
    write,
)
from tests.paths import SAMPLE_DATA


def test_classes_keep_their_colours_and_are_not_averaged(tmp_path):
    classes = np.ones((400, 400), "uint8")
    classes[:200] = 2
    classes[:, :100] = 0
    path = write(tmp_path / "r.tif", classes, nodata=0, bands=[palette])
    assert read_raster(path).value.is_classes
    picture = shown(read_backdrop(path).value)
    np.testing.assert_allclose(picture[:3, 300, 300], [255, 0, 0], atol=12)
    np.testing.assert_allclose(picture[:3, 100, 300], [0, 128, 0], atol=12)
    assert picture[3, 100, 50] == 0


def test_the_corners_of_a_backdrop_are_where_the_pixels_end(tmp_path):
    west, north = corner()
    picture = read_backdrop(write(tmp_path / "r.tif", ramp(dtype="float32"))).value
    x, y = TO_UTM.transform(*picture.corners_lonlat.T)
    wanted_x, wanted_y = (
        [west, west, west + 400, west + 400],
        [north - 400, north, north, north - 400],
    )
    np.testing.assert_allclose(x, wanted_x, atol=1e-4)
    np.testing.assert_allclose(y, wanted_y, atol=1e-4)


def test_a_backdrop_shows_east_on_the_right_and_north_above(tmp_path):
    image = np.zeros((3, 400, 400), "uint8")
    image[0, :, 200:] = 255  # red in the east
    image[2, :200] = 255  # blue in the north
    read = read_backdrop(write(tmp_path / "r.tif", image, photometric="RGB"))
    picture = shown(read.value)
    assert read.value.mime == "image/jpeg"
    np.testing.assert_allclose(picture[:, 100, 300], [255, 0, 255], atol=12)
    np.testing.assert_allclose(picture[:, 300, 100], [0, 0, 0], atol=12)
    west, north = corner()
    upside_down = Affine(1.0, 0.0, west, 0.0, 1.0, north - 400)
    flipped = write(tmp_path / "f.tif", image[:, ::-1].copy(), upside_down, photometric="RGB")
    again = read_backdrop(flipped).value
    # the first line lies in the south, and so do the upper corners
    np.testing.assert_allclose(
        again.corners_lonlat, read.value.corners_lonlat[[1, 0, 3, 2]], atol=1e-9
    )
    np.testing.assert_allclose(shown(again)[:, 300, 300], [255, 0, 255], atol=12)


def test_a_turned_backdrop_has_turned_corners(tmp_path):
    place = turned(25.0)
    picture = read_backdrop(write(tmp_path / "r.tif", ramp(), place)).value
    x, y = place @ (np.array([0, 0, 400, 400]), np.array([400, 0, 0, 400]))
    np.testing.assert_allclose(
        np.stack(TO_UTM.transform(*picture.corners_lonlat.T)), [x, y], atol=1e-4
    )


def test_a_backdrop_about_a_plot_is_cut_to_it(tmp_path):
    small = Field("small", PLOT.boundary.buffer(-0.0004))
    picture = read_backdrop(write(tmp_path / "r.tif", ramp()), near=small).value
    west, south, east, north = small.boundary.bounds
    lon, lat = picture.corners_lonlat.T
    assert lon.min() < west < east < lon.max()
    assert lat.min() < south < north < lat.max()
    assert np.ptp(lon) < 0.0025


@pytest.mark.parametrize("shape", [(300, 5000), (5000, 300), (3000, 3000)])
def test_a_backdrop_is_no_longer_than_2000_pixels(tmp_path, shape):
    path = write(tmp_path / "r.tif", np.ones(shape, "uint8"))
    picture = shown(read_backdrop(path).value)
    assert max(picture.shape) <= 2000
    assert picture.shape[1] / picture.shape[2] == pytest.approx(shape[0] / shape[1], rel=0.02)


@pytest.mark.parametrize("dtype", ["uint16", "float32", "int16"])
def test_other_numbers_than_bytes_are_stretched_so_that_they_are_seen(tmp_path, dtype):
    values = np.linspace(100, 1100, 160_000).reshape(400, 400).astype(dtype)
    values[0, 0] = 30_000
    read = read_backdrop(write(tmp_path / "r.tif", values))
    assert said(read, "stretched over the middle 96 %: 120 to 1080")
    picture = shown(read.value)[0].astype(int)
    assert picture[1, 0] < 10
    assert picture[-1, -1] > 245
    np.testing.assert_allclose(picture[200, 200], 127, atol=6)


def test_a_large_picture_that_bends_on_the_map_is_doubted(tmp_path):
    west, north = corner()
    read = read_backdrop(
        write(tmp_path / "r.tif", ramp(), from_origin(west - 50_000, north + 50_000, 250, 250))
    )
    (bent,) = said(read, "m off its place", Severity.DOUBTFUL)
    assert float(re.search(r"up to ([\d.]+) m", bent.sentence).group(1)) > 100


def test_the_estates_picture_is_green_where_plants_are_and_sandy_beside():
    estate = SAMPLE_DATA
    (plot,) = read_plots(estate / "paran_estate.zip", PlotOptions(feature="Gate")).value
    grid = lay(plot, planting_of(plot))
    red, green = (
        read_raster(estate / "backdrop.tif", RasterOptions(band=band), near=plot).value
        for band in ("1", "2")
    )
    greener = green.of_plants(grid) - red.of_plants(grid)
    sand = shapely.segmentize(plot.boundary.buffer(0.00025).exterior, 1e-4)
    beside = np.array(sand.coords)
    sandy = red.at(beside) - green.at(beside)
    assert np.mean(greener > -10) > 0.95
    assert np.mean(sandy > 10) > 0.8


def test_black_declared_as_nodata_does_not_make_pure_colours_clear(tmp_path):
    image = np.zeros((3, 400, 400), "uint8")
    image[1, :, 200:] = 180  # pure green in the east, nothing in the west
    path = write(tmp_path / "r.tif", image, photometric="RGB", nodata=0)
    alpha = shown(read_backdrop(path).value)[3]
    assert (alpha[:, 210:] == 255).all()
    assert (alpha[:, :190] == 0).all()
