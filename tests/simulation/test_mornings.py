"""Mornings are believed alike in whatever order they are asked for, and cost nothing unasked."""

from types import SimpleNamespace

import numpy as np

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.plot.layout import rectangle
from fieldmon.simulation.mornings import MorningBeliefs

GRID = rectangle(5, 6)
WORKS = [
    SimpleNamespace(plant=np.array([0, 7], np.int32), found=np.array([True, False])),
    SimpleNamespace(plant=np.array([8], np.int32), found=np.array([False])),
    SimpleNamespace(plant=np.array([20, 21], np.int32), found=np.array([False, True])),
]
LEFT = np.full(len(GRID), 0.2)


def season():
    asked = []

    def first():
        asked.append(0)
        return IndependentPlants(GRID, np.full(len(GRID), 0.1))

    mornings = MorningBeliefs(first, lambda _: Learning(0.84), lambda _: Spread(0.3))
    for number, work in enumerate(WORKS):
        mornings.add(work, LEFT if number == 1 else None)
    return mornings, asked


def by_hand(number):
    belief = IndependentPlants(GRID, np.full(len(GRID), 0.1))
    for day, work in enumerate(WORKS[:number]):
        belief = belief.learn(work.plant, work.found, Learning(0.84))
        belief = belief.treated(LEFT) if day == 1 else belief
        belief = belief.overnight(Spread(0.3))
    return belief.chance


def test_nothing_is_worked_out_before_somebody_asks():
    mornings, asked = season()
    assert (mornings.known, asked) == (3, [])
    mornings.on(1)
    assert asked == [0]


def test_each_morning_is_what_follows_from_the_days_before_in_any_order():
    mornings, _ = season()
    for number in (2, 0, 3, 3, 1):
        np.testing.assert_array_equal(mornings.on(number).chance, by_hand(number))


def test_an_evening_is_before_any_treatment():
    mornings, _ = season()
    work = WORKS[1]
    evening = mornings.on(1).learn(work.plant, work.found, Learning(0.84)).chance
    np.testing.assert_array_equal(mornings.evening(1, work).chance, evening)
