"""One plan of all plots that are due: routes fit the hours, and nobody is in two places."""

import shutil
from dataclasses import replace
from datetime import UTC, date, datetime, time, timedelta
from itertools import pairwise

import numpy as np
import pytest
import shapely

from app.state import estate, shared_plots
from app.state.estate import PlotState
from app.state.shared_plots import EstateCrew
from fieldmon.monitoring.days.estate_day import EstatePlot, not_begun, share_estate
from fieldmon.monitoring.treating.applications import Application
from fieldmon.planning.plan import plan_in
from fieldmon.plot import local_clock as clocks
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.robot import Robot, scout
from fieldmon.samplers import sampler

OUTLINE = shapely.MultiPolygon([shapely.box(0, 0, 1, 1)])


def plot(name, days):
    return PlotState(name, name, OUTLINE, days_since=days, expected=1.0)


def test_due_is_what_was_not_seen_for_three_days_or_ever():
    plots = [plot("a", 0), plot("b", 2), plot("c", 3), plot("d", None)]
    due = shared_plots.due(plots)
    assert [one.name for one in due] == ["c", "d"]
    assert shared_plots.due(plots[:2]) == []
    left_out = [(one.plot, one.why) for one in shared_plots.not_due(plots, due)]
    assert left_out == [
        ("a", "inspected today, not due"), ("b", "inspected 2 days ago, not due"),
    ]  # fmt: skip
    waits = replace(plot("e", None), waits=not_begun(date(2026, 12, 1), date(2026, 11, 30)))
    assert shared_plots.due([waits]) == shared_plots.due([waits], every=True) == []
    wanted = shared_plots.due([*plots, waits], every=True)
    (left,) = shared_plots.not_due([*plots, waits], wanted)
    assert (left.plot, left.why) == ("e", "begins on Tue 1 Dec")


def test_a_crew_has_names_and_hours():
    members = EstateCrew(robots=1, robot_hours=5, scouts=2, scout_hours=3).members()
    assert [one.name for one in members] == ["robot 1", "scout 1", "scout 2"]
    assert [one.robot.hours for one in members] == [5, 3, 3]
    assert members[1].robot.speed_m_s != members[0].robot.speed_m_s
    slow = Robot(look_s=120.0, hours=1.0)
    members = EstateCrew(robots=1, robot_hours=5, scouts=1).members(slow)
    assert members[0].robot == replace(slow, hours=5)
    assert members[1] == EstateCrew(scouts=1).members()[1]


@pytest.mark.usefixtures("session")
def test_the_sample_s_plots_are_shared_by_two():
    plots, _ = estate.plots()
    some = [one for one in plots if one.name in {"Gate", "Nursery", "Bend"}]
    told = []
    made = shared_plots.planned(some, EstateCrew(robots=1, robot_hours=3, scouts=1, scout_hours=2),
                                lambda k, n: told.append((k, n)))  # fmt: skip
    assert made.problems == ()
    assert {one.plot for one in made.turns} | {one.plot for one in made.left_out} == {
        one.name for one in some
    }
    assert {one.who for one in made.turns} == {"robot 1", "scout 1"}
    for who in ("robot 1", "scout 1"):
        own = sorted((one for one in made.turns if one.who == who), key=lambda one: one.begins)
        for first, then in pairwise(own):
            assert then.begins >= first.ends + timedelta(minutes=15) - timedelta(seconds=1)
        hours = {"robot 1": 3, "scout 1": 2}[who]
        assert own[-1].ends - own[0].begins <= timedelta(hours=hours)
    assert [k for k, _ in told] == sorted(k for k, _ in told)
    assert all(k < n for k, n in told)


@pytest.mark.usefixtures("session")
def test_a_season_is_planned_by_what_it_knows_and_one_that_is_gone_is_said(
    begun_file, seasons_folder, season, monkeypatch
):
    shutil.copy(begun_file, seasons_folder)
    project, settings = season(), season().settings
    every_sixth = replace(settings, sampler="bouncy", sampler_settings={"every": 6})
    project.change(every_sixth, settings)
    (own,), _ = estate.plots()
    made = shared_plots.planned(
        [own, plot("gone", None)], EstateCrew(robot_hours=1), lambda *_: None
    )
    (turn,) = made.turns
    assert turn.state is own
    assert turn.sampler == "bouncy"
    on = turn.begins.date()
    assert not made.several_kinds
    members = EstateCrew(robot_hours=1).members(settings.robot)
    (alone,) = share_estate([EstatePlot.of(project, on)], members, time(6)).turns
    by_itself = plan_in(alone.scene, sampler("bouncy", every=6)).route.plant
    assert turn.route.plant.tolist() == by_itself.tolist()
    assert len(by_itself) > 10
    assert len(made.problems) == 1
    assert made.problems[0].plot == "gone"
    # on the day before its first it has no part in the round
    before = datetime.combine(settings.begins, time(), UTC) - timedelta(hours=12)
    monkeypatch.setattr(clocks, "utc_now", lambda: before)
    (own,), _ = estate.plots()
    assert shared_plots.due([own]) == []
    assert [one.why for one in shared_plots.not_due([own], [])] == ["begins on Mon 16 Nov"]


@pytest.mark.usefixtures("session")
def test_where_all_seasons_are_scouts_a_scout_of_their_hours_is_usual(
    begun_file, seasons_folder, season
):
    plots, _ = estate.plots()
    assert shared_plots.usual_crew(plots) == EstateCrew(), "plots of the sample say nobody"
    shutil.copy(begun_file, seasons_folder)
    for robot, usual in (
        (Robot(hours=5), EstateCrew(robot_hours=5)),
        (scout(), EstateCrew(robots=0, scouts=1, scout_hours=4)),
    ):
        settings = season().settings
        season().change(replace(settings, robot=robot), settings)
        plots, _ = estate.plots()
        assert shared_plots.usual_crew([*plots, plot("gone", None)]) == usual


@pytest.mark.usefixtures("session")
def test_rows_are_closed_by_the_hours_at_which_somebody_is_there(
    begun_file, seasons_folder, season
):
    shutil.copy(begun_file, seasons_folder)
    project, settings = season(), season().settings
    project.change(replace(settings, starts=time(7)), settings)
    on = max(local_clock(project.plot.field).today(), settings.begins)
    line = project.plant_numbers.line

    def planned(rows):
        until_half_past_six = Application(
            "Soap", reentry_hours=6.0, began=time(0, 10), ended=time(0, 30)
        )
        plants = np.isin(line, rows)
        project.treat(on, 0.1, plants=plants, application=until_half_past_six)
        (own,), _ = estate.plots()
        return shared_plots.planned([own], EstateCrew(robot_hours=1), lambda *_: None)

    made = planned(np.unique(line)[::2])
    (turn,) = made.turns
    assert turn.begins.time() == time(6)
    assert not (line[turn.route.plant] % 2).any()
    assert turn.closed
    (said,) = made.closed
    assert "Closed until 06:30" in said
    made = planned(np.unique(line))
    assert (made.turns, [one.why for one in made.left_out]) == ((), ["closed to people"])
    assert "Closed until 06:30" in made.closed[0]


@pytest.mark.usefixtures("session")
def test_two_seasons_of_one_plot_are_said_where_one_of_them_is_asked_for(
    begun_file, seasons_folder
):
    for name in "ab":
        shutil.copy(begun_file, seasons_folder / f"{name}.gpkg")
    (said,) = shared_plots.of_one_plot(["a"])
    assert said.startswith(
        "\u2068a\u2069 and \u2068b\u2069 are 2 seasons of one plot: each counts."
    )
    assert shared_plots.of_one_plot(["c"]) == shared_plots.of_one_plot([]) == ()
