import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyproj import Transformer

from fieldmon.io.rasters.interpolated_projection import smoothly
from fieldmon.plot.projection import Frame


@settings(max_examples=25)
@given(
    lon=st.floats(-179.0, 179.0),
    lat=st.floats(-65.0, 65.0),
    sides_m=st.tuples(st.floats(1.0, 10_000.0), st.floats(1.0, 10_000.0)),
    bearing=st.floats(0.0, 360.0),
)
def test_positions_read_off_between_nodes_are_within_a_millimetre(lon, lat, sides_m, bearing):
    frame = Frame(lon, lat, bearing)
    zone = min(int((lon + 180) // 6) + 1, 60)
    to_map = Transformer.from_crs("OGC:CRS84", f"EPSG:{32600 + zone}", always_xy=True)
    calls = []

    def exact(xy_m):
        calls.append(len(xy_m))
        return np.stack(to_map.transform(*frame.lonlat(xy_m).T), axis=1)

    xy_m = (np.random.default_rng(1).random((30_000, 2)) - 0.5) * sides_m
    there = smoothly(xy_m, exact)
    assert calls[0] < len(xy_m) / 2
    np.testing.assert_allclose(there, exact(xy_m), atol=1e-3)


@pytest.mark.parametrize("n", [1, 2, 9_999])
def test_few_positions_are_worked_out_one_by_one(n):
    xy_m = np.random.default_rng(2).random((n, 2)) * 1000.0
    np.testing.assert_array_equal(smoothly(xy_m, lambda xy: xy**2), xy_m**2)


def test_a_single_row_of_plants_has_no_breadth_and_serves():
    xy_m = np.stack([np.arange(20_000.0), np.zeros(20_000)], axis=1)
    np.testing.assert_allclose(smoothly(xy_m, lambda xy: 3 * xy + 7.0), 3 * xy_m + 7.0)
