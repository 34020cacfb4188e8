"""The same day on many plots: one of them."""

from dataclasses import replace
from datetime import time

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, box

from fieldmon.errors import SettingError
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import PRESENT, Records
from fieldmon.pests.pest import Pest
from fieldmon.planning.day_bound import found_bound
from fieldmon.planning.many_plots import Orders, Task, _robot, plan_task
from fieldmon.planning.plan import PlanSettings, first_day
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot, rover, scout
from fieldmon.samplers import sampler

FRAME = Frame(5.0, 45.0)
FIELD = Field("square", FRAME.geometry_lonlat(MultiPolygon([shapely.box(-30, -25, 30, 25)])))
PLOT = Plot.of(FIELD)
DAY = np.datetime64("2026-11-02")
ORDERS = Orders(DAY, "naive")
RECORDS = Records.of(FRAME.lonlat(np.array([[5.0, 5.0]])), np.array([PRESENT]), np.array([DAY - 1]))
HALF_AN_HOUR = {"hours": 0.5}


def by_itself(robot, name="naive", **settings):
    plans = PlanSettings(robot, sampler(name, **settings))
    return first_day(PLOT, RECORDS, DAY, plans).route


@pytest.mark.parametrize(
    ("task", "robot"),
    [
        (Task(FIELD, None, HALF_AN_HOUR, ORDERS), Robot(hours=0.5)),
        (Task(FIELD, "Scout", HALF_AN_HOUR, ORDERS), replace(scout(), hours=0.5)),
        # what is ordered by hand goes before what the plot's file states
        (
            Task(FIELD, "robot", HALF_AN_HOUR, replace(ORDERS, on_foot=True)),
            replace(scout(), hours=0.5),
        ),
        (Task(FIELD, None, HALF_AN_HOUR, replace(ORDERS, robot={"hours": 1.0})), Robot(hours=1.0)),
        (
            Task(FIELD, "scout", HALF_AN_HOUR, replace(ORDERS, rover=True)),
            replace(rover(), hours=0.5),
        ),
        (
            Task(FIELD, None, HALF_AN_HOUR, replace(ORDERS, robot_times="thesis")),
            Robot(hours=0.5).with_times("thesis"),
        ),
        # a scout has times of its own
        (
            Task(FIELD, "scout", HALF_AN_HOUR, replace(ORDERS, robot_times="thesis")),
            replace(scout(), hours=0.5),
        ),
    ],
)
def test_a_plot_is_worked_by_who_is_stated_or_ordered(task, robot):
    route, expected = plan_task(task, PLOT, RECORDS).route, by_itself(robot)
    np.testing.assert_array_equal(route.plant, expected.plant)
    np.testing.assert_array_equal(route.arrive_s, expected.arrive_s)


def test_a_sampler_leaves_out_as_many_as_ordered():
    task = Task(FIELD, None, HALF_AN_HOUR, Orders(DAY, "bouncy", every=3))
    expected = by_itself(Robot(hours=0.5), "bouncy", every=3)
    np.testing.assert_array_equal(plan_task(task, PLOT, RECORDS).route.plant, expected.plant)


@pytest.mark.parametrize(
    ("task", "says"),
    [
        (Task(FIELD, "donkey", {}, ORDERS), "'donkey'"),
        (Task(FIELD, None, {"hours": 0.001}, ORDERS), "0.001 h are not"),
    ],
)
def test_what_cannot_be_done_is_a_sentence(task, says):
    with pytest.raises(SettingError, match=says):
        plan_task(task, PLOT, RECORDS)


def test_a_task_is_told_from_any_other_and_known_again():
    task = Task(FIELD, "robot", HALF_AN_HOUR, ORDERS)
    moved = replace(FIELD, boundary=shapely.affinity.translate(FIELD.boundary, 1e-7))
    others = [
        (replace(task, plot=moved), RECORDS),
        (replace(task, plot=replace(FIELD, name="other")), RECORDS),
        (replace(task, plot=replace(FIELD, gate=(5.0, 45.0))), RECORDS),
        (replace(task, who="scout"), RECORDS),
        (replace(task, stated={"hours": 0.6}), RECORDS),
        (replace(task, orders=replace(ORDERS, sampler="bouncy")), RECORDS),
        (replace(task, orders=replace(ORDERS, day=DAY + 1)), RECORDS),
        (replace(task, orders=replace(ORDERS, planting={"row_spacing_m": 5.0})), RECORDS),
        (replace(task, orders=replace(ORDERS, rover=True)), RECORDS),
        (replace(task, orders=replace(ORDERS, robot_times="thesis")), RECORDS),
        (replace(task, orders=replace(ORDERS, at=time(8))), RECORDS),
        (task, Records.none()),
    ]
    digests = {each.digest(records) for each, records in [(task, RECORDS), *others]}
    assert len(digests) == 1 + len(others)
    again = Task(replace(FIELD), "robot", dict(HALF_AN_HOUR), replace(ORDERS))
    assert again.digest(RECORDS.take(np.array([True]))) == task.digest(RECORDS)


def test_another_text_of_an_own_sampler_is_another_task(tmp_path):
    file = tmp_path / "mine.py"
    task = Task(FIELD, None, {}, Orders(DAY, f"{file}:Mine"))
    digests = [file.write_text(text) and task.digest(RECORDS) for text in ("a = 1", "a = 2")]
    assert digests[0] != digests[1]


def test_a_task_has_the_digest_that_folders_of_routes_hold():
    field = Field("Gate", MultiPolygon([box(35.15, 30.36, 35.1508, 30.3607)]), gate=(35.15, 30.36))
    records = Records.of(
        np.array([[35.1501, 30.3601], [35.1502, 30.3602]]),
        np.array([1, 0], np.int8),
        np.array(["2026-04-01", "NaT"], "datetime64[D]"),
        count=np.array([3.0, np.nan]),
    )
    by_hand = {"robot": {"hours": 2.0}, "planting": {"row_spacing_m": 3.0}}
    orders = Orders(np.datetime64("2026-04-06"), "bouncy", 3, **by_hand)
    task = Task(field, "scout", {"look_s": 30.0, "hours": 4.0}, orders)
    assert task.digest(records) == "c9b199b28e29aa71"


def planned(who=None, stated=HALF_AN_HOUR, **orders):
    return plan_task(Task(FIELD, who, stated, replace(ORDERS, **orders)), PLOT, RECORDS)


def test_a_day_says_its_bound_if_that_was_ordered_and_is_the_same_day():
    bound, plain = planned(), planned(bound=False)
    assert bound.route.found_bound == found_bound(plain)
    assert plain.route.found_bound is None
    assert bound.route.plant.tolist() == plain.route.plant.tolist()


def test_what_records_say_is_told_by_the_prior_that_was_ordered():
    for prior in (PriorSettings(), PriorSettings(background_chance=0.2, edge_chance=0.0)):
        chance = prior_chance(PLOT.grid, FIELD, RECORDS, DAY, prior)
        assert planned(prior=prior).chance.tolist() == chance.tolist()


def test_records_are_taken_as_of_the_day_that_was_ordered():
    chance = [planned(day=DAY + later).chance.max() for later in (0, 7, 60)]
    assert sorted(chance, reverse=True) == chance
    assert len({*chance}) == 3


@pytest.mark.parametrize("name", ["naive", "adaptive"])
def test_the_sampler_that_was_ordered_decides(name):
    route, expected = planned(sampler=name).route, by_itself(Robot(hours=0.5), name)
    assert route.plant.tolist() == expected.plant.tolist()


@pytest.mark.parametrize("who", ["robot", "scout"])
@pytest.mark.parametrize("on_foot", [True, False])
@pytest.mark.parametrize("small", [True, False])
@pytest.mark.parametrize("times", [None, "thesis"])
def test_who_works_is_what_its_file_and_then_the_orders_say(who, on_foot, small, times):
    """On foot goes before the small robot, and that before a scout of the plot's own file."""
    found = _robot(Task(FIELD, who.upper(), {"look_s": 25.0, "hours": 2.0},
                        replace(ORDERS, on_foot=on_foot, rover=small, robot_times=times,
                                robot={"hours": 3.0})))  # fmt: skip
    walks = on_foot or (who == "scout" and not small)
    base = scout() if walks else rover() if small else Robot()
    base = base if walks or times is None else base.with_times(times)
    assert found == replace(base, look_s=25.0, hours=3.0)


def test_a_pest_that_is_looked_for_is_seen_as_it_can_be_seen():
    pest = Pest("mine", "", detection=0.31)
    seen, plain = planned(pest=pest), planned()
    assert seen.scene.robot == replace(plain.scene.robot, detection=0.31)
    assert set(seen.work.detects.tolist()) == {0.31}


@pytest.mark.parametrize(
    "later", [{"prior": PriorSettings(edge_chance=0.2)}, {"pest": Pest("mine", "")},
              {"rover": True}, {"robot_times": "thesis"}, {"at": time(7)}]
)  # fmt: skip
def test_what_could_be_ordered_later_only_tells_tasks_apart_where_it_is_ordered(later):
    """Else folders of routes of old would all be planned again."""
    tasks = [Task(FIELD, None, {}, Orders(DAY, **one)) for one in ({}, later)]
    plain, other = (task.digest(RECORDS) for task in tasks)
    assert plain != other
    usual = {name: getattr(Orders(DAY), name) for name in later}
    assert Task(FIELD, None, {}, Orders(DAY, **usual)).digest(RECORDS) == plain
    assert len(plain) == 16
