"""Rasters about a plot: how much of it they cover, and what a damaged one leaves."""

import re

import numpy as np
import pytest
from rasterio.transform import from_origin

from fieldmon.errors import FileProblem
from fieldmon.io.import_report import Severity
from fieldmon.io.rasters.read import read_backdrop, read_raster
from fieldmon.plot.field import Field
from tests import fuzz_rasters
from tests.io.rasters.raster_files import (
    PLOT,
    SPOTS,
    TO_UTM,
    corner,
    expected,
    ramp,
    said,
    shown,
    write,
)
from tests.thorough import times


def test_only_the_ground_about_the_plot_is_read(tmp_path):
    small = Field("small", PLOT.boundary.buffer(-0.0004))
    read = read_raster(write(tmp_path / "r.tif", ramp()), near=small)
    assert read.value.values.size < 0.1 * 400 * 400
    inside = SPOTS[1:2]
    np.testing.assert_array_equal(read.value.at(inside), expected(inside))


def test_a_raster_beside_the_plot_is_refused_with_the_distance(tmp_path):
    west, north = corner()
    path = write(tmp_path / "r.tif", ramp(), from_origin(west + 20_000, north, 1, 1))
    for door in (read_raster, read_backdrop):
        with pytest.raises(FileProblem, match="20 km away"):
            door(path, near=PLOT)


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


def test_damaged_rasters_leave_nothing_but_sentences():
    tally = fuzz_rasters.fuzz(times(22, 2000))
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
