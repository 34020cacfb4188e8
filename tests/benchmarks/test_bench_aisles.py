"""Finding the ways on a plot, and asking for them."""

import numpy as np
import pytest
from shapely import MultiPolygon, Polygon

from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.travel import Aisles
from tests.crossing import crosses_rows


def skewed():
    """Return a plot of two slanted parts with a hole, about 10 000 plants."""
    left = Polygon([(-210, -150), (-20, -150), (30, 150), (-160, 150)])
    right = Polygon(
        [(-12, -150), (180, -150), (230, 150), (38, 150)],
        [[(60, -40), (150, -40), (170, 30), (80, 40)]],
    )
    area = Frame(35.15, 30.36).geometry_lonlat(MultiPolygon([left, right]))
    return lay(Field("skewed", area), Planting(90.0, 3.0, 3.0))


@pytest.mark.parametrize("n", [91, 1000])
def test_aisles_of_a_rectangle(benchmark, n):
    grid = rectangle(n, n)
    aisles = benchmark.pedantic(Aisles.of, (grid,), rounds=5, warmup_rounds=1)
    assert len(aisles.travel.between_m) == 2 * n + 1


def test_aisles_of_a_slanted_plot_in_two_parts(benchmark):
    grid = skewed()
    aisles = benchmark.pedantic(Aisles.of, (grid,), rounds=5, warmup_rounds=1)
    assert aisles.roads.end.shape == (grid.n_rows, 2)


@pytest.mark.parametrize("n", [91, 1000])
def test_a_million_distances(benchmark, n):
    aisles = Aisles.of(rectangle(n, n))
    i, j = np.random.default_rng(0).integers(-1, n * n, (2, 1_000_000))
    assert benchmark(aisles.distance_m, i, j).min() >= 0


def test_a_thousand_paths_to_the_next_row(benchmark):
    aisles = Aisles.of(rectangle(91, 91))
    plants = np.random.default_rng(0).integers(0, 90 * 91, 1000).tolist()
    paths = benchmark(lambda: [aisles.path(i, i + 91) for i in plants])
    assert not crosses_rows(aisles.grid, paths[0])
