"""Where a raster lies, how much of it is read, and what is refused."""

import io
import shutil
import zipfile

import numpy as np
import pytest
import rasterio
from pyproj import Transformer
from rasterio.transform import Affine, from_origin
from shapely import MultiPolygon, box

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.options import Upload
from fieldmon.io.rasters.read import RasterOptions, read_backdrop, read_raster
from fieldmon.plot.field import Field
from tests.io.rasters.raster_files import (
    PLOT,
    SPOTS,
    TO_UTM,
    UTM,
    corner,
    declared,
    expected,
    ramp,
    refused,
    said,
    turned,
    write,
)


@pytest.mark.parametrize("crs", ["EPSG:4326", "EPSG:3857", "EPSG:2039", "EPSG:32636"])
def test_any_coordinate_system_leads_to_the_same_ground(tmp_path, crs):
    there = Transformer.from_crs("OGC:CRS84", crs, always_xy=True)
    west, south, east, north = PLOT.boundary.bounds
    x, y = there.transform([west, east], [south, north])
    pixel = (x[1] - x[0]) / 100, (y[1] - y[0]) / 50
    values = np.arange(50 * 100, dtype="float32").reshape(50, 100)
    path = write(tmp_path / "r.tif", values, from_origin(x[0], y[1], *pixel), crs)
    raster = read_raster(path).value
    x, y = there.transform(*SPOTS.T)
    columns = np.floor((np.array(x) - raster.to_map[2]) / pixel[0])
    rows = np.floor((raster.to_map[5] - np.array(y)) / pixel[1])
    np.testing.assert_array_equal(raster.at(SPOTS), rows * 100 + columns)


def test_longitudes_counted_all_around_the_earth_are_west_of_greenwich(tmp_path):
    west = Field("west", MultiPolygon([box(-121.001, 38.0, -121.0, 38.001)]))
    place = from_origin(360 - 121.002, 38.002, 1e-4, 1e-4)
    read = read_raster(write(tmp_path / "r.tif", ramp(40), place, "EPSG:4326"), near=west)
    # 15 pixels from the west, 25 from the south
    assert read.value.at(np.array([[-121.00045, 38.00055]])).tolist() == [15 + 1000 * 25]
    assert said(read, "west of Greenwich")


@pytest.mark.parametrize("degrees", [30.0, -100.0])
def test_a_turned_raster_is_followed_and_said(tmp_path, degrees):
    place = turned(degrees)
    read = read_raster(write(tmp_path / "r.tif", ramp(), place), near=PLOT)
    x, y = TO_UTM.transform(*SPOTS.T)
    columns, rows = (~place) @ (np.array(x), np.array(y))
    wanted = np.floor(columns) + 1000 * (399 - np.floor(rows))
    np.testing.assert_array_equal(read.value.at(SPOTS), wanted)
    assert said(read, "turned by")


def test_a_raster_that_begins_in_the_south_is_followed_and_said(tmp_path):
    west, north = corner()
    place = Affine(1.0, 0.0, west, 0.0, 1.0, north - 400)
    read = read_raster(write(tmp_path / "r.tif", ramp()[::-1].copy(), place), near=PLOT)
    np.testing.assert_array_equal(read.value.at(SPOTS), expected(SPOTS))
    assert said(read, "first line lies in the south")


def test_a_missing_coordinate_system_is_asked_for_with_candidates(tmp_path):
    path = write(tmp_path / "r.tif", ramp(), crs=None)
    with pytest.raises(ChoiceNeeded, match="coordinate system") as asked:
        read_raster(path, near=PLOT)
    assert asked.value.option == "crs"
    assert UTM in asked.value.choices
    read = read_raster(path, RasterOptions().choose("crs", UTM), near=PLOT)
    np.testing.assert_array_equal(read.value.at(SPOTS), expected(SPOTS))


def test_a_prj_and_a_world_file_beside_it_are_used(tmp_path):
    path = write(tmp_path / "r.tif", ramp(), transform=False, crs=None)
    west, north = corner()
    (tmp_path / "r.tfw").write_text(f"1\n0\n0\n-1\n{west + 0.5}\n{north - 0.5}\n")
    (tmp_path / "r.prj").write_text(rasterio.crs.CRS.from_string(UTM).to_wkt())
    read = read_raster(path, near=PLOT)
    np.testing.assert_array_equal(read.value.at(SPOTS), expected(SPOTS))
    assert said(read, r"\.prj file")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for part in tmp_path.iterdir():
            archive.write(part, f"ortho/{part.name}")
    read = read_raster(Upload("ortho.zip", packed.getvalue()), near=PLOT)
    np.testing.assert_array_equal(read.value.at(SPOTS), expected(SPOTS))


def test_a_picture_without_a_position_is_refused(tmp_path):
    path = write(tmp_path / "r.tif", ramp(dtype="uint8"), transform=False)
    assert "picture without a position" in refused(path)
    picture = Upload("r.png", b"\x89PNG\r\n\x1a\n" + b"\x00" * 40)
    assert "positions in photos are not read" in refused(picture)


def test_control_points_alone_are_refused(tmp_path):
    from rasterio.control import GroundControlPoint

    points = [
        GroundControlPoint(r, c, 35.15 + c * 1e-5, 30.36 - r * 1e-5) for r in (0, 9) for c in (0, 9)
    ]
    path = write(
        tmp_path / "r.tif", np.ones((10, 10), "uint8"), transform=False, crs="EPSG:4326",
        gcps=points,
    )  # fmt: skip
    assert "control points" in refused(path)


def test_pixels_without_ground_are_refused(tmp_path):
    path = write(tmp_path / "r.tif", ramp(dtype="uint8"), Affine(1, 1, 7e5, 1, 1, 3e6))
    assert "cover some ground" in refused(path)


def test_metres_called_degrees_are_asked_about(tmp_path):
    path = write(tmp_path / "r.tif", ramp(dtype="uint8"), crs="EPSG:4326")
    assert "lies nowhere so" in refused(path)


def test_a_vrt_in_disguise_is_refused(tmp_path):
    write(tmp_path / "secret.tif", ramp())
    vrt = (
        '<VRTDataset rasterXSize="400" rasterYSize="400">'
        '<VRTRasterBand dataType="Float32" band="1">'
        f"<SimpleSource><SourceFilename>{tmp_path / 'secret.tif'}</SourceFilename></SimpleSource>"
        "</VRTRasterBand></VRTDataset>"
    )
    assert "VRT" in refused(Upload("harmless.tif", vrt.encode()))
    assert "web service" in refused(Upload("harmless.tif", b"<GDAL_WMS></GDAL_WMS>"))


def test_what_lies_beside_a_raster_is_not_followed(tmp_path):
    path = write(tmp_path / "r.tif", ramp())
    plain = read_raster(path).value
    other = write(tmp_path / "other.tif", np.full((400, 400), 5.0, "float32"))
    shutil.copy(other, tmp_path / "r.tif.msk")
    shutil.copy(other, tmp_path / "r.tif.ovr")
    (tmp_path / "r.tif.aux.xml").write_text(
        "<PAMDataset><GeoTransform>0,1,0,0,0,-1</GeoTransform>"
        f"<Metadata domain='GEOLOCATION'><MDI key='X_DATASET'>{other}</MDI></Metadata></PAMDataset>"
    )
    again = read_raster(path).value
    np.testing.assert_array_equal(again.values, plain.values)
    assert again.to_map == plain.to_map


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("plots.geojson", b'{"type": "FeatureCollection", "features": []}', "must be a GeoTIFF"),
        ("empty.tif", b"", "is empty"),
        ("head.tif", b"II*\x00\x08\x00\x00\x00", "whole GeoTIFF"),
        ("noise.tif", b"II*\x00" + b"\x07" * 500, "whole GeoTIFF"),
        ("one tile", declared(20_000, 20_000, 16_384), "tiles or strips of 200 MB"),
        ("bomb.tif", declared(100_000, 100_000, 8192), "1 GB of a raster"),
        ("huge.tif", declared(2**31 - 16, 2**31 - 16), ""),
    ],
    ids=lambda value: value if isinstance(value, str) and len(value) < 20 else "",
)
def test_unusable_files_are_refused_with_a_sentence(name, data, words):
    assert words in refused(Upload(name, data))


def test_a_truncated_raster_is_refused(tmp_path):
    data = write(tmp_path / "r.tif", ramp(), compress="deflate").read_bytes()
    for share in (0.3, 0.6, 0.9):
        assert "whole GeoTIFF" in refused(Upload("r.tif", data[: int(share * len(data))]))


def test_complex_numbers_are_refused(tmp_path):
    path = write(tmp_path / "radar.tif", np.ones((40, 40), "complex64"))
    with pytest.raises(FileProblem, match="complex"):
        read_raster(path)
    with pytest.raises(FileProblem, match="complex"):
        read_backdrop(path)
