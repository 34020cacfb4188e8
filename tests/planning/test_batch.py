"""What tells one plot's task from any other, and how it is planned."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.errors import SettingError
from fieldmon.infestation.observations import Observations
from fieldmon.planning.batch import Orders, Task, plan_task
from fieldmon.plot.field import Field

FIELD = Field("Gate", MultiPolygon([box(35.15, 30.36, 35.1508, 30.3607)]), gate=(35.15, 30.36))
RECORDS = Observations.of(
    np.array([[35.1501, 30.3601], [35.1502, 30.3602]]),
    np.array([1, 0], np.int8),
    np.array(["2026-04-01", "NaT"], "datetime64[D]"),
    count=np.array([3.0, np.nan]),
)
DAY = np.datetime64("2026-04-06")
ORDERS = Orders(DAY, "bouncy", 3, robot={"hours": 2.0}, planting={"row_spacing_m": 3.0})
TASK = Task(FIELD, "scout", {"look_s": 30.0, "hours": 4.0}, ORDERS)


def test_a_task_has_the_digest_that_folders_of_routes_hold():
    assert TASK.digest(RECORDS) == "7675b30d2cc3e467"


@pytest.mark.parametrize(
    "other",
    [
        replace(TASK, who="robot"),
        replace(TASK, stated={"look_s": 30.0}),
        replace(TASK, plot=replace(FIELD, name="Other")),
        replace(TASK, orders=replace(ORDERS, day=DAY + 1)),
    ],
    ids=["who", "stated", "plot", "day"],
)
def test_any_other_task_has_another_digest(other):
    assert other.digest(RECORDS) != TASK.digest(RECORDS)
    assert TASK.digest(Observations.none()) != TASK.digest(RECORDS)


def test_what_was_ordered_goes_before_what_the_file_states():
    today = plan_task(TASK, RECORDS)
    assert today.scene.robot.hours == 2.0
    assert today.scene.robot.look_s == 30.0
    assert today.route.end_s <= 2.0 * 3600


def test_a_plot_must_be_worked_by_somebody_known():
    with pytest.raises(SettingError, match="'robot' or 'scout'"):
        plan_task(replace(TASK, who="drone"), RECORDS)


def test_a_day_too_short_for_a_plant_is_a_sentence():
    short = replace(ORDERS, robot={"hours": 0.001})
    with pytest.raises(SettingError, match="Give more hours"):
        plan_task(replace(TASK, orders=short), RECORDS)
