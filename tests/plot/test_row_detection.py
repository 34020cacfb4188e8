import numpy as np
import pytest
import shapely
from hypothesis import example, given
from hypothesis import strategies as st
from shapely import MultiLineString, MultiPolygon

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_detection import (
    distinct,
    frame_around,
    rows_from_lines,
    rows_from_plants,
    split_lines,
)


def field_of(area_m, bearing_deg=90.0, **known):
    """Return a plot from an area in metres, x along the bearing."""
    frame = Frame(35.15, 30.36, bearing_deg)
    return Field("plot", MultiPolygon([frame.geometry_lonlat(area_m)]), **known)


def off_deg(bearing_deg, wanted_deg):
    """Return the angle between two directions, either way along them."""
    return abs((bearing_deg - wanted_deg + 90.0) % 180.0 - 90.0)


def planted(n_rows, n_plants, row_spacing_m, plant_spacing_m):
    y, x = np.meshgrid(np.arange(n_rows), np.arange(n_plants), indexing="ij")
    return np.stack([x.ravel() * plant_spacing_m, y.ravel() * row_spacing_m], axis=1)


# --- from plants -----------------------------------------------------------------------------


@given(
    size=st.tuples(st.integers(5, 25), st.integers(8, 25)),
    spacing_m=st.tuples(st.floats(1.5, 5.0), st.floats(0.3, 0.8)),
    bearing_deg=st.floats(0, 180),
    missing=st.floats(0, 0.3),
    seed=st.integers(0, 2**32),
)
@example((10, 12), (2.5, 0.55), 170.0, 0.3, 1)
@example((20, 8), (4.0, 0.75), 0.0, 0.1, 2)
@example((12, 8), (2.0, 0.75), 0.0, 0.0, 12)
@example((5, 8), (2.0, 0.5), 0.0, 0.25, 353)
def test_rows_are_found_whatever_their_bearing_in_spite_of_missing_plants_and_gps_errors(
    size, spacing_m, bearing_deg, missing, seed
):
    row_spacing_m, plant_spacing_m = spacing_m[0], spacing_m[0] * spacing_m[1]
    rng = np.random.default_rng(seed)
    xy_m = planted(*size, row_spacing_m, plant_spacing_m)
    xy_m = xy_m[rng.random(len(xy_m)) >= missing]
    error_m = 0.1 * plant_spacing_m
    xy_m += rng.normal(scale=error_m, size=xy_m.shape)
    rows = rows_from_plants(Frame(35.15, 30.36, bearing_deg).lonlat(rng.permutation(xy_m)))
    # five standard errors of a direction fitted to rows of this length
    row_m = size[1] * plant_spacing_m
    standard_error = error_m / (row_m / np.sqrt(12.0) * np.sqrt(len(xy_m)))
    assert off_deg(rows.bearing_deg, bearing_deg) < np.rad2deg(5 * standard_error)
    assert rows.row_spacing_m == pytest.approx(row_spacing_m, rel=0.1)
    assert rows.plant_spacing_m == pytest.approx(plant_spacing_m, rel=0.15)
    assert "hardly" not in rows.how


@pytest.mark.parametrize("bearing_deg", [0.0, 33.0, 90.0, 170.5])
def test_exact_rows_are_found_exactly(bearing_deg):
    xy_m = planted(10, 12, 2.5, 1.393)
    rows = rows_from_plants(Frame(-0.52, 53.27, bearing_deg).lonlat(xy_m))
    assert off_deg(rows.bearing_deg, bearing_deg) < 0.001
    assert rows.row_spacing_m == pytest.approx(2.5, abs=1e-3)
    assert rows.plant_spacing_m == pytest.approx(1.393, abs=1e-3)
    assert "10 rows" in rows.how


def test_where_plants_stand_wider_in_the_row_than_between_rows_the_straight_lines_are_the_rows():
    rng = np.random.default_rng(5)
    xy_m = planted(30, 20, 2.0, 3.0) + rng.normal(scale=[0.3, 0.05], size=(600, 2))
    rows = rows_from_plants(Frame(11.5, 48.6, 62.0).lonlat(xy_m))
    assert off_deg(rows.bearing_deg, 62.0) < 0.5
    assert rows.row_spacing_m == pytest.approx(2.0, abs=0.05)
    assert rows.plant_spacing_m == pytest.approx(3.0, abs=0.1)


def test_a_known_bearing_decides_between_directions_that_are_equally_straight():
    square = Frame(35.15, 30.36, 20.0).lonlat(planted(12, 12, 3.0, 3.0))
    assert rows_from_plants(square, 25.0).bearing_deg == pytest.approx(20.0, abs=0.01)
    assert rows_from_plants(square, 105.0).bearing_deg == pytest.approx(110.0, abs=0.01)


def test_rows_of_very_unequal_length_and_many_plants_are_found():
    rng = np.random.default_rng(8)
    xy_m = planted(150, 150, 4.0, 3.0)
    slanted = xy_m[xy_m[:, 0] > 0.7 * xy_m[:, 1]]
    assert len(slanted) > 10_000
    xy_m = slanted + rng.normal(scale=0.2, size=slanted.shape)
    rows = rows_from_plants(Frame(35.15, 30.36, 71.0).lonlat(xy_m))
    assert off_deg(rows.bearing_deg, 71.0) < 0.05
    assert rows.row_spacing_m == pytest.approx(4.0, abs=0.05)
    assert rows.plant_spacing_m == pytest.approx(3.0, abs=0.05)


def test_of_one_row_the_row_spacing_stays_unknown():
    rows = rows_from_plants(Frame(35.15, 30.36, 12.0).lonlat(planted(1, 15, 1.0, 2.0)))
    assert off_deg(rows.bearing_deg, 12.0) < 0.01
    assert rows.row_spacing_m is None
    assert rows.plant_spacing_m == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize("seed", range(5))
def test_plants_scattered_anyhow_are_said_to_be_so(seed):
    xy_m = np.random.default_rng(seed).uniform(0, 100, (300, 2))
    assert "hardly stand in rows" in rows_from_plants(Frame(35.15, 30.36).lonlat(xy_m)).how


def test_one_plant_has_no_rows():
    with pytest.raises(PlotError, match="2 plants or more"):
        rows_from_plants(np.array([[35.0, 30.0]]))


def test_plants_all_in_the_same_places_have_no_rows():
    with pytest.raises(PlotError, match="share their position"):
        rows_from_plants(np.array([[35.0, 30.0], [35.001, 30.0]] * 10))


def test_doubles_leave_the_first():
    twice = np.array([[35.0, 30.0], [35.0001, 30.0], [35.0, 30.0000001], [35.0002, 30.0]])
    assert distinct(twice).tolist() == [0, 1, 3]
    assert distinct(twice, apart_m=15.0).tolist() == [0]
    assert distinct(twice[:2]).tolist() == [0, 1]


def test_lines_nearer_than_half_a_spacing_are_one():
    assert split_lines(np.array([0.0, 2.0, 2.8, 4.8]), 2.0).tolist() == [0, 1, 1, 2]


# half a spacing, what positions are off on both sides, and a bin of the density
@given(
    st.lists(st.floats(1.0 + 2 * 0.15 + 0.1, 9.0), min_size=1, max_size=20),
    st.integers(1, 30),
    st.integers(0, 2**32),
)
def test_lines_are_told_apart_even_if_they_are_unevenly_spaced(steps_m, n_plants, seed):
    middle = np.repeat(np.cumsum(steps_m), n_plants)
    y_m = middle + np.random.default_rng(seed).uniform(-0.15, 0.15, len(middle))
    lines = split_lines(y_m, 2.0)
    assert lines.tolist() == np.repeat(np.arange(len(steps_m)), n_plants).tolist()


def test_the_frame_around_plants_is_centred_on_them_and_points_east():
    frame = frame_around(np.array([[35.0, 30.0], [35.2, 30.4], [35.0, 30.0]]))
    assert (frame.lon, frame.lat, frame.bearing_deg) == pytest.approx((35.1, 30.2, 90.0))


# --- from drawn rows -------------------------------------------------------------------------


def drawn(bearing_deg, *lines):
    frame = Frame(35.15, 30.36, bearing_deg)
    rows = MultiLineString([frame.lonlat(line) for line in lines])
    return field_of(shapely.box(-10, -10, 60, 60), row_lines=rows)


def test_drawn_rows_tell_bearing_and_spacing():
    lines = [[(0, y), (20 + y, y + 0.05), (40 + y, y)] for y in (0, 3.5, 7, 10.5)]
    rows = rows_from_lines(drawn(128.0, *lines))
    assert off_deg(rows.bearing_deg, 128.0) < 0.2
    assert rows.row_spacing_m == pytest.approx(3.5, abs=0.05)
    assert rows.how == "from 4 drawn rows"


def test_pieces_of_one_drawn_row_are_no_rows_apart():
    rows = rows_from_lines(drawn(90.0, [(0, 0), (9, 0)], [(15, 0), (30, 0)], [(0, 4), (30, 4)]))
    assert rows.row_spacing_m == pytest.approx(4.0, abs=0.01)


def test_one_drawn_row_tells_its_bearing_only():
    rows = rows_from_lines(drawn(10.0, [(0, 0), (30, 0)]))
    assert off_deg(rows.bearing_deg, 10.0) < 0.01
    assert rows.row_spacing_m is None


def test_no_drawn_rows_are_refused():
    with pytest.raises(PlotError, match="none are"):
        rows_from_lines(field_of(shapely.box(0, 0, 30, 30)))
