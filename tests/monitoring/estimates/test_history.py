"""What was done on a plot, day by day, and what that says each morning."""

from dataclasses import replace
from datetime import date
from itertools import pairwise

import numpy as np
import pytest

from fieldmon.errors import ObservationError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.infestation.level_range import LevelRange
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.settings.shift_work import Shift
from fieldmon.monitoring.treating.treatment import Treatment
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE
from fieldmon.samplers.base import NEVER
from tests.monitoring.seasons import a_plot
from tests.thorough import seeds

PLOT = a_plot()
N = len(PLOT.grid)
BEGINS = date(2026, 4, 6)
MORNING = PairApproximation.of(PLOT.grid, np.full(N, 0.02))
DONE = Inspections.of(
    np.array([5, 6, 7, 6, 9, 5]),
    np.array([CLEAN, FOUND, SKIPPED, CLEAN, FOUND, CLEAN]),
    np.array(["2026-04-06"] * 3 + ["2026-04-08"] * 2 + ["2026-04-10"], "datetime64[D]"),
    second=np.array([21_700.0, 21_800.0, np.nan, np.nan, np.nan, 22_000.0]),
)
HISTORY = History(PLOT.grid, BEGINS, MORNING, DONE)
ALL = np.ones(N, np.bool_)
SHIFT = Shift(PLOT.aisles, Robot(hours=2.0))


def test_days_are_counted_from_the_first():
    assert HISTORY.days.tolist() == [0, 0, 0, 2, 2, 4]
    assert [HISTORY.date_of(day) for day in (0, 30)] == [BEGINS, date(2026, 5, 6)]
    assert HISTORY.on(2).plant.tolist() == [6, 9]
    assert HISTORY.on(1).plant.tolist() == []
    assert HISTORY.until(2).plant.tolist() == [5, 6, 7, 6, 9]
    assert len(HISTORY.until(-1)) == 0


def test_inspections_must_come_in_the_order_of_their_days():
    with pytest.raises(ObservationError, match="in the order of their days"):
        History(PLOT.grid, BEGINS, MORNING, DONE.take(np.array([3, 0])))


def test_a_plant_found_once_stays_found_and_one_only_skipped_was_never_seen():
    states = HISTORY.states(4)
    assert states[[5, 6, 9]].tolist() == [CLEAN, FOUND, FOUND]
    assert states[7] == -1
    assert np.count_nonzero(states >= 0) == 3
    assert HISTORY.states(1)[9] == -1


def test_the_last_inspection_of_a_plant_is_that_up_to_the_day_asked():
    assert HISTORY.last_inspected(4)[[5, 6, 7, 9]].tolist() == [4, 2, NEVER, 2]
    assert HISTORY.last_inspected(2)[[5, 6, 7, 9]].tolist() == [0, 2, NEVER, 2]


def test_an_evening_is_its_morning_after_the_days_findings_and_treatments():
    looked = np.array([5, 6], np.int32)
    known = MORNING.learn(looked, np.array([False, True]), Learning(HISTORY.detection))
    np.testing.assert_array_equal(HISTORY.evening(MORNING, 0).chance, known.chance)
    plants = np.arange(N) < 50
    treated = History(PLOT.grid, BEGINS, MORNING, DONE, (Treatment(0, plants, 0.75),))
    wanted = known.treated(np.where(plants, 0.25, 1.0))
    np.testing.assert_array_equal(treated.evening(MORNING, 0).chance, wanted.chance)
    np.testing.assert_array_equal(treated.evening(MORNING, 3).chance, MORNING.chance)


def test_what_was_inspected_after_a_treatment_of_the_day_counts_after_it():
    done = Inspections.of(
        np.array([5, 6, 7, 8]), np.array([FOUND] * 4), np.datetime64(BEGINS),
        second=np.array([21_600.0, 30_000.0, 43_200.0, np.nan]),
    )  # fmt: skip
    at_7, at_10 = Treatment(0, ALL, 0.75, 25_200.0), Treatment(0, ALL, 0.5, 36_000.0)
    history = History(PLOT.grid, BEGINS, MORNING, done, (at_10, at_7))

    def looked(believed, *plants):
        found = np.ones(len(plants), bool)
        return believed.learn(np.array(plants, np.int32), found, Learning(history.detection))

    # without a time: before the first treatment of the day
    wanted = looked(MORNING, 5, 8).treated(np.full(N, 0.25))
    wanted = looked(looked(wanted, 6).treated(np.full(N, 0.5)), 7)
    np.testing.assert_array_equal(history.evening(MORNING, 0).chance, wanted.chance)
    left = BeliefSettings(treated=False)
    flagged = replace(history, belief=left).evening(MORNING, 0).chance[[5, 6, 7, 8]]
    assert flagged == pytest.approx([0.125, 0.5, 1.0, 0.125], abs=0.01)


@pytest.mark.parametrize("belief", [PairApproximation, TracedPairs])
def test_a_find_recorded_twice_counts_once_and_one_after_a_spraying_lowers_nobody(belief):
    morning = belief.of(PLOT.grid, np.full(N, 0.02))
    start, beside = PLOT.grid.adjacent
    near = beside[start[50] : start[51]]

    def evening(seconds, result, *treatments):
        done = Inspections.of(
            np.full(len(seconds), 50), result, np.datetime64(BEGINS), second=np.array(seconds)
        )
        return History(PLOT.grid, BEGINS, morning, done, treatments).evening(morning, 0).chance

    once = evening([36_000.0], [FOUND])
    assert (once[near] > 0.1).all()
    np.testing.assert_array_equal(evening([36_000.0, 36_001.0], [FOUND, FOUND]), once)
    np.testing.assert_array_equal(evening([36_000.0, 50_000.0], [FOUND, CLEAN]), once)
    none = Treatment(0, np.zeros(N, bool), 0.5, 40_000.0)
    again = evening([36_000.0, 50_000.0], [FOUND, FOUND], none)
    assert (again[near] >= evening([36_000.0], [FOUND], none)[near]).all()
    assert again[50] < 0.01


def test_an_inspection_past_midnight_counts_after_what_was_treated_before_it():
    done = Inspections.of(
        np.array([5, 6]), np.array([FOUND, FOUND]), np.datetime64(BEGINS) + np.array([0, 1]),
        second=np.array([82_800.0, 1_800.0]),
    )  # fmt: skip
    shift = Shift(PLOT.aisles, Robot(hours=4.0), starts_s=79_200.0)
    left = BeliefSettings(treated=False)
    at_11 = Treatment(0, ALL, 0.75, 84_600.0)
    history = History(PLOT.grid, BEGINS, MORNING, done, (at_11,), left)
    assert history.scene(shift, 0, MORNING).chance[[5, 6]] == pytest.approx([0.25, 1.0], abs=0.01)
    untold = replace(history, treatments=(Treatment(0, ALL, 0.75),))
    assert untold.scene(shift, 0, MORNING).chance[[5, 6]] == pytest.approx([0.25] * 2, abs=0.01)


def test_the_next_morning_comes_of_the_evening_by_the_spread_that_is_believed():
    spread = Spread(0.3, "one", arrivals_per_day=0.01)
    history = History(PLOT.grid, BEGINS, MORNING, DONE, belief=BeliefSettings(spread))
    wanted = history.evening(MORNING, 0).overnight(spread)
    np.testing.assert_array_equal(history.night_after(MORNING, 0).chance, wanted.chance)


def test_what_is_inspected_narrows_how_far_all_chances_may_be_off():
    # a tenth is told, and a tenth is found: more than was told would leave more in doubt
    first = TracedPairs.of(PLOT.grid, np.full(N, 0.1))
    looked = np.arange(0, N, 3)
    finds = np.where(looked % 30 == 0, FOUND, CLEAN)
    done = Inspections.of(looked, finds, np.datetime64(BEGINS))
    before = History(PLOT.grid, BEGINS, first).level_range(first, 0)
    for treated in (True, False):
        after = History(PLOT.grid, BEGINS, first, done, belief=BeliefSettings(treated=treated))
        narrower = after.level_range(first, 0)
        assert before.low < narrower.low < 1.0 < narrower.high < before.high
    assert HISTORY.level_range(MORNING, 0) == LevelRange(), "pairs alone do not know"


def test_finds_left_alone_are_known_and_so_no_longer_counted_as_out_there():
    flagged = History(PLOT.grid, BEGINS, MORNING, DONE, belief=BeliefSettings(treated=False))
    evening = flagged.evening(MORNING, 0)
    assert evening.chance[6] > 0.99
    left = flagged.estimate(MORNING, 0).expected
    assert left == pytest.approx(evening.chance.sum() - 1, abs=0.01)
    # who counts both counts all that decide, plan and forecast count
    assert left + flagged.flagged(MORNING, 0) == pytest.approx(evening.chance.sum())
    assert HISTORY.flagged(MORNING, 0) == 0.0, "treated"


def test_a_plot_with_a_plant_known_to_be_infested_is_not_clean():
    n_found, believed = 40, BeliefSettings(treated=False)
    some = np.arange(n_found, dtype=np.int32)
    nowhere = PairApproximation.of(PLOT.grid, np.full(N, 1e-6))
    found = Inspections.of(some, np.full(n_found, FOUND), np.datetime64(BEGINS))
    left = History(PLOT.grid, BEGINS, nowhere, found, belief=believed)
    assert left.estimate(nowhere, 0).chance_clean == 0.0
    together = left.infested(nowhere, 0)
    assert together == left.estimate(nowhere, 0).beside(n_found)
    # a treatment leaves them in doubt: they may all be clean
    sprayed = replace(left, treatments=(Treatment(0, ALL, 0.98),))
    clean = sprayed.estimate(nowhere, 0).chance_clean
    assert clean == sprayed.infested(nowhere, 0).chance_clean
    assert 0.3 < clean < 0.6


def test_a_plant_that_is_gone_is_not_infested_nor_asked_for_until_it_is_inspected_again():
    flagged = BeliefSettings(treated=False)
    first = TracedPairs.of(PLOT.grid, np.full(N, 0.02))
    done = Inspections.of(
        np.array([5, 6, 5, 8, 5]), np.array([FOUND, FOUND, SKIPPED, SKIPPED, FOUND]),
        np.datetime64(BEGINS) + np.array([0, 0, 1, 1, 5]),
        notes=np.array(["", "", "gone: rotten", "locked", ""], object),
    )  # fmt: skip
    history = History(PLOT.grid, BEGINS, first, done, belief=flagged)
    mornings = [first]
    for day in range(6):
        mornings.append(history.night_after(mornings[-1], day))
    gone = [np.flatnonzero(history.gone(day)).tolist() for day in (0, 1, 4, 5)]
    assert gone == [[], [5], [5], []]
    assert history.flagged(mornings[0], 0) == pytest.approx(2.0, abs=0.01)
    assert history.flagged(mornings[1], 1) == pytest.approx(1.0, abs=0.01)
    assert history.evening(mornings[1], 1).chance[[5, 6]] == pytest.approx([0.0, 1.0], abs=1e-3)
    assert history.flagged(mornings[5], 5) == pytest.approx(2.0, abs=0.01)
    for day in (2, 3, 4):
        scene = history.scene(SHIFT, day, mornings[day])
        assert scene.last_inspected[5] == day
        assert scene.flagged[[5, 6]].tolist() == [False, True]
    # one that could not be inspected comes back, one that is gone does not
    assert np.flatnonzero(history.skips(1).times).tolist() == [8]
    assert (history.evening(mornings[4], 4).chance[6], history.states(4)[5]) == (
        pytest.approx(1.0, abs=0.01), FOUND
    )  # fmt: skip


def test_the_scene_of_a_day_stands_where_and_when_its_last_inspection_was_made():
    scene = HISTORY.scene(SHIFT, 4, MORNING)
    assert (scene.at, scene.day) == (5, 4)
    assert scene.seconds_left == SHIFT.robot.day_s - (22_000.0 - SHIFT.starts_s)
    assert scene.trail.tolist() == [6, 9]
    assert scene.last_inspected[5] == 4


def test_nobody_is_sent_again_on_that_day_or_the_next_to_a_plant_that_could_not_be_inspected():
    days = [HISTORY.scene(SHIFT, day, MORNING) for day in range(3)]
    assert [scene.last_inspected[7] for scene in days] == [0, 1, NEVER]
    assert days[0].skipped is days[2].skipped is None
    assert np.flatnonzero(days[1].skipped).tolist() == [7]


def random_history(seed):
    """Return a history of some weeks of three people, and each of its looks as a tuple."""
    rng = np.random.default_rng(seed)
    days = np.sort(rng.choice([0, 1, 3, 4, 7], 25))
    who = np.array(["", "Ann", "ANN", "bob"], object)[rng.integers(0, 4, 25)]
    seconds = np.where(rng.random(25) < 0.5, np.nan, 6 * 3600.0 + np.arange(25) * 100.0)
    done = Inspections.of(
        rng.integers(0, 8, 25), rng.integers(0, 3, 25), np.datetime64(BEGINS) + days,
        second=seconds, who=who,
    )  # fmt: skip
    looks = zip(done.plant.tolist(), done.result.tolist(), days.tolist(), seconds.tolist(), who,
                strict=True)  # fmt: skip
    recorded = np.full(N, -1, np.int8)
    recorded[:8] = rng.integers(-1, 2, 8)
    return History(PLOT.grid, BEGINS, MORNING, done, recorded=recorded), list(looks)


@pytest.mark.parametrize("seed", seeds(4, 8))
@pytest.mark.parametrize("who", [None, "ann", "Bob", "eve"])
def test_a_day_and_all_before_it_are_what_going_through_the_looks_says(seed, who):
    history, looks = random_history(seed)
    stays = Shift(PLOT.aisles, Robot(hours=2.0, returns=False))
    for day in range(9):
        today = [one for one in looks if one[2] == day]
        until = [one for one in looks if one[2] <= day]
        seen = [one for one in until if one[1] != SKIPPED]
        last, state = np.full(N, NEVER), np.full(N, -1)
        for plant, result, number, *_ in seen:
            last[plant], state[plant] = number, max(state[plant], result)
        assert history.on(day).plant.tolist() == [one[0] for one in today]
        assert history.until(day).plant.tolist() == [one[0] for one in until]
        assert history.last_inspected(day).tolist() == last.tolist()
        assert history.states(day).tolist() == state.tolist()
        assert history.known(day).tolist() == np.maximum(state, history.recorded).tolist()
        finds = [one[2] for one in seen if one[1] == FOUND]
        first = history.date_of(finds[0]) if finds else None
        assert history.first_find(history.date_of(day)) == first

        scene = history.scene(stays, day, MORNING, who=who)
        mine = [one for one in looks if who is None or one[4].casefold() == who.casefold()]
        earlier = [one for one in mine if one[2] < day and one[1] != SKIPPED]
        trail = [one[0] for one in earlier if one[2] == earlier[-1][2]]
        own = [one for one in mine if one[2] == day]
        closed = last.copy()
        for plant in range(N):
            of_plant = (one for one in until if one[0] == plant and one[1] == SKIPPED)
            times = {one[2] for one in of_plant if last[plant] < one[2] < day}
            if times and day - max(times) <= 2 ** (len(times) - 1):
                closed[plant] = day
        closed[[one[0] for one in today]] = day
        assert scene.last_inspected.tolist() == closed.tolist()
        assert scene.trail.tolist() == trail
        assert scene.at == (own[-1][0] if own else trail[-1] if trail else GATE)
        gone_s = stays.robot.day_s - scene.seconds_left
        begun_s = history.work(stays, who).begun_s(day)
        if own and np.isfinite(own[-1][3]):
            assert gone_s == min(own[-1][3] - begun_s, stays.robot.day_s)
        elif own:
            visits_s = stays.robot.visit_s * len(own)
            places = [trail[-1] if trail else GATE, *(one[0] for one in own)]
            way_m = sum(float(PLOT.aisles.distance_m(a, b)) for a, b in pairwise(places))
            assert gone_s >= visits_s + way_m / stays.robot.speed_m_s - 1e-6
        else:
            assert gone_s == 0.0
        early = history.scene(stays, day, MORNING, now_s=stays.starts_s - 60.0, who=who)
        assert early.seconds_left == stays.robot.day_s


def test_each_inspection_is_learnt_from_by_what_it_was_told_to_find():
    told, result = np.array([0.9, 0.5, 0.84, 0.9]), np.array([CLEAN, CLEAN, SKIPPED, CLEAN])
    done = Inspections.of(np.arange(4), result, np.datetime64(BEGINS))
    history = History(PLOT.grid, BEGINS, MORNING, done, detection=told)
    looked = done.plant[[0, 1, 3]]
    known = MORNING.learn(looked, np.zeros(3, bool), Learning(told[[0, 1, 3]]))
    assert history.evening(MORNING, 0).chance.tolist() == known.chance.tolist()
    assert history.mean_detection(0) == pytest.approx((0.9 + 0.5 + 0.9) / 3)


def test_inspections_that_are_told_to_find_alike_are_told_exactly_that():
    assert History(PLOT.grid, BEGINS, MORNING, DONE, detection=0.7).mean_detection(5) == 0.7
    assert History(PLOT.grid, BEGINS, MORNING, detection=0.7).mean_detection(0) == 0.7
