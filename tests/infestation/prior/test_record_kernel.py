"""What records say about plants: more the nearer, the newer, the more was counted."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pyproj import Geod

from fieldmon.errors import ObservationError
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.prior.record_kernel import record_chance
from fieldmon.infestation.records import ABSENT, PRESENT, Records
from fieldmon.plot.layout import rectangle
from tests.infestation.prior.placed_records import (
    GRID,
    MIDDLE,
    TODAY,
    USUAL,
    at_middle,
    records,
    some_records,
    together,
)


def heard(given, grid=GRID, prior=USUAL, base=0.01):
    return record_chance(grid, np.full(len(grid), base), given, TODAY, prior)


# --- a single record


def test_a_find_says_less_the_farther_a_plant_is():
    metres = np.hypot(*(GRID.xy_m - GRID.xy_m[MIDDLE]).T)
    order = np.argsort(metres, kind="stable")
    chance = heard(at_middle(PRESENT))[order]
    assert (np.diff(chance) <= 1e-6).all()
    assert chance[0] > chance[5] > chance[20] > 0.01


def test_a_clean_look_says_less_the_farther_a_plant_is():
    metres = np.hypot(*(GRID.xy_m - GRID.xy_m[MIDDLE]).T)
    order = np.argsort(metres, kind="stable")
    chance = heard(at_middle(ABSENT), base=0.3)[order]
    assert (np.diff(chance) >= -1e-6).all()
    assert chance[0] < chance[5] < chance[20] < 0.3


@given(st.integers(0, 400), st.integers(1, 400), st.sampled_from((PRESENT, ABSENT)))
def test_a_record_says_less_the_older_it_is(age, more, present):
    newer, older = (heard(at_middle(present, a), base=0.2) for a in (age, age + more))
    moved = 1.0 if present == PRESENT else -1.0
    assert (moved * (newer - older) >= -1e-15).all()
    assert moved * (newer - older)[MIDDLE] > 0
    assert (moved * (older - 0.2) >= 0).all()


def test_after_a_half_life_a_record_counts_half():
    fresh, half = (heard(at_middle(PRESENT, age)) for age in (0, 14))
    np.testing.assert_allclose(half - 0.01, (fresh - 0.01) / 2, atol=1e-15)


@given(st.floats(0.0, 1e6), st.floats(0.01, 1e6))
def test_a_find_says_more_the_more_was_counted(count, more):
    few, many = (heard(at_middle(PRESENT, count=c)) for c in (count, count + more))
    assert (many >= few).all()


def test_counting_more_and_more_says_ever_less_more():
    at = [heard(at_middle(PRESENT, count=c))[MIDDLE + 1] for c in (0, 10, 20, 30, 40, 1e9)]
    steps = np.diff(at)
    assert (steps[:4] > 0).all()
    assert (np.diff(steps[:4]) < 0).all()
    assert at[-1] > at[-2]


@given(st.integers(0, 100), st.integers(1, 100))
def test_a_clean_look_says_more_the_more_leaves_were_looked_at(leaves, more):
    few, many = (
        heard(at_middle(ABSENT, leaves_sampled=k), base=0.2) for k in (leaves, leaves + more)
    )
    assert (many <= few).all()
    assert many[MIDDLE] < few[MIDDLE]


def test_a_clean_look_at_a_plant_itself_is_bayes_rule():
    sharp = PriorSettings(beside_one=0.0, detection=0.84)
    after = heard(at_middle(ABSENT, accuracy_m=0.0), prior=sharp, base=0.3)
    assert after[MIDDLE] == pytest.approx(0.3 * 0.16 / (1.0 - 0.3 * 0.84))


def test_a_find_with_a_sharp_position_is_sure_of_its_plant_and_less_so_of_the_next():
    chance = heard(at_middle(PRESENT, accuracy_m=0.0))
    assert chance[MIDDLE] > 0.95
    assert chance[MIDDLE + 1] < 0.6


def test_a_find_with_a_vague_position_says_less_here_and_more_there():
    sharp, vague = (heard(at_middle(PRESENT, accuracy_m=a)) for a in (1.0, 15.0))
    metres = np.hypot(*(GRID.xy_m - GRID.xy_m[MIDDLE]).T)
    assert vague[MIDDLE] < sharp[MIDDLE] / 3
    far = (metres > 18) & (metres < 25)
    assert (vague[far] > sharp[far]).all()


def test_a_vague_position_spreads_what_is_said_without_adding_to_it():
    """The infested plants that a record points at stay as many, wherever they are."""
    wide = rectangle(61, 81)
    spot = wide.xy_m[len(wide) // 2]
    quiet = PriorSettings(beside_one=0.01, beside_many=0.01, at_record=0.01)
    sums = [
        (heard(records(spot, PRESENT, grid=wide, accuracy_m=a), wide, quiet, 0.0)).sum()
        for a in (2.0, 6.0)
    ]
    assert sums[0] == pytest.approx(sums[1], rel=0.15)


def test_an_unknown_accuracy_is_the_usual_one():
    np.testing.assert_array_equal(
        heard(at_middle(PRESENT)), heard(at_middle(PRESENT, accuracy_m=USUAL.accuracy_m))
    )


# --- several records


def one_by_one(base, given, prior):
    """Hear records slowly, plant by plant, with nothing left out for being far."""
    area = GRID.row_spacing_m * GRID.plant_spacing_m / (2 * np.pi)
    xy = GRID.frame.xy_m(given.lonlat)
    ages = (TODAY - given.day) / np.timedelta64(1, "D")
    finds = given.present == PRESENT
    chance = np.full(len(GRID), base)
    clock = None
    for r in sorted(range(len(ages)), key=lambda r: (-ages[r], not finds[r])):
        if clock is not None:
            chance = base + (chance - base) * 0.5 ** ((clock - ages[r]) / prior.half_life_days)
        clock = ages[r]
        accuracy, count, leaves = (
            getattr(given, name)[r] for name in ("accuracy_m", "count", "leaves_sampled")
        )
        accuracy = prior.accuracy_m if np.isnan(accuracy) else accuracy
        count = prior.half_count if np.isnan(count) else count
        share = count / (count + prior.half_count) if finds[r] else 0.0
        beside = prior.beside_one + share * (prior.beside_many - prior.beside_one)
        square = ((GRID.xy_m - xy[r]) ** 2).sum(axis=1)
        own = area / (area + accuracy**2) * np.exp(-square / 2 / (area + accuracy**2))
        wide = prior.reach_m**2 + accuracy**2
        near = beside * prior.reach_m**2 / wide * np.exp(-square / 2 / wide)
        if finds[r]:
            chance = 1 - (1 - chance) * (1 - prior.at_record * own) * (1 - near)
        else:
            seen = 1 - (1 - prior.leaf_detection) ** leaves
            d = (prior.detection if np.isnan(leaves) else seen) * (1 - (1 - own) * (1 - near))
            chance = chance * (1 - d) / (1 - chance * d)
    return base + (chance - base) * 0.5 ** (clock / prior.half_life_days)


@given(some_records, st.floats(0.0, 0.5))
def test_records_add_up_as_they_do_when_heard_one_by_one_on_all_plants(given, base):
    # each is cut where it would say less than 1e-4
    np.testing.assert_allclose(
        heard(given, base=base),
        one_by_one(base, given, USUAL),
        rtol=0,
        atol=3e-4 * len(given),
    )


@given(some_records, st.randoms(use_true_random=False))
def test_the_order_of_the_records_does_not_matter(given, random):
    order = list(range(len(given)))
    random.shuffle(order)
    np.testing.assert_array_equal(heard(given), heard(given.take(np.array(order))))


@given(some_records, some_records)
def test_one_more_find_never_lowers_and_one_more_clean_look_never_raises(given, others):
    before = heard(given, base=0.1)
    for present, sign in ((PRESENT, 1.0), (ABSENT, -1.0)):
        more = replace(others, present=np.full(len(others), present, np.int8))
        after = heard(together(given, more), base=0.1)
        assert (sign * (after - before) >= -1e-12).all()


@given(some_records, st.sampled_from((PRESENT, ABSENT)))
def test_a_record_far_from_all_plants_changes_nothing(given, present):
    far = records([[5_000.0, 0.0], [0.0, -90_000.0]], present, accuracy_m=5.0)
    np.testing.assert_array_equal(heard(given), heard(together(given, far)))


def test_a_record_changes_nothing_far_from_itself():
    chance = heard(records(GRID.xy_m[0], PRESENT))
    assert chance[0] > 0.1
    assert chance[-1] == 0.01


def test_newer_evidence_outweighs_older_at_the_same_place():
    sharp = {"accuracy_m": 0.0, "leaves_sampled": 20.0}
    old_find = at_middle(PRESENT, 10, **sharp)
    old_look = at_middle(ABSENT, 10, **sharp)
    find, look = (at_middle(present, 0, **sharp) for present in (PRESENT, ABSENT))
    lately_clean = heard(together(old_find, look), base=0.1)[MIDDLE]
    lately_found = heard(together(old_look, find), base=0.1)[MIDDLE]
    assert lately_clean < 0.3
    assert lately_found > 0.9


@given(some_records, some_records)
def test_of_one_day_the_finds_are_heard_before_the_clean_looks(first, second):
    finds = replace(
        first, present=np.full(len(first), PRESENT, np.int8), day=TODAY.repeat(len(first))
    )
    looks = replace(
        second, present=np.full(len(second), ABSENT, np.int8), day=TODAY.repeat(len(second))
    )
    after_finds = heard(finds, base=0.1)
    np.testing.assert_allclose(
        heard(together(looks, finds), base=0.1),
        record_chance(GRID, after_finds, looks, TODAY, USUAL),
        rtol=1e-9,
    )


# --- when, and from where


def test_a_record_of_today_speaks_today_at_any_hour():
    np.testing.assert_array_equal(
        heard(at_middle(PRESENT)),
        record_chance(
            GRID,
            np.full(len(GRID), 0.01),
            at_middle(PRESENT),
            np.datetime64("2026-05-20T17:00"),
            USUAL,
        ),
    )


def test_a_record_without_a_date_counts_as_the_settings_say():
    undated = replace(at_middle(PRESENT), day=np.array(["NaT"], "datetime64[D]"))
    np.testing.assert_array_equal(heard(undated), heard(at_middle(PRESENT, 14)))
    np.testing.assert_array_equal(
        heard(undated, prior=PriorSettings(undated_days=30.0)), heard(at_middle(PRESENT, 30))
    )


@pytest.mark.parametrize(
    ("xy_m", "distance"), [((0.0, 542.0), "500 m away"), ((-3_040.0, 0.0), "3 km away")]
)
def test_records_that_are_all_elsewhere_are_refused_with_the_distance(xy_m, distance):
    given = records([xy_m, (0.0, 20_000.0)], PRESENT)
    with pytest.raises(ObservationError, match=f"of 2 the nearest is {distance}") as refused:
        heard(given)
    assert "coordinate system" in str(refused.value)


def test_records_near_the_plot_that_reach_no_plant_say_nothing():
    outside = GRID.xy_m.max(axis=0) + np.array([60.0, 0.0])
    np.testing.assert_array_equal(heard(records(outside, PRESENT)), np.full(len(GRID), 0.01))
    with_another = together(records(outside, PRESENT), at_middle(PRESENT))
    np.testing.assert_array_equal(heard(with_another), heard(at_middle(PRESENT)))


def test_records_on_another_continent_are_refused_with_the_distance():
    given = Records.of([[-72.0, -41.0]], [PRESENT])
    km = Geod(ellps="WGS84").inv(-72.0, -41.0, GRID.frame.lon, GRID.frame.lat)[2] / 1000
    with pytest.raises(ObservationError) as refused:
        heard(given)
    said = float(str(refused.value).split("nearest is ")[1].split(" km")[0])
    assert said == pytest.approx(km, rel=0.01)


def test_exchanged_longitude_and_latitude_are_recognised():
    exchanged = Records.of(GRID.lonlat()[:5, ::-1].copy(), [PRESENT] * 5)
    with pytest.raises(ObservationError, match="longitude and latitude exchanged"):
        heard(exchanged)


def test_metres_taken_for_degrees_are_recognised():
    with pytest.raises(
        ObservationError, match="longitude and latitude in degrees, but one is 735000"
    ):
        heard(Records.of([[735_000.0, 3_360_000.0], [np.nan, np.nan]], [PRESENT, ABSENT]))


def test_a_record_just_outside_the_plot_still_speaks_of_the_plants_next_to_it():
    corner = GRID.xy_m.min(axis=0)
    chance = heard(records(corner - 6.0, PRESENT))
    assert chance[0] > 0.02


def test_one_record_whose_longitude_and_latitude_are_exchanged_is_recognised_among_others():
    exchanged, far = GRID.lonlat()[:1, ::-1], np.array([[-72.0, -41.0]])
    with pytest.raises(ObservationError, match="longitude and latitude exchanged"):
        heard(Records.of(np.concatenate([far, exchanged, far]), [PRESENT] * 3))
