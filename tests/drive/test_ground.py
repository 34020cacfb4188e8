"""Uneven ground under a simulated robot."""

import numpy as np
import pytest
import rasterio
from rasterio.transform import from_origin

from fieldmon.drive.ground import ground_of_raster, rough_ground
from fieldmon.errors import FieldmonError, SettingError


def test_bumps_are_as_high_as_was_said_and_the_same_with_a_seed(plot):
    ground = rough_ground(plot.grid, 0.03, seed=4)
    assert ground.height_m.std() == pytest.approx(0.03)
    assert ground.height_m.min() == 0.0
    assert (rough_ground(plot.grid, 0.03, seed=4).height_m == ground.height_m).all()
    assert not (rough_ground(plot.grid, 0.03, seed=5).height_m == ground.height_m).all()
    assert not rough_ground(plot.grid, 0.0).height_m.any()


@pytest.mark.parametrize("rough_m", [-0.1, 0.5, float("nan")])
def test_ground_that_no_wheel_drives_on_is_refused(plot, rough_m):
    with pytest.raises(SettingError, match=r"0 to 0\.3 metres"):
        rough_ground(plot.grid, rough_m)


def raster(plot, file, heights):
    west, south, east, north = plot.field.boundary.bounds
    size = (east - west + 0.002) / heights.shape[1], (north - south + 0.002) / heights.shape[0]
    place = {"crs": "EPSG:4326", "transform": from_origin(west - 0.001, north + 0.001, *size)}
    kind = {"driver": "GTiff", "count": 1, "dtype": "float32", "nodata": -9999}
    rows, columns = heights.shape
    with rasterio.open(file, "w", width=columns, height=rows, **kind, **place) as tif:
        tif.write(heights.astype("float32"), 1)
    return file


def test_a_slope_of_a_raster_is_the_slope_of_the_ground(plot, tmp_path):
    """Higher to the north by a metre a row of the raster, wherever rows of plants point."""
    file = raster(plot, tmp_path / "dem.tif", 300.0 + np.repeat(np.arange(40.0)[::-1, None], 40, 1))
    ground = ground_of_raster(plot.grid, plot.field, file)
    assert ground.height_m.min() == 0.0
    lonlat = plot.grid.lonlat()
    north = np.polyfit(lonlat[:, 1], ground.at(plot.grid.xy_m), 1)
    _west, south, _east, top = plot.field.boundary.bounds
    assert north[0] == pytest.approx(40.0 / (top - south + 0.002), rel=0.02)


def test_a_raster_of_elsewhere_is_refused(plot, tmp_path):
    file = raster(plot, tmp_path / "dem.tif", np.full((9, 9), -9999.0))
    with pytest.raises(FieldmonError):
        ground_of_raster(plot.grid, plot.field, file)
