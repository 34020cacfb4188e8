"""Strips in which whole rows fit into an area."""

import numpy as np
import pytest
import shapely
from hypothesis import example, given
from hypothesis import strategies as st
from shapely import MultiPolygon, Polygon

from fieldmon.plot.strips import free_intervals
from tests.crooked import areas


@given(areas(30.0), st.floats(1.0, 8.0), st.floats(0.0, 1.0))
@example(MultiPolygon([shapely.box(-5, -4, 5, 4)]), 4.0, 0.0)
@example(Polygon([(0, 0), (9, 0), (9, 9), (5, 2), (0, 9)]), 3.0, 0.0)
@example(Polygon([(6, -6), (-6, -6), (-6, 6), (4.8, 6), (4.8, 1e-320), (6, 2e-320)]), 1.0, 0.0)
def test_free_stretches_of_a_strip_are_those_that_shapely_finds(area, width_m, phase):
    _, low, _, high = area.bounds
    low_y = np.arange(low - phase * width_m, high, width_m)
    free = free_intervals(area, low_y, low_y + width_m)
    assert (free.low_x < free.high_x).all()
    for k, y in enumerate(low_y):
        strip = shapely.box(-500, y, 500, y + width_m)
        taken = shapely.get_parts(shapely.difference(strip, area))
        if any(0.0 < t.area <= 1e-9 for t in taken):
            continue  # what reaches in by a hair does so or not as its last digit is rounded
        shadow = shapely.union_all(
            [shapely.box(t.bounds[0], 0, t.bounds[2], 1) for t in taken if t.area > 1e-9]
        )
        expected = shapely.get_parts(shapely.difference(shapely.box(-500, 0, 500, 1), shadow))
        bounds = sorted((p.bounds[0], p.bounds[2]) for p in expected if p.area > 1e-6)
        mine = free.strip == k
        found = np.stack([free.low_x[mine], free.high_x[mine]], axis=1)
        found = found[np.ptp(found, axis=1) > 1e-6]
        assert found.reshape(-1) == pytest.approx(np.ravel(bounds), abs=1e-6)
