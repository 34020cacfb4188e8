import numpy as np
import pytest
import shapely
from shapely import MultiLineString

from fieldmon.infestation.hotspots import hot_spots, record_states
from fieldmon.infestation.prior.prior import prior_chance, start_infested
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import ABSENT, PRESENT, Records
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle

TODAY = np.datetime64("2026-05-20")
SIZES = pytest.mark.parametrize(
    ("side", "n_records"),
    [(91, 100), (316, 1_000), (1_000, 10_000)],
    ids=["8281 plants", "100k plants", "1M plants"],
)


def plot(side, n_records):
    grid = rectangle(side, side)
    rng = np.random.default_rng(5)
    round_m = shapely.Point(0.0, 0.0).buffer(1.7 * side, quad_segs=64).exterior
    boundary = grid.frame.geometry_lonlat(grid.drivable_m)
    paths = MultiLineString([grid.frame.geometry_lonlat(round_m)])
    lonlat = grid.lonlat(rng.integers(0, len(grid), n_records))
    records = Records.of(
        lonlat + rng.normal(0.0, 2e-5, lonlat.shape),
        rng.choice([ABSENT, PRESENT], n_records, p=[0.8, 0.2]),
        TODAY - rng.integers(0, 60, n_records),
    )
    return grid, Field("plot", boundary, paths=paths), records


@SIZES
def test_bench_a_prior_from_records_edges_and_paths(benchmark, side, n_records):
    grid, field, records = plot(side, n_records)
    chance = benchmark(prior_chance, grid, field, records, TODAY, PriorSettings())
    assert chance.shape == (len(grid),)


@SIZES
def test_bench_a_start_with_an_expected_share(benchmark, side, n_records):
    grid, field, records = plot(side, n_records)
    chance = prior_chance(grid, field, records, TODAY, PriorSettings())
    infested = benchmark(start_infested, chance, 0.05, np.random.default_rng(1))
    assert infested.any()


@SIZES
@pytest.mark.parametrize("share", [0.02, 0.3])
def test_bench_hot_spots_where_every_plant_was_inspected(benchmark, side, n_records, share):
    grid, _, _ = plot(side, n_records)
    state = np.where(np.random.default_rng(1).random(len(grid)) < share, PRESENT, ABSENT)
    state[np.hypot(*(grid.xy_m - grid.xy_m[len(grid) // 3]).T) < 12.0] = PRESENT
    spots = benchmark(hot_spots, grid, state.astype(np.int8))
    assert spots.of_plant[len(grid) // 3] == 0


@SIZES
def test_bench_states_from_records(benchmark, side, n_records):
    grid, _, records = plot(side, n_records)
    state = benchmark(record_states, grid, records)
    assert (state == PRESENT).any()
