"""Small cases: the best route over few plants by trying every order, and a plot as one ladder."""

from __future__ import annotations

import numpy as np

from fieldmon.planning.routes.relaxation import Ladders
from fieldmon.plot.travel import GATE, robot_clock, travel_s


def best_of_all(aisles, reward, robot, seconds):
    """Return the most reward of any order of the plants with any, at most a dozen of them."""
    plants = np.flatnonzero(reward)
    assert len(plants) <= 12
    k = len(plants)
    clock = robot_clock(robot, seconds)
    leg = np.array(
        [[travel_s(aisles.travel, clock, int(a), int(b)) for b in plants] for a in plants]
    )
    out = np.array([travel_s(aisles.travel, clock, GATE, int(a)) for a in plants])
    back = out if robot.returns else np.zeros(k)
    earliest = np.full((1 << k, k), np.inf)
    for a in range(k):
        earliest[1 << a, a] = out[a] + robot.visit_s
    most = 0.0
    for visited in range(1, 1 << k):
        held = float(reward[plants[[a for a in range(k) if visited >> a & 1]]].sum())
        for a in range(k):
            if not np.isfinite(earliest[visited, a]):
                continue
            if earliest[visited, a] + back[a] <= seconds:
                most = max(most, held)
            for b in range(k):
                if visited >> b & 1:
                    continue
                arrive = earliest[visited, a] + leg[a, b] + robot.visit_s
                after = visited | 1 << b
                earliest[after, b] = min(earliest[after, b], arrive)
    return most


def ladder_below(aisles):
    """Return a ladder on which no way is longer than the true one."""
    return Ladders(aisles).whole(hanging=False)
