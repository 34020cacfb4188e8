"""Places along lines, against shapely as the oracle."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely.ops import substring

from fieldmon.plot.polylines import Polylines, sampled


@st.composite
def gentle_lines(draw):
    """Draw one to four lines that turn by less than 30 degrees a step."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    lines = []
    for _ in range(draw(st.integers(1, 4))):
        n = draw(st.integers(1, 30))
        way = np.cumsum(rng.uniform(-0.5, 0.5, n)) + rng.uniform(0, 2 * np.pi)
        step = rng.uniform(0.5, 3.0, (n, 1)) * np.stack([np.cos(way), np.sin(way)], axis=1)
        start = rng.uniform(-50, 50, (1, 2))
        lines.append(np.concatenate([start, start + np.cumsum(step, axis=0)]))
    return lines, rng


@given(gentle_lines())
def test_places_are_metres_along_a_line(drawn):
    lines, rng = drawn
    known = Polylines.each(lines)
    which = rng.integers(0, len(lines), 20)
    place = rng.random(20) * known.length_m[which]
    shapes = [shapely.linestrings(line) for line in lines]
    wanted = [shapes[i].interpolate(p).coords[0] for i, p in zip(which, place, strict=True)]
    assert known.points(which, place) == pytest.approx(np.array(wanted), abs=1e-9)
    assert known.length_m == pytest.approx(shapely.length(shapes))


@given(gentle_lines())
def test_a_point_beside_a_line_projects_to_where_the_line_is_nearest(drawn):
    lines, rng = drawn
    known = Polylines.each(lines)
    for i, line in enumerate(lines):
        place = np.sort(rng.random(15)) * known.length_m[i]
        which = np.full(15, i)
        ahead = known.ahead(which, place)
        off = rng.uniform(-0.4, 0.4, 15)
        xy_m = known.points(which, place) + off[:, None] * np.stack([-ahead[:, 1], ahead[:, 0]], 1)
        at, left = known.project(xy_m, which)
        shape = shapely.linestrings(line)
        assert np.abs(left) == pytest.approx(
            shapely.distance(shape, shapely.points(xy_m)), abs=1e-9
        )
        foot = known.points(which, at)
        assert np.hypot(*(foot - xy_m).T) == pytest.approx(np.abs(left), abs=1e-9)


def test_left_is_left_and_places_go_on_beyond_the_ends():
    line = Polylines.each([np.array([[0.0, 0.0], [10.0, 0.0], [20.0, 0.0]])])
    xy_m = np.array([[-3.0, 1.0], [5.0, 2.0], [15.0, -2.0], [24.0, 0.5]])
    place, left = line.project(xy_m, np.zeros(4, int))
    assert place.tolist() == [-3.0, 5.0, 15.0, 24.0]
    assert left.tolist() == [1.0, 2.0, -2.0, 0.5]
    assert line.points(np.zeros(2, int), np.array([-3.0, 24.0])).tolist() == [[-3, 0], [24, 0]]


@given(gentle_lines(), st.floats(0, 1), st.floats(0, 1))
def test_corners_between_places_are_those_driven_past(drawn, a, b):
    lines, _ = drawn
    known = Polylines.each(lines)
    line, length = lines[-1], float(known.length_m[-1])
    inner = known.corners_between(len(lines) - 1, a * length, b * length)
    ends = known.points(np.full(2, len(lines) - 1), np.array([a, b]) * length)
    driven = np.concatenate([ends[:1], inner, ends[1:]])
    assert np.hypot(*np.diff(driven, axis=0).T).sum() == pytest.approx(abs(a - b) * length)
    part = substring(shapely.linestrings(line), a * length, b * length)
    assert shapely.hausdorff_distance(part, shapely.linestrings(driven)) < 1e-6


@given(gentle_lines(), st.floats(-2, 2), st.floats(-2, 2))
def test_stretches_are_driven_past_the_same_corners_each_on_its_line(drawn, from_m, to_m):
    lines, rng = drawn
    known = Polylines.each(lines)
    which = np.sort(rng.integers(0, len(lines), 8))
    # some begin before the line or end beyond it
    low, high = (rng.random(8) * known.length_m[which] + m for m in (from_m, to_m))
    parts = known.stretches(which, low, high)
    assert len(parts) == 8
    for i, line in enumerate(which):
        ends = known.points(np.full(2, line), np.array([low[i], high[i]]))
        inner = known.corners_between(line, low[i], high[i])
        driven = np.concatenate([ends[:1], inner, ends[1:]])
        assert parts.line(i)[[0, -1]] == pytest.approx(ends, abs=1e-9)
        assert parts.length_m[i] == pytest.approx(abs(high[i] - low[i]), abs=1e-9)
        shapes = [shapely.linestrings(line_m) for line_m in (parts.line(i), driven)]
        assert shapely.hausdorff_distance(*shapes) < 1e-9


@given(gentle_lines(), st.floats(0.1, 9.0))
def test_longer_lines_go_straight_on_and_samples_reach_both_ends(drawn, by_m):
    lines, _ = drawn
    known = Polylines.each(lines)
    longer = known.extended(by_m)
    assert longer.length_m == pytest.approx(known.length_m + 2 * by_m)
    ends = known.points(np.arange(len(lines)), -np.full(len(lines), by_m))
    assert longer.xy_m[longer.start[:-1]] == pytest.approx(ends)
    which, place = sampled(known, by_m)
    for i in range(len(lines)):
        mine = place[which == i]
        assert mine[[0, -1]] == pytest.approx([0.0, known.length_m[i]])
        assert np.diff(mine).max() <= by_m + 1e-9


def test_simpler_lines_stay_near():
    turn = np.linspace(0, 1, 200)
    circle = np.stack([50 * np.cos(turn), 50 * np.sin(turn)], axis=1)
    thin = Polylines.each([circle]).simpler(0.02)
    assert len(thin.xy_m) < 40
    assert shapely.hausdorff_distance(thin.shapes()[0], shapely.linestrings(circle)) < 0.02
