import base64
import io
import re
import shutil
import warnings
import zipfile

import numpy as np
import pytest
import rasterio
import shapely
from pyproj import Transformer
from rasterio.transform import Affine, from_origin
from shapely import MultiPolygon, box

from fieldmon.errors import ChoiceNeeded, FieldmonError, FileProblem
from fieldmon.io.import_report import Severity
from fieldmon.io.options import PlotOptions, Upload
from fieldmon.io.rasters import reading
from fieldmon.io.rasters.read import RasterOptions, read_backdrop, read_raster
from fieldmon.io.read import read_plots
from fieldmon.io.sandbox import limits
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.plot import planting_of
from tests import fuzz_rasters
from tests.io.rasters.raster_files import (
    PLOT,
    TO_UTM,
    UTM,
    alpha_last,
    corner,
    declared,
    palette,
    ramp,
    turned,
    write,
)
from tests.paths import SAMPLE_DATA

SPOTS = np.array([[35.1503, 30.3602], [35.1510, 30.3605], [35.1519, 30.3607]])


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


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"tiled": True, "blockxsize": 128, "blockysize": 128, "compress": "deflate"},
        {"compress": "lzw", "predictor": 3},
        {"nodata": -1.0},
        {"BIGTIFF": "YES"},
    ],
    ids=["strips", "tiles", "lzw", "nodata", "bigtiff"],
)
def test_values_are_those_of_the_ground(tmp_path, more):
    path = write(tmp_path / "r.tif", ramp(), **more)
    read = read_raster(path, near=PLOT)
    np.testing.assert_array_equal(read.value.at(SPOTS), expected(SPOTS))
    assert read.worst is Severity.SEEN
    assert said(read, r"band 1 of 1 \(float32\), 400 x 400 pixels of 1 m")
    upload = read_raster(Upload("r.tif", path.read_bytes()))
    np.testing.assert_array_equal(upload.value.at(SPOTS), expected(SPOTS))


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


def test_only_the_ground_about_the_plot_is_read(tmp_path):
    small = Field("small", PLOT.boundary.buffer(-0.0004))
    read = read_raster(write(tmp_path / "r.tif", ramp()), near=small)
    assert read.value.values.size < 0.1 * 400 * 400
    inside = SPOTS[1:2]
    np.testing.assert_array_equal(read.value.at(inside), expected(inside))


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


def test_no_value_is_kept_apart_from_zero_and_counted(tmp_path):
    values = np.zeros((400, 400), "int16")
    values[:, :200] = -99
    read = read_raster(write(tmp_path / "r.tif", values, nodata=-99), near=PLOT)
    np.testing.assert_array_equal(read.value.at(SPOTS), [np.nan, np.nan, 0.0])
    (covers,) = said(read, r"covers 50\.?\d* % of plot home", Severity.DOUBTFUL)
    assert covers
    assert said(read, r"50 % of the pixels read have no value")


def test_a_nan_is_no_value(tmp_path):
    values = ramp()
    values[:200] = np.nan
    read = read_raster(write(tmp_path / "r.tif", values), near=PLOT)
    assert np.isnan(read.value.at(SPOTS)).tolist() == [False, True, True]


@pytest.mark.parametrize("value", [-9999.0, -3.4028235e38])
def test_an_undeclared_no_value_is_guessed_and_can_be_taken_back(tmp_path, value):
    values = ramp()
    values[:200] = value
    path = write(tmp_path / "r.tif", values)
    read = read_raster(path, near=PLOT)
    assert np.isnan(read.value.at(SPOTS)).tolist() == [False, True, True]
    (guess,) = said(read, "taken as no value", Severity.GUESSED)
    assert (guess.remedy.option, guess.remedy.value) == ("nodata", "none")
    as_is = RasterOptions().choose(guess.remedy.option, guess.remedy.value)
    assert read_raster(path, as_is, near=PLOT).value.at(SPOTS)[1] == np.float32(value)


def test_what_stands_for_no_value_can_be_named(tmp_path):
    values = ramp()
    values[:200] = 7.0
    path = write(tmp_path / "r.tif", values)
    read = read_raster(path, RasterOptions(nodata="7"), near=PLOT)
    assert np.isnan(read.value.at(SPOTS)).tolist() == [False, True, True]


def test_a_mask_band_and_an_alpha_band_say_where_no_value_is(tmp_path):
    mask = np.full((400, 400), 255, "uint8")
    mask[:200] = 0
    ones = np.ones((400, 400), "uint8")
    with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=True):
        masked = write(tmp_path / "m.tif", ones, bands=[lambda tif: tif.write_mask(mask)])
    seen_through = write(tmp_path / "a.tif", np.stack([ones, ones, ones, mask]), bands=[alpha_last])
    for path in (masked, seen_through):
        read = read_raster(path, RasterOptions(band="1"), near=PLOT)
        np.testing.assert_array_equal(read.value.at(SPOTS), [1.0, np.nan, np.nan])
        picture = read_backdrop(path).value
        assert picture.mime == "image/webp"
        alpha = shown(picture)[3]
        assert (alpha[:199] == 0).all()
        assert (alpha[201:] == 255).all()


def test_scale_and_offset_are_applied_after_nodata_and_said(tmp_path):
    values = np.full((400, 400), 150, "int16")
    values[:200] = -32768

    def scaled(tif):
        tif.scales, tif.offsets = (0.01,), (-1.0,)

    path = write(tmp_path / "ndvi.tif", values, nodata=-32768, bands=[scaled])
    read = read_raster(path, near=PLOT)
    np.testing.assert_allclose(read.value.at(SPOTS), [0.5, np.nan, np.nan], atol=1e-6)
    assert said(read, "times 0.01, plus -1")


def test_several_bands_are_asked_for_and_named_by_number_or_description(tmp_path):
    cube = np.stack([np.full((40, 40), n, "uint16") for n in (10, 20, 30, 40, 50)])

    def describe(tif):
        tif.set_band_description(4, "NIR")

    path = write(tmp_path / "r.tif", cube, bands=[describe])
    with pytest.raises(ChoiceNeeded, match="5 bands") as asked:
        read_raster(path)
    assert (asked.value.option, asked.value.choices) == ("band", ("1", "2", "3", "4", "5"))
    for band in ("4", "NIR"):
        assert read_raster(path, RasterOptions(band=band)).value.at(SPOTS)[0] == 40
    for band in ("6", "0", "RED"):
        with pytest.raises(ChoiceNeeded, match="bands 1 to 5"):
            read_raster(path, RasterOptions(band=band))


def test_a_raster_beside_the_plot_is_refused_with_the_distance(tmp_path):
    west, north = corner()
    path = write(tmp_path / "r.tif", ramp(), from_origin(west + 20_000, north, 1, 1))
    for door in (read_raster, read_backdrop):
        with pytest.raises(FileProblem, match="20 km away"):
            door(path, near=PLOT)


def test_a_raster_with_nothing_but_nodata_on_the_plot_is_refused(tmp_path):
    values = np.full((400, 400), -1.0, "float32")
    values[:140] = 1.0  # ends some metres north of it
    path = write(tmp_path / "r.tif", values, nodata=-1)
    with pytest.raises(FileProblem, match="there it holds none"):
        read_raster(path, near=PLOT)
    values[:] = -1.0
    path = write(tmp_path / "r.tif", values, nodata=-1)
    with pytest.raises(FileProblem, match="nodata"):
        read_raster(path)
    with pytest.raises(FileProblem, match="no value"):
        read_backdrop(path)


def test_the_share_of_the_plot_that_is_covered_is_said(tmp_path):
    west, north = corner()
    x, _ = TO_UTM.transform((35.1500 + 35.1521) / 2, 30.36045)
    assert x == pytest.approx(west + 200)
    path = write(tmp_path / "r.tif", ramp(), from_origin(west + 150, north, 1, 1))
    (covers,) = said(read_raster(path, near=PLOT), "of plot home", Severity.DOUBTFUL)
    share = float(re.search(r"covers ([\d.]+) %", covers.sentence).group(1))
    wide = TO_UTM.transform(35.1521, 30.36045)[0] - TO_UTM.transform(35.15, 30.36045)[0]
    assert share == pytest.approx(100 * (50 + wide / 2) / wide, abs=1.0)


def test_a_tiny_raster_serves(tmp_path):
    west, north = corner()
    path = write(
        tmp_path / "r.tif", np.array([[3.0]], "float32"), from_origin(west, north, 400, 400)
    )
    assert read_raster(path, near=PLOT).value.at(SPOTS).tolist() == [3.0, 3.0, 3.0]
    assert shown(read_backdrop(path, near=PLOT).value).shape == (3, 1, 1)


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


# pictures for the map


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


def test_a_backdrop_can_be_handed_to_a_map_as_text(tmp_path):
    picture = read_backdrop(write(tmp_path / "r.tif", ramp())).value
    kind, _, text = picture.data_uri.partition(",")
    assert kind == "data:image/jpeg;base64"
    assert base64.b64decode(text) == picture.image


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


# hostile and unusable


def refused(source, options=None):
    """Return the sentence with which both doors refuse a source."""
    with pytest.raises(FieldmonError) as first:
        read_raster(source, options)
    with pytest.raises(FieldmonError) as second:
        read_backdrop(source, options)
    assert type(first.value) is type(second.value)
    return str(first.value)


def test_a_picture_without_a_position_is_refused(tmp_path):
    path = write(tmp_path / "r.tif", ramp(dtype="uint8"), transform=False)
    assert "picture without a position" in refused(path)
    assert "without a position" in refused(Upload("r.png", b"\x89PNG\r\n\x1a\n" + b"\x00" * 40))


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


def test_a_huge_raster_serves_where_only_the_plot_is_read():
    # 10 gigapixels of nothing: only the tiles about the plot are looked at
    sparse = Upload("huge.tif", declared(100_000, 100_000, 1024))
    read = read_raster(sparse, near=PLOT)
    assert (read.value.at(SPOTS) == 0.0).all()
    assert read.value.values.size < 500 * 500


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


def test_damaged_rasters_leave_nothing_but_sentences():
    tally = fuzz_rasters.fuzz(66)
    assert tally.failures == []
    assert tally.outcomes["came in"] > 0
    assert tally.outcomes["refused"] > 0


def test_the_fuzzer_notices_what_it_looks_for(monkeypatch):
    def wrong(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(fuzz_rasters, "read_raster", wrong)
    assert fuzz_rasters.fuzz(1).failures == ["input 0: ZeroDivisionError: "]


def test_the_same_number_gives_the_same_file(tmp_path):
    for number, seed in enumerate(fuzz_rasters.seeds(tmp_path)):
        once, again = (fuzz_rasters.mutated(seed, np.random.default_rng(number)) for _ in range(2))
        assert once == again
        assert once != seed
