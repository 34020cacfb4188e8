"""Chances by the ancestry of finds, the morning after."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.ancestry import ancestry, ancestry_night
from fieldmon.infestation.ancestry.ancestry import Ancestry
from fieldmon.infestation.ancestry.ancestry_night import ToldNight, overnight, sweeps_of
from fieldmon.infestation.ancestry.infestation_course import BEFORE
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


def test_weeks_of_clean_inspections_that_hardly_overlook_anything_leave_numbers():
    """A chance of 1e-4 on each of 24 days is none that a computer tells from nothing."""
    plants, known = np.arange(N), Ancestry.of(GRID, FLAT)
    for day in range(25):
        found = (plants == MIDDLE) & (day == 24)
        known, chance = after(plants, found, known, 0.9999)
        assert np.isfinite(chance).all()
    begins = known.infestations.begins[known.infestations.found]
    assert begins.tolist() == [BEFORE + 24]
    # it came last night, and had sent nothing out yet
    assert chance.max() < 0.01


def test_a_find_speaks_for_the_plants_about_it():
    _, chance = after([MIDDLE], [True])
    assert chance[[MIDDLE - 1, MIDDLE + 1, MIDDLE - 20, MIDDLE + 20]].min() > 3.0 * chance[0]
    assert chance[MIDDLE + 2] > chance[0]


def test_a_clean_plant_is_less_likely_infested_and_so_are_those_about_it():
    block = (np.arange(8)[:, None] * 20 + np.arange(8)).ravel()
    _, chance = after(block, np.zeros(64, bool))
    assert chance[20 * 3 + 3] < 0.5 * chance[-1]
    assert chance[20 * 3 + 8] < chance[-1]


def test_a_plant_clean_between_finds_is_inspected_again_before_one_far_away():
    beside = [MIDDLE - 1, MIDDLE + 1, MIDDLE - 20, MIDDLE + 20]
    _, chance = after([MIDDLE, *beside], [False, True, True, True, True])
    assert chance[MIDDLE] > 3.0 * chance[0]


def test_chances_stay_chances_where_nearly_all_is_found():
    known, plants = Ancestry.of(GRID, np.full(N, 0.6)), np.arange(N)
    for day in range(3):
        known, chance = after(plants, (plants + day) % 4 > 0, known)
        assert ((chance > 0.0) & (chance <= 0.95)).all()


def test_it_begins_anew_after_many_days_and_with_many_infestations(monkeypatch):
    monkeypatch.setattr(ancestry, "_MOST_DAYS", 5)
    known = a_week()
    assert len(known.sends) == 2
    assert (known.start != FLAT).any()
    monkeypatch.setattr(ancestry_night, "_MOST_INFESTATIONS", 10)
    known, chance = after(np.arange(40), np.ones(40, bool), known)
    assert len(known.sends) == 0
    assert (known.start == chance).all()
    # what was learnt of jumps and of hiding stays
    assert known.hiding.tolist() == [0.6, 0.1, 0.2, 0.1]
    assert known.rates.shares.sum() == pytest.approx(1.0)


def test_a_find_that_is_left_goes_on_and_sends_out_others():
    """It began no later than it was seen, and each night brings the plants beside it as much."""
    left, chance_left = all_clean_but_the_middle(treated=False)
    ended, chance_ended = all_clean_but_the_middle(treated=True)
    assert left.left.nonzero()[0].tolist() == [MIDDLE]
    assert not ended.left.any()
    assert chance_left[BESIDE].max() < 0.3 / 4
    for night in range(2, 6):
        left, chance_left = after([0], [False], left)
        ended, chance_ended = after([0], [False], ended)
        by_now = 1.0 - (1.0 - 0.3 / 4) ** night
        assert chance_left[BESIDE] == pytest.approx(0.9 * by_now, rel=0.2)
        assert chance_ended[BESIDE].max() < 0.02
    assert chance_left[MIDDLE] > 0.999
    assert left.infestations.begins[left.infestations.plant == MIDDLE].max() <= BEFORE
    # found again it is the same one, and destroyed at last it ends
    again, _ = after([MIDDLE], [True], left, treated=False)
    assert np.count_nonzero(again.infestations.found) == 1
    assert again.left[MIDDLE]
    gone, chance = after([MIDDLE], [True], again)
    assert not gone.left.any()
    assert chance[MIDDLE] < 0.1
    assert gone.infestations.ends[gone.infestations.found].tolist() == [BEFORE + 6]


def test_as_many_were_infested_at_the_start_as_were_found_at_once():
    known = Ancestry.of(GRID, FLAT)
    assert known.infested_at_start is None
    at_once = whole_plot([[21, 88, 173, 250, 251, 333], [], [], []])
    number = at_once.infested_at_start
    assert number.value == pytest.approx(6.0, abs=0.7)
    # what was found on the first day was there
    assert number.low == 6.0 < number.high
    # told were eight: with a quarter inspected it is between both
    quarter, _ = after(np.arange(100), np.arange(100) % 50 == 0, known, 0.95)
    assert 4.0 < quarter.infested_at_start.value < 10.0


def test_finds_far_from_all_others_on_a_clean_plot_arrived_from_outside():
    finds = [[21], *([20 * (2 * day + 1) + 7 * day % 19] for day in range(1, 9))]
    from_outside = whole_plot(finds).arrivals
    none = whole_plot([[21], *[[]] * 8]).arrivals
    assert from_outside.low < from_outside.value < from_outside.high
    assert from_outside.value > 0.4
    assert none.value < 0.1
    assert whole_plot(finds).arrived > 4.0


def test_by_the_evening_it_is_known_what_was_inspected_that_day():
    known = whole_plot([[21, 88], []])
    assert not known.waits
    plants = np.arange(N)
    evening = known.learn(plants, plants == 22, np.full(N, 0.95))
    assert evening.waits
    so_far, (morning, _) = overnight(evening, ToldNight(0.0))[0], overnight(evening, ToldNight(0.3))
    assert so_far.infested_at_start.value == pytest.approx(
        morning.infested_at_start.value, rel=0.05
    )
    assert so_far.arrivals.value == pytest.approx(morning.arrivals.value, rel=0.2)


def test_nights_without_inspections_teach_nothing_of_the_past():
    """With few finds another draw of them would tell of twice as many, or half."""
    known, _ = after(np.arange(60), np.arange(60) % 10 == 0)
    first, numbers = known, []
    for _ in range(6):
        known, _ = overnight(known, ToldNight(0.05))
        assert np.array_equal(known.rates.shares, first.rates.shares)
        assert known.rates[1:] == first.rates[1:]
        numbers.append(known.infested_at_start.value)
    assert numbers == pytest.approx([first.infested_at_start.value] * 6, rel=0.15)
    assert known.heard == first.heard == 1
    # the next day that teaches something is given the work that they left
    assert (known.idle, len(sweeps_of(replace(known, heard=3)))) == (6, 16)
    later, _ = after([399], [False], known)
    assert (later.heard, later.idle, len(sweeps_of(later))) == (2, 0, 6)
