"""Laying plants: nothing grows faster than the number of plants."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.plot.field import Field
from fieldmon.plot.grid import nearest_plants
from fieldmon.plot.layout import grid_from_plants, lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame


def crooked_plot(n_plants):
    """Return a plot with dents, a hole and a second part that holds about so many plants."""
    frame = Frame(35.15, 30.36, 71.0)
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    radius = 1.0 + 0.15 * np.sin(5 * turn) + 0.05 * np.sin(23 * turn)
    area = shapely.Polygon(np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1))
    area = shapely.difference(area, shapely.Point(0.3, 0.2).buffer(0.15))
    area = MultiPolygon([area, shapely.box(1.4, -0.5, 1.8, 0.5)])
    scale = np.sqrt(n_plants * 12.0 / area.area) * 1.01
    area = shapely.transform(area, lambda xy: xy * scale)
    return Field("crooked", frame.geometry_lonlat(area))


SIZES = [100, 1_000, 10_000, 100_000, 1_000_000]


@pytest.mark.benchmark(group="lay plants in a crooked polygon")
@pytest.mark.parametrize("n_plants", SIZES)
def test_lay(benchmark, n_plants):
    field = crooked_plot(n_plants)
    planting = Planting(row_bearing_deg=33.0, headland_m=1.0)
    grid = benchmark(lay, field, planting)
    assert len(grid) == pytest.approx(n_plants, rel=0.5 if n_plants < 10_000 else 0.1)


@pytest.mark.benchmark(group="lay plants in a crooked polygon, both faces")
@pytest.mark.parametrize("n_plants", [10_000, 1_000_000])
def test_lay_two_faces(benchmark, n_plants):
    field = crooked_plot(n_plants // 2)
    grid = benchmark(lay, field, Planting(row_bearing_deg=33.0, faces=2))
    assert len(grid) == pytest.approx(n_plants, rel=0.2)


@pytest.mark.benchmark(group="the thesis's field")
def test_rectangle(benchmark):
    assert len(benchmark(rectangle, 91, 91)) == 8281


@pytest.mark.benchmark(group="measured plants, rows found")
@pytest.mark.parametrize("n_plants", [100, 10_000, 100_000])
def test_grid_from_plants(benchmark, n_plants):
    lonlat = lay(crooked_plot(n_plants), Planting(row_bearing_deg=33.0, headland_m=1.0)).lonlat()
    order = np.random.default_rng(1).permutation(len(lonlat))
    grid = benchmark(grid_from_plants, lonlat[order])
    assert len(grid) == len(lonlat)


@pytest.mark.benchmark(group="10 000 records to their plants")
@pytest.mark.parametrize("n_plants", [10_000, 1_000_000])
def test_nearest_plants(benchmark, n_plants):
    grid = rectangle(int(n_plants**0.5), int(n_plants**0.5))
    rng = np.random.default_rng(1)
    low, high = grid.xy_m.min(axis=0), grid.xy_m.max(axis=0)
    lonlat = grid.frame.lonlat(rng.uniform(low, high, (10_000, 2)))
    plant, _ = benchmark(nearest_plants, grid, lonlat, 5.0)
    assert (plant >= 0).all()
