"""One value that many plants share: a raster that tells nothing, or no value in disguise."""

import numpy as np
import pytest

from fieldmon.infestation.prior.raster_risk import RiskSettings
from fieldmon.io.import_report import Severity
from fieldmon.io.rasters.at_plants import read_missing, read_risk
from fieldmon.io.rasters.read import RasterOptions
from fieldmon.io.rasters.shared_values import doubts_of_alike
from fieldmon.io.rasters.values import Raster
from fieldmon.plot.plot import Plot
from tests.io.rasters.raster_files import PLOT, UTM, corner, ramp, said, write

HOME = Plot.of(PLOT)
RANK = RiskSettings("rank", mean_share=0.02, low_is_risky=True)


def noise(dtype="float32", levels=None):
    """Return values that no two pixels share, or of so many levels."""
    values = np.random.default_rng(1).normal(0.6, 0.1, (400, 400))
    if levels is not None:
        values = np.clip(np.round(values * levels), 0, levels)
    return values.astype(dtype)


def doubts(values, how="mean", least=0.01, *, zero_is_none=False):
    """Return what is doubted of values on 400 m about the plot."""
    (west, north), (height, width) = corner(), values.shape
    raster = Raster(values.copy(), (400 / width, 0.0, west, 0.0, -400 / height, north), UTM)
    at = raster.of_plants(HOME.grid, how)
    return doubts_of_alike(at, raster, HOME.grid, least, zero_is_none=zero_is_none)


@pytest.mark.parametrize("how", ["nearest", "bilinear", "mean", "highest"])
def test_a_raster_that_is_the_same_everywhere_says_nothing(how):
    (doubt,) = doubts(np.full((400, 400), 0.3, "float32"), how)
    assert doubt.severity is Severity.DOUBTFUL
    assert "same value, 0.3, at all plants that it shows, and tells none of" in doubt.sentence
    half = np.full((400, 400), 0.3, "float32")
    half[:, :190] = np.nan
    assert "same value, 0.3, at all plants" in doubts(half, how)[0].sentence


@pytest.mark.parametrize("value", [0.0, -1.0, 255.0])
def test_one_value_up_to_where_the_raster_ends_may_stand_for_none(value):
    values = noise()
    values[:, 200:] = value
    (doubt,) = doubts(values)
    assert f"have exactly {value:g} on it, in a piece that reaches" in doubt.sentence
    assert doubt.sentence.startswith(("48 %", "49 %", "50 %", "51 %"))
    assert (doubt.remedy.option, doubt.remedy.value) == ("nodata", f"{value:g}")


def test_what_lies_within_the_raster_or_comes_in_levels_is_no_doubt():
    values = noise()
    values[150:250, 180:220] = 0.0  # a pond
    assert doubts(values) == []
    values[:100] = np.nan
    assert doubts(values) == []
    values[:200, 200] = 0.0  # and a ditch from it
    assert "exactly 0" in doubts(values)[0].sentence
    assert doubts(noise("uint8", 255)) == []
    assert doubts(np.where(noise() > 0.6, 1.0, 0.0).astype("float32"), "nearest") == []
    terraces = np.floor(np.indices((400, 400))[1] / 5.0).astype("float32")
    assert doubts(terraces, "nearest") == []


def test_no_chance_is_as_good_as_no_value():
    values = noise()
    values[:, 200:] = 0.0
    assert doubts(values, zero_is_none=True) == []
    values[:, 200:] = 1.0
    assert "exactly 1" in doubts(values, zero_is_none=True)[0].sentence


def test_a_rank_that_is_half_zeros_is_doubted_and_read_right_as_the_doubt_says(tmp_path):
    values = (1000.0 * noise()).astype("int16")
    values[:, 200:] = 0

    def scaled(tif):
        tif.scales, tif.offsets = (0.001,), (-1.0,)

    path = write(tmp_path / "ndvi.tif", values, bands=[scaled])
    read = read_risk(path, RasterOptions(), HOME, RANK)
    (doubt,) = said(read, "exactly -1 on it", Severity.DOUBTFUL)
    assert doubt.remedy.value == "0"
    options = RasterOptions().choose(doubt.remedy.option, doubt.remedy.value)
    again = read_risk(path, options, HOME, RANK)
    assert not said(again, "exactly")
    assert np.isnan(again.value).mean() == pytest.approx(0.5, abs=0.03)


def test_a_canopy_of_zeros_up_to_its_end_is_doubted_where_much_would_be_missing(tmp_path):
    values = noise()
    values[:, 200:] = 0.0
    read = read_missing(write(tmp_path / "canopy.tif", values), RasterOptions(), HOME, 0.2)
    assert said(read, "exactly 0 on it", Severity.DOUBTFUL)
    values = noise()
    values[:, :120] = 0.0
    few = read_missing(write(tmp_path / "few.tif", values), RasterOptions(), HOME, 0.2)
    assert few.value.any()
    assert not said(few, "exactly")
    assert not said(read_risk(write(tmp_path / "r.tif", ramp()), RasterOptions(), HOME, RANK), "ex")
