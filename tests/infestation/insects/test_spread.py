"""What the insects do in a night."""

import numpy as np
import pytest
from scipy import stats
from shapely import MultiPolygon, Polygon

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from tests.thorough import seeds


def key(seed):
    return RandomStreams(seed).key("spread", 0)


@pytest.fixture(scope="module")
def ragged():
    """Return a crooked plot with a hole."""
    d = 1 / 111_000
    shell = [(35.0, 30.0), (35.0 + 90 * d, 30.0), (35.0 + 60 * d, 30.0 + 60 * d), (35, 30 + 40 * d)]
    hole = [(35 + x * d, 30 + y * d) for x, y in [(30, 15), (45, 15), (45, 30), (30, 30)]]
    field = Field("ragged", MultiPolygon([Polygon(shell, [hole])]))
    return lay(field, Planting(row_bearing_deg=90.0, headland_m=2.0))


def infested_at(grid, *plants):
    start = np.zeros(len(grid), bool)
    start[list(plants)] = True
    return start


def neighbours_by_distance(grid):
    """Return who is next to whom, told from positions alone: the test's own way of looking."""
    x, y = grid.xy_m.T
    rows, plants = grid.row_spacing_m, grid.plant_spacing_m
    dx, dy = abs(x[:, None] - x), abs(y[:, None] - y)
    along = (dx > 0.1) & (dx < 1.5 * plants) & (dy < 0.1)
    across = (dx < 0.1) & (dy > 0.1) & (dy < 1.5 * rows)
    return along | across


def night_plant_by_plant(grid, infested, rate, rng):
    """Spread in plain Python, by the rule's words: each infested plant tries each neighbour."""
    beside = neighbours_by_distance(grid)
    after = infested.copy()
    for i in np.flatnonzero(infested):
        for j in np.flatnonzero(beside[i]):
            if rng.random() < rate:
                after[j] = True
    return after


def test_insects_move_to_adjacent_plants_only(ragged):
    beside = neighbours_by_distance(ragged)
    for seed in range(30):
        plant = seed * 7 % len(ragged)
        new = night(ragged, infested_at(ragged, plant), Spread(1.0), key(seed))
        assert set(np.flatnonzero(new)) == {plant, *np.flatnonzero(beside[plant])}


def test_nothing_spreads_at_rate_zero_and_nobody_recovers(ragged):
    start = infested_at(ragged, 3, 40)
    assert (night(ragged, start, Spread(0.0), key(1)) == start).all()
    assert night(ragged, start, Spread(0.5), key(1))[start].all()


def test_the_evening_stays_as_it_was(ragged):
    start = infested_at(ragged, 3)
    night(ragged, start, Spread(1.0), key(1))
    assert start.sum() == 1


def test_three_nights_agree_in_distribution_with_a_plain_simulation(ragged):
    rng = np.random.default_rng(5)
    ours, plain = [], []
    runs = seeds(200, 600)
    for seed in runs:
        a = b = infested_at(ragged, 20, 21, 75)
        for day in range(3):
            a = night(ragged, a, Spread(0.3), RandomStreams(seed).key("spread", day))
            b = night_plant_by_plant(ragged, b, 0.3, rng)
        ours.append(a)
        plain.append(b)
    ours, plain = np.array(ours), np.array(plain)
    assert stats.ks_2samp(ours.sum(1), plain.sum(1)).pvalue > 1e-3
    p = (ours.mean(0) + plain.mean(0)) / 2
    z = (ours.mean(0) - plain.mean(0)) / np.sqrt(np.maximum(p * (1 - p), 1e-3) * 2 / len(runs))
    assert np.abs(z).max() < 4.5


@pytest.mark.parametrize(
    ("to", "mean", "together"), [("each", 1.2, False), ("one", 0.3, False), ("all", 1.2, True)]
)
def test_who_infects_whom_is_a_choice(to, mean, together):
    grid = rectangle(5, 5)
    start = infested_at(grid, 12)
    new = [night(grid, start, Spread(0.3, to), key(s)).sum() - 1 for s in seeds(1000, 3000)]
    assert np.mean(new) == pytest.approx(mean, abs=0.12)
    assert (set(new) <= {0, 4}) == together
    assert (max(new) == 1) == (to == "one")


def test_arrivals_come_anywhere_without_neighbours():
    grid = rectangle(40, 40)
    none = np.zeros(len(grid), bool)
    arrived = [night(grid, none, Spread(0.5, arrivals_per_day=0.02), key(s)) for s in range(60)]
    assert np.mean(arrived) == pytest.approx(0.02, rel=0.06)


def test_a_plant_more_changes_nothing_far_away():
    grid = rectangle(9, 60)
    one = night(grid, infested_at(grid, 5), Spread(0.5), key(4))
    two = night(grid, infested_at(grid, 5, 500), Spread(0.5), key(4))
    assert (one[:300] == two[:300]).all()


@pytest.mark.parametrize("bad", [{"rate_per_day": 1.1}, {"arrivals_per_day": -0.1}, {"to": "some"}])
def test_impossible_settings_are_refused(bad):
    with pytest.raises(SettingError):
        Spread(**bad)
