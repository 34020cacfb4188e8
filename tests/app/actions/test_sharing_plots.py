"""Planning all plots from their page: one button, who works, and the files."""

import csv
import io
import json
import zipfile
from contextlib import nullcontext
from dataclasses import replace
from datetime import datetime, timedelta
from types import SimpleNamespace

import numpy as np
import pytest

from app.actions import sharing_plots
from app.state import estate, shared_plots
from app.state.shared_plots import EstateCrew
from app.words import texts
from fieldmon.monitoring.days.estate_routes import PlotLeftOut
from tests.app.driving import go, layer, map_of, press, texts_of


def test_all_plots_are_planned_by_one_button_and_shown_on_the_map(app):
    go(app, "plots")
    press(app, texts.PLAN_ALL)
    assert not app.exception
    assert "plots; expect" in texts_of(app)
    (table,) = (frame.value for frame in app.dataframe)
    worked = table[table[texts.PLAN_ALL_COLUMNS["who"]].notna()]
    assert len(worked) == len(layer(app, "route")["data"]) > 3
    assert sum("robot 1" in one["t"] for one in map_of(app)["labels"]) == len(worked)
    boxes = [box.key for box in app.number_input if box.key.startswith("crew_")]
    assert boxes[:4] == ["crew_robots", "crew_robot_hours", "crew_scouts", "crew_scout_hours"]
    app.number_input(key="crew_scouts").set_value(1).run()
    assert not app.exception
    (table,) = (frame.value for frame in app.dataframe)
    assert {"robot 1", "scout 1"} == set(table[texts.PLAN_ALL_COLUMNS["who"]].dropna())
    when = table[texts.PLAN_ALL_COLUMNS["when"]].dropna().tolist()
    assert [one[:5] for one in when] == sorted(one[:5] for one in when)
    assert texts.PLAN_ALL_WHEN.format(day="Mon 16 Nov", start="06:00") in texts_of(app)
    app.number_input(key="crew_scouts").set_value(0).run()
    app.number_input(key="crew_robots").set_value(0).run()
    assert not app.exception
    assert texts.PLAN_ALL_NOBODY in texts_of(app)
    assert "0 plants" not in texts_of(app)
    assert "Left out" not in texts_of(app)
    press(app, texts.PLAN_ALL_OFF)
    assert layer(app, "route") is None


def test_the_files_hold_each_route_and_a_table(session):  # noqa: ARG001 - read within it
    nursery = [one for one in estate.plots()[0] if one.name == "Nursery"]
    made = shared_plots.planned(nursery, EstateCrew(robot_hours=1), lambda *_: None)
    made = replace(made, left_out=(PlotLeftOut("Hill", "not due"),))
    (turn,) = made.turns
    with zipfile.ZipFile(
        io.BytesIO(sharing_plots.packed(made, [PlotLeftOut("gone", "torn")]))
    ) as archive:
        assert sorted(archive.namelist()) == ["01-Nursery.geojson", "plan.csv"]
        route = json.loads(archive.read("01-Nursery.geojson"))
        row, *out = csv.DictReader(io.StringIO(archive.read("plan.csv").decode("utf-8-sig")))
    assert [(one["plot"], one["left_out"]) for one in out] == [
        ("Hill", "not due"),
        ("gone", "torn"),
    ]
    line = np.array(route["features"][0]["geometry"]["coordinates"])
    assert np.allclose(line, turn.route.line_lonlat(), atol=1e-8)
    assert (row["plot"], row["who"], int(row["plants"])) == (
        "Nursery", "robot 1", len(turn.route)
    )  # fmt: skip


@pytest.fixture
def said(monkeypatch):
    said = []
    monkeypatch.setattr(sharing_plots, "st", SimpleNamespace(
        container=lambda **_: nullcontext(), caption=lambda _: None,
        expander=lambda words: nullcontext(said.append(words)),
        markdown=said.append, warning=said.append,
    ))  # fmt: skip
    return said


def test_plots_left_out_are_named_by_reason_and_very_many_in_a_fold(said):
    for n, words in ((2, "Left out (no time): \u2068Plot 0\u2069"), (96, "Left out: 96 plots")):
        left_out = [PlotLeftOut(f"Plot {k}", "no time") for k in range(n)]
        sharing_plots._say(
            shared_plots.SharedPlots((), (*left_out, PlotLeftOut("Hill", "not due")))
        )
        told = [one for one in said if one.startswith("Left out")]
        assert told[0].startswith(words.replace("96", "97"))
        assert told[-1] == "Left out (not due): \u2068Hill\u2069."
        assert len(told) == (2 if n == 2 else 3)
        said.clear()


def test_where_the_day_is_under_way_it_is_said_that_times_are_those_of_a_whole_one(
    session, monkeypatch  # noqa: ARG001 - looked at within it
):  # fmt: skip
    begins = datetime(2026, 11, 16, 6)
    turn = SimpleNamespace(begins=begins, route=SimpleNamespace(aisles=SimpleNamespace(grid=None)))
    for later, said in ((0, []), (200, [texts.PLAN_ALL_LATE.format(now="09:20")])):
        clock = SimpleNamespace(now=lambda later=later: begins + timedelta(minutes=later))
        monkeypatch.setattr(sharing_plots, "grid_clock", lambda _, clock=clock: clock)
        assert sharing_plots._times([turn])[1:] == said


def test_where_no_plot_is_due_none_is_planned_until_those_seen_are_asked_for(app, monkeypatch):
    every = estate.plots
    monkeypatch.setattr(
        estate, "plots", lambda: ([replace(one, days_since=1) for one in every()[0][:3]], [])
    )
    go(app, "plots")
    press(app, texts.PLAN_ALL)
    assert not app.exception
    assert texts.PLAN_ALL_NONE in texts_of(app)
    assert "Left out (inspected 1 day ago, not due): " in texts_of(app)
    assert layer(app, "route") is None
    app.checkbox(key="crew_also").check().run()
    assert not app.exception
    assert texts.PLAN_ALL_NONE not in texts_of(app)
    assert "plots; expect" in texts_of(app)


def test_who_has_no_plot_is_said_to_be_free(said):
    free = shared_plots.planned([], EstateCrew(robots=2), lambda *_: None).free
    sharing_plots._say(
        shared_plots.SharedPlots(
            (),
            (),
            (PlotLeftOut("Hill", "broken"),),
            free=free,
            n_members=2,
            several_kinds=True,
            teams=(("Gate", ("Ann", "Ben")),),
        )
    )
    assert texts.PLAN_ALL_KINDS in said
    named = texts.isolated("Ann"), texts.isolated("Ben")
    team = texts.PLAN_ALL_TEAM.format(plot=texts.isolated("Gate"), names=", ".join(named))
    assert team in said
    assert "Free today: robot 1, robot 2." in said
    many = tuple(f"robot {k}" for k in range(40))
    sharing_plots._say(shared_plots.SharedPlots((), free=many, n_members=40))
    assert said[-1] == "Free today: 40 of 40.", "no wall of names"
    assert "\u2068Hill\u2069: broken" in said
