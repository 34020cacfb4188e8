"""An estate's day: what comes of it, and its files, with names in any script and a table."""

import csv
import io
from dataclasses import replace
from datetime import datetime, time
from types import SimpleNamespace

import numpy as np

from fieldmon.monitoring.days.estate_day import EstatePlot, EstateTurn, share_estate
from fieldmon.monitoring.days.estate_routes import (
    EstateRoute,
    NamedPlot,
    PlotLeftOut,
    plan_table,
    stems,
    too_far,
    walked,
)
from fieldmon.monitoring.treating.applications import Application
from fieldmon.planning.members import TeamMember
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from tests.monitoring.seasons import BEGINS, a_plot, a_season

SIX = datetime(2026, 4, 6, 6)


def a_route(plot):
    return EstateRoute(plot, "Ann", SIX, SevenStops(), "adaptive")


class SevenStops:
    end_s, expected_finds, aisles, plant = 3599.7, 1.234, a_plot().aisles, np.arange(7)

    def __len__(self):
        return 7


def test_plots_of_one_name_have_files_of_their_own():
    assert [*stems([a_route("a/b"), a_route("a/b"), a_route("מטע")])] == [
        "01-a_b", "02-a_b", "03-מטע",
    ]  # fmt: skip


def test_both_faces_of_a_plant_are_one_plant_of_a_round():
    grid = a_plot(faces=2).grid
    route = SimpleNamespace(plant=np.arange(len(grid)), aisles=SimpleNamespace(grid=grid))
    assert 2 * replace(a_route("a"), route=route).plants == len(grid)


def test_a_way_to_the_next_plot_that_nobody_drives_in_its_minutes_is_said():
    """Of 30 km a quarter of an hour asks for 120 km/h; of one who has another plot for nothing."""
    frames = {"gate": Frame(35.0, 30.0), "far": Frame(35.0, 30.27), "near": Frame(35.0, 30.001)}
    routes = [
        replace(a_route(plot), who=who, begins=SIX.replace(hour=hour), route=SimpleNamespace(
            aisles=SimpleNamespace(grid=SimpleNamespace(frame=frames[plot]), gate_m=np.zeros(2)),
        ))
        for plot, who, hour in (("far", "Ann", 8), ("gate", "Ann", 6), ("near", "Ben", 6),
                                ("gate", "Ben", 7), ("far", "Cy", 6))
    ]  # fmt: skip
    (said,) = too_far(routes, 900.0)
    assert said.startswith("From gate to far it is 29.93 km in a straight line, more than 15 minut")
    assert too_far(routes, 1800.0) == []


def test_the_table_tells_each_route_once_and_all_its_files():
    data = plan_table({"01-a.geojson 01-a.gpx": a_route("a, b"), "02-מטע.kml": a_route("מטע")})
    first, second = csv.DictReader(io.StringIO(data.decode("utf-8-sig")))
    assert (first["plot"], first["from"], first["to"]) == (
        "a, b", "2026-04-06T06:00:00", "2026-04-06T07:00:00",
    )  # fmt: skip
    assert (second["plants"], second["finds_expected"]) == ("7", "1.23")


def test_the_table_tells_where_nobody_goes_and_who_goes_nowhere():
    data = plan_table(
        {"01-a.gpx": a_route("a")},
        [PlotLeftOut("b", "no time"), PlotLeftOut("c", "closed", ("Closed until 06:30.",))],
        ["Bo"],
    )
    rows = [*csv.DictReader(io.StringIO(data.decode("utf-8-sig")))]
    assert [(one["plot"], one["who"], one["file"]) for one in rows] == [
        ("a", "Ann", "01-a.gpx"), ("b", "", ""), ("c", "", ""), ("", "Bo", ""),
    ]  # fmt: skip
    assert [one["closed"] for one in rows] == ["", "", "Closed until 06:30.", ""]
    assert [one["left_out"] for one in rows] == ["", "no time", "closed", ""]


def test_no_name_in_the_table_is_run_by_a_spreadsheet():
    named = replace(a_route("=1+1"), who="+cmd", closed=["@a is closed."])
    data = plan_table({"01-a.gpx": named}, [PlotLeftOut("-b", "@w", ("=c is closed.",))], ["\t=d"])
    rows = [*csv.DictReader(io.StringIO(data.decode("utf-8-sig")))]
    assert [(one["plot"], one["who"], one["closed"]) for one in rows] == [
        ("'=1+1", "'+cmd", "'@a is closed."), ("'-b", "", "'=c is closed."), ("", "'\t=d", ""),
    ]  # fmt: skip


def test_a_turn_over_a_change_of_clocks_ends_when_the_clock_says():
    late = replace(a_route("a"), begins=datetime(2027, 3, 26, 1, 30))
    (row,) = csv.DictReader(io.StringIO(plan_table({"a.gpx": late}).decode("utf-8-sig")))
    assert (row["from"], row["to"]) == ("2027-03-26T01:30:00", "2027-03-26T03:30:00")


def test_what_comes_of_a_shared_day_is_who_is_where_what_is_closed_and_who_is_free(tmp_path):
    robot = Robot(hours=2, detection=0.7)
    seasons = [a_season(tmp_path / f"{name}.gpkg", robot=robot) for name in "abc"]
    until_six_on_wednesday = Application("Soap", reentry_hours=48.0, began=time(5), ended=time(6))
    seasons[0].treat(BEGINS, 0.1, application=until_six_on_wednesday)
    plots = [NamedPlot(one.path.stem, "adaptive", EstatePlot.of(one, BEGINS)) for one in seasons]
    members = tuple(
        TeamMember(name, Robot(hours=1, detection=0.7)) for name in ("Ann", "Ben", "Cy")
    )
    shared = share_estate([one.known for one in plots], members, time(6))
    made = walked(shared, plots, members, said=str.upper)
    assert [(turn.plot, route.plot) for turn, route in made.turns] == [
        (turn.plot, "abc"[turn.plot]) for turn in shared.turns
    ]
    for turn, route in made.turns:
        assert route.who == members[turn.who].name
        assert route.route.plant.tolist() == turn.plan().route.plant.tolist()
    busy = {route.who for _, route in made.turns}
    assert set(made.free) == {"Ann", "Ben", "Cy"} - busy
    assert made.closed[0][0].startswith("CLOSED UNTIL 06:00 ON 2026-04-08 AFTER SOAP")
    assert made.closed[1:] == ((), ())
    left_out = PlotLeftOut("a", "CLOSED TO PEOPLE", made.closed[0])
    assert made.left_out == (left_out,), "it is closed, and has not too little time"


def test_a_plot_whose_hours_are_too_short_for_a_stop_waits(tmp_path):
    plot = NamedPlot("a", "adaptive", EstatePlot.of(a_season(tmp_path / "a.gpkg"), BEGINS))
    members = (TeamMember("Ann", Robot(hours=1)),)
    shared = share_estate([plot.known], members, time(6))

    def plan(_: EstateTurn):
        return SimpleNamespace(route=())

    made = walked(shared, [plot], members, plan)
    assert (made.turns, made.left_out, made.free) == ((), (PlotLeftOut("a", "no time"),), ("Ann",))
    seen = replace(plot.known.scene, last_inspected=np.full(len(plot.known.scene.chance), 0))
    plot = replace(plot, known=replace(plot.known, scene=seen))
    made = walked(share_estate([plot.known], members, time(6)), [plot], members, plan)
    assert made.left_out == (PlotLeftOut("a", "all of it was inspected today"),)
