"""What the ancestries drawn in a night say of each plant."""

from dataclasses import replace

import numpy as np

from fieldmon.infestation.ancestry.ancestry import Ancestry
from fieldmon.infestation.ancestry.infestation_course import BEFORE
from tests.infestation.ancestry.ancestries import BESIDE, FLAT, GRID, MIDDLE, N, after

AT_ONCE, FOUR_NIGHTS = np.eye(4)[0], np.array([0.001, 0.0, 0.999, 0.0])


def season(hiding, days, find_on=1):
    """Return what is known, and the chances each morning: a plot inspected wholly every day.

    One plant is found, on the second day: what it sent out in the night before may hide.
    """
    plants, known, chances = np.arange(N), replace(Ancestry.of(GRID, FLAT), hiding=hiding), []
    for day in range(days):
        known, chance = after(plants, (plants == MIDDLE) & (day == find_on), known, 0.9)
        chances.append(chance)
    return known, chances


def test_finds_that_stand_apart_teach_that_insects_jump():
    """On a plot that is inspected wholly: diagonally two away every day, or side by side."""
    far = [MIDDLE, MIDDLE + 42, MIDDLE + 38, MIDDLE - 38, MIDDLE - 42]
    near = [MIDDLE, MIDDLE + 1, MIDDLE + 20, MIDDLE - 20, MIDDLE - 1]
    jump = []
    for plants in (far, near):
        all_plants, known = np.arange(N, dtype=np.int32), Ancestry.of(GRID, FLAT)
        for day in range(5):
            known, _ = after(all_plants, all_plants == plants[day], known, 0.9)
        jump.append(known.rates.shares[2:].sum())
    assert jump[0] > 2.0 * jump[1]


def test_what_hides_stays_likely_beside_a_find_however_often_plants_seemed_clean():
    _, hidden = season(FOUR_NIGHTS, 7)
    _, seen = season(AT_ONCE, 7)
    # sent out in the night before the find, it shows from the fifth morning after that on
    assert hidden[3][BESIDE].min() > 0.02
    assert hidden[3][BESIDE].min() > 20.0 * seen[3][BESIDE].max()
    assert hidden[6][BESIDE].max() < 0.5 * hidden[3][BESIDE].min()


def test_what_is_found_began_before_it_hid_or_before_the_season():
    known, _ = season(FOUR_NIGHTS, 7, find_on=6)
    found = known.infestations.found & known.infestations.there
    begins, ends = known.infestations.begins[found], known.infestations.ends[found]
    assert ends.tolist() == [BEFORE + 6]
    assert begins[0] <= BEFORE + 2
    known, _ = season(AT_ONCE, 7, find_on=6)
    # inspected clean every day before, it came in one of the last nights
    assert known.infestations.begins[known.infestations.found].max() >= BEFORE + 4
