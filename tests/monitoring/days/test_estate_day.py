"""An estate's day: hours go to plots where people may be, and what is closed is left off."""

from dataclasses import replace
from datetime import date, datetime, time, timedelta

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, Inspections
from fieldmon.monitoring.days.estate_day import EstatePlot, days_since, due, share_estate
from fieldmon.monitoring.treating.applications import Application
from fieldmon.planning.members import team_of
from fieldmon.plot.robot import Robot
from fieldmon.samplers.base import NEVER
from tests.monitoring.seasons import BEGINS, a_season

ON = BEGINS
SIX = time(6)
ONE = team_of(1, Robot(hours=2))


@pytest.fixture
def seasons(tmp_path):
    return [a_season(tmp_path / f"{name}.gpkg") for name in "ab"]


def plot_of(season, on: date = ON):
    return EstatePlot.of(season, on)


def spray(season, began, hours, plants=None):
    soap = Application("Soap", reentry_hours=hours, began=began, ended=began)
    season.treat(ON, 0.1, plants=plants, application=soap)


def hours_of(day):
    return {turn.plot: round(turn.scene.robot.day_s / 3600, 2) for turn in day.turns}


def test_due_is_what_was_not_seen_for_three_days_or_never_and_nothing_else():
    assert due([0, 2, 3, None]) == [2, 3]
    assert due([0, 2]) == due([0]) == due([]) == []


def test_a_plot_that_nobody_may_enter_gets_no_hours_and_no_way_to_it(seasons):
    spray(seasons[0], time(4), 48.0)
    closed, other = (plot_of(one) for one in seasons)
    day = share_estate([closed, other], ONE, SIX)
    (turn,) = day.turns
    (alone,) = share_estate([other], ONE, SIX).turns
    assert (turn.plot, turn.begins) == (1, datetime.combine(ON, SIX))
    assert turn.scene.robot.day_s == alone.scene.robot.day_s
    assert day.waiting == ()
    assert [len(some) for some in day.closed] == [1, 0]


def test_a_plot_that_is_closed_only_in_its_own_hours_gets_none_either(seasons):
    plots = [plot_of(one) for one in seasons]
    first = share_estate(plots, ONE, SIX).turns[0].plot
    spray(seasons[first], time(0, 10), 6.0)  # until 06:10
    day = share_estate(plots, ONE, SIX)
    assert hours_of(day) == {1 - first: 2.0}
    assert day.waiting == ()
    assert day.closed[first]


def test_a_plot_that_comes_later_since_some_of_it_is_closed_first_is_open_when_it_comes(seasons):
    plots = [plot_of(one) for one in seasons]
    first = share_estate(plots, ONE, SIX).turns[0].plot
    spray(seasons[first], time(0, 10), 6.0, plants=seasons[first].plot.grid.row >= 2)
    day = share_estate(plots, ONE, SIX)
    assert [turn.plot for turn in day.turns] == [1 - first, first]
    assert day.closed == ((), ())


def test_inspecting_a_few_open_rows_takes_no_longer_than_they_do(seasons):
    grid = seasons[0].plot.grid
    spray(seasons[0], time(4), 48.0, plants=grid.row >= 1)
    (turn,) = share_estate([plot_of(seasons[0])], ONE, SIX).turns
    open_s = np.count_nonzero(grid.row < 1) * turn.scene.robot.visit_s
    assert open_s < turn.scene.robot.day_s < 2 * open_s


def test_only_plants_that_are_open_call_for_hours(seasons):
    rows = seasons[0].plot.grid.row
    plots = [plot_of(one) for one in seasons]
    before = hours_of(share_estate(plots, ONE, SIX, 0.0))
    spray(seasons[0], time(4), 48.0, plants=rows >= 2)
    day = share_estate(plots, ONE, SIX, 0.0)
    assert before[0] == before[1]
    assert 0 < hours_of(day)[0] < before[0] / 2 < before[1] < hours_of(day)[1]
    (part,) = [turn for turn in day.turns if turn.plot == 0]
    assert set(rows[part.plan().route.plant]) <= {0, 1}
    assert len(day.closed[0]) == 1


def test_a_plot_for_which_there_is_no_time_waits_and_says_nothing_of_what_is_closed(seasons):
    spray(seasons[0], time(4), 48.0, plants=seasons[0].plot.grid.row >= 2)
    plots = [plot_of(one) for one in seasons]
    day = share_estate(plots, team_of(1, Robot(hours=0.3)), SIX)
    assert [turn.plot for turn in day.turns] == [1]
    assert day.waiting == (0,)
    assert day.closed == ((), ())
    assert share_estate(plots, (), SIX).waiting == (0, 1)


def test_a_plot_that_is_closed_all_day_does_not_wait_for_time(seasons):
    spray(seasons[0], time(4), 48.0)
    day = share_estate([plot_of(one) for one in seasons], team_of(1, Robot(hours=0.3)), SIX)
    assert day.waiting == ()
    assert day.closed[0]


def test_a_plot_of_no_season_has_nothing_closed(seasons):
    plot = plot_of(seasons[0])
    (turn,) = share_estate([EstatePlot(ON, plot.scene, plot.decides)], ONE, SIX).turns
    assert turn.closed == ()
    assert turn.scene.last_inspected.max() == NEVER
    assert turn.begins + timedelta(hours=2) == datetime.combine(ON, time(8))


def test_who_starts_later_comes_later_and_meets_what_is_closed_then(seasons):
    late = replace(ONE[0], starts_s=3600.0)
    (turn,) = share_estate([plot_of(seasons[0])], [late], SIX).turns
    assert turn.begins == datetime.combine(ON, time(7))
    spray(seasons[0], time(0, 30), 6.0)  # until 06:30
    (turn,) = share_estate([plot_of(seasons[0])], [late], SIX).turns
    assert turn.closed == ()
    assert share_estate([plot_of(seasons[0])], ONE, SIX).turns == ()


def test_days_since_a_plant_was_seen_leave_out_what_comes_later(seasons):
    season = seasons[0]
    assert days_since(season, ON) is None
    plants = np.arange(len(season.plot.grid) // 2 + 1)
    for day in (ON, ON + timedelta(days=4)):
        season.record(Inspections.of(plants, np.full(len(plants), CLEAN), day), str(day))
    assert [days_since(season, ON + timedelta(days=k)) for k in (-1, 0, 3, 6)] == [None, 0, 3, 2]


def test_a_day_that_has_only_begun_is_none_on_which_a_plot_was_seen(seasons):
    season = seasons[0]
    planned = season.plan(ON).route.plant
    half = len(planned) // 2
    for name, plants in (("begun", planned[: half - 1]), ("half", planned[half - 1 : half + 1])):
        assert days_since(season, ON) is None
        season.record(Inspections.of(plants, np.full(len(plants), CLEAN), ON), name)
    assert days_since(season, ON) == 0


def test_without_a_plan_a_plot_was_seen_once_half_of_the_hours_are_gone(seasons):
    season = seasons[0]
    plants = season.plan(ON, keep=False).route.plant  # those of all the hours
    for name, some in (("one", plants[:1]), ("begun", plants[1 : len(plants) // 3])):
        season.record(Inspections.of(some, np.full(len(some), CLEAN), ON), name)
        assert days_since(season, ON) is None
    season.record(Inspections.of(plants, np.full(len(plants), CLEAN), ON), "the rest")
    assert len(plants) < len(season.plot.grid) / 2
    assert days_since(season, ON) == 0
