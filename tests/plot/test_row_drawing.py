"""Rows drawn from end posts and along contours."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, MultiPolygon

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_drawing import contour_row, rows_from_posts, smooth_row, turns_back

FRAME = Frame(8.0, 47.0)


def posts(n_rows, seed, turn_deg=0.0):
    """Return end posts of rows between oblique headlands, mixed, and the row of each."""
    rng = np.random.default_rng(seed)
    y = 2.5 * np.arange(n_rows)
    low, high = rng.uniform(-0.8, 0.8, 2)
    ends = np.stack([np.stack([low * y, y], 1), np.stack([80.0 + high * y, y], 1)], axis=1)
    xy_m = ends.reshape(-1, 2) + rng.normal(0, 0.1, (2 * n_rows, 2))
    row = np.repeat(np.arange(n_rows), 2)
    order = rng.permutation(2 * n_rows)
    return FRAME.turned(turn_deg).lonlat(xy_m[order]), row[order]


@given(st.integers(3, 25), st.integers(0, 1000), st.floats(0, 180))
def test_end_posts_are_paired_across_oblique_headlands(n_rows, seed, turn_deg):
    lonlat, row = posts(n_rows, seed, turn_deg)
    lines = rows_from_posts(lonlat)
    assert len(lines.geoms) == n_rows
    of = {tuple(at): r for at, r in zip(lonlat.tolist(), row.tolist(), strict=True)}
    for line in lines.geoms:
        first, last = (of[tuple(c)] for c in line.coords)
        assert first == last


def test_names_pair_posts_that_lie_anyhow():
    lonlat = FRAME.lonlat(np.random.default_rng(1).uniform(0, 50, (6, 2)))
    names = np.array(["b", "a", "c", "a", "c", "b"])
    lines = rows_from_posts(lonlat, names)
    ends = {tuple(sorted(map(tuple, line.coords))) for line in lines.geoms}
    wanted = [(1, 3), (0, 5), (2, 4)]
    assert ends == {tuple(sorted((tuple(lonlat[a]), tuple(lonlat[b])))) for a, b in wanted}


def test_posts_that_are_not_two_a_row_are_refused():
    lonlat, row = posts(5, 3)
    with pytest.raises(PlotError, match=r"two a row.*there are 9"):
        rows_from_posts(lonlat[:9])
    names = row.astype(np.str_)
    names[0] = names[row != row[0]][0]
    with pytest.raises(PlotError, match="two end posts each, but row"):
        rows_from_posts(lonlat, names)
    anyhow = FRAME.lonlat(np.random.default_rng(2).uniform(0, 50, (20, 2)))
    with pytest.raises(PlotError, match="two by two in line"):
        rows_from_posts(anyhow)


def hill(lonlat):
    """Return heights of a cone whose top is 90 m south of the frame's middle."""
    xy_m = FRAME.xy_m(lonlat)
    return 400.0 - 0.3 * np.hypot(xy_m[:, 0], xy_m[:, 1] + 90.0)


def vineyard():
    return Field("terrace", MultiPolygon([FRAME.geometry_lonlat(shapely.box(-50, -30, 50, 35))]))


def test_a_contour_stays_on_its_level_from_boundary_to_boundary():
    plot = vineyard()
    row = contour_row(plot, hill, 2.0)
    corners = shapely.get_coordinates(row)
    assert np.ptp(hill(corners)) < 0.02
    beyond = shapely.difference(plot.boundary, shapely.buffer(row, 1e-7))
    assert len(shapely.get_parts(beyond)) == 2


def test_rows_of_a_terrace_follow_its_contours_and_keep_their_spacing():
    plot = vineyard()
    drawn = Field("terrace", plot.boundary, row_lines=contour_row(plot, hill, 2.0))
    grid = lay(drawn, Planting(row_spacing_m=3.0, plant_spacing_m=1.2))
    height_m = hill(grid.lonlat())
    assert grid.n_rows > 15
    for k in range(grid.n_rows):
        mine = slice(grid.row_start[k], grid.row_start[k + 1])
        assert np.ptp(height_m[mine]) < 0.1
    # neighbours across are the spacing apart, within 5 %
    one = np.repeat(np.arange(len(grid)), np.diff(grid.across_start))
    radius = np.hypot(*(FRAME.xy_m(grid.lonlat()) + np.array([0.0, 90.0])).T)
    apart_m = np.abs(radius[one] - radius[grid.across_plant])
    assert apart_m == pytest.approx(np.full(len(apart_m), 3.0), rel=0.05)


def test_level_ground_and_unknown_heights_are_refused():
    with pytest.raises(PlotError, match="no slope"):
        contour_row(vineyard(), lambda lonlat: np.full(len(lonlat), 7.0), 2.0)
    with pytest.raises(PlotError, match="shows none"):
        contour_row(vineyard(), lambda lonlat: np.full(len(lonlat), np.nan), 2.0)


def test_a_row_through_places_is_smooth_and_passes_through_each():
    frame = Frame(8.0, 47.0)
    places = np.array([[0.0, 0.0], [30.0, 9.0], [60.0, 12.0], [90.0, 9.0], [120.0, 0.0]])
    row = shapely.get_coordinates(smooth_row(frame.lonlat(places)))
    xy_m = frame.xy_m(row)
    line = shapely.linestrings(xy_m)
    assert shapely.distance(line, shapely.points(places)).max() < 0.05
    step = np.diff(xy_m, axis=0)
    turn_deg = np.abs(np.diff(np.rad2deg(np.arctan2(step[:, 1], step[:, 0]))))
    assert turn_deg.max() < 3.0
    straight = smooth_row(frame.lonlat(places[[0, 4]]))
    assert len(straight.coords) == 2
    once = smooth_row(frame.lonlat(places[[0, 0, 4, 4]]))
    assert len(once.coords) == 2
    with pytest.raises(PlotError, match="must lead somewhere"):
        smooth_row(frame.lonlat(places[[1, 1, 1]]))


def walked(xy_m, noise_m=0.0, seed=1):
    """Return a line as somebody walked it, a place a metre, each off by the noise."""
    line = LineString(xy_m)
    at = shapely.line_interpolate_point(line, np.arange(0.0, line.length, 1.0))
    noise = np.random.default_rng(seed).normal(0.0, noise_m, (len(at), 2))
    return LineString(FRAME.lonlat(shapely.get_coordinates(at) + noise))


def up_and_down(n_rows, length_m, spacing_m):
    ends = [(0.0, length_m) if k % 2 == 0 else (length_m, 0.0) for k in range(n_rows)]
    return [(x, spacing_m * k) for k, pair in enumerate(ends) for x in pair]


@pytest.mark.parametrize("noise_m", [0.0, 0.5])
@pytest.mark.parametrize(
    ("n_rows", "length_m", "spacing_m"),
    [(2, 100.0, 4.0), (6, 84.0, 4.0), (3, 40.0, 2.5), (40, 150.0, 8.0), (2, 80.0, 0.0)],
)
def test_a_track_up_and_down_several_rows_turns_back(n_rows, length_m, spacing_m, noise_m):
    assert turns_back(walked(up_and_down(n_rows, length_m, spacing_m), noise_m))


@pytest.mark.parametrize("noise_m", [0.0, 0.5, 1.0])
def test_rows_that_bend_around_a_hill_or_lead_around_it_do_not(noise_m):
    angle = np.linspace(0.0, 2 * np.pi, 400)
    ring = np.stack([np.cos(angle), np.sin(angle)], 1)
    half = ring[:200]
    legs = np.vstack([[40.0, -80.0], 20.0 * half, [-20.0, -80.0]])
    for row in ([(0, 0), (300, 0)], 15.0 * ring, 60.0 * ring, 10.0 * half, legs):
        assert not turns_back(walked(row, noise_m))
    assert not turns_back(LineString(FRAME.lonlat(np.array([(0.0, 0.0), (5.0, 0.0)]))))
