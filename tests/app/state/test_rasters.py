"""What rasters of a session say of a plot; one that cannot be used is left out and said."""

from types import SimpleNamespace

import numpy as np
import pytest

from app.state import brought_files, rasters
from tests.app.chosen import CORNER, a_plot
from tests.app.driving import geotiff

LON, LAT = CORNER
EDGES = (LON - 0.001, LAT - 0.001, LON + 0.0016, LAT + 0.0016)


@pytest.fixture(scope="module")
def plot():
    return a_plot()


def bring(kind, data):
    brought_files.keep(kind, [SimpleNamespace(name=f"{kind}.tif", getvalue=lambda: data)])


@pytest.mark.usefixtures("session")
def test_without_a_raster_nothing_changes(plot):
    assert rasters.without_missing(plot, "key") == (plot, (), "key")
    assert rasters.risk(plot, "key") == (None, (), "key")


def test_a_raster_s_key_stands_for_the_file_and_how_it_is_read(plot, session):
    bring(rasters.RISK, geotiff(np.full((30, 30), 0.2, np.float32), EDGES))
    assert rasters.risk(plot, "key") == (None, (), "key")
    assert "nothing says" in str(rasters.problem(rasters.RISK))
    session[rasters.RISK_MEANING] = "chance"
    risk, said, key = rasters.risk(plot, "key")
    assert risk == pytest.approx(0.2, abs=1e-6)
    assert [one.asked for one in said] == [brought_files.brought()[rasters.RISK].asked] * len(said)
    session[rasters.RISK_MEANING] = "percent"
    less, _, other = rasters.risk(plot, "key")
    assert less == pytest.approx(0.002, abs=1e-6)
    assert key.startswith("key ")
    assert other.startswith("key ")
    assert other != key


def test_plants_are_missing_below_the_value_in_the_box(plot, session):
    half = np.repeat([[0.2, 1.5]], 15, axis=1).repeat(30, axis=0).astype(np.float32)
    bring(rasters.MISSING, geotiff(half, (LON, LAT - 0.001, LON + 0.0006, LAT + 0.0016)))
    left, _, key = rasters.without_missing(plot, "key")
    assert 0.3 < len(left.grid) / len(plot.grid) < 0.7
    session[rasters.MISSING_BELOW] = 0.1
    every, _, other = rasters.without_missing(plot, "key")
    assert len(every.grid) == len(plot.grid)
    assert other != key


def test_a_raster_that_cannot_be_used_is_left_out_and_its_problem_kept_until_it_is_gone(
    plot, session
):
    session[rasters.RISK_MEANING] = "chance"
    bring(rasters.RISK, geotiff(np.full((30, 30), 7.0, np.float32), EDGES))
    assert rasters.risk(plot, "key") == (None, (), "key")
    assert "0..1" in str(rasters.problem(rasters.RISK))
    bring(rasters.RISK, geotiff(np.full((30, 30), 0.7, np.float32), EDGES))
    assert rasters.risk(plot, "key")[0] is not None
    assert rasters.problem(rasters.RISK) is None
