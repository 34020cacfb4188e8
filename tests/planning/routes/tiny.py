"""Small cases: the best route over few plants by trying every order, and a plot as one ladder."""

from __future__ import annotations

import numpy as np

from fieldmon.planning.routes.ladders import Ladders
from fieldmon.plot.travel import GATE, robot_clock, travel_s


def best_of_all(aisles, reward, robot, seconds):
    """Return the most reward of any order of the plants with any, at most a dozen of them."""
    held, took_s = earliest_of_each(aisles, reward, robot)
    return float(held[took_s <= seconds].max())


def earliest_of_each(aisles, reward, robot):
    """Return of each set of the plants with any reward what it holds, and the least seconds."""
    plants = np.flatnonzero(reward)
    assert len(plants) <= 12
    k = len(plants)
    clock = robot_clock(robot, 1.0)
    leg = np.array(
        [[travel_s(aisles.travel, clock, int(a), int(b)) for b in plants] for a in plants]
    )
    out = np.array([travel_s(aisles.travel, clock, GATE, int(a)) for a in plants])
    back = out if robot.returns else np.zeros(k)
    earliest = np.full((1 << k, k), np.inf)
    for a in range(k):
        earliest[1 << a, a] = out[a] + robot.visit_s
    for visited in range(1, 1 << k):
        arrive = (earliest[visited][:, None] + leg).min(axis=0) + robot.visit_s
        for b in range(k):
            if not visited >> b & 1:
                earliest[visited | 1 << b, b] = arrive[b]
    held = (np.arange(1 << k)[:, None] >> np.arange(k) & 1) @ reward[plants]
    took_s = (earliest + back).min(axis=1)
    took_s[0] = 0.0
    return held, took_s


def ladder_below(aisles):
    """Return a ladder on which no way is longer than the true one."""
    return Ladders(aisles).whole(hanging=False)


def no_line_above(kinds, prices):
    """Check that no drive of a kind, known from one price, is worth more than the kind at another.

    `kinds` gives worth and reward of the best drive of each kind at a price.
    """
    found = [kinds(price) for price in prices]
    checked = 0
    for (worth, reward), price in zip(found, prices, strict=True):
        there = worth > -1e200
        checked += int(there.sum())
        for (other, _), at in zip(found, prices, strict=True):
            line = reward - at / price * (reward - worth)
            rounded = 1e-9 * (reward.max() + at + np.abs(line))
            assert (other >= line - rounded)[there].all(), (price, at)
    assert checked
