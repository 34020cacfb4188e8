from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom, false_discovery_control, hypergeom

from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.hotspots import (
    HotSpotSettings,
    _tail,
    _window_p,
    hot_spots,
    outlines_m,
    record_states,
    states,
)
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN, Records
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from tests.crooked import crooked_grids
from tests.thorough import times

GRID = rectangle(30, 40)
MIDDLE = 15 * 40 + 20
DAY = np.datetime64("2026-05-20")


def strewn(rng, n, share, inspected=1.0):
    state = np.where(rng.random(n) < share, PRESENT, ABSENT).astype(np.int8)
    state[rng.random(n) >= inspected] = UNKNOWN
    return state


def with_cluster(state, grid, plant, radius_m, share, rng):
    inside = np.hypot(*(grid.xy_m - grid.xy_m[plant]).T) < radius_m
    hit = inside & (rng.random(len(grid)) < share) & (state != UNKNOWN)
    return np.where(hit, PRESENT, state).astype(np.int8)


# --- the test itself


@given(st.data())
def test_a_tail_is_the_hypergeometric_one(data):
    total = data.draw(st.integers(1, 20_000))
    special, drawn = (data.draw(st.integers(0, total)) for _ in range(2))
    if data.draw(st.booleans()):
        drawn = min(drawn, 40)
    x = data.draw(st.integers(0, drawn + 1))
    expected = hypergeom.sf(x - 1, total, special, drawn)
    assert _tail(x, drawn, special, total) == pytest.approx(expected, rel=1e-8, abs=1e-290)


@pytest.mark.parametrize("x", [1, 2_000, 2_500, 3_000])
def test_a_tail_keeps_its_digits_in_a_window_of_thousands_of_plants(x):
    expected = hypergeom.sf(x - 1, 20_000, 10_000, 5_000)
    assert _tail(x, 5_000, 10_000, 20_000) == pytest.approx(expected, rel=1e-8)


def test_a_window_counts_every_way_to_lay_the_finds():
    """Enumerate all 6 188 ways to lay 5 finds on 17 plants; the find at the centre is given."""
    positions = np.random.default_rng(2).uniform(0, 4, (17, 2))
    finds = [3, 4, 8, 11, 16]
    centre = 8
    p = _window_p(positions, positions[finds], 1.5 / 1.01, 2)[finds.index(centre)]
    inside = set(np.flatnonzero(np.hypot(*(positions - positions[centre]).T) <= 1.5))
    seen = len(inside & set(finds))
    ways = [len(inside & set(way)) for way in combinations(range(17), 5) if centre in way]
    assert seen >= 2
    assert p == pytest.approx(np.mean(np.array(ways) >= seen))


@pytest.mark.parametrize("share", [0.01, 0.05, 0.2, 0.5])
@pytest.mark.parametrize("inspected", [1.0, 0.4])
def test_finds_strewn_at_random_seldom_make_a_hot_spot(share, inspected):
    trials, level = times(50, 200), 0.05
    loud = HotSpotSettings(false_share=level, least_finds=2)
    fields = (strewn(np.random.default_rng(s), len(GRID), share, inspected) for s in range(trials))
    false = sum(len(hot_spots(GRID, state, loud)) > 0 for state in fields)
    assert false <= binom.ppf(0.999, trials, level)


def test_a_cluster_is_found_where_it_is():
    hits = 0
    for seed in range(100):
        rng = np.random.default_rng(seed)
        state = strewn(rng, len(GRID), 0.02, 0.7)
        spots = hot_spots(GRID, with_cluster(state, GRID, MIDDLE, 9.0, 0.6, rng))
        near = np.hypot(*(spots.centre_m - GRID.xy_m[MIDDLE]).T) < 6.0
        hits += len(spots) > 0 and near[0]
    assert hits >= 95


def test_two_clusters_are_two_hot_spots_the_more_certain_first():
    rng = np.random.default_rng(1)
    state = strewn(rng, len(GRID), 0.01)
    small, large = 5 * 40 + 6, 24 * 40 + 33
    state = with_cluster(state, GRID, small, 5.0, 1.0, rng)
    state = with_cluster(state, GRID, large, 10.0, 1.0, rng)
    spots = hot_spots(GRID, state)
    assert len(spots) == 2
    assert (spots.of_plant[large], spots.of_plant[small]) == (0, 1)
    assert spots.p[0] < spots.p[1]
    assert (spots.q >= spots.p).all()
    assert (spots.q <= 0.05).all()


@pytest.mark.parametrize(("plants_apart", "n_spots"), [(4, 1), (9, 2)])
def test_clusters_whose_windows_overlap_are_one_hot_spot(plants_apart, n_spots):
    state = np.full(len(GRID), ABSENT, np.int8)
    for first in (MIDDLE, MIDDLE + 2 + plants_apart):
        for row in range(3):
            state[first + 40 * row + np.arange(3)] = PRESENT
    spots = hot_spots(GRID, state, HotSpotSettings(radius_m=6.5))
    assert spots.found.sum() == 18
    assert len(spots) == n_spots


# --- what is not a hot spot


def test_finds_that_stand_alone_are_no_hot_spot():
    state = np.full(len(GRID), ABSENT, np.int8)
    for finds in ([MIDDLE], [40 * 5 + 5, 40 * 5 + 25, 40 * 20 + 10, 40 * 25 + 35]):
        state[finds] = PRESENT
        assert len(hot_spots(GRID, state, HotSpotSettings(least_finds=2))) == 0


def test_two_finds_side_by_side_are_a_hot_spot_only_if_so_wished():
    state = np.full(len(GRID), ABSENT, np.int8)
    state[[MIDDLE, MIDDLE + 1]] = PRESENT
    assert len(hot_spots(GRID, state)) == 0
    assert len(hot_spots(GRID, state, HotSpotSettings(least_finds=2))) == 1


@pytest.mark.parametrize("what", [UNKNOWN, ABSENT, PRESENT])
def test_a_plot_all_alike_has_no_hot_spot(what):
    spots = hot_spots(GRID, np.full(len(GRID), what, np.int8))
    assert len(spots) == 0
    assert (spots.of_plant == -1).all()
    assert spots.centre_m.shape == (0, 2)


@pytest.mark.parametrize("what", [UNKNOWN, ABSENT, PRESENT])
def test_a_single_plant_has_no_hot_spot(what):
    assert len(hot_spots(rectangle(1, 1), np.array([what], np.int8))) == 0


def test_unknown_is_not_clean():
    """Nine finds on nine plants looked at are no cluster; among clean plants they are."""
    block = [MIDDLE + 40 * row + plant for row in range(3) for plant in range(3)]
    only = states(len(GRID), np.array(block), np.ones(9, bool))
    assert len(hot_spots(GRID, only)) == 0
    others = only.copy()
    others[: 10 * 40] = ABSENT
    spots = hot_spots(GRID, others, HotSpotSettings(radius_m=7.0))
    assert len(spots) == 1
    assert (spots.found[0], spots.inspected[0]) == (9, 9)
    assert spots.plants[0] > 9


# --- what a hot spot tells


@given(crooked_grids(60.0, max_plants=4000), st.integers(0, 2**32 - 1))
def test_the_columns_say_what_stands_in_each_hot_spot(grid, seed):
    rng = np.random.default_rng(seed)
    state = strewn(rng, len(grid), 0.03, 0.7)
    state = with_cluster(state, grid, rng.integers(len(grid)), 12.0, 0.8, rng)
    before = state.copy()
    spots = hot_spots(grid, state)
    np.testing.assert_array_equal(state, before)
    vine = np.where(
        grid.twin >= 0, np.minimum(grid.twin, np.arange(len(grid))), np.arange(len(grid))
    )
    np.testing.assert_array_equal(spots.of_plant, spots.of_plant[vine])
    found, looked = {*vine[state == PRESENT]}, {*vine[state != UNKNOWN]}
    for h in range(len(spots)):
        here = {*vine[spots.of_plant == h]}
        assert spots.plants[h] == len(here)
        assert spots.inspected[h] == len(here & looked)
        assert spots.found[h] == len(here & found) >= 3
        assert spots.expected[h] == pytest.approx(len(here & looked) * len(found) / len(looked))
        assert spots.found[h] > spots.expected[h]
        centre_m = grid.xy_m[sorted(here & found)].mean(axis=0)
        np.testing.assert_allclose(spots.centre_m[h], centre_m, atol=1e-9)
    assert not (set(range(len(spots))) ^ set(np.unique(spots.of_plant)) - {-1})


@given(crooked_grids(50.0, faces=(1,), max_plants=1500), st.integers(0, 2**32 - 1))
def test_hot_spots_are_the_windows_that_survive_the_false_discovery_rate(grid, seed):
    rng = np.random.default_rng(seed)
    state = strewn(rng, len(grid), 0.05, 0.8)
    state = with_cluster(state, grid, rng.integers(len(grid)), 8.0, 0.9, rng)
    spots = hot_spots(grid, state, HotSpotSettings(radius_m=7.3))
    finds, looked = np.flatnonzero(state == PRESENT), state != UNKNOWN
    p, windows = [], []
    for find in finds:
        window = np.hypot(*(grid.xy_m - grid.xy_m[find]).T) <= 7.3 * 1.01
        others = (np.count_nonzero(window & (state == s)) for s in (PRESENT, ABSENT))
        found, clean = others
        tail = hypergeom.sf(found - 2, looked.sum() - 1, len(finds) - 1, found + clean - 1)
        p.append(tail if found >= 3 else 1.0)
        windows.append(window)
    expected = np.zeros(len(grid), bool)
    q = false_discovery_control(p) if p else []
    for window, each in zip(windows, q, strict=True):
        expected |= window & (each <= 0.05 * (1.0 + 1e-9))
    np.testing.assert_array_equal(spots.of_plant >= 0, expected)
    if len(spots):
        assert spots.p[0] == pytest.approx(min(p))
        assert spots.q[0] == pytest.approx(min(q))


@pytest.mark.parametrize("seed", range(5))
def test_a_share_that_is_met_exactly_is_met_however_it_was_rounded(seed):
    grid, rng = rectangle(9, 9), np.random.default_rng(seed)
    state = with_cluster(strewn(rng, len(grid), 0.05, 1.0), grid, 40, 6.0, 0.7, rng)
    finds = np.flatnonzero(state == PRESENT)
    windows = [np.hypot(*(grid.xy_m - grid.xy_m[i]).T) <= 7.3 * 1.01 for i in finds]
    found = np.array([np.count_nonzero(window & (state == PRESENT)) for window in windows])
    plants = np.array([np.count_nonzero(window) for window in windows])
    tail = hypergeom.sf(found - 2, len(grid) - 1, len(finds) - 1, plants - 1)
    q = false_discovery_control(np.where(found >= 3, tail, 1.0))
    for limit in np.unique(q[q < 0.5]):
        for share in (np.nextafter(limit, 0.0), limit, np.nextafter(limit, 1.0)):
            spots = hot_spots(grid, state, HotSpotSettings(radius_m=7.3, false_share=share))
            inside = np.any(
                [w for w, each in zip(windows, q, strict=True) if each <= limit], axis=0
            )
            np.testing.assert_array_equal(spots.of_plant >= 0, inside)


def test_a_vine_found_on_both_faces_is_one_find():
    grid = rectangle(12, 30, Planting(faces=2))
    state = np.full(len(grid), ABSENT, np.int8)
    one = np.flatnonzero(grid.twin >= 0)[150]
    state[[one, grid.twin[one]]] = PRESENT
    assert len(hot_spots(grid, state, HotSpotSettings(least_finds=2))) == 0
    same_row = np.flatnonzero(grid.row == grid.row[one])
    beside = same_row[np.flatnonzero(same_row == one)[0] + np.arange(1, 3)]
    state[beside] = PRESENT
    spots = hot_spots(grid, state)
    assert spots.found.tolist() == [3]
    assert spots.of_plant[one] == spots.of_plant[grid.twin[one]] == 0


def test_plants_between_the_finds_belong_to_the_hot_spot_whatever_their_state():
    state = np.full(len(GRID), ABSENT, np.int8)
    around = MIDDLE + np.array([-41, -40, -39, -1, 1, 39, 40, 41])
    state[around] = PRESENT
    state[MIDDLE] = UNKNOWN
    spots = hot_spots(GRID, state)
    assert spots.of_plant[MIDDLE] == 0
    assert spots.plants[0] - spots.inspected[0] == 1


def test_windows_grow_where_few_plants_were_inspected():
    everything = np.full(len(GRID), ABSENT, np.int8)
    few = np.full(len(GRID), UNKNOWN, np.int8)
    few[::8] = ABSENT
    assert hot_spots(GRID, few).radius_m > 1.5 * hot_spots(GRID, everything).radius_m
    spacings = hot_spots(GRID, everything).radius_m / np.sqrt(4.0 * 3.0)
    assert 2.0 < spacings < 3.0


@given(st.floats(-80.0, 80.0), st.integers(0, 1000))
def test_the_direction_of_the_frame_does_not_matter(turn_deg, seed):
    rng = np.random.default_rng(seed)
    state = with_cluster(strewn(rng, len(GRID), 0.03, 0.8), GRID, MIDDLE, 9.0, 0.7, rng)
    frame = GRID.frame.turned(GRID.frame.bearing_deg + turn_deg)
    turned = replace(GRID, frame=frame, xy_m=frame.xy_m(GRID.lonlat()))
    here, there = hot_spots(GRID, state), hot_spots(turned, state)
    np.testing.assert_array_equal(here.of_plant, there.of_plant)
    np.testing.assert_allclose(here.p, there.p)
    np.testing.assert_allclose(
        frame.lonlat(there.centre_m), GRID.frame.lonlat(here.centre_m), atol=1e-9
    )


# --- states


def test_a_plant_found_once_is_found_and_one_never_inspected_is_unknown():
    state = states(5, np.array([1, 3, 1, 2]), np.array([True, False, False, False]))
    assert state.tolist() == [UNKNOWN, PRESENT, ABSENT, ABSENT, UNKNOWN]


def observed(plants, present, day, **columns):
    at = GRID.lonlat(np.array(plants))
    days = np.array(day, "datetime64[D]")
    return Records.of(at, np.array(present, np.int8), days, **columns)


def test_the_newest_record_of_a_plant_counts():
    records = observed(
        [7, 7, 8, 8, 9, 9, 10, 10, 11],
        [PRESENT, ABSENT, ABSENT, PRESENT, PRESENT, ABSENT, PRESENT, ABSENT, UNKNOWN],
        [DAY, DAY - 1, DAY - 1, DAY, DAY, DAY, "NaT", DAY - 90, DAY],
    )
    for order in (slice(None), slice(None, None, -1)):
        state = record_states(GRID, records.take(np.arange(9)[order]))
        assert state[7:12].tolist() == [PRESENT, PRESENT, PRESENT, ABSENT, UNKNOWN]
        assert (np.delete(state, [7, 8, 9, 10]) == UNKNOWN).all()


def test_a_record_speaks_of_its_nearest_plant_unless_that_is_too_far():
    corner = GRID.xy_m[0]
    for off_m, accuracy, said in (
        (1.4, np.nan, PRESENT),
        (2.5, np.nan, UNKNOWN),
        (2.5, 1.0, PRESENT),
    ):
        at = GRID.frame.lonlat([corner - [0.0, off_m]])
        records = Records.of(at, [PRESENT], accuracy_m=np.array([accuracy]))
        assert record_states(GRID, records)[0] == said
        assert record_states(GRID, records, within_m=10.0)[0] == PRESENT


def test_records_from_nowhere_say_nothing_about_plants():
    lost = Records.of([[np.nan, np.nan], [30.36, 35.15], [-179.0, 89.0]], [PRESENT] * 3)
    assert (record_states(GRID, lost) == UNKNOWN).all()
    assert (record_states(GRID, Records.none()) == UNKNOWN).all()


# --- refusals


def test_states_of_another_plot_are_refused():
    with pytest.raises(ObservationError, match=f"one entry a plant \\({len(GRID)}\\)"):
        hot_spots(GRID, np.zeros(7, np.int8))


@pytest.mark.parametrize(
    "wrong", [{"radius_m": 0.0}, {"radius_m": np.nan}, {"false_share": 1.0}, {"least_finds": 1}]
)
def test_a_setting_out_of_range_is_refused(wrong):
    with pytest.raises(SettingError, match=str(next(iter(wrong.values())))):
        HotSpotSettings(**wrong)


def test_an_outline_holds_the_plants_of_its_own_hot_spot_and_of_no_other():
    rng = np.random.default_rng(1)
    state = strewn(rng, len(GRID), 0.01)
    state = with_cluster(state, GRID, 5 * 40 + 6, 7.0, 1.0, rng)
    state = with_cluster(state, GRID, 24 * 40 + 33, 10.0, 1.0, rng)
    spots = hot_spots(GRID, state)
    assert len(spots) == 2
    for k, outline in enumerate(outlines_m(GRID, spots)):
        inside = shapely.contains_xy(outline, GRID.xy_m)
        assert inside[spots.of_plant == k].all()
        assert not inside[spots.of_plant == 1 - k].any()
