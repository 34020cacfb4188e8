"""How much infested plants stand together, held against sums over pairs of neighbours."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.infestation.pairs.clustering import (
    _LIKELY,
    _NEIGHBOUR,
    CLUSTERING,
    ClusterEstimate,
    chance_apart,
    clustering_scale,
    kept_evidence,
    leaning,
    learn_clustering,
    no_evidence,
    scale_clustering,
    update_clusters,
)
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.plot.layout import rectangle

GRID = rectangle(6, 7)
N = len(GRID)
START, NEIGHBOUR = GRID.adjacent
OWN = np.repeat(np.arange(N), np.diff(START))
MORNING = PairApproximation.of(GRID, np.linspace(0.02, 0.3, N))


def estimate(inspections):
    """Note inspections (plant, found, detection) one after the other, as the compiled loops do."""
    clusters = ClusterEstimate.none(N)
    believed = MORNING.chance, MORNING.pair_chance
    for plant, found, detects in inspections:
        update_clusters.py_func(believed, GRID.linked, (plant, found, detects), clusters)
    return clusters


def finds_beside_finds(inspections):
    """Sum over all pairs of neighbours that were inspected: finds beside finds beyond chance."""
    known = {plant: (found, detects) for plant, found, detects in inspections}
    there, expected = 3.0, 3.0
    for i, j, both in zip(OWN, NEIGHBOUR, MORNING.pair_chance, strict=True):
        if i in known and j in known and known[i][0]:
            found, detects = known[j]
            p, q = MORNING.chance[i], MORNING.chance[j]
            there += found - detects * q
            expected += detects * (both / p - q)
    return there, expected


some_inspections = st.lists(
    st.tuples(st.integers(0, N - 1), st.booleans(), st.sampled_from((0.5, 0.84, 1.0))),
    unique_by=lambda one: one[0],
    max_size=N,
)


@given(some_inspections)
def test_finds_beside_finds_are_counted_once_a_pair_in_whatever_order(inspections):
    for order in (inspections, inspections[::-1]):
        assert estimate(order).finds == pytest.approx(finds_beside_finds(inspections))


def test_before_anybody_inspected_the_belief_of_the_morning_stands():
    assert clustering_scale.py_func(ClusterEstimate.none(N)) == 1.0


def test_finds_side_by_side_say_more_and_finds_alone_say_less_up_to_a_bound():
    together = [(i, True, 0.84) for i in range(20)]
    alone = [(i, i % 8 == 0, 0.84) for i in range(N)]
    assert clustering_scale.py_func(estimate(together)) == 1.5
    assert 0.0 <= clustering_scale.py_func(estimate(alone)) < 1.0


@given(st.floats(0.0, 1.5), st.floats(0.0, 1.5))
def test_scaling_moves_what_pairs_have_in_common_and_no_chance(along, across):
    chance, pair_chance = MORNING.chance.copy(), MORNING.pair_chance.copy()
    scale_clustering.py_func((chance, pair_chance), GRID.linked, (along, across))
    np.testing.assert_array_equal(chance, MORNING.chance)
    apart = chance[OWN] * chance[NEIGHBOUR]
    scale = np.where(GRID.row[OWN] == GRID.row[NEIGHBOUR], along, across)
    np.testing.assert_allclose(
        pair_chance - apart, scale * (MORNING.pair_chance - apart), atol=1e-12
    )


def test_finds_along_the_row_lean_neighbours_that_way_and_finds_across_the_other():
    in_rows = estimate([(i, GRID.row[i] % 3 == 0, 0.84) for i in range(N)])
    across = estimate([(i, i % 7 % 3 == 0, 0.84) for i in range(N)])
    at_first = leaning.py_func(no_evidence())
    assert at_first == pytest.approx(0.5, abs=0.03)
    assert leaning.py_func(in_rows.evidence) > 0.8
    assert leaning.py_func(across.evidence) < 0.2


def evidence_told(inspections, lean):
    """Return half the logarithm of how likely all seen beside finds is, by each way to stand."""
    known = {plant: (found, detects) for plant, found, detects in inspections}
    fresh = 2 * CLUSTERING * np.array([lean, 1 - lean])
    told = np.zeros(4)
    for i, j, both in zip(OWN.tolist(), NEIGHBOUR.tolist(), MORNING.pair_chance, strict=True):
        if i in known and j in known and known[i][0]:
            found, detects = known[j]
            across = int(GRID.row[i] != GRID.row[j])
            p, q = MORNING.chance[i], MORNING.chance[j]
            beyond_chance = min(max((both / p - q) / fresh[across], 0.0), 1.0)
            finds = detects * (q + (1 - q) * _NEIGHBOUR[:, across] * beyond_chance)
            told += 0.5 * np.log(finds if found else 1.0 - finds)
    return told


@given(some_inspections, st.sampled_from((0.3, 0.5, 0.8)))
def test_evidence_is_how_likely_what_was_seen_beside_finds_is_by_each_way_to_stand(given_, lean):
    clusters = ClusterEstimate.none(N, np.array([0.1, 0.0, 0.3, -0.2]), lean)
    believed = MORNING.chance, MORNING.pair_chance
    for one in given_:
        update_clusters.py_func(believed, GRID.linked, one, clusters)
    told = evidence_told(given_, lean)
    assert clusters.evidence - [0.1, 0.0, 0.3, -0.2] == pytest.approx(told)


@given(st.lists(st.floats(-6.0, 3.0), min_size=4, max_size=4).map(np.array))
def test_ways_to_stand_are_weighed_by_bayes_rule(evidence):
    likely = np.exp(_LIKELY + evidence)
    likely /= likely.sum()
    assert chance_apart.py_func(evidence) == pytest.approx(likely[3])
    lean = likely @ (_NEIGHBOUR[:, 0] / _NEIGHBOUR.sum(axis=1))
    assert leaning.py_func(evidence) == pytest.approx(lean)
    kept = kept_evidence(evidence)
    assert kept.max() == 0.0
    near = evidence > evidence.max() - 6.0
    assert kept[near] == pytest.approx((evidence - evidence.max())[near])
    assert (kept >= -6.0).all()


def test_ways_to_stand_at_first_are_chances_and_rows_are_the_mirror_of_columns():
    assert np.exp(_LIKELY).sum() == pytest.approx(1.0)
    assert _NEIGHBOUR[1].tolist() == _NEIGHBOUR[2, ::-1].tolist()
    assert _NEIGHBOUR[[0, 3], 0].tolist() == _NEIGHBOUR[[0, 3], 1].tolist()


@given(some_inspections, st.sampled_from((0.0, 0.4, 0.7)))
def test_a_day_s_inspections_scale_pairs_by_all_of_them_together(inspections, lean):
    plants, found, detects = (
        (np.array(each) for each in zip(*inspections, strict=True))
        if (inspections)
        else (np.empty(0), np.empty(0), np.empty(0))
    )
    given_ = plants.astype(np.int32), found.astype(np.bool_), detects.astype(float)
    clusters, told = (ClusterEstimate.none(N, None, lean or 0.5) for _ in "ab")
    pair_chance, scaled = MORNING.pair_chance.copy(), MORNING.pair_chance.copy()
    learn_clustering((MORNING.chance, pair_chance), GRID.linked, given_, clusters, lean)
    for one in inspections:
        update_clusters.py_func((MORNING.chance, MORNING.pair_chance), GRID.linked, one, told)
    there, expected = told.finds
    both_ways = min(max(there, 0.0) / max(expected, 3.0), 1.5)
    now = leaning.py_func(told.evidence)
    each = (now / lean, (1 - now) / (1 - lean)) if lean else (1.0, 1.0)
    ratios = both_ways * each[0], both_ways * each[1]
    scale_clustering.py_func((MORNING.chance, scaled), GRID.linked, ratios)
    assert pair_chance == pytest.approx(scaled)
