"""Ancestries of finds on a small plot, for the tests of all their parts."""

from dataclasses import replace

import numpy as np

from fieldmon.infestation.ancestry.ancestry import Ancestry
from fieldmon.infestation.ancestry.ancestry_night import ToldNight, overnight
from fieldmon.plot.layout import rectangle

GRID = rectangle(20, 20)
N = len(GRID)
FLAT = np.full(N, 0.02)
MIDDLE = 20 * 10 + 10
BESIDE = [MIDDLE - 1, MIDDLE + 1, MIDDLE - 20, MIDDLE + 20]


def after(plants, found, ancestry=None, detects=0.84, *, treated=True):
    """Return what is known, and the chances, the morning after inspecting some plants."""
    plants = np.asarray(plants, np.int32)
    ancestry = Ancestry.of(GRID, FLAT) if ancestry is None else ancestry
    each = np.full(len(plants), detects)
    known = ancestry.learn(plants, np.asarray(found, bool), each, treated=treated)
    return overnight(known, ToldNight(0.3))


def a_week(seed=0, *, treated=True):
    """Return what is known after a week of finds and clean plants."""
    rng = np.random.default_rng(seed)
    known = replace(Ancestry.of(GRID, FLAT), hiding=np.array([0.6, 0.1, 0.2, 0.1]))
    for _ in range(7):
        plants = rng.choice(N, 60, replace=False).astype(np.int32)
        found = rng.random(60) < 0.1
        known, _ = after(plants, found, known, treated=treated)
    return known


def all_clean_but_the_middle(*, treated):
    """Return what is known after inspecting all, hardly overlooking anything."""
    plants = np.arange(N)
    return after(plants, plants == MIDDLE, detects=0.99, treated=treated)


def whole_plot(finds, detects=0.95):
    """Return what is known after days on which the whole plot was inspected, with these finds."""
    known, plants = Ancestry.of(GRID, FLAT), np.arange(N)
    for found in finds:
        known, _ = after(plants, np.isin(plants, found), known, detects)
    return known
