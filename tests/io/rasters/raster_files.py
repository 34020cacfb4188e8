"""Rasters that people bring, awkward ones among them, made by the tests."""

import re
import struct
import warnings

import numpy as np
import pytest
import rasterio
from pyproj import Transformer
from rasterio.enums import ColorInterp
from rasterio.transform import Affine, from_origin
from shapely import MultiPolygon, box

from fieldmon.errors import FieldmonError
from fieldmon.io.rasters.read import read_backdrop, read_raster
from fieldmon.plot.field import Field

UTM = "EPSG:32636"
SPOTS = np.array([[35.1503, 30.3602], [35.1510, 30.3605], [35.1519, 30.3607]])
#: a plot of 200 m x 100 m by Paran
PLOT = Field("home", MultiPolygon([box(35.1500, 30.3600, 35.1521, 30.3609)]))
WEST, NORTH = 706_700.0, 3_360_800.0
TO_UTM = Transformer.from_crs("OGC:CRS84", UTM, always_xy=True)


def write(path, values, transform=None, crs=UTM, bands=None, **more):
    """Write ``(h, w)`` or ``(bands, h, w)`` values as a GeoTIFF; 400 m of ground about the plot.

    A transform of False leaves out where they lie.
    """
    cube = values if values.ndim == 3 else values[None]
    count, height, width = cube.shape
    if transform is None:
        transform = from_origin(*corner(), 400 / width, 400 / height)
    place = {} if transform is False else {"transform": transform}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with rasterio.open(
            path, "w", driver="GTiff", count=count, height=height, width=width, dtype=cube.dtype,
            crs=crs, **place, **more,
        ) as tif:  # fmt: skip
            tif.write(cube)
            for change in bands or ():
                change(tif)
    return path


def corner():
    """Return the north-west corner of a square of 400 m about the plot, UTM."""
    west, south, east, north = PLOT.boundary.bounds
    x, y = TO_UTM.transform((west + east) / 2, (south + north) / 2)
    return x - 200.0, y + 200.0


def ramp(size=400, dtype="float32"):
    """Return values that grow eastward by 1 a pixel and northward by 1000."""
    rows, columns = np.indices((size, size))
    return (columns + 1000 * (size - 1 - rows)).astype(dtype)


def turned(degrees, pixel_m=1.0):
    """Return the place of 400 x 400 pixels about the plot, turned counter-clockwise."""
    x, y = corner()
    return (
        Affine.translation(x + 200, y - 200)
        @ Affine.rotation(degrees)
        @ Affine.scale(pixel_m, -pixel_m)
        @ Affine.translation(-200, -200)
    )


def palette(tif):
    tif.write_colormap(1, {0: (0, 0, 0, 0), 1: (255, 0, 0, 255), 2: (0, 128, 0, 255)})


def alpha_last(tif):
    tif.colorinterp = [ColorInterp.red, ColorInterp.green, ColorInterp.blue, ColorInterp.alpha]


def declared(width, height, block=None):
    """Return a little-endian TIFF of one byte a pixel that declares any size and holds nothing."""
    tags = [
        (256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 1),
        (277, 3, 1, 1),
    ]  # fmt: skip
    if block is None:
        tags += [(273, 4, 1, 8), (278, 4, 1, height), (279, 4, 1, 100)]
    else:
        tiles = -(-width // block) * -(-height // block)
        tags += [(322, 4, 1, block), (323, 4, 1, block), (324, 4, tiles, 0), (325, 4, tiles, 0)]
    scale = struct.pack("<3d", 1.0, 1.0, 0.0)
    tie = struct.pack("<6d", 0, 0, 0, *corner(), 0)
    keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32636)
    end = 8 + 2 + 12 * (len(tags) + 3) + 4
    zeros = 0 if block is None else 4 * tiles
    tags += [(33550, 12, 3, end), (33922, 12, 6, end + 24), (34735, 3, 16, end + 72)]
    after = end + 104
    fields = b"".join(
        struct.pack("<HHII", tag, kind, n, after if tag in {324, 325} else value)
        for tag, kind, n, value in sorted(tags)
    )
    head = b"II*\x00" + struct.pack("<I", 8) + struct.pack("<H", len(tags))
    return head + fields + b"\x00" * 4 + scale + tie + keys + b"\x00" * zeros


def expected(lonlat):
    """Return what `ramp` says at positions, written as 400 x 400 pixels of 1 m."""
    x, y = TO_UTM.transform(*lonlat.T)
    west, north = corner()
    return np.floor(x - west) + 1000 * (399 - np.floor(north - y))


def said(imported, pattern, severity=None):
    return [
        f
        for f in imported.messages
        if re.search(pattern, f.sentence) and severity in {None, f.severity}
    ]


def shown(backdrop):
    """Return the picture of a backdrop as ``(bands, h, w)``."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with rasterio.MemoryFile(backdrop.image) as file, file.open() as picture:
            return picture.read()


def refused(source, options=None):
    """Return the sentence with which both doors refuse a source."""
    with pytest.raises(FieldmonError) as first:
        read_raster(source, options)
    with pytest.raises(FieldmonError) as second:
        read_backdrop(source, options)
    assert type(first.value) is type(second.value)
    return str(first.value)
