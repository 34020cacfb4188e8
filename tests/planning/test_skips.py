"""A plant that nobody could inspect is left out for a while, longer each time in a row."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.monitoring.treating.closures import Closure, open_to_people
from fieldmon.planning.explain import explain
from fieldmon.planning.plan import plan_from, plan_in
from fieldmon.planning.skips import (
    Skips,
    left_out_in_words,
    nothing_left_in_words,
    without_flagged,
    without_skipped,
)
from fieldmon.planning.wishes import Wishes
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import NEVER
from tests.planning.test_wishes import HOUR, chance, plot  # noqa: F401 - fixtures

DAY = 9


def skips_of(days, inspected=NEVER):
    """Return the skips of plant 1 of 3 on these days, and its last inspection."""
    last = np.array([NEVER, inspected, NEVER])
    return Skips.of(np.ones(len(days), np.int32), np.array(days, np.int32), last)


def asked_again(skips, since):
    return next(day for day in range(since + 1, since + 99) if not skips.left_out(day)[1])


def test_each_skip_in_a_row_doubles_the_days_that_a_plant_is_left_out():
    days = [3]
    for out in (1, 2, 4, 8, 16):
        again = asked_again(skips_of(days), days[-1])
        assert again - days[-1] - 1 == out
        days.append(again)


def test_an_inspection_begins_the_row_anew_and_two_who_say_the_same_count_once():
    assert asked_again(skips_of([3, 5, 8], inspected=5), 8) == 10
    assert asked_again(skips_of([3, 3, 3]), 3) == 5
    for of_the_same_day in (skips_of([3, 5, 8], inspected=8), skips_of([])):
        assert not of_the_same_day.times.any()
        assert not of_the_same_day.left_out(9).any()


def test_a_plant_skipped_for_ever_is_left_out_and_nothing_overflows():
    skips = skips_of([*range(500)])
    assert skips.left_out(500 + 365 * 5)[1]
    assert skips.left_out(500).tolist() == [False, True, False]


@pytest.fixture(scope="module")
def scene(plot, chance):  # noqa: F811
    return replace(plan_from(plot, chance, HOUR).scene, day=DAY)


def skipped(scene, plants):
    """Return the scene of the day after these plants were skipped."""
    days = np.full(len(plants), DAY - 1)
    return without_skipped(scene, Skips.of(np.array(plants, np.int32), days, scene.last_inspected))


@pytest.mark.parametrize("name", [*SAMPLERS])
def test_no_sampler_goes_to_what_is_left_out_unless_somebody_wishes_for_it(scene, name):
    usual = plan_in(scene, sampler(name)).route.plant
    without = skipped(scene, usual[::2])
    route = plan_in(without, sampler(name)).route
    assert len(route)
    assert not set(usual[::2]) & set(route.plant.tolist())
    wanted = int(usual[0])
    wished = Wishes((wanted,)).applied_to(without)
    assert wished.last_inspected[wanted] == NEVER
    assert (wished.last_inspected[usual[2::2]] == DAY).all()


def test_nothing_skipped_leaves_the_scene_itself(scene):
    assert skipped(scene, []) is scene
    assert left_out_in_words(scene, plan_in(scene, HOUR.sampler).route) == ()


def test_what_was_inspected_today_or_is_closed_stays_so_when_it_is_wished_for(scene):
    last = scene.last_inspected.copy()
    last[3] = DAY
    without = skipped(replace(scene, last_inspected=last), [3, 4, 5])
    assert np.flatnonzero(without.skipped).tolist() == [4, 5]
    closed = Closure(np.arange(len(last)) == 4, None, "")
    seen = Wishes((3, 4, 5)).applied_to(open_to_people(without, (closed,))).last_inspected
    assert seen[[3, 4, 5]].tolist() == [DAY, DAY, NEVER]


def test_a_plan_says_how_many_plants_it_leaves_out(scene):
    without = skipped(scene, [300, 301])
    (said,) = left_out_in_words(without, plan_in(without, HOUR.sampler).route)
    assert said == "Left out of this plan: 2 plants that nobody could inspect last time."
    wished = plan_in(without, HOUR.sampler, Wishes((300,)))
    assert 300 in wished.route.plant
    (said,) = left_out_in_words(without, wished.route)
    assert said == "Left out of this plan: 1 plant that nobody could inspect last time."
    assert wished.scene.are_open(np.array([300, 0])).all()
    assert any("1 nobody could inspect last time" in one
               for one in explain(wished.scene, wished.work))  # fmt: skip


def test_a_flagged_plant_is_left_out_unless_somebody_wishes_for_it(scene):
    every = np.arange(len(scene.last_inspected))
    assert without_flagged(scene, None) is scene
    assert without_flagged(scene, np.zeros(len(every), np.bool_)) is scene
    flagged = without_flagged(scene, np.isin(every, [300, 301]))
    both = skipped(flagged, [302])
    assert (both.last_inspected[[300, 301, 302]] == DAY).all()
    wished = plan_in(both, HOUR.sampler, Wishes((300,)))
    assert 300 in wished.route.plant
    assert left_out_in_words(both, wished.route) == (
        "Left out of this plan: 1 plant that nobody could inspect last time.",
        "Left out of this plan: 1 plant found and only flagged.",
    )
    assert wished.scene.are_open(np.array([300, 302, 0])).all()
    assert any("1 found and only flagged" in one
               for one in explain(wished.scene, wished.work))  # fmt: skip
    # where all are known there is nowhere to go
    assert len(plan_in(without_flagged(scene, every >= 0), HOUR.sampler).route) == 0


def test_a_flagged_plant_that_nobody_could_inspect_last_time_is_said_as_that_and_once(scene):
    known = np.isin(np.arange(len(scene.chance)), [300, 301, 302])
    skips = Skips.of(np.array([302, 303]), np.full(2, DAY - 1), scene.last_inspected)
    both = without_skipped(without_flagged(scene, known), skips)
    said = left_out_in_words(both)
    assert "2 plants that nobody could inspect last time" in said[0]
    assert "2 plants found and only flagged" in said[1]
    assert (both.last_inspected[[300, 301, 302, 303]] == DAY).all()
    seen = np.where(known, np.int32(DAY), scene.last_inspected)
    today = without_skipped(without_flagged(replace(scene, last_inspected=seen), known), skips)
    assert np.flatnonzero(today.skipped).tolist() == [303]


def test_where_every_plant_was_skipped_none_is_left_out():
    """A locked gate is no reason to stay away tomorrow."""
    every, never = np.arange(4), np.full(4, NEVER)
    assert not Skips.of(every, np.full(4, 3), never).left_out(4).any()
    assert Skips.of(every[1:], np.full(3, 3), never).left_out(4).tolist() == [
        False,
        True,
        True,
        True,
    ]


def test_where_every_plant_is_known_it_is_said_that_nothing_is_left(scene):
    every = np.arange(len(scene.chance))
    assert nothing_left_in_words(scene) is None
    assert nothing_left_in_words(without_flagged(scene, every > 0)) is None
    flagged = without_flagged(scene, every >= 0)
    said = f"Every plant is known: {len(every):,} plants were found and only flagged."
    assert str(nothing_left_in_words(flagged)).startswith(said)
    one = replace(scene, last_inspected=np.full(len(every), scene.day))
    said = "Nothing is left to inspect: every plant was inspected on this day"
    assert str(nothing_left_in_words(one)).startswith(said)
    said = "Nothing is left to inspect: 1 plant was found and only flagged, and all others"
    one = without_flagged(replace(one, last_inspected=np.where(every, scene.day, NEVER)), every < 1)
    assert str(nothing_left_in_words(one)).startswith(said)
    done = replace(scene, last_inspected=np.where(every > 2, scene.day, scene.last_inspected))
    said = "Nothing is left to inspect: 3 plants were found and only flagged, and all others"
    assert str(nothing_left_in_words(without_flagged(done, every >= 0))).startswith(said)
