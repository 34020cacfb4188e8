"""Areas are what the ellipsoid says, whatever the shape."""

from itertools import pairwise

import numpy as np
import pyproj
import pytest
import shapely
import shapely.affinity
from hypothesis import given
from hypothesis import strategies as st
from shapely import MultiPolygon, Polygon, box

from fieldmon.io.parse.geometry import area_m2, areas_m2, boundaries, boundary, steps_m

GEOD = pyproj.Geod(ellps="WGS84")


@given(
    lon=st.floats(-179, 179),
    lat=st.floats(-70, 70),
    size_deg=st.floats(1e-5, 0.01),
    corners=st.integers(3, 60),
    seed=st.integers(0, 1000),
)
def test_the_area_of_a_ragged_plot_with_a_hole_is_geodesic(lon, lat, size_deg, corners, seed):
    angle = np.sort(np.random.default_rng(seed).random(corners)) * 2 * np.pi
    ring = np.column_stack([lon + size_deg * np.cos(angle), lat + size_deg * np.sin(angle)])
    hole = box(lon - size_deg / 9, lat - size_deg / 9, lon + size_deg / 9, lat + size_deg / 9)
    plot = Polygon(ring).difference(hole)
    geodesic = abs(GEOD.geometry_area_perimeter(shapely.orient_polygons(plot))[0])
    # a side d bulges by d^2/8R tan(lat) at most; three of them, each twice the size; and the digits
    # of the oracle end at a thousandth of a square metre
    bulge_m2 = 6 * np.deg2rad(size_deg) * (size_deg * 111_000) ** 2
    assert area_m2(plot) == pytest.approx(geodesic, rel=1e-5, abs=bulge_m2 + 1e-3)


def test_the_whole_earth_but_the_poles_has_the_area_that_is_published():
    halves = MultiPolygon([box(-180, -90, 0, 90).segmentize(1), box(0, -90, 180, 90).segmentize(1)])
    assert area_m2(halves) == pytest.approx(510_065_621.724e6, rel=1e-9)


def shape_of(seed):
    """Return a star, perhaps crossing itself, tiny, in parts, or with a hole."""
    rng = np.random.default_rng(seed)
    size = float(rng.choice([1e-7, 1e-5, 1e-3]))
    ring = np.array([35.0, 30.0]) + size * rng.random((int(rng.integers(3, 9)), 2))
    star = Polygon(ring)
    kind = seed % 4
    if kind == 1:
        return MultiPolygon(
            [star.convex_hull, shapely.affinity.translate(star.convex_hull, 2 * size)]
        )
    if kind == 2:
        return star.convex_hull.difference(star.convex_hull.centroid.buffer(size / 20))
    return star if kind else star.convex_hull


@given(st.lists(st.integers(0, 10_000), min_size=1, max_size=12))
def test_areas_together_are_what_they_are_one_by_one(seeds):
    areas = np.array([shape_of(seed) for seed in seeds], dtype=object)
    names = [f"plot {i}" for i in range(len(seeds))]
    together, said = boundaries(areas, names)
    alone = [boundary(area, name) for area, name in zip(areas, names, strict=True)]
    for one, (other, _) in zip(together, alone, strict=True):
        assert one.geom_type == "MultiPolygon"
        assert one.normalize().equals_exact(other.normalize(), 0)
    told = [message for _, messages in alone for message in messages]
    assert sorted(map(str, said)) == sorted(map(str, told))
    np.testing.assert_allclose(areas_m2(together), [area_m2(one) for one, _ in alone])


def test_steps_are_geodesic_and_one_position_has_none():
    lonlat = np.array([[35.0, 31.0], [35.01, 31.0], [35.01, 31.02]])
    expected = [GEOD.inv(*a, *b)[2] for a, b in pairwise(lonlat)]
    assert steps_m(lonlat) == pytest.approx(expected)
    assert len(steps_m(lonlat[:1])) == len(steps_m(lonlat[:0])) == 0
