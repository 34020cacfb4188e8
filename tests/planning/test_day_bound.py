"""A planned day says what no other route of its hours can expect to find."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.wording import estimate
from fieldmon.planning import routes
from fieldmon.planning.day_bound import found_bound, with_bound
from fieldmon.planning.plan import DayPlan, plan_day, plan_in
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import NEVER, Scene


def scene(**more):
    aisles = Aisles.of(rectangle(9, 12))
    chance = np.random.default_rng(3).random(108) * 0.3
    never = np.full(108, NEVER, np.int32)
    robot = Robot()
    return Scene(aisles, robot, chance, **{"last_inspected": never, "seconds_left": 3000.0, **more})


def planned(name="adaptive", **more) -> DayPlan:
    return plan_in(scene(**more), sampler(name))


@pytest.mark.parametrize("name", [name for name, kind in SAMPLERS.items() if not kind.chooses_time])
def test_no_sampler_expects_more_than_the_bound_and_all_share_it(name):
    day = with_bound(planned(name))
    assert day.route.expected_finds <= day.route.found_bound
    assert day.route.found_bound == pytest.approx(found_bound(planned("naive")))


def test_the_sentence_says_the_expected_finds_and_the_bound():
    route = with_bound(planned()).route
    assert route.bound_sentence.startswith(
        f"{estimate(route.expected_finds)} finds expected; no route "
    )


def test_a_day_that_was_not_asked_says_nothing():
    assert planned().route.found_bound is None
    assert planned().route.bound_sentence == ""


def test_plants_inspected_today_are_worth_nothing_more():
    done = np.full(108, NEVER, np.int32)
    done[:54] = 0
    left = found_bound(planned(last_inspected=done))
    chance = scene().chance * Robot().detects
    assert left <= chance[54:].sum() * (1 + 1e-6)
    assert left < found_bound(planned())


def test_no_bound_is_claimed_away_from_the_gate_nor_where_inspection_times_are_chosen():
    assert found_bound(planned(at=5)) is None
    assert found_bound(planned("adaptive-looks")) is None


def test_with_no_time_to_compute_it_is_a_bound_all_the_same():
    day = planned()
    hurried = found_bound(day, within_s=0.0)
    assert hurried >= found_bound(day) >= day.route.expected_finds


def test_a_bound_below_what_the_day_expects_is_not_told(monkeypatch):
    day = planned()
    monkeypatch.setattr(routes, "bound", lambda *_: 0.9 * day.route.expected_finds)
    with pytest.warns(RuntimeWarning, match="a fault of fieldmon"):
        assert with_bound(day).route.bound_sentence == ""


def test_a_plant_that_is_certain_to_be_clean_makes_no_bound_of_nan():
    clean = plan_in(replace(scene(), chance=np.zeros(108)), sampler("naive"))
    assert found_bound(clean) >= 0.0


def test_a_bound_rises_with_the_hours_up_to_all_that_can_be_found():
    """Of the hours of the scene, whatever a whole day of the robot has."""
    bounds = [
        found_bound(planned(seconds_left=seconds)) for seconds in (600.0, 1500.0, 3000.0, 1e5)
    ]
    everything = (scene().chance * Robot().detects).sum()
    assert sorted({*bounds}) == bounds
    assert bounds[-1] == pytest.approx(everything)
    assert bounds[-2] < 0.9 * everything


@pytest.mark.parametrize("detection", [0.25, 0.9])
def test_a_bound_is_in_proportion_to_the_chance_to_see_what_is_there(detection):
    sharp, dull = (
        found_bound(plan_in(replace(scene(), robot=Robot(detection=d)), sampler("naive")))
        for d in (1.0, detection)
    )
    assert dull == pytest.approx(detection * sharp, rel=1e-3)


def test_no_bound_is_known_where_no_time_is_left_or_trees_stand_in_no_rows():
    day = planned()
    assert found_bound(replace(day, scene=replace(day.scene, seconds_left=0.0))) is None
    lonlat = np.array([[34.9, 32.5], [34.9001, 32.5], [34.9, 32.5001]])
    trees = Plot.among("park", lonlat)
    assert found_bound(plan_day(trees, on="2026-11-18", robot=Robot(hours=1.0))) is None


def test_a_route_says_the_bound_for_which_there_was_time_and_stays_what_it_was():
    day = planned()
    for within_s in (0.0, 10.0):
        bound = with_bound(day, within_s)
        assert bound.route.found_bound == found_bound(day, within_s)
        assert (bound.work, bound.scene) == (day.work, day.scene)
        assert bound.route.plant is day.route.plant


def test_only_today_s_inspections_leave_nothing_to_find():
    done = np.full(108, NEVER, np.int32)
    done[:54] = 3
    assert found_bound(planned(last_inspected=done, day=4)) == found_bound(planned())


def test_what_a_route_holds_is_below_its_bound_though_sums_round(monkeypatch):
    day = planned()
    held = day.route.expected_finds
    monkeypatch.setattr(routes, "bound", lambda *_: held * (1.0 - 1e-9))
    assert found_bound(day) == held
