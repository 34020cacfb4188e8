"""Values of a raster: which band, what has no value, and how they are scaled."""

import numpy as np
import pytest
import rasterio

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Severity
from fieldmon.io.options import Upload
from fieldmon.io.rasters.read import RasterOptions, read_backdrop, read_raster
from tests.io.rasters.raster_files import (
    PLOT,
    SPOTS,
    alpha_last,
    expected,
    ramp,
    said,
    shown,
    write,
)


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
