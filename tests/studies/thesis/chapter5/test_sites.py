"""First mornings of chapter 5: clusters from the margin, records, real plots' chance maps."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import ABSENT, PRESENT, Records
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.travel import Aisles
from fieldmon.studies.thesis.chapter5.open_choices import StartUp
from fieldmon.studies.thesis.chapter5.sites import Site, first_morning, square

SITE = square(5.0)


def mornings(n=40, **settings):
    starts = [first_morning(SITE, StartUp(**settings), RandomStreams(seed)) for seed in range(n)]
    return np.array([start.infested for start in starts]), starts


def from_the_edge_m(grid):
    """Return how far each plant is from the rectangle's edge, told from positions alone."""
    x, y = np.abs(grid.xy_m).T
    half_x = x.max() + 4.0
    half_y = y.max() + 2.0
    return np.minimum(half_x - x, half_y - y)


@pytest.mark.parametrize("share", [0.002, 0.02, 0.3])
def test_exactly_the_asked_share_is_infested(share):
    infested, _ = mornings(5, share=share)
    assert (infested.sum(1) == round(share * 4096)).all()


def test_insects_from_the_margin_are_as_deep_as_asked():
    depth_m = from_the_edge_m(SITE.grid)
    weights = np.exp(-depth_m / 10.0)
    infested, _ = mornings(share=0.01, margin_share=1.0, depth_m=10.0, cluster_size=1.0)
    assert (infested * depth_m).sum() / infested.sum() == pytest.approx(
        (weights * depth_m).sum() / weights.sum(), rel=0.1
    )
    anywhere, _ = mornings(share=0.01, margin_share=0.0, cluster_size=1.0)
    assert (anywhere * depth_m).sum() / anywhere.sum() == pytest.approx(depth_m.mean(), rel=0.1)


def test_clusters_are_as_big_as_asked_and_hang_together():
    grid = SITE.grid
    start = np.repeat(np.arange(len(grid)), np.diff(grid.adjacent.start))
    for size in (1.0, 4.0, 10.0):
        infested, _ = mornings(share=0.01, margin_share=0.0, cluster_size=size)
        parts = []
        for morning in infested:
            both = morning[start] & morning[grid.adjacent.plant]
            pairs = (start[both], grid.adjacent.plant[both])
            links = coo_matrix((np.ones(both.sum()), pairs), shape=(len(grid), len(grid)))
            parts.append(connected_components(links)[0] - (~morning).sum())
        # some clusters touch and count as one, the last of a morning is cut short
        assert infested.sum(1).mean() / np.mean(parts) == pytest.approx(size, rel=0.2)


def test_records_point_at_the_asked_share_of_the_infested():
    infested, starts = mornings(share=0.02, recorded_share=0.4)
    told = np.array([start.chance == PriorSettings().at_record for start in starts])
    assert not told[~infested].any()
    assert told.sum() / infested.sum() == pytest.approx(0.4, abs=0.03)


def test_without_records_only_the_margin_is_suspicious():
    _, (start, *_) = mornings(2, recorded_share=0.0, margin_share=0.8, depth_m=10.0)
    depth_m = from_the_edge_m(SITE.grid)
    order = np.argsort(depth_m)
    assert (np.diff(start.chance[order]) <= 1e-8).all()
    assert start.chance.mean() == pytest.approx(0.02, rel=0.05)


def test_a_crowded_margin_does_not_hang():
    settings = StartUp(share=0.5, margin_share=1.0, depth_m=0.5, cluster_size=1.0)
    assert first_morning(square(1.0), settings, RandomStreams(1)).infested.sum() == 392


def test_where_records_exist_they_seed_the_start():
    grid = rectangle(30, 30)
    field = Field("plot", grid.frame.geometry_lonlat(grid.drivable_m))
    records = Records.of(grid.lonlat(np.array([100, 800])), np.array([PRESENT, ABSENT], np.int8))
    day = np.datetime64("2026-06-01", "D")
    chance = prior_chance(grid, field, records, day, PriorSettings())
    site = Site("plot", Aisles.of(grid), field, chance)
    starts = [first_morning(site, StartUp(share=0.03), RandomStreams(s)) for s in range(300)]
    assert all(start.chance is chance for start in starts)
    often = np.mean([start.infested for start in starts], axis=0)
    assert often.mean() == pytest.approx(0.03, rel=0.05)
    assert often[100] > 3 * often.mean()
    assert often[800] < often.mean()
