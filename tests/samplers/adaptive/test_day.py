"""Adaptive's day as it goes: it stops where nothing more fits, and learns on the way."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.infestation.calibration_slope import no_inspections
from fieldmon.infestation.pairs.clustering import (
    ClusterEstimate,
    chance_apart,
    leaning,
    scale_clustering,
)
from fieldmon.infestation.pairs.pairs import Neighbourhood, PairApproximation
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.infestation.tracing.tracing import Traces, rescale_traced
from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, travel_s
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.adaptive.arrays import Stretch
from fieldmon.samplers.adaptive.day import (
    _best_left,
    _inspect,
    _learn_clustering,
    _least_s,
    _next_in,
    _value_finds,
    times_odds,
    times_odds_of_all,
    trust_in_differences,
)
from fieldmon.samplers.base import NEVER
from fieldmon.samplers.sweeps import Naive
from tests.samplers.adaptive.working import first_price_of, planned_on, times_of, workspace
from tests.scenes import scene_on
from tests.thorough import seeds

GRID = rectangle(12, 15)
N = len(GRID)


def scene_of(seed, hours, at=GATE, *, returns=True):
    chance = np.clip(np.random.default_rng(seed).beta(0.4, 3.0, N), 1e-5, 1 - 1e-5)
    robot, belief = Robot(hours=hours, returns=returns), PairApproximation.of(GRID, chance, 0.5)
    return replace(
        scene_on(GRID), robot=robot, chance=belief.chance, pair_chance=belief.pair_chance,
        seconds_left=robot.day_s, at=at,
    )  # fmt: skip


@pytest.mark.parametrize("seed", seeds(2, 5))
@pytest.mark.parametrize("hours", [0.1, 0.4, 1.3])
@pytest.mark.parametrize(("returns", "at"), [(True, GATE), (False, 100)])
@pytest.mark.parametrize("chooses", [False, True])
def test_the_day_ends_only_where_no_other_plant_would_fit(seed, hours, returns, at, chooses):
    scene = scene_of(seed, hours, at, returns=returns)
    found = np.random.default_rng(seed).random(N) < 0.1
    sampler = Adaptive(chooses_time=chooses)
    work = work_day(scene, sampler, found.astype(np.uint8))
    quickest_s = sampler.inspection_times(scene.robot).stop_s[0]
    place = int(work.plant[-1]) if len(work) else scene.at
    now_s = float(work.arrive_s[-1] + work.stop_s[-1]) if len(work) else 0.0
    travel, clock = scene.aisles.travel, scene.clock
    for plant in np.setdiff1d(np.arange(N), work.plant).tolist():
        end_s = now_s + travel_s(travel, clock, place, plant) + quickest_s
        end_s += travel_s(travel, clock, plant, GATE) if returns else 0.0
        assert end_s > scene.seconds_left


def test_until_the_first_find_the_day_is_that_on_which_nothing_is_found():
    scene = scene_of(1, 1.0)
    calm = plan_work(scene, Adaptive())
    found = np.zeros(N, np.bool_)
    found[calm.plant[20]] = True
    work = work_day(scene, Adaptive(), found)
    assert work.plant[:21].tolist() == calm.plant[:21].tolist()
    assert work.plant.tolist() != calm.plant.tolist()


def test_a_find_draws_the_robot_to_its_neighbours_and_a_clean_plant_does_not():
    scene = replace(scene_of(1, 0.8), chance=np.full(N, 0.03))
    scene = replace(scene, pair_chance=PairApproximation.of(GRID, scene.chance, 0.8).pair_chance)
    calm = plan_work(scene, Adaptive())
    k = len(calm) // 2
    found = np.zeros(N, np.bool_)
    found[calm.plant[k]] = True
    work = work_day(scene, Adaptive(), found)
    start, other = GRID.adjacent
    beside = set(other[start[calm.plant[k]] : start[calm.plant[k] + 1]].tolist())
    seen = set(work.plant[k + 1 :].tolist()) & beside
    assert len(seen) > len(set(calm.plant[k + 1 :].tolist()) & beside)


def test_plants_that_were_inspected_today_are_worth_nothing_more():
    scene = scene_of(2, 24.0)
    last = scene.last_inspected.copy()
    last[::3] = scene.day
    work = plan_work(replace(scene, last_inspected=last), Adaptive())
    assert set(work.plant.tolist()) == set(range(N)) - set(range(0, N, 3))


@pytest.mark.parametrize("seed", range(4))
def test_a_longer_day_is_expected_to_find_more(seed):
    found = [scene_of(seed, hours).chance[plan_work(scene_of(seed, hours), Adaptive()).plant].sum()
             for hours in (0.2, 0.5, 1.0, 1.8)]  # fmt: skip
    assert (np.diff(found) > 0).all()


def test_the_scene_is_left_as_it_was():
    scene = scene_of(3, 1.0)
    chance, pair_chance = scene.chance.copy(), scene.pair_chance.copy()
    work_day(scene, Adaptive(), np.ones(N, np.bool_))
    np.testing.assert_array_equal(scene.chance, chance)
    np.testing.assert_array_equal(scene.pair_chance, pair_chance)


def test_where_all_plants_are_infested_unannounced_the_day_is_driven_as_a_sweep():
    belief = TracedPairs.of(GRID, np.full(N, 0.02))
    robot = Robot(hours=1.5)
    scene = replace(
        scene_on(GRID), robot=robot, chance=belief.chance, pair_chance=belief.pair_chance,
        traces=belief.traces, seconds_left=robot.day_s,
    )  # fmt: skip
    every = np.ones(N, np.bool_)
    assert len(work_day(scene, Adaptive(), every)) >= 0.95 * len(work_day(scene, Naive(), every))


@loop
def trust(share, slope_sums):
    return trust_in_differences(share, slope_sums)


def traced_scene(share, hours, **given):
    belief, robot = TracedPairs.of(GRID, np.full(N, share)), Robot(hours=hours)
    return replace(
        scene_on(GRID), robot=robot, chance=belief.chance, pair_chance=belief.pair_chance,
        traces=belief.traces, seconds_left=robot.day_s, **given,
    )  # fmt: skip


def test_a_plan_that_takes_plants_for_clean_learns_nothing_of_how_many_are_infested():
    scene, chances = traced_scene(0.3, 1.5), []
    none = np.zeros(N, np.bool_)
    plan = plan_work(scene, Adaptive())
    supposed = work_day(replace(scene, supposed=True), Adaptive(), none)
    assert plan.plant.tolist() == supposed.plant.tolist()
    for each in (scene, replace(scene, supposed=True)):
        belief = replace(each, robot=replace(each.robot, hours=1.0), seconds_left=3600.0)
        chances.append(Adaptive().walk(belief, none).plant.tolist())
    assert chances[0] != chances[1]


def test_where_few_are_infested_differences_count_and_where_many_are_they_must_have_come_true():
    nothing, proved = no_inspections(), np.array([400.0, -400.0, 160.0, 1200.0, 80.0, 0.0])
    assert [trust(share, nothing) for share in (0.0, 0.015, 0.03)] == [1.0] * 3
    assert trust(0.1, nothing) == pytest.approx(0.5)
    assert 0.0 < trust(0.6, nothing) < 0.002
    assert trust(0.6, proved) > 0.6
    assert trust(0.1, proved) > trust(0.1, nothing)
    told = no_inspections(np.where(np.arange(N) < 20, 0.6, 0.1))
    assert trust(0.6, told) > 0.4


@pytest.mark.parametrize(("at", "share"), [(GATE, 0.5), (37, 0.4), (44, 0.8)])
def test_where_differences_have_come_to_nothing_the_day_is_the_sweep_plant_for_plant(at, share):
    # up two rows and into the third, or through it, a sweep has come so far
    swept = np.where(np.arange(N) <= at, 0, NEVER).astype(np.int32)
    scene = traced_scene(share, 2.0, at=at, last_inspected=swept)
    # 400 inspections, of which those said to be likelier were infested no more often
    nothing = np.array([400.0, -400.0, 400.0 * share, 1200.0, -400.0 * share, 0.0])
    scene = replace(
        scene,
        robot=replace(scene.robot, returns=False),
        traces=scene.traces._replace(slope_sums=nothing),
    )
    infested = np.random.default_rng(5).random(N) < share
    adaptive, naive = (work_day(scene, each, infested) for each in (Adaptive(), Naive()))
    assert adaptive.plant.tolist() == naive.plant.tolist()
    assert len(naive) > 90


def test_odds_are_multiplied_and_chances_stay_chances():
    assert times_odds.py_func(0.5, 3.0) == pytest.approx(0.75)
    assert times_odds.py_func(0.2, 1.0) == pytest.approx(0.2)
    assert 0.0 < times_odds.py_func(1e-6, 0.01) < times_odds.py_func(1.0 - 1e-6, 100.0) < 1.0


def test_with_all_odds_multiplied_neighbours_stay_as_correlated():
    before = PairApproximation.of(GRID, np.random.default_rng(3).uniform(0.1, 0.3, N), 0.3)
    chance, pair_chance = before.chance.copy(), before.pair_chance.copy()
    times_odds_of_all.py_func((chance, pair_chance), GRID.linked, 1.7, tuple(np.empty((2, N))))
    odds = [c / (1.0 - c) for c in (chance, before.chance)]
    np.testing.assert_allclose(odds[0], 1.7 * odds[1])

    def correlation(chance, pair_chance):
        start, other = GRID.adjacent
        p, q = np.repeat(chance, np.diff(start)), chance[other]
        return (pair_chance - p * q) / np.sqrt(p * (1.0 - p) * q * (1.0 - q))

    was = correlation(before.chance, before.pair_chance)
    np.testing.assert_allclose(correlation(chance, pair_chance), was)


@loop
def learn_clustering(linked, belief, rows):
    _learn_clustering(linked, belief, rows)


def test_neighbours_with_nothing_in_common_are_thought_over_once():
    belief, rows, *_ = workspace(scene_of(3, 1.0), times_of((40.0, 0.84)))
    belief.clusters.finds[:] = 0.0, 5.0
    learn_clustering(GRID.linked, belief, rows)
    assert belief.scale[0] == 0.0
    assert rows.stale.all()
    rows.stale[:] = False
    learn_clustering(GRID.linked, belief, rows)
    assert not rows.stale.any()


SMALL = rectangle(4, 5)
THREE_TIMES = times_of((20.0, 0.5), (30.0, 0.7), (40.0, 0.84))


@loop
def value_finds(linked, belief, closed, spares):
    _value_finds(linked, belief, closed, spares)


@loop
def next_in(travel, work, stretch, state):
    return _next_in(travel, work, stretch, state)


@loop
def best_left(travel, clock, work, at, now_s):
    return _best_left(travel, clock, work, at, now_s)


@loop
def least_s(travel, clock, at, row):
    return _least_s(travel, clock, at, row)


@loop
def inspected(travel, clock, plants, work, stops, state):
    return _inspect(travel, clock, plants, work, stops, state)


def small_scene(seed, hours=1.0, **given):
    chance = np.clip(np.random.default_rng(seed).beta(0.4, 3.0, len(SMALL)), 1e-5, 0.9)
    belief, robot = TracedPairs.of(SMALL, chance), Robot(hours=hours, returns=seed % 2 == 0)
    return replace(
        scene_on(SMALL), robot=robot, chance=belief.chance, pair_chance=belief.pair_chance,
        traces=belief.traces, seconds_left=robot.day_s, **given,
    )  # fmt: skip


def traced_work(seed, times=THREE_TIMES, hours=1.0):
    """Return a scene and what planning works in, as Adaptive makes it where finds are traced."""
    scene = small_scene(seed, hours)
    belief, *others = workspace(scene, times, 0.3)
    traces = scene.traces.own()
    scale = [1.0, chance_apart(traces.evidence), leaning(traces.evidence), 1.0]
    n = len(SMALL)
    belief = belief._replace(
        traces=traces, near=Neighbourhood.of(n, scene.chance), worth=np.linspace(1.0, 1.5, n),
        scale=np.array([*scale, scene.chance.mean()]), level=np.array([3.0, 3.0, 1.0]),
        clusters=ClusterEstimate.none(n, traces.evidence, scale[2]),
    )  # fmt: skip
    return scene, (belief, *others)


def test_a_find_is_worth_what_it_may_save_beside_it_and_a_closed_plant_nothing():
    belief = workspace(small_scene(1), THREE_TIMES)[0]
    belief.worth[:], belief.pair_before[:] = 0.0, -1
    closed = np.arange(len(SMALL)) % 3 == 0
    value_finds(SMALL.linked, belief, closed, 0.7)
    start, other = SMALL.adjacent
    for i in range(len(SMALL)):
        beside = other[start[i] : start[i + 1]]
        worth = 0.0 if closed[i] else 1.0 + 0.7 * np.mean(1.0 - belief.chance[beside])
        assert belief.worth[i] == pytest.approx(worth)
        before = np.flatnonzero(beside == i - 1) if i % 5 else []
        assert belief.pair_before[i] == (start[i] + before[0] if len(before) else -1)


@pytest.mark.parametrize("price", [1e-6, 0.001, 0.004, 0.02])
def test_the_next_of_a_stretch_is_the_first_that_is_worth_its_stop_and_gets_its_best_time(price):
    scene, work = traced_work(4)
    belief, times = work[0], work[3]
    values = belief.worth * belief.chance
    gains = times.detects[:, None] * values - price * times.stop_s[:, None]
    for row, end, k, at in product(range(4), range(2), range(5), range(-1, 20)):
        last, first = 5 * row + k, at
        if at < 0 or at // 5 != row:
            first = 5 * row - 1 if end == 0 else 5 * row + 5
        ahead = range(first + 1, last + 1) if end == 0 else range(first - 1, last - 1, -1)
        wanted = next((i for i in ahead if gains[:, i].max() > 0), -1)
        stretch = Stretch(row, end, last, 0.0)
        plant, time = next_in(scene.aisles.travel, (belief, times), stretch, (at, price))
        assert plant == wanted
        assert time == (gains[:, plant].argmax() if plant >= 0 else 0)


@pytest.mark.parametrize("seed", seeds(2, 6))
@pytest.mark.parametrize("hours", [0.03, 0.06, 0.5])
def test_what_is_left_at_last_is_the_plant_that_is_worth_most_for_its_seconds(seed, hours):
    scene, work = traced_work(seed, hours=hours)
    belief, times, travel, clock = work[0], work[3], scene.aisles.travel, scene.clock
    belief.worth[np.random.default_rng(seed).random(len(SMALL)) < 0.4] = 0.0
    for at, now_s in product((-1, 0, 7, 13, 19), (0.0, 60.0)):
        rates = {}
        for plant, time in product(range(len(SMALL)), range(3)):
            took_s = travel_s(travel, clock, at, plant) + times.stop_s[time]
            home_s = travel_s(travel, clock, plant, -1) if clock.returns else 0.0
            worth = times.detects[time] * belief.worth[plant] * belief.chance[plant]
            if now_s + took_s + home_s <= clock.seconds_left and worth > 0.0:
                rates[plant, time] = worth / took_s
        work[1].most[:] = -1.0
        plant, time = best_left(travel, clock, work, at, now_s)
        if rates:
            assert rates[plant, time] == pytest.approx(max(rates.values()))
        else:
            assert plant == -1


def test_no_plant_of_a_row_is_nearer_than_said_and_other_aisles_are_away():
    scene = small_scene(2)
    travel, clock, row = scene.aisles.travel, scene.clock, SMALL.row
    for at, to in product(range(-1, len(SMALL)), range(4)):
        seconds = [travel_s(travel, clock, at, i) for i in np.flatnonzero(row == to)]
        told_s = least_s(travel, clock, at, to)
        assert told_s <= min(seconds) + 1e-9
        if at >= 0 and SMALL.corridor[row[at]] != SMALL.corridor[to]:
            out_m = min(abs(travel.end_x_m[row[at]] - travel.x_m[at]))
            assert told_s >= min(seconds) - (out_m + 20.0) / clock.speed_m_s
            assert told_s > clock.row_change_s
        else:
            assert told_s == 0.0


@loop
def scaled(believed, linked, scale):
    scale_clustering(believed, linked, scale)


def believed_of(belief):
    return belief.chance.copy(), belief.pair_chance.copy()


@pytest.mark.parametrize("finds", [2.0, 2.8, 3.2, 4.5])
@pytest.mark.parametrize("before", [1.0, 1.3])
def test_finds_beyond_what_was_expected_raise_the_odds_of_all_plants_alike(finds, before):
    _, (belief, rows, *_) = traced_work(3)
    belief.clusters.finds[:] = 3.0
    belief.level[:], rows.stale[:] = [finds, 3.0, before], False
    was, share = believed_of(belief), belief.scale[4]
    learn_clustering(SMALL.linked, belief, rows)
    told = was[0].copy(), was[1].copy()
    ratio = finds / 3.0 / before
    if abs(ratio - 1.0) < 0.1:
        assert belief.level[2] == before
        assert not rows.stale.any()
        assert belief.scale[4] == share
    else:
        times_odds_of_all(told, SMALL.linked, ratio, (np.empty(20), np.empty(20)))
        assert belief.level[2] == pytest.approx(finds / 3.0)
        assert rows.stale.all()
        assert (rows.most == -1.0).all()
        assert belief.scale[4] == pytest.approx(belief.chance.mean())
    assert belief.chance == pytest.approx(told[0])
    assert belief.pair_chance == pytest.approx(told[1])


def test_where_nothing_is_believed_of_jumps_only_pairs_are_learnt():
    _, (belief, rows, *_) = traced_work(3)
    belief = belief._replace(traces=Traces.none(len(SMALL)))
    belief.level[0], belief.scale[4] = 9.0, 0.5
    belief.clusters.evidence[3] += 3.0
    was, before = believed_of(belief), belief.scale.copy()
    belief.scale[2] = before[2] = 0.5
    belief.clusters.finds[0] = 1.5
    learn_clustering(SMALL.linked, belief, rows)
    assert belief.level[2] == 1.0
    assert belief.scale.tolist() == [0.5, *before[1:]]
    scaled(was, SMALL.linked, (0.5, 0.5))
    assert belief.chance.tolist() == was[0].tolist()
    assert belief.pair_chance == pytest.approx(was[1])


def test_trust_lies_between_what_few_infested_earn_and_what_came_true():
    proved = np.array([400.0, -400.0, 160.0, 1200.0, 80.0, 0.0])
    slope = trust(1e3, proved)  # where all are infested nothing else counts
    for share in (0.05, 0.1, 0.2):
        few = trust(share, no_inspections())
        assert few == pytest.approx(1.0 / (1.0 + (share / 0.1) ** 4), abs=1e-3)
        assert trust(share, proved) == pytest.approx(few + (1.0 - few) * slope)


@pytest.mark.parametrize("evidence", [0.02, 0.07, 0.2, 1.5, -1.5])
def test_evidence_of_jumps_scales_what_jumps_brought_and_what_goes_together(evidence):
    _, (belief, rows, *_) = traced_work(3)
    belief.clusters.evidence[3] += evidence
    belief.traces.from_afar[:] = np.linspace(0.0, 0.6, 20)
    rows.stale[:] = False
    was, before, afar = believed_of(belief), belief.scale.copy(), belief.traces.from_afar.copy()
    learn_clustering(SMALL.linked, belief, rows)
    jumps, lean = chance_apart(belief.clusters.evidence), leaning(belief.clusters.evidence)
    notable = abs(jumps - before[1]) >= max(0.1 * before[1], 0.005)
    turned = abs(lean - before[2]) >= 0.1 * min(before[2], 1.0 - before[2])
    if notable:
        rescale_traced(was, SMALL.linked, afar, jumps / before[1])
    if turned:
        scaled(was, SMALL.linked, (lean / before[2], (1.0 - lean) / (1.0 - before[2])))
    assert belief.scale[1] == (jumps if notable else before[1])
    assert belief.scale[2] == (lean if turned else before[2])
    assert rows.stale.all() == (notable or turned)
    assert belief.chance == pytest.approx(was[0])
    assert belief.pair_chance == pytest.approx(was[1])


@pytest.mark.parametrize("finds", [0.0, 2.0, 2.8, 4.0])
@pytest.mark.parametrize("lean", [None, (0, 1.0), (1, 1.0)])
def test_pairs_go_together_as_much_as_finds_beside_finds_say_each_way(finds, lean):
    _, (belief, rows, *_) = traced_work(5)
    belief.clusters.finds[0] = finds
    if lean is not None:  # in rows or across: along[1] of the four ways to stand
        belief.clusters.evidence[1 + lean[0]] += lean[1]
    belief.traces.from_afar[:] = 0.0
    belief.scale[1] = chance_apart(belief.clusters.evidence)
    before, was = belief.scale.copy(), believed_of(belief)
    learn_clustering(SMALL.linked, belief, rows)
    now = leaning(belief.clusters.evidence)
    turned = abs(now - before[2]) >= 0.1 * min(before[2], 1.0 - before[2])
    told = was[0].copy(), was[1].copy()
    if turned or abs(finds / 3.0 - 1.0) > 0.1:
        scale = min(finds / 3.0, 1.5)
        each = scale * now / before[2], scale * (1.0 - now) / (1.0 - before[2])
        scaled(told, SMALL.linked, each)
        assert belief.scale[[0, 2]] == pytest.approx([scale, now])
    else:
        assert belief.scale.tolist() == before.tolist()
    assert belief.pair_chance == pytest.approx(told[1])


def test_trust_follows_what_came_true_once_it_differs_and_not_in_a_plan_of_supposed_results():
    for supposed, share, proved in product((False, True), (0.02, 0.08, 0.3), (False, True)):
        _, (belief, rows, *_) = traced_work(3)
        belief.scale[4], rows.stale[:] = share, False
        if proved:
            belief.traces.slope_sums[:] = [400.0, -400.0, 160.0, 1200.0, 80.0, 0.0]
        belief.level[:2] = 1e12 if supposed else 3.0
        learn_clustering(SMALL.linked, belief, rows)
        told = trust(share, belief.traces.slope_sums)
        moved = not supposed and abs(told - 1.0) >= 0.05
        assert belief.scale[3] == (told if moved else 1.0)
        assert rows.stale.all() == moved == (rows.stale.any())


@pytest.mark.parametrize("found", [False, True])
def test_an_inspection_is_written_down_and_learnt_from_and_all_it_changed_is_marked(found):
    scene, (belief, rows, _, times, _) = traced_work(6)
    n, i, time, at, now_s = len(SMALL), 7, 1, 3, 50.0
    travel, clock = scene.aisles.travel, scene.clock
    belief.traces.unseen[:], belief.level[2] = 2.0, 1.6
    rows.stale[:], rows.most[:] = False, 5.0
    would_find = np.zeros(n, np.uint8)
    would_find[i] = 2 if found else 3  # found by the second time, or by the third only
    stops = np.empty(n, np.int32), np.empty(n), np.empty(n, np.uint8)
    was, p = believed_of(belief), belief.chance[i]
    plants = SMALL.linked, belief, would_find
    state = (at, i, time, 2), now_s
    done_s, told = inspected(travel, clock, plants, (rows, times), stops, state)
    arrive_s = now_s + travel_s(travel, clock, at, i)
    assert told == found
    assert (stops[0][2], stops[1][2], stops[2][2]) == (i, pytest.approx(arrive_s), time)
    assert done_s == pytest.approx(arrive_s + times.stop_s[time])
    detects = times.detects[time]
    assert belief.level[:2] == pytest.approx([3.0 + found, 3.0 + detects * p / 1.6])
    assert belief.traces.unseen[i] == pytest.approx(0.0 if found else 2.0 * (1.0 - detects))
    assert belief.traces.slope_sums[:3] == pytest.approx([1.0, np.log(p / (1.0 - p)), float(found)])
    assert belief.worth[i] == 0.0
    assert (belief.worth[np.arange(n) != i] > 0.0).all()
    assert belief.clusters.outcome[i] == found
    changed = np.flatnonzero(belief.chance != was[0])
    assert {i} < set(changed.tolist())
    assert rows.stale[SMALL.row[changed]].all()
    assert rows.most[0] == -1.0
    # a find may have infested others, or come from them
    assert (belief.traces.from_afar > 0.0).any() == found


@pytest.mark.parametrize("seed", seeds(2, 6))
@pytest.mark.parametrize("hours", [0.08, 0.2, 0.6])
def test_a_day_follows_its_plan_to_a_find_or_the_end_of_a_stretch_and_plans_again(seed, hours):
    """The day played again by its parts, of which each has promises of its own."""
    rng = np.random.default_rng([seed, 7])
    seen = rng.random(len(SMALL)) < 0.15
    given = {"at": int(rng.integers(-1, 20)), "last_inspected": np.where(seen, 0, -1)}
    scene = replace(small_scene(seed, hours), **given)
    found = (rng.random(len(SMALL)) < 0.3).astype(np.uint8)
    sampler = Adaptive(spares=0.4)
    work = work_day(scene, sampler, found)
    times = sampler.inspection_times(scene.robot)
    _, (belief, rows, tours, _, own) = traced_work(seed, times, hours)
    worth = np.where(seen, 0.0, 1.0)
    belief.worth[:], belief.pair_before[:] = 0.0, -1
    belief = belief._replace(pair_chance=scene.pair_chance.copy(),
                             morning_pair_chance=scene.pair_chance.copy())  # fmt: skip
    belief.scale[3] = trust(belief.scale[4], belief.traces.slope_sums)
    value_finds(SMALL.linked, belief, seen, 0.4)
    assert ((belief.worth > 0) == (worth > 0)).all()
    travel, clock, linked = scene.aisles.travel, scene.clock, SMALL.linked
    all_work, plants = (belief, rows, tours, times, own), (linked, belief, found)
    stops = np.empty(20, np.int32), np.empty(20), np.empty(20, np.uint8)
    at, now_s, k = scene.at, 0.0, 0
    price = first_price_of(travel, clock, all_work, at)
    while True:
        learn_clustering(linked, belief, rows)
        price, stretch = planned_on(
            travel, clock, all_work, (at, price, clock.seconds_left - now_s)
        )
        n_before, plant = k, -1
        while stretch.row >= 0:
            plant, time = next_in(travel, (belief, times), stretch, (at, price))
            if plant < 0 or not fits(travel, clock, (at, plant), times.stop_s[time], now_s):
                break
            state = (at, plant, time, k), now_s
            now_s, is_find = inspected(travel, clock, plants, (rows, times), stops, state)
            at, k = plant, k + 1
            if is_find or plant == stretch.last:
                break
        if k == n_before:
            plant, time = best_left(travel, clock, all_work, at, now_s)
            if plant < 0:
                break
            state = (at, plant, time, k), now_s
            now_s, _ = inspected(travel, clock, plants, (rows, times), stops, state)
            at, k = plant, k + 1
    assert work.plant.tolist() == stops[0][:k].tolist()
    assert work.arrive_s == pytest.approx(stops[1][:k])


def fits(travel, clock, move, stop_s, now_s):
    at, plant = move
    home_s = travel_s(travel, clock, plant, -1) if clock.returns else 0.0
    return now_s + travel_s(travel, clock, at, plant) + stop_s + home_s <= clock.seconds_left
