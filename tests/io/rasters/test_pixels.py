"""Which part of a raster is read, and how finely."""

import numpy as np
import pytest
import rasterio
from pyproj import Transformer
from rasterio.transform import from_origin

from fieldmon.errors import FileProblem
from fieldmon.io.options import Upload
from fieldmon.io.rasters import reading
from fieldmon.io.rasters.read import RasterOptions, read_raster
from fieldmon.io.sandbox import limits
from tests.io.rasters.raster_files import (
    PLOT,
    SPOTS,
    TO_UTM,
    UTM,
    corner,
    declared,
    said,
    write,
)


def test_a_big_raster_is_read_at_fewer_pixels_about_where_they_are(tmp_path):
    west, north = corner()
    values = np.zeros((5000, 5000), "uint8")
    values[:, 2500:] = 200
    path = write(
        tmp_path / "r.tif", values, from_origin(west, north, 0.08, 0.08), tiled=True,
        compress="deflate",
    )  # fmt: skip
    with rasterio.open(path, "r+") as tif:
        tif.build_overviews([2, 4])
    read = read_raster(path)
    assert read.value.values.size <= 16_000_000
    assert said(read, r"every 1\.25th pixel")
    lon, lat = Transformer.from_crs(UTM, "OGC:CRS84", always_xy=True).transform(
        west + 200 + np.array([-0.5, 0.5]), [north - 200] * 2
    )
    assert read.value.at(np.stack([lon, lat], axis=1)).tolist() == [0.0, 200.0]


def test_the_smaller_copies_inside_are_read_where_they_do(tmp_path, monkeypatch):
    # in this process, where the limits can be made small
    monkeypatch.setattr(limits, "PIXELS", 10_000)
    monkeypatch.setattr(limits, "RASTER_BYTES", 100_000)
    east = np.tile(np.arange(2000, dtype="float32"), (2000, 1))
    path = write(tmp_path / "r.tif", east, tiled=True, blockxsize=256, blockysize=256)
    for number, bounds in enumerate((None, PLOT.boundary.bounds)):
        room = tmp_path / f"room {number}"
        room.mkdir()
        with pytest.raises(FileProblem, match="100 kB of a raster may be read"):
            reading.raster(str(room), path, RasterOptions(), bounds)
    with rasterio.open(path, "r+") as tif:
        tif.build_overviews([2, 4, 8, 16], rasterio.enums.Resampling.average)
    room = tmp_path / "room"
    room.mkdir()
    read = reading.raster(str(room), path, RasterOptions(), None)
    assert read.value.values.size <= 10_000
    # the mean of 16 x 16 pixels of 0.2 m, at most a step of 4 m away
    wanted = 5 * (TO_UTM.transform(*SPOTS.T)[0] - corner()[0])
    np.testing.assert_allclose(read.value.at(SPOTS), wanted, atol=20.0)
    # no pixel of the file holds half a number, their means do
    assert set(np.unique(read.value.values % 1)) == {0.5}


def test_a_raster_that_is_a_mere_line_keeps_to_the_limit(tmp_path):
    west, north = corner()
    line = np.arange(20_000_000, dtype="float32")[None]
    place = from_origin(west, north, 400 / 20_000_000, 400)
    read = read_raster(write(tmp_path / "r.tif", line, place))
    assert read.value.values.shape[0] == 1
    assert 10_000_000 < read.value.values.size <= 16_000_000
    x, _ = TO_UTM.transform(*SPOTS[1])
    wanted = (x - west) / 400 * 20_000_000
    assert read.value.at(SPOTS[1:2])[0] == pytest.approx(wanted, abs=2.0)


def test_a_huge_raster_serves_where_only_the_plot_is_read():
    # 10 gigapixels of nothing: only the tiles about the plot are looked at
    sparse = Upload("huge.tif", declared(100_000, 100_000, 1024))
    read = read_raster(sparse, near=PLOT)
    assert (read.value.at(SPOTS) == 0.0).all()
    assert read.value.values.size < 500 * 500
