"""How infested plants stand together, as a day's inspections beside its finds tell it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import inlined, inner_loop, loop
from fieldmon.infestation.chance_bounds import bounded_pair_chance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Linked

#: correlation of neighbours before anything was found beside a find: where clusters are believed
#: in more, single infested plants cost more inspections, and the other way round; learnt soon
CLUSTERING = 0.25
# how many finds beside finds the belief's own idea of clusters is worth; the most it grows a day
_PRIOR_FINDS, _MOST_SCALE = 3.0, 1.5
_NEXT = np.uint64(1)
# how infested plants may stand: chance that the neighbour of one along the row, and that of one
# across, is infested too; side by side, in rows, across rows, apart; and how likely each is before
# anything was inspected (our choice: insects that jump are seen within a day's finds)
_NEIGHBOUR = np.array([[0.5, 0.5], [0.75, 0.1], [0.1, 0.75], [0.15, 0.15]])
_LIKELY = np.log(np.array([0.64, 0.14, 0.1, 0.12]))
_STANDS, _APART = 4, 3
# neighbours of one find share their fate, so each counts half; and nothing is settled for good
_TEMPER, _SETTLED = 0.5, 6.0


class ClusterEstimate(NamedTuple):
    """What a day's inspections tell of how much infested plants stand together.

    Parameters
    ----------
    outcome
        ``(n,)`` 1 for a find, 0 for none, -1 where nobody inspected.
    detects
        ``(n,)`` the detection of that inspection.
    finds
        ``(2,)`` finds beside finds: those there were, and those expected, both beyond what
        independent plants would give. A few expected ones are added to both, so that a day of
        few finds changes little.
    evidence
        ``(4,)`` logarithms of how likely all that was found beside finds this season is where
        infested plants stand side by side, in rows, across rows, or apart.
    fresh
        ``(2,)`` correlation of neighbours, along the row and across, where nobody has inspected.
    """

    outcome: NDArray[np.int8]
    detects: NDArray[np.float64]
    finds: NDArray[np.float64]
    evidence: NDArray[np.float64]
    fresh: NDArray[np.float64]

    @classmethod
    def none(
        cls, n: int, evidence: NDArray[np.float64] | None = None, lean: float = 0.5
    ) -> ClusterEstimate:
        """Return what is known of `n` plants on a morning, with the evidence of days before.

        `lean` is how much more neighbours have in common along the row, see `leaning`.
        """
        since = no_evidence() if evidence is None else evidence.copy()
        finds, fresh = np.full(2, _PRIOR_FINDS), 2.0 * CLUSTERING * np.array([lean, 1.0 - lean])
        return cls(np.full(n, -1, np.int8), np.zeros(n), finds, since, fresh)


def no_evidence() -> NDArray[np.float64]:
    """Return what speaks for each way to stand before anything was found, ``(4,)``."""
    return np.zeros(_STANDS)


def kept_evidence(evidence: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a day's evidence as it counts on the next: it can still be overturned."""
    kept: NDArray[np.float64] = np.maximum(evidence - evidence.max(), -_SETTLED)
    return kept


@inlined
def chance_apart(evidence: NDArray[np.float64]) -> float:
    """Return the chance that infested plants stand apart: that insects jump beyond neighbours."""
    most = -np.inf
    for k in range(_STANDS):
        most = max(most, evidence[k] + _LIKELY[k])
    total = 0.0
    for k in range(_STANDS):
        total += np.exp(evidence[k] + _LIKELY[k] - most)
    return float(np.exp(evidence[_APART] + _LIKELY[_APART] - most) / total)


@inlined
def leaning(evidence: NDArray[np.float64]) -> float:
    """Return how much of what neighbours have in common is along the row: a half if as across."""
    most, total, lean = -np.inf, 0.0, 0.0
    for k in range(_STANDS):
        most = max(most, evidence[k] + _LIKELY[k])
    for k in range(_STANDS):
        weight = np.exp(evidence[k] + _LIKELY[k] - most)
        total += weight
        lean += weight * _NEIGHBOUR[k, 0] / (_NEIGHBOUR[k, 0] + _NEIGHBOUR[k, 1])
    return float(lean / total)


@inner_loop
def update_clusters(
    morning: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    result: tuple[int, bool, float],
    clusters: ClusterEstimate,
) -> None:
    """Note an inspection (plant, found, detection), and what it says beside others of the day.

    `morning` is ``chance (n,)`` and ``pair_chance (e,)`` as believed before the first of them.
    """
    chance, pair_chance = morning
    i, found, detects = result
    clusters.outcome[i], clusters.detects[i] = found, detects
    for e in range(linked.start[i], linked.start[i + 1]):
        j = linked.plant[e]
        if clusters.outcome[j] < 0:
            continue
        if found:
            _update_evidence(morning, clusters, (i, j, e), clusters.detects[j])
            clusters.finds[0] += clusters.outcome[j] - clusters.detects[j] * chance[j]
            clusters.finds[1] += clusters.detects[j] * (pair_chance[e] / chance[i] - chance[j])
        if clusters.outcome[j] == 1:
            _update_evidence(morning, clusters, (j, i, e), detects)
            clusters.finds[0] += found - detects * chance[i]
            clusters.finds[1] += detects * (pair_chance[e] / chance[j] - chance[i])


@inlined
def _update_evidence(
    morning: tuple[NDArray[np.float64], NDArray[np.float64]],
    clusters: ClusterEstimate,
    pair: tuple[int, int, int],
    detects: float,
) -> None:
    """Note what the plant beside a find says of how infested plants stand.

    Where less is expected beside it than on a fresh plot, as after earlier inspections, every way
    to stand expects less in proportion.
    """
    chance, pair_chance = morning
    find, other, e = pair
    along = 0 if abs(find - other) == 1 else 1
    excess = pair_chance[e] / chance[find] - chance[other]
    fresh = min(max(excess / clusters.fresh[along], 0.0), 1.0)
    for k in range(_STANDS):
        infested = chance[other] + (1.0 - chance[other]) * _NEIGHBOUR[k, along] * fresh
        found = detects * infested
        likely = found if clusters.outcome[other] == 1 else 1.0 - found
        clusters.evidence[k] += _TEMPER * np.log(likely)


@inner_loop
def clustering_scale(clusters: ClusterEstimate) -> float:
    """Return by how much infested plants stand closer together than believed in the morning."""
    return float(
        min(max(clusters.finds[0], 0.0) / max(clusters.finds[1], _PRIOR_FINDS), _MOST_SCALE)
    )


@inner_loop
def scale_clustering(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    scale: tuple[float, float],
) -> None:
    """Scale what pairs have in common along the row, and across, all over the plot.

    `believed` is ``chance (n,)`` and ``pair_chance (e,)``, the second changed in place.
    """
    chance, pair_chance = believed
    for i in range(np.uint64(chance.size)):
        p = chance[i]
        for e in range(np.uint32(linked.start[i]), np.uint32(linked.start[i + _NEXT])):
            j = np.uint32(linked.plant[e])
            q = chance[j]
            along = j + _NEXT == i or i + _NEXT == j
            scaled = p * q + (scale[0] if along else scale[1]) * (pair_chance[e] - p * q)
            pair_chance[e] = bounded_pair_chance(scaled, p, q)


@loop
def learn_clustering(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    inspections: tuple[NDArray[np.int32], NDArray[np.bool_], NDArray[np.float64]],
    clusters: ClusterEstimate,
    lean: float,
) -> None:
    """Learn from a day's inspections beside its finds how much infested plants stand together.

    `believed` is ``chance (n,)`` and ``pair_chance (e,)``, the second changed in place; `lean` what
    :func:`leaning` was in the morning, 0 where no direction is told from another.
    """
    plants, found, detects = inspections
    for k in range(plants.size):
        update_clusters(believed, linked, (0 + plants[k], found[k], detects[k]), clusters)
    along = across = clustering_scale(clusters)
    if lean > 0.0:
        now = leaning(clusters.evidence)
        along, across = along * now / lean, across * (1.0 - now) / (1.0 - lean)
    scale_clustering(believed, linked, (along, across))
