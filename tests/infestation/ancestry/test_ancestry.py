"""What is known of who infested whom."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.ancestry import Ancestry
from fieldmon.infestation.ancestry.ancestry_night import ToldNight, overnight
from fieldmon.infestation.ancestry.kept_ancestry import ancestry_of, arrays_of
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.cell_squares import NOBODY
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import Pest
from fieldmon.plot.layout import rectangle
from tests.infestation.ancestry.ancestries import (
    BESIDE,
    FLAT,
    GRID,
    MIDDLE,
    N,
    a_week,
    after,
    all_clean_but_the_middle,
    whole_plot,
)

SPREAD = Spread(0.3, "one")


def test_nothing_is_known_before_anything_was_inspected():
    known = Ancestry.of(GRID, FLAT)
    for _ in range(3):
        known, chance = overnight(known, ToldNight(0.3))
        assert chance is None
    assert not known.knows
    belief = TracedPairs.of(GRID, FLAT)
    other = TracedPairs.of(GRID, FLAT, by_ancestry=False)
    for _ in range(2):
        belief, other = belief.overnight(SPREAD), other.overnight(SPREAD)
    assert (belief.chance == other.chance).all()


def test_a_day_in_two_parts_is_one_day():
    plants = np.arange(0, N, 7, dtype=np.int32)
    found, detects = plants % 5 == 0, np.full(len(plants), 0.84)
    first = Ancestry.of(GRID, FLAT)
    once, chance = overnight(first.learn(plants, found, detects), ToldNight(0.3))
    twice = first.learn(plants[:20], found[:20], detects[:20])
    twice, same = overnight(twice.learn(plants[20:], found[20:], detects[20:]), ToldNight(0.3))
    assert (chance == same).all()
    assert (once.missed == twice.missed).all()


def test_what_is_known_is_never_changed():
    known = a_week()
    before = {name: values.copy() for name, values in arrays_of(known).items()}
    after(np.arange(40), np.arange(40) % 3 == 0, known)
    for name, values in before.items():
        assert (values == arrays_of(known)[name]).all(), name
    assert "finds" in repr(known)


def test_it_is_left_out_where_it_does_not_hold():
    belief = TracedPairs.of(GRID, FLAT)
    assert belief.ancestry is not None
    assert belief.of_pest(Pest("mite", mortality_per_day=0.1)).ancestry is None
    assert TracedPairs.of(rectangle(101, 100), np.full(10_100, 0.01)).ancestry is None


def test_what_is_left_stays_known_when_it_begins_anew():
    known, chance = all_clean_but_the_middle(treated=False)
    later = known.anew(chance)
    assert later.left.nonzero()[0].tolist() == [MIDDLE]
    # it sends out others, but is itself no find to be explained
    for _ in range(3):
        later, chance = after([0], [False], later)
        known, without = after([0], [False], known)
    assert later.infestations.parent[later.infestations.plant == MIDDLE].tolist() == [NOBODY]
    assert chance[BESIDE] == pytest.approx(without[BESIDE], rel=0.3)
    waits = known.learn(np.array([50, 3]), np.ones(2, bool), np.full(2, 0.84), treated=False)
    assert waits.anew(np.ones(N)).left.nonzero()[0].tolist() == [3, 50, MIDDLE]
    # what may be clean after a treatment is not known any more
    assert not waits.anew(np.full(N, 0.9)).left.any()


def test_a_treatment_begins_anew_with_what_it_left():
    belief = TracedPairs.of(GRID, FLAT)
    belief = belief.learn(np.array([MIDDLE], np.int32), np.ones(1, bool), Learning())
    left = np.where(np.arange(N) < 200, 0.1, 1.0)
    treated = belief.overnight(SPREAD).treated(left)
    assert (treated.ancestry.start == treated.chance).all()
    assert not treated.ancestry.knows


def test_no_more_were_infested_at_the_start_than_there_are_plants():
    known = Ancestry.of(GRID, np.full(N, 0.9))
    known, _ = after(np.arange(0, N, 3), np.ones(len(range(0, N, 3)), bool), known, 0.5)
    number = known.infested_at_start
    assert number.low < number.value <= number.high == N


def test_what_was_learnt_of_arrivals_and_jumps_outlives_a_beginning_anew():
    finds = [[21], *([20 * (2 * day + 1) + 7 * day % 19] for day in range(1, 9))]
    known = whole_plot(finds)
    quiet, _ = overnight(known.anew(FLAT), ToldNight(0.3))
    assert quiet.arrivals.value == pytest.approx(known.arrivals.value)
    later, _ = after(np.arange(N), np.zeros(N, bool), known.anew(FLAT), 0.95)
    assert later.arrivals.value == pytest.approx(known.arrivals.value, rel=0.2)
    assert later.arrivals.value > 3.0 * whole_plot([[21], *[[]] * 8]).arrivals.value
    assert later.rates.shares == pytest.approx(known.rates.shares, abs=0.05)
    kept = ancestry_of(GRID, arrays_of(known.anew(FLAT)))
    assert np.array_equal(kept.earlier, known.taught)


def test_how_many_there_were_at_the_start_stays_known_when_it_begins_anew():
    known = whole_plot([[21, 88, 173], []])
    later = known.anew(FLAT)
    on, _ = after(np.arange(N), np.arange(N) % 3 == 0, later)
    assert on.infested_at_start == known.infested_at_start
    assert ancestry_of(GRID, arrays_of(on)).began_anew
