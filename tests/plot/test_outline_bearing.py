"""Rows run along the longest side of a plot, also where its outline was walked with a phone."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import MultiPolygon

from fieldmon.plot.field import Field
from fieldmon.plot.outline_bearing import area_bearing, bearing_of, outline_bearing
from fieldmon.plot.projection import Frame
from tests.plot.test_row_detection import field_of, off_deg
from tests.walked import walked


@given(st.floats(0, 180), st.floats(1.3, 20.0))
def test_rows_run_along_the_long_side_of_a_plot(bearing_deg, times_longer):
    plot = field_of(shapely.box(0, 0, 30 * times_longer, 30), bearing_deg)
    assert off_deg(bearing_of(plot).bearing_deg, bearing_deg) < 0.01


def test_a_ragged_short_end_does_not_turn_the_rows():
    saw = [(200 + 8 * (k % 2), 5 * k) for k in range(13)]
    plot = field_of(shapely.Polygon([(0, 0), *saw, (0, 60)]), 33.0)
    assert off_deg(bearing_of(plot).bearing_deg, 33.0) < 0.1


def test_a_long_side_drawn_by_a_shaky_hand_keeps_its_direction():
    rng = np.random.default_rng(3)
    x = np.linspace(0, 200, 41)
    lower, upper = (np.stack([x, y + rng.normal(scale=0.1, size=41)], axis=1) for y in (0, 90))
    plot = field_of(shapely.Polygon(np.concatenate([lower, upper[::-1]])), 140.0)
    assert off_deg(bearing_of(plot).bearing_deg, 140.0) < 0.3


def test_the_largest_part_decides():
    big, small = shapely.box(0, 0, 100, 60), shapely.box(120, 0, 130, 90)
    frame = Frame(35.15, 30.36, 50.0)
    plot = Field("two", MultiPolygon([frame.geometry_lonlat(part) for part in (small, big)]))
    assert off_deg(bearing_of(plot).bearing_deg, 50.0) < 0.1


def test_a_direction_close_to_north_is_found_from_both_sides_of_it():
    ring = [(0, 0), (0.5, 100), (-0.5, 200), (20, 200), (20.5, 100), (19.5, 0)]
    assert off_deg(bearing_of(field_of(shapely.Polygon(ring))).bearing_deg, 0.0) < 0.3


# --- as it was walked ------------------------------------------------------------------------

BLOCK = [(0, 0), (160, 10), (150, 110), (-5, 100)]
ANGLE = [(0, 0), (240, 0), (240, 60), (80, 60), (80, 140), (0, 140)]
SLOPE = [(0, 0), (190, 0), (60, 110)]
STRIP = [(0, 0), (300, 40), (295, 85), (-5, 45)]


@pytest.mark.parametrize(
    ("step_m", "noise_m", "drift_m", "most_deg"),
    [(3, 0.3, 0, 0.5), (3, 1, 0, 1), (1, 1, 0, 1), (8, 2, 0, 3), (3, 0.1, 1, 3)],
)
@pytest.mark.parametrize("corners", [BLOCK, ANGLE, SLOPE, STRIP])
def test_a_walked_outline_has_the_bearing_of_its_longest_side(
    corners, step_m, noise_m, drift_m, most_deg
):
    wanted = area_bearing(shapely.Polygon(corners)).bearing_deg
    for seed in range(4):
        ring = walked(corners, step_m, noise_m, drift_m=drift_m, seed=seed)
        found = outline_bearing(ring)
        assert off_deg(found.bearing_deg, wanted) < most_deg
        assert 0 < found.off_deg < 4 * most_deg


def test_the_side_that_was_not_walked_is_no_longer_than_it_is():
    ring = walked(BLOCK, 3, 1)
    three_sides = ring[np.append(np.arange(137), 0)]
    wanted = area_bearing(shapely.Polygon(BLOCK)).bearing_deg
    assert off_deg(outline_bearing(three_sides).bearing_deg, wanted) < 1


def test_who_stands_at_corners_does_not_turn_the_rows():
    ring = walked(BLOCK, 3, 1, stand=20)
    wanted = area_bearing(shapely.Polygon(BLOCK)).bearing_deg
    assert off_deg(outline_bearing(ring).bearing_deg, wanted) < 1


def test_the_more_fixes_stray_the_less_sure_is_the_bearing():
    off = [np.mean([outline_bearing(walked(BLOCK, 3, noise, seed=k)).off_deg for k in range(5)])
           for noise in (0.5, 1.0, 3.0)]  # fmt: skip
    assert off[0] < 0.3 < off[1] < 1.0 < off[2]


def test_of_two_sides_about_as_long_the_other_is_named():
    square = outline_bearing(walked([(0, 0), (100, 0), (100, 98), (0, 98)], 3, 1))
    assert off_deg(square.or_deg, square.bearing_deg + 90) < 2
    assert outline_bearing(walked(STRIP, 3, 1)).or_deg is None


@pytest.mark.parametrize("corners", [BLOCK, ANGLE, SLOPE])
def test_a_clean_outline_is_not_doubted_however_many_corners_it_has(corners):
    ring = shapely.get_coordinates(shapely.Polygon(corners).exterior.segmentize(3.0))
    found, plain = outline_bearing(ring), area_bearing(shapely.Polygon(corners))
    assert (found.off_deg, found.or_deg) == (0.0, None)
    assert found.bearing_deg == pytest.approx(plain.bearing_deg)


def test_fixes_of_no_length_and_of_one_place_have_some_bearing():
    still = np.zeros((40, 2))
    assert outline_bearing(still).bearing_deg == 0.0
    thread = np.array([(k % 2, 0.1 * (k % 7)) for k in range(60)] + [(0, 0)])
    assert 0 <= outline_bearing(thread).bearing_deg < 180
