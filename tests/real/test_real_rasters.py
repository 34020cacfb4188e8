"""Aerial pictures with trees that people marked: pixels and positions must agree."""

import csv
import json
import warnings

import numpy as np
import pytest
import rasterio
from pyproj import Transformer

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.rasters.read import RasterOptions, read_backdrop, read_raster

TILES = [("chico_2020_70", 26910), ("claremont_2020_82", 26911)]


def trees(folder, name, zone):
    """Return the marked trees in degrees, and the pixels in which the same people marked them."""
    collection = json.loads((folder / f"{name}.geojson").read_text())
    xy = np.array([feature["geometry"]["coordinates"] for feature in collection["features"]])
    with (folder / f"{name}.csv").open() as file:
        pixels = np.array([[int(row["x"]), int(row["y"])] for row in csv.DictReader(file)])
    lon, lat = Transformer.from_crs(zone, 4326, always_xy=True).transform(*xy.T)
    return np.stack([lon, lat], axis=1), pixels


@pytest.mark.parametrize(("name", "zone"), TILES)
def test_marked_trees_fall_into_the_pixels_in_which_they_were_marked(shared, name, zone):
    lonlat, pixels = trees(shared / "naip_trees", name, zone)
    path = shared / "naip_trees" / f"{name}.tif"
    raster = read_raster(path, RasterOptions(band="4")).value
    np.testing.assert_array_equal(np.floor(raster.pixels(lonlat)), pixels)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with rasterio.open(path) as tif:
            infrared = tif.read(4)
    np.testing.assert_array_equal(raster.at(lonlat), infrared[pixels[:, 1], pixels[:, 0]])


@pytest.mark.parametrize(("name", "zone"), TILES)
def test_trees_are_greener_than_the_ground_between_them(shared, name, zone):
    lonlat, _ = trees(shared / "naip_trees", name, zone)
    path = shared / "naip_trees" / f"{name}.tif"
    red, infrared = (read_raster(path, RasterOptions(band=band)).value for band in "14")
    index, ground = (
        np.mean((i - r) / (i + r))
        for i, r in [(infrared.at(lonlat), red.at(lonlat)), (infrared.values, red.values)]
    )
    assert index > ground + 0.1


def test_the_four_bands_are_asked_for_and_the_picture_takes_the_first_three(shared):
    path = shared / "naip_trees" / "chico_2020_70.tif"
    with pytest.raises(ChoiceNeeded, match="4 bands"):
        read_raster(path)
    picture = read_backdrop(path)
    assert "bands 1, 2, 3 of 4" in picture.messages[0].sentence
    # 256 pixels of 0.6 m from 601845.6, 4397523 in UTM zone 10, as the file's own header says
    x, y = Transformer.from_crs(4326, 26910, always_xy=True).transform(
        *picture.value.corners_lonlat.T
    )
    np.testing.assert_allclose(x, [601845.6, 601845.6, 601999.2, 601999.2], atol=0.01)
    np.testing.assert_allclose(y, [4397369.4, 4397523.0, 4397523.0, 4397369.4], atol=0.01)
