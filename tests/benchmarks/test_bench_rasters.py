import numpy as np
import pytest
from pyproj import Transformer

from fieldmon.io.rasters.values import Raster
from fieldmon.io.writers.chance_raster import write_chance_raster
from fieldmon.plot.layout import rectangle

UTM = "EPSG:32636"


def about(grid):
    """Return a raster of 4000 x 4000 pixels over a grid."""
    east, north = Transformer.from_crs("OGC:CRS84", UTM, always_xy=True).transform(*grid.lonlat().T)
    pixel_m = max(np.ptp(east), np.ptp(north)) / 4000
    values = np.random.default_rng(1).random((4000, 4000), np.float32)
    return Raster(values, (pixel_m, 0.0, east.min(), 0.0, -pixel_m, north.max()), UTM)


@pytest.mark.parametrize("how", ["nearest", "bilinear", "mean"])
def test_bench_sampling_a_million_plants(benchmark, how):
    grid = rectangle(1000, 1000)
    values = benchmark(about(grid).of_plants, grid, how)
    assert np.count_nonzero(~np.isnan(values)) > 990_000


def test_bench_a_chance_map_of_a_million_plants(benchmark, tmp_path):
    grid = rectangle(1000, 1000)
    chance = np.random.default_rng(1).random(len(grid))
    benchmark.pedantic(write_chance_raster, (grid, chance, tmp_path / "c.tif"), rounds=2)
    assert (tmp_path / "c.tif").stat().st_size > 1_000_000
