"""Trees in no rows, and the ways among them."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.trees import trees_grid

FRAME = Frame(8.0, 47.0)


def anyhow(n=120, wide_m=90.0, seed=0):
    """Return trees no nearer to each other than 3 m, in no rows."""
    rng = np.random.default_rng(seed)
    kept = np.empty((0, 2))
    while len(kept) < n:
        one = rng.uniform(0, wide_m, 2)
        if not len(kept) or np.hypot(*(kept - one).T).min() >= 3.0:
            kept = np.concatenate([kept, one[None]])
    return kept


@pytest.fixture(scope="module")
def plot():
    return Plot.among("park", FRAME.lonlat(anyhow()))


def test_every_tree_is_there_once_and_counted_on(plot):
    grid = plot.grid
    assert not grid.in_rows
    assert grid.counts == "120 plants in no rows"
    numbered = plant_numbers(grid)
    assert numbered.number.tolist() == list(range(1, 121))
    found = np.sort(FRAME.xy_m(grid.lonlat()), axis=0)
    assert found == pytest.approx(np.sort(anyhow(), axis=0), abs=1e-6)


def test_ways_are_hardly_longer_than_straight_ones(plot):
    i, j = np.random.default_rng(1).integers(0, 120, (2, 300))
    straight_m = np.hypot(*(plot.grid.stop_m[i] - plot.grid.stop_m[j]).T)
    driven_m = plot.aisles.distance_m(i, j)
    assert (driven_m >= straight_m - 1e-6).all()
    far = straight_m > 15
    assert np.median(driven_m[far] / straight_m[far]) < 1.1
    for a, b in zip(i[:5].tolist(), j[:5].tolist(), strict=True):
        line = plot.aisles.path(a, b)
        length_m = float(np.hypot(*np.diff(line, axis=0).T).sum())
        assert length_m == pytest.approx(float(plot.aisles.distance_m(a, b)), abs=1e-6)


@pytest.mark.parametrize("turns", [None, 1.5])
def test_a_robot_of_known_width_is_planned_for_and_what_it_comes_too_near_to_said(plot, turns):
    robot = Robot(width_m=0.6, length_m=1.0, turning_radius_m=turns)
    ways = plot.aisles.for_robot(robot)
    assert not ways.too_narrow.any()
    line, _ = ways.line(np.array([-1, *range(20), -1]))
    (said,) = ways.said_of(line)
    assert "ways keep no width off plants" in said
    assert "nearer than 0.65 m to the middle of one" in said
    assert plot.aisles.for_robot(Robot()).said_of(line) == ()


def test_neighbours_are_those_with_none_between_them(plot):
    grid = plot.grid
    for plant in range(0, 120, 17):
        own = grid.across_plant[grid.across_start[plant] : grid.across_start[plant + 1]]
        for other in own:
            middle = grid.xy_m[[plant, other]].mean(axis=0)
            radius_m = np.hypot(*(grid.xy_m[plant] - middle))
            others = np.delete(grid.xy_m, [plant, other], axis=0)
            assert np.hypot(*(others - middle).T).min() >= radius_m - 1e-9
            low, high = grid.across_start[other : other + 2]
            assert plant in grid.across_plant[low:high]
    assert not len(grid.along_plant)


def test_ways_stay_on_the_field_and_off_its_ponds():
    trees = anyhow()
    pond = shapely.Point(45, 45).buffer(12)
    trees = trees[np.hypot(*(trees - 45).T) > 13]
    park = shapely.difference(shapely.box(-3, -3, 93, 93), pond)
    field = Field("park", FRAME.geometry_lonlat(MultiPolygon([park])), plants=FRAME.lonlat(trees))
    plot = Plot.of(replace(field, in_rows=False))
    shore = shapely.buffer(plot.grid.frame.geometry_m(FRAME.geometry_lonlat(pond)), -0.05)
    for i, j in np.random.default_rng(2).integers(0, len(trees), (20, 2)).tolist():
        assert not shapely.intersects(shapely.linestrings(plot.aisles.path(i, j)), shore)


def test_no_rows_are_changed_where_there_are_none(plot):
    assert plot.aisles.worked_by(Robot(row_change_s=30.0)).row_change_s == 0.0
    robot = Robot(row_change_s=0.0)
    assert plot.aisles.worked_by(robot) is robot


@pytest.mark.parametrize("n", [1, 2, 3])
def test_a_tree_or_two_are_enough(n):
    plot = Plot.among("few", FRAME.lonlat(np.array([[0.0, 0.0], [40.0, 3.0], [80.0, 6.0]])[:n]))
    assert np.isfinite(plot.aisles.distance_m(0, n - 1))


def test_too_many_trees_and_trees_elsewhere_are_refused():
    many = FRAME.lonlat(np.stack(np.divmod(np.arange(3001.0), 60.0), axis=1) * 5)
    with pytest.raises(PlotError, match="3000 on a plot"):
        trees_grid(many)
    field = Field("park", FRAME.geometry_lonlat(MultiPolygon([shapely.box(500, 0, 600, 90)])))
    with pytest.raises(PlotError, match="none of 120 does"):
        trees_grid(FRAME.lonlat(anyhow()), field)
    with pytest.raises(PlotError, match="nobody gave their positions"):
        Plot.of(replace(field, in_rows=False))
