"""How much infested plants stand together, as a day's inspections beside its finds tell it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import part
from fieldmon.infestation.belief import bounded_pair_chance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Linked

#: correlation of neighbours before anything was found beside a find: where clusters are believed
#: in more, single infested plants cost more inspections, and the other way round; learnt soon
CLUSTERING = 0.25
# how many finds beside finds the belief's own idea of clusters is worth; the most it grows a day
_PRIOR_FINDS, _MOST_SCALE = 3.0, 1.5
_NEXT = np.uint64(1)


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
    """

    outcome: NDArray[np.int8]
    detects: NDArray[np.float64]
    finds: NDArray[np.float64]

    @classmethod
    def none(cls, n: int) -> ClusterEstimate:
        """Return what is known of `n` plants before anybody inspected."""
        return cls(np.full(n, -1, np.int8), np.zeros(n), np.full(2, _PRIOR_FINDS))


@part
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
            clusters.finds[0] += clusters.outcome[j] - clusters.detects[j] * chance[j]
            clusters.finds[1] += clusters.detects[j] * (pair_chance[e] / chance[i] - chance[j])
        if clusters.outcome[j] == 1:
            clusters.finds[0] += found - detects * chance[i]
            clusters.finds[1] += detects * (pair_chance[e] / chance[j] - chance[i])


@part
def clustering_scale(clusters: ClusterEstimate) -> float:
    """Return by how much infested plants stand closer together than believed in the morning."""
    return float(
        min(max(clusters.finds[0], 0.0) / max(clusters.finds[1], _PRIOR_FINDS), _MOST_SCALE)
    )


@part
def scale_clustering(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]], linked: Linked, scale: float
) -> None:
    """Scale what pairs have in common, all over the plot.

    `believed` is ``chance (n,)`` and ``pair_chance (e,)``, the second changed in place.
    """
    chance, pair_chance = believed
    for i in range(np.uint64(chance.size)):
        p = chance[i]
        for e in range(np.uint32(linked.start[i]), np.uint32(linked.start[i + _NEXT])):
            q = chance[np.uint32(linked.plant[e])]
            scaled = p * q + scale * (pair_chance[e] - p * q)
            pair_chance[e] = bounded_pair_chance(scaled, p, q)
