"""Chances by the ancestry of finds."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation import ancestry as module
from fieldmon.infestation.ancestry import Ancestry, ToldNight
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.cell_squares import NOBODY
from fieldmon.infestation.infestation_course import BEFORE, Course
from fieldmon.infestation.spread import Spread
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.infestation.unseen_offspring import Unseen
from fieldmon.pests.pest import Pest
from fieldmon.plot.layout import rectangle

GRID = rectangle(20, 20)
N = len(GRID)
FLAT = np.full(N, 0.02)
SPREAD = Spread(0.3, "one")
MIDDLE = 20 * 10 + 10


def after(plants, found, ancestry=None, detects=0.84, *, treated=True):
    """Return what is known, and the chances, the morning after inspecting some plants."""
    plants = np.asarray(plants, np.int32)
    ancestry = Ancestry.of(GRID, FLAT) if ancestry is None else ancestry
    each = np.full(len(plants), detects)
    known = ancestry.learn(plants, np.asarray(found, bool), each, treated=treated)
    return known.overnight(ToldNight(0.3))


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


def season(hiding, days, find_on=1):
    """Return what is known, and the chances each morning: a plot inspected wholly every day.

    One plant is found, on the second day: what it sent out in the night before may hide.
    """
    plants, known, chances = np.arange(N), replace(Ancestry.of(GRID, FLAT), hiding=hiding), []
    for day in range(days):
        known, chance = after(plants, (plants == MIDDLE) & (day == find_on), known, 0.9)
        chances.append(chance)
    return known, chances


AT_ONCE, FOUR_NIGHTS = np.eye(4)[0], np.array([0.001, 0.0, 0.999, 0.0])
BESIDE = [MIDDLE - 1, MIDDLE + 1, MIDDLE - 20, MIDDLE + 20]


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


def test_nights_are_mixed_as_they_are_likely():
    """By hand: one plant, one inspection a day; what began before the season shows at once."""
    t = BEFORE + 5
    missed = np.zeros((t, 1))
    missed[BEFORE:-1, 0] = np.log(0.2) * np.arange(4, 0, -1)
    missed[:BEFORE] = missed[BEFORE]
    hiding = np.array([0.5, 0.3, 0.15, 0.05])
    course = Course.that_may_hide(t, hiding)
    overlooked = module._overlooked(missed, course)[:, 0]
    assert overlooked[: BEFORE + 1] == pytest.approx(0.2**4)
    for began in range(1, 5):
        # as many inspections as it could have been seen by
        many = [max(4 - began - nights, 0) for nights in (0, 2, 4, 7)]
        assert overlooked[BEFORE + began] == pytest.approx(hiding @ 0.2 ** np.array(many))
    # the same until a find on the last day but one, where it must show by then
    finds = np.array([BEFORE + 3]), np.array([BEFORE + 3]), np.array([0])
    ones = np.ones((t, 1))
    until = module._until_found(missed, Unseen(ones, ones, ones), finds, course)[0]
    assert until[: BEFORE + 1] == pytest.approx(0.2**3)
    for began in range(1, 4):
        each = [0.2 ** (3 - began - k) if k <= 3 - began else 0.0 for k in (0, 2, 4, 7)]
        assert until[BEFORE + began] == pytest.approx(hiding @ each)
    assert until[BEFORE + 4] == 0.0


def test_a_clean_plant_is_less_likely_infested_and_so_are_those_about_it():
    block = (np.arange(8)[:, None] * 20 + np.arange(8)).ravel()
    _, chance = after(block, np.zeros(64, bool))
    assert chance[20 * 3 + 3] < 0.5 * chance[-1]
    assert chance[20 * 3 + 8] < chance[-1]


def test_a_plant_clean_between_finds_is_inspected_again_before_one_far_away():
    beside = [MIDDLE - 1, MIDDLE + 1, MIDDLE - 20, MIDDLE + 20]
    _, chance = after([MIDDLE, *beside], [False, True, True, True, True])
    assert chance[MIDDLE] > 3.0 * chance[0]


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


def test_nothing_is_known_before_anything_was_inspected():
    known = Ancestry.of(GRID, FLAT)
    for _ in range(3):
        known, chance = known.overnight(ToldNight(0.3))
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
    once, chance = first.learn(plants, found, detects).overnight(ToldNight(0.3))
    twice = first.learn(plants[:20], found[:20], detects[:20])
    twice, same = twice.learn(plants[20:], found[20:], detects[20:]).overnight(ToldNight(0.3))
    assert (chance == same).all()
    assert (once.missed == twice.missed).all()


def a_week(seed=0, *, treated=True):
    """Return what is known after a week of finds and clean plants."""
    rng = np.random.default_rng(seed)
    known = replace(Ancestry.of(GRID, FLAT), hiding=np.array([0.6, 0.1, 0.2, 0.1]))
    for _ in range(7):
        plants = rng.choice(N, 60, replace=False).astype(np.int32)
        found = rng.random(60) < 0.1
        known, _ = after(plants, found, known, treated=treated)
    return known


@pytest.mark.parametrize("treated", [True, False])
def test_what_is_kept_of_a_morning_goes_on_as_it_did(treated):
    known = a_week(treated=treated)
    kept = Ancestry.of_arrays(GRID, known.arrays)
    plants = np.arange(50, 90)
    on, chance = after(plants, plants % 9 == 0, known)
    again, same = after(plants, plants % 9 == 0, kept)
    assert (chance == same).all()
    for name, values in on.arrays.items():
        assert (values == again.arrays[name]).all(), name
    with pytest.raises(ValueError, match="An ancestry of 100 plants must have arrays of so many"):
        Ancestry.of_arrays(rectangle(10, 10), known.arrays)


def test_what_is_known_is_never_changed():
    known = a_week()
    before = {name: values.copy() for name, values in known.arrays.items()}
    after(np.arange(40), np.arange(40) % 3 == 0, known)
    for name, values in before.items():
        assert (values == known.arrays[name]).all(), name
    assert "finds" in repr(known)


def test_chances_stay_chances_where_nearly_all_is_found():
    known, plants = Ancestry.of(GRID, np.full(N, 0.6)), np.arange(N)
    for day in range(3):
        known, chance = after(plants, (plants + day) % 4 > 0, known)
        assert ((chance > 0.0) & (chance <= 0.95)).all()


def test_it_begins_anew_after_many_days_and_with_many_infestations(monkeypatch):
    monkeypatch.setattr(module, "_MOST_DAYS", 5)
    known = a_week()
    assert len(known.sends) == 2
    assert (known.start != FLAT).any()
    monkeypatch.setattr(module, "_MOST_INFESTATIONS", 10)
    known, chance = after(np.arange(40), np.ones(40, bool), known)
    assert len(known.sends) == 0
    assert (known.start == chance).all()
    # what was learnt of jumps and of hiding stays
    assert known.hiding.tolist() == [0.6, 0.1, 0.2, 0.1]
    assert known.rates.shares.sum() == pytest.approx(1.0)


def test_it_is_left_out_where_it_does_not_hold():
    belief = TracedPairs.of(GRID, FLAT)
    assert belief.ancestry is not None
    assert belief.of_pest(Pest("mite", mortality_per_day=0.1)).ancestry is None
    assert TracedPairs.of(rectangle(101, 100), np.full(10_100, 0.01)).ancestry is None


def all_clean_but_the_middle(*, treated):
    """Return what is known after inspecting all, hardly overlooking anything."""
    plants = np.arange(N)
    return after(plants, plants == MIDDLE, detects=0.99, treated=treated)


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


def test_both_maps_are_pooled():
    """By the ancestry most: where it says more than the other map the pool says more, too."""
    plants = np.arange(0, N, 3, dtype=np.int32)
    found = plants % 11 == 0
    belief = TracedPairs.of(GRID, FLAT).learn(plants, found, Learning())
    alone = replace(belief, ancestry=None).overnight(SPREAD)
    _, chance = belief.ancestry.overnight(ToldNight(0.3))
    pooled = belief.overnight(SPREAD).chance
    odds = [p / (1.0 - p) for p in (chance, alone.chance, pooled)]
    assert odds[2] == pytest.approx(1.15 * odds[0] ** 0.63 * odds[1] ** 0.42)
    assert np.corrcoef(chance, pooled)[0, 1] > 0.9


def whole_plot(finds, detects=0.95):
    """Return what is known after days on which the whole plot was inspected, with these finds."""
    known, plants = Ancestry.of(GRID, FLAT), np.arange(N)
    for found in finds:
        known, _ = after(plants, np.isin(plants, found), known, detects)
    return known


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


def test_no_more_were_infested_at_the_start_than_there_are_plants():
    known = Ancestry.of(GRID, np.full(N, 0.9))
    known, _ = after(np.arange(0, N, 3), np.ones(len(range(0, N, 3)), bool), known, 0.5)
    number = known.infested_at_start
    assert number.low < number.value <= number.high == N


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
    so_far, (morning, _) = evening.overnight(ToldNight(0.0))[0], evening.overnight(ToldNight(0.3))
    assert so_far.infested_at_start.value == pytest.approx(
        morning.infested_at_start.value, rel=0.05
    )
    assert so_far.arrivals.value == pytest.approx(morning.arrivals.value, rel=0.2)


def test_nights_without_inspections_teach_nothing_of_the_past():
    """With few finds another draw of them would tell of twice as many, or half."""
    known, _ = after(np.arange(60), np.arange(60) % 10 == 0)
    first, numbers = known, []
    for _ in range(6):
        known, _ = known.overnight(ToldNight(0.05))
        assert np.array_equal(known.rates.shares, first.rates.shares)
        assert known.rates[1:] == first.rates[1:]
        numbers.append(known.infested_at_start.value)
    assert numbers == pytest.approx([first.infested_at_start.value] * 6, rel=0.15)
    assert known.heard == first.heard == 1
    # the next day that teaches something is given the work that they left
    assert (known.idle, len(replace(known, heard=3).sweeps)) == (6, 16)
    later, _ = after([399], [False], known)
    assert (later.heard, later.idle, len(later.sweeps)) == (2, 0, 6)


def test_what_was_learnt_of_arrivals_and_jumps_outlives_a_beginning_anew():
    finds = [[21], *([20 * (2 * day + 1) + 7 * day % 19] for day in range(1, 9))]
    known = whole_plot(finds)
    quiet, _ = known.anew(FLAT).overnight(ToldNight(0.3))
    assert quiet.arrivals.value == pytest.approx(known.arrivals.value)
    later, _ = after(np.arange(N), np.zeros(N, bool), known.anew(FLAT), 0.95)
    assert later.arrivals.value == pytest.approx(known.arrivals.value, rel=0.2)
    assert later.arrivals.value > 3.0 * whole_plot([[21], *[[]] * 8]).arrivals.value
    assert later.rates.shares == pytest.approx(known.rates.shares, abs=0.05)
    kept = Ancestry.of_arrays(GRID, known.anew(FLAT).arrays)
    assert np.array_equal(kept.earlier, known.taught)


def test_how_many_there_were_at_the_start_stays_known_when_it_begins_anew():
    known = whole_plot([[21, 88, 173], []])
    later = known.anew(FLAT)
    on, _ = after(np.arange(N), np.arange(N) % 3 == 0, later)
    assert on.infested_at_start == known.infested_at_start
    assert Ancestry.of_arrays(GRID, on.arrays).began_anew
