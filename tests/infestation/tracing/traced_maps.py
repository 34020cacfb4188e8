"""Maps whose finds are traced, for the tests of all their parts."""

from dataclasses import replace

import numpy as np

from fieldmon.infestation.ancestry.origins import N_ORIGINS, OriginCounts
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.tracing.traced_day import TracedDay
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.plot.layout import rectangle

GRID = rectangle(20, 20)
N = 400
FLAT = np.full(N, 0.02)
EVERY = np.arange(N, dtype=np.int32)
FEW = rectangle(3, 4)
LEARNING, QUIET = Learning(detection=0.84), Spread(0.3, "one")


def seen(belief, infested, learning=LEARNING, days=1):
    """Inspect every plant for some days, by draws of seed 1; finds are treated."""
    rng, left = np.random.default_rng(1), infested.copy()
    for _ in range(days):
        found = left & (rng.random(N) < learning.detection)
        belief = belief.learn(EVERY, found, learning)
        left &= ~found
        belief = belief.overnight(QUIET)
    return belief


def mid_season(seed=0):
    """Return what may be believed some days into a season on a dozen plants."""
    rng = np.random.default_rng(seed)
    belief = TracedPairs.of(FEW, rng.uniform(0.02, 0.4, 12))
    shares = rng.random((12, N_ORIGINS)).astype(np.float32)
    counts = OriginCounts(rng.uniform(0.0, 4.0, N_ORIGINS), rng.uniform(0.0, 4.0, N_ORIGINS))
    return replace(
        belief, shares=shares / shares.sum(axis=1, keepdims=True), counts=counts,
        unseen=rng.uniform(0.0, 7.0, 12), evidence=np.array([0.0, -1.0, 0.4, -0.3]),
    )  # fmt: skip


def day_of(belief):
    n, none = len(belief.chance), np.zeros((2, N_ORIGINS))
    zeros = np.zeros((2, n))
    return TracedDay(
        belief.shares.astype(np.float64), belief.chance.copy(), *zeros, *none, np.zeros(1)
    )
