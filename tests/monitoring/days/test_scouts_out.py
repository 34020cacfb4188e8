"""Who is out: a line for each with a code or of the team, as the season's file knows it."""

import shutil
from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest

from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.days.day_ahead import WorkPart, planned_again, route_ahead
from fieldmon.monitoring.days.scouts_out import scouts_out
from fieldmon.monitoring.file import connections
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.phones.findings import take
from fieldmon.planning.members import team_of
from fieldmon.plot.local_clock import utc_now
from tests.monitoring.phone import a_finding
from tests.monitoring.seasons import BEGINS, a_season, on


@pytest.fixture
def fresh(tmp_path):
    return a_season(tmp_path / "fresh.gpkg")


def of(season, name):
    (one,) = (one for one in scouts_out(season, BEGINS) if one.name == name)
    return one


def test_it_says_who_has_which_rows_and_how_far_they_are(fresh):
    key = scouts.let_in(fresh, "Ann", (1, 8))
    scouts.let_in(fresh, "Ben", (11, 19))
    ann = of(fresh, "Ann")
    assert (ann.rows, ann.heard, ann.done, ann.ahead) == ((1, 8), None, 0, 0)
    assert abs(ann.made - utc_now()) < timedelta(minutes=1)
    route = route_ahead(fresh, BEGINS, WorkPart((1, 8), "Ann")).plant
    take(fresh, key, [a_finding(int(route[0]), on=BEGINS)], utc_now())
    route_ahead(fresh, BEGINS, WorkPart((11, 19), "Ben"))
    ann = of(fresh, "Ann")
    assert (ann.done, ann.ahead) == (1, len(route) - 1)
    assert abs(ann.heard - utc_now()) < timedelta(minutes=1)
    assert not ann.clock_is_wrong
    assert ann.shares == ()
    assert of(fresh, "Ben").done == 0


def test_what_is_ahead_of_who_has_other_rows_now_lies_in_these(fresh):
    scouts.let_in(fresh, "Dan", (1, 8))
    line = fresh.plant_numbers.line[route_ahead(fresh, BEGINS, WorkPart((1, 8), "Dan")).plant]
    scouts.let_in(fresh, "Dan", (7, 12))
    assert of(fresh, "Dan").ahead == int((line >= 7).sum())
    route = route_ahead(fresh, BEGINS, WorkPart((7, 12), "Dan"))
    assert of(fresh, "Dan").ahead == len(route)


def test_a_wrong_clock_and_shared_plants_are_said(fresh):
    key = scouts.let_in(fresh, "Ann")
    scouts.let_in(fresh, "Ben")
    assert (of(fresh, "Ann").shares, of(fresh, "Ben").shares) == (("Ben",), ("Ann",))
    route_ahead(fresh, BEGINS, WorkPart(None, "Ann"))
    take(fresh, key, [a_finding(5, on=BEGINS)], utc_now() + timedelta(minutes=30))
    ann = of(fresh, "Ann")
    assert ann.clock_is_wrong
    assert ann.fast.total_seconds() == pytest.approx(1800, abs=30)


def test_which_plan_was_given_last_is_known_before_anything_is_recorded_by_it(fresh):
    scouts.let_in(fresh, "Ann")
    assert of(fresh, "Ann").plan is None
    route_ahead(fresh, BEGINS, WorkPart(None, "Ann"))
    alone = of(fresh, "Ann").plan
    scouts.let_in(fresh, "Ben")
    route_ahead(fresh, BEGINS, WorkPart(None, "Ben"))
    shared = of(fresh, "Ann").plan
    assert len({alone, shared, of(fresh, "Ben").plan}) == 3
    planned_again(fresh, BEGINS, WorkPart(None, "Ann"), seconds_left=3000.0)
    assert of(fresh, "Ann").plan not in {alone, shared}


def test_what_is_left_is_what_the_plan_says_though_something_was_found_beside_it(fresh):
    part = WorkPart((1, 8), "Ann")
    key = scouts.let_in(fresh, "Ann", part.rows)
    given = route_ahead(fresh, BEGINS, part).plant
    start, second = fresh.plot.grid.adjacent
    plant = next(
        int(one) for one in given if len(np.setdiff1d(second[start[one] : start[one + 1]], given))
    )
    take(fresh, key, [a_finding(plant, FOUND, on=BEGINS)], utc_now())
    for _ in range(2):
        one, kept = of(fresh, "Ann"), fresh.planned_and_done(BEGINS)
        assert (one.done, one.ahead) == (1, kept.left)
        planned_again(fresh, BEGINS, part, seconds_left=3000.0)


def test_a_person_is_one_though_an_older_file_writes_the_name_in_two_ways(fresh):
    scouts.let_in(fresh, "Ann")
    part = WorkPart((1, 8), "Ann")
    given = route_ahead(fresh, BEGINS, part).plant.tolist()
    scouts.let_in(fresh, "Ann", (1, 8))
    with fresh.store.writing() as db:
        db.execute("UPDATE scouts SET name = 'ANN' WHERE ended IS NULL")
    assert of(fresh, "ANN").ahead == len(given)
    part = WorkPart((1, 8), "ANN")
    assert route_ahead(fresh, BEGINS, part).plant.tolist() == given
    planned_again(fresh, BEGINS, part, seconds_left=3000.0)
    assert fresh.planned_and_done(BEGINS).people == 1


def test_the_file_is_read_as_often_for_many_people_as_for_one(fresh, monkeypatch):
    opened, connect = [], connections.connect
    monkeypatch.setattr(connections, "connect", lambda *told: opened.append(told) or connect(*told))
    times = []
    for k in range(3):
        scouts.let_in(fresh, f"scout {k}", (1 + 2 * k, 2 + 2 * k))
        opened.clear()
        scouts_out(fresh, BEGINS)
        times.append(len(opened))
    assert len({*times}) == 1


def test_the_team_is_there_without_codes_and_who_is_beside_it_has_no_route(fresh):
    scouts.let_in(fresh, "Anna")
    before = fresh.settings
    fresh.change(replace(before, team=team_of(2)), before)
    scouts.let_in(fresh, "robot-2")
    out = scouts_out(fresh, BEGINS)
    assert [one.name for one in out] == ["Anna", "robot-2", "robot-1"]
    assert [one.made is not None for one in out] == [True, True, False]
    assert [one.has_route for one in out] == [False, True, True]


def test_a_code_made_after_a_day_changes_nothing_of_its_plan_or_of_who_was_out(fresh):
    for name, rows in (("Ann", (1, 8)), ("Dan", (11, 19))):
        key = scouts.let_in(fresh, name, rows)
        first = route_ahead(fresh, BEGINS, WorkPart(rows, name)).plant[0]
        take(fresh, key, [a_finding(int(first), on=BEGINS)], utc_now())
    with fresh.store.writing() as db:  # that evening
        db.execute(
            "UPDATE scouts SET ended = ? WHERE name = 'Dan'", (f"{BEGINS}T16:00:00.000000Z",)
        )
    planned, out = fresh.planned_and_done(BEGINS), scouts_out(fresh, BEGINS)
    assert ([one.name for one in out], planned.people) == (["Ann"], 1)
    scouts.let_in(fresh, "Dan", (11, 19))
    scouts.let_in(fresh, "Ann", (9, 10))
    scouts.let_in(fresh, "Eve", (1, 8))
    assert fresh.planned_and_done(BEGINS) == planned
    (ann,) = scouts_out(fresh, BEGINS)
    assert (ann.name, ann.rows, ann.ahead) == ("Ann", (1, 8), out[0].ahead)
    before = fresh.settings
    fresh.change(replace(before, team=team_of(2)), before)
    assert [(one.name, one.has_route) for one in scouts_out(fresh, BEGINS)] == [("Ann", True)]
    assert {one.name for one in scouts_out(fresh, on(1))} >= {"Dan", "Eve", "robot-1"}


def test_a_code_that_one_of_the_team_got_after_a_day_is_said_of_that_day_too(fresh):
    before = fresh.settings
    fresh.change(replace(before, team=team_of(2)), before)
    first = fresh.plan_each(BEGINS)[0].route.plant[:1]
    fresh.record(Inspections.of(first, np.zeros(1, np.int8), BEGINS), "f", "robot-1")
    assert fresh.work(BEGINS).is_earlier
    assert of(fresh, "robot-2").made is None
    scouts.let_in(fresh, "robot-2")
    assert abs(of(fresh, "robot-2").made - utc_now()) < timedelta(minutes=1)


def test_rows_that_overlap_after_a_merge_are_said_there_and_of_each(fresh, tmp_path):
    other = Season(shutil.copy(fresh.path, tmp_path / "other.gpkg"))
    scouts.let_in(fresh, "Ann", (1, 9))
    scouts.let_in(fresh, "Cem", (1, 9))
    scouts.let_in(other, "Ben", (5, 12))
    said = fresh.merge(other).overlaps
    assert len(said) == 2
    assert said[0].startswith("Ann has rows 1 to 9, and Ben rows 5 to 12")
    assert {one.name: one.overlaps for one in scouts_out(fresh, BEGINS)} == {
        "Ann": ("Ben",), "Cem": ("Ben",), "Ben": ("Ann", "Cem")
    }  # fmt: skip


def test_finds_that_came_in_after_a_route_was_given_out_are_counted_but_ones_own(
    fresh, monkeypatch
):
    keys = {name: scouts.let_in(fresh, name) for name in ("Ann", "Ben")}
    take(fresh, keys["Ann"], [a_finding(2, FOUND, on=BEGINS)], utc_now())
    route_ahead(fresh, on(1), WorkPart(None, "Ann"))
    monkeypatch.setattr(fresh, "_is_earlier", lambda *_: False)

    def newer():
        return [one.newer for one in scouts_out(fresh, on(1))]

    assert newer() == [0, 0]
    for name, plant, day in (("Ann", 3, 0), ("Ben", 4, 1), ("Ann", 5, 1), ("Ann", 6, 2)):
        take(fresh, keys[name], [a_finding(plant, FOUND, on=on(day))], utc_now())
    take(fresh, keys["Ben"], [a_finding(7, on=BEGINS)], utc_now())
    assert newer() == [2, 2]
    planned_again(fresh, on(1), WorkPart(None, "Ann"), seconds_left=3000.0)
    assert newer() == [0, 0]
    route_ahead(fresh, on(2), WorkPart(None, "Ann"))
    take(fresh, keys["Ben"], [a_finding(8, FOUND, on=BEGINS)], utc_now())
    assert newer() == [1, 1]
