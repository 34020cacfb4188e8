"""A phone is told of the plot and the day what the season says."""

import csv
import json
from dataclasses import replace
from datetime import datetime, time, timedelta
from types import SimpleNamespace

import jsonschema
import numpy as np
import pytest

from app.api import description
from app.api.documents import day_document, plot_document, rest_document
from app.show import who_is_out
from app.show.maps.plant_layers import drawn_at
from app.show.next_stop import next_stop
from app.words import texts
from app.words.language import in_words
from app.words.units import UnitsInLanguage
from fieldmon.compute.wording import chance_figure
from fieldmon.infestation.inspections import Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.io.writers.csv import route_csv
from fieldmon.io.writers.day_file import HandoffPlan
from fieldmon.monitoring.days.day_ahead import WorkPart, route_ahead
from fieldmon.monitoring.days.scouts_out import scouts_out
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.phones.findings import take
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.treating.applications import Application
from fieldmon.planning.members import team_of
from fieldmon.planning.skips import left_out_in_words
from fieldmon.plot.local_clock import local_clock
from tests.app.chosen import a_plot, in_season
from tests.monitoring.phone import NOW, a_finding
from tests.monitoring.seasons import BEGINS, a_season


@pytest.fixture
def scout(served):
    return scouts.key_owner(served.season, served.key)


def test_plants_are_where_they_are_with_their_rows(served):
    name, made = plot_document(served.season)
    plot = json.loads(made)
    jsonschema.validate(plot, description.PLOT)
    grid, numbered = served.season.plot.grid, served.season.plant_numbers
    there = np.stack([plot["plants"]["lon"], plot["plants"]["lat"]], axis=1)
    assert np.abs(there - grid.lonlat()).max() < 1e-7
    assert plot["plants"]["number"] == numbered.number.tolist()
    start, row = plot["rows"]["start"], plot["rows"]["row"]
    assert np.repeat(row, np.diff(start)).tolist() == numbered.line.tolist()
    assert plot["rows"]["sign"] == [grid.line_signs[k] for k in row]
    assert plot["zone"] == "Asia/Jerusalem"
    _tells_where_the_aisles_are(served.season, plot)
    assert plot_document(served.season) == (name, made)
    assert "face" not in plot["plants"]


def test_of_plants_with_two_faces_it_is_told_which_each_is_and_where_the_app_draws_it(tmp_path):
    season = a_season(tmp_path / "s.gpkg", plot=a_plot(faces=2))
    plot, grid = json.loads(plot_document(season)[1]), season.plot.grid
    jsonschema.validate(plot, description.PLOT)
    told = plot["plants"]
    assert told["face"] == [1 if k < grid.twin[k] else 2 for k in range(len(grid))]
    drawn = np.stack([told["drawn_lon"], told["drawn_lat"]], axis=1)
    assert np.abs(drawn - drawn_at(grid)).max() < 1e-7
    assert len(np.unique(drawn, axis=0)) == len(grid)


def _tells_where_the_aisles_are(season, plot):
    """Hold each stop of a route to lie on the side of its row that is told."""
    route, grid = season.plan(BEGINS, keep=False).route, season.plot.grid
    row = grid.row[route.plant]
    first, last = grid.xy_m[grid.row_start[row]], grid.xy_m[grid.row_start[row + 1] - 1]
    to_aisle = route.line_m[route.line_stop] - grid.xy_m[route.plant]
    ahead = last - first
    left = np.sign(ahead[:, 0] * to_aisle[:, 1] - ahead[:, 1] * to_aisle[:, 0])
    assert left.tolist() == np.array(plot["rows"]["side"])[row].tolist()


def test_the_day_is_what_the_season_says(served, scout):
    season = served.season
    day = json.loads(day_document(season, scout, BEGINS))
    jsonschema.validate(day, description.DAY)
    route = route_ahead(season, BEGINS, WorkPart(name="Ann"))
    assert day["route"]["plants"] == route.plant.tolist()
    seconds = np.cumsum(np.array(day["route"]["walk_s"]) + day["robot"]["visit_s"])
    assert seconds == pytest.approx(route.leave_s, abs=0.1 * len(route))
    assert day["chance"] == pytest.approx(season.evening(BEGINS) * 1000, abs=0.5)
    assert [one["result"] for one in day["today"]].count("found") == 1
    assert {*day["found"]} >= {one["plant"] for one in day["today"] if one["result"] == "found"}
    assert (day["day"], day["live"], day["scout"]) == ("2026-04-06", False, "Ann")
    assert day["past"]
    line = np.array(day["route"]["line"])
    assert np.abs(line - route.line_lonlat()).max() < 1e-7


def test_the_app_shows_the_route_and_hours_that_the_phone_gets(served, scout):
    season, on = served.season, BEGINS + timedelta(days=1)
    for who, result in (("Ann", 0), ("", 1)):
        day = json.loads(day_document(season, scout, on))
        shown = in_season(season, on).plan()
        assert shown.route.plant.tolist() == day["route"]["plants"]
        assert shown.scene.seconds_left == day["seconds_left"]
        done = np.array(day["route"]["plants"][:3], np.int32)
        season.record(Inspections.of(done, np.array([0, 0, result]), on), "f", who)
    day = json.loads(day_document(season, scout, on))
    assert in_season(season, on).plan().route.plant.tolist() == day["route"]["plants"]


def test_the_route_says_what_it_was_planned_to_find_until_it_is_planned_anew(served, scout):
    season = served.season

    def told(document, *more):
        return json.loads(document(season, scout, BEGINS, *more))["route"]["detects"]

    assert told(day_document) == season.settings.robot.detects == 0.84
    sees_less = replace(season.settings.robot, detection=1 / 3)
    season.change(replace(season.settings, robot=sees_less), season.settings)
    assert told(day_document) == 0.84
    later = BEGINS + timedelta(days=1)
    rest = json.loads(rest_document(season, scout, later, None))
    assert rest["route"]["detects"] == 0.333333
    day = json.loads(day_document(season, scout, later))
    jsonschema.validate(day, description.DAY)
    assert day["route"]["detects"] == 0.333333


def test_who_has_a_part_is_sent_to_its_rows(served):
    scouts.withdraw_key(served.season, "Ann")
    key = scouts.let_in(served.season, "Ben", (1, 5))
    day = json.loads(day_document(served.season, scouts.key_owner(served.season, key), BEGINS))
    numbered = served.season.plant_numbers
    assert day["route"]["plants"]
    assert numbered.line[day["route"]["plants"]].max() <= 5
    assert day["rows"] == [1, 5]


def test_where_two_say_otherwise_everybody_is_told(served, scout):
    other = scouts.let_in(served.season, "Ben")
    take(served.season, served.key, [a_finding(40, 1, on=BEGINS)], NOW)
    take(served.season, other, [a_finding(40, 0, on=BEGINS)], NOW)
    day = json.loads(day_document(served.season, scout, BEGINS))
    said = {(one["plant"], one["who"], one["result"]) for one in day["contradicting"]}
    assert said == {(40, "Ann", "found"), (40, "Ben", "clean")}


def test_who_works_is_told_what_plans_leave_out_and_why(tmp_path, monkeypatch):
    monkeypatch.setenv("FIELDMON_SEASONS", str(tmp_path))
    season = a_season(tmp_path / "season.gpkg", belief=BeliefSettings(treated=False))
    scout = scouts.key_owner(season, scouts.let_in(season, "Ann"))
    assert json.loads(day_document(season, scout, BEGINS))["left_out"] == []
    results = np.array([2, 2, 2, 1, 1, 2], np.int8)
    notes = np.array([""] * 5 + ["Plant missing."], object)
    done = Inspections.of(np.arange(100, 106), results, np.datetime64(BEGINS), notes=notes)
    season.record(done, "a.csv", "Z")
    today = json.loads(day_document(season, scout, BEGINS))
    jsonschema.validate(today, description.DAY)
    assert [one["plant"] for one in today["today"] if one.get("gone")] == [105]
    day = json.loads(day_document(season, scout, BEGINS + timedelta(days=1)))
    jsonschema.validate(day, description.DAY)
    assert day["gone"] == [105]
    assert day["left_out"] == [
        {"why": "skipped", "plants": [[100, 102]], "own": 3},
        {"why": "flagged", "plants": [[103, 104]], "own": 2},
    ]
    planned = season.plan(BEGINS + timedelta(days=1), keep=False)
    said = " ".join(map(str, left_out_in_words(planned.scene, planned.route)))
    assert "3 plants that nobody" in said
    assert "2 plants found and only flagged" in said


def test_a_plant_that_was_treated_and_is_clean_since_is_told_as_clean(served, scout):
    season, found = served.season, [100, 101]
    season.record(Inspections.of(found, [1, 1], np.datetime64(BEGINS)), "a.csv", "Zoe")
    season.treat(BEGINS, 0.9)
    tuesday = BEGINS + timedelta(days=1)
    season.record(Inspections.of([100], [0], np.datetime64(tuesday)), "b.csv", "Zoe")
    day = json.loads(day_document(season, scout, tuesday))
    assert {*day["found"]}.isdisjoint({100})
    assert {*day["clean"]}.issuperset({100})
    assert {*day["found"]}.issuperset({101})


def test_finds_of_records_alone_are_told_apart_from_those_of_the_season(served, scout):
    season = served.season
    before = np.flatnonzero(season.history.recorded == 1).tolist()
    day = json.loads(day_document(season, scout, BEGINS))
    own = np.flatnonzero(season.history.states(0) == 1).tolist()
    assert day["found"] == own
    assert day["recorded"] == sorted({*before} - {*own}) != []


def test_a_chance_is_one_figure_on_a_phone_in_the_app_and_in_files(tmp_path, scout):
    """That of the map: of a pest that hides at first less can be seen, and days go by that."""
    season = a_season(tmp_path / "mites.gpkg", pest=shipped_pest("spider-mite"))
    on = BEGINS + timedelta(days=3)
    plan = season.plan(on)
    route, (first, *_) = plan.route, plan.route.plant.tolist()
    believed = season.evening(on)[route.plant]
    assert (route.chance < believed).any()
    told = json.loads(day_document(season, scout, on))
    assert np.array(told["chance"])[route.plant] == pytest.approx(1000 * believed, abs=0.5)
    made = route_csv(HandoffPlan(route, route.notes)).decode("utf-8-sig")
    rows = csv.DictReader(made.splitlines())
    assert [float(row["chance"]) for row in rows] == pytest.approx(believed, abs=1e-6)
    said = in_words(chance_figure(float(season.evening(on)[first]), 1))
    assert said in next_stop(plan, 0, UnitsInLanguage()).chance
    with season.store.reading() as db:
        kept = db.execute("SELECT chance FROM stops WHERE route = 1 ORDER BY stop").fetchall()
    assert [one for (one,) in kept] == pytest.approx(believed)


def test_the_rest_is_planned_anew_within_what_is_left(served, scout):
    rest = json.loads(rest_document(served.season, scout, BEGINS, 1200))["route"]
    assert 0 < rest["end_s"] <= 1200
    whole = json.loads(rest_document(served.season, scout, BEGINS + timedelta(days=1), None))
    assert len(whole["route"]["plants"]) > len(rest["plants"])


def test_the_board_warns_until_a_phone_has_the_plan_given_last(tmp_path):
    season = a_season(tmp_path / "out.gpkg")
    choices = SimpleNamespace(open_season=season, plot=season.plot, on=BEGINS, is_today=True,
                              clock=local_clock(season.plot.field),
                              units=UnitsInLanguage())  # fmt: skip

    def warned():
        return [one.name for one in who_is_out.lines(choices) if texts.OUT_OLDER in one.cautions]

    def loaded(scout, has=None):
        return json.loads(day_document(season, scout, BEGINS, has))["plan"]

    ann = scouts.key_owner(season, scouts.let_in(season, "Ann"))
    alone = loaded(ann)
    assert warned() == []
    dan = scouts.key_owner(season, scouts.let_in(season, "Dan"))
    loaded(dan)
    assert warned() == ["Ann"]
    assert loaded(ann, alone) != alone, "it sees what others found, and goes on by what it has"
    assert warned() == ["Ann"]
    loaded(ann)
    assert warned() == []
    planned = json.loads(rest_document(season, ann, BEGINS, 900.0))
    jsonschema.validate(planned["route"], description.ROUTE)
    assert warned() == ["Dan"], "the rest of both was planned anew"
    loaded(dan)
    assert warned() == []


def test_rows_that_nobody_may_enter_are_told_with_the_time_until_which(served, scout):
    season, line = served.season, served.season.plant_numbers.line
    waits = Application("Acarol", reentry_hours=48.0, ended=time(9, 30))
    season.treat(BEGINS, 0.5, plants=np.isin(line, [3, 4, 7]), application=waits)
    day = json.loads(day_document(season, scout, BEGINS + timedelta(days=1)))
    jsonschema.validate(day, description.DAY)
    until = "2026-04-08T09:30"
    told = [(one["rows"], one["until"]) for one in day["closed"]]
    assert told == [([3, 4], until), ([7, 7], until)]
    closed = [p for one in day["closed"] for a, b in one["plants"] for p in range(a, b + 1)]
    assert sorted(closed) == np.flatnonzero(np.isin(line, [3, 4, 7])).tolist()
    assert sum(one["own"] for one in day["closed"]) == len(closed)
    assert not {*closed} & {*day["route"]["plants"]}
    assert json.loads(day_document(season, scout, BEGINS + timedelta(days=3)))["closed"] == []


def test_who_is_of_the_team_has_its_route_though_an_older_file_has_rows_for_the_code(tmp_path):
    season = a_season(tmp_path / "team.gpkg")
    ann = scouts.key_owner(season, scouts.let_in(season, "robot-1", (1, 4)))
    before = season.settings
    season.change(replace(before, team=team_of(2, before.robot)), before)
    day = json.loads(day_document(season, ann, BEGINS))
    assert day["rows"] is None
    assert day["route"]["plants"] == season.kept_route(BEGINS, "robot-1").tolist()
    rest = json.loads(rest_document(season, ann, BEGINS, 1200.0))
    assert rest["route"]["plants"] == season.kept_route(BEGINS, "robot-1").tolist()
    (line, _) = scouts_out(season, BEGINS)
    assert (line.rows, line.ahead, line.plan) == (None, len(rest["route"]["plants"]), rest["plan"])


def test_who_is_taken_out_of_the_team_has_neither_route_nor_hours(tmp_path):
    season = a_season(tmp_path / "team.gpkg")
    before = season.settings
    season.change(replace(before, team=team_of(2, before.robot)), before)
    left = scouts.key_owner(season, scouts.let_in(season, "robot-2"))
    told = json.loads(day_document(season, left, BEGINS))
    assert told["has_route"]
    assert told["seconds_left"] == pytest.approx(before.robot.day_s)
    before = season.settings
    season.change(replace(before, team=before.team[:1]), before)
    told = json.loads(day_document(season, left, BEGINS))
    jsonschema.validate(told, description.DAY)
    assert (told["has_route"], told["seconds_left"], told["route"]["plants"]) == (False, 0.0, [])


def test_the_hours_of_today_run_by_the_clock_from_when_work_began(served, scout, monkeypatch):
    season, on = served.season, BEGINS + timedelta(days=1)  # a day of which nothing is recorded
    starts = local_clock(season.plot.field).moment(on, season.settings.starts)

    def loaded_after(hours):
        now = starts + timedelta(hours=hours)
        for module in ("fieldmon.plot.local_clock", "app.api.documents"):
            monkeypatch.setattr(f"{module}.utc_now", lambda: now)
        day = json.loads(day_document(season, scout, on))
        jsonschema.validate(day, description.DAY)
        assert datetime.fromisoformat(day["begins"]) == starts
        return day

    hours = season.settings.robot.hours
    first = loaded_after(0.5)
    assert (first["live"], first["begun"], first["seconds_left"]) == (True, False, 3600 * hours)
    plants = np.array(first["route"]["plants"][:1], np.int32)
    second = np.array([season.work(on).begun_s + 120])
    season.record(Inspections.of(plants, np.zeros(1, np.int8), on, second=second), "f", "Ann")
    late = loaded_after(hours - 0.3)
    assert (late["begun"], late["seconds_left"]) == (True, pytest.approx(0.3 * 3600))
    route, kept = late["route"], first["route"]["plants"][1:]
    assert 0 < len(route["plants"]) < len(kept)
    assert route["plants"] == kept[: len(route["plants"])], "the plan is the one that was given"
    assert late["plan"] == first["plan"]
    rest = json.loads(rest_document(season, scout, on, None))
    assert max(rest["route"]["end_s"], route["end_s"]) <= late["seconds_left"] + 0.1
    assert loaded_after(hours + 1.0)["route"]["plants"] == []
    after = loaded_after(24.0)
    assert (after["past"], after["begun"]) == (True, False)
    assert after["seconds_left"] == pytest.approx(3600 * hours - 120)


def test_the_evening_after_a_shift_past_midnight_has_its_own_begin_and_hours(
    served, scout, monkeypatch
):
    season = served.season
    season.change(replace(season.settings, starts=time(23, 30)), season.settings)
    route, next_day = season.plan(BEGINS).route, BEGINS + timedelta(days=1)
    plants, second = route.plant[:2], np.array([85_000.0, 1800.0])
    season.record(Inspections.of(plants, np.zeros(2, np.int8),
                                 np.array([BEGINS, next_day], "datetime64[D]"), second=second,
                                 who=np.full(2, scout.name, object)), "f", scout.name)  # fmt: skip
    starts = local_clock(season.plot.field).moment(next_day, season.settings.starts)
    now = starts - timedelta(hours=2)
    for module in ("fieldmon.plot.local_clock", "app.api.documents"):
        monkeypatch.setattr(f"{module}.utc_now", lambda: now)
    day = json.loads(day_document(season, scout, None))
    assert (day["day"], day["live"], day["begun"]) == (str(next_day), True, False)
    assert datetime.fromisoformat(day["begins"]) == starts
    assert day["seconds_left"] == season.settings.robot.day_s


def test_a_phone_of_the_team_is_told_which_plants_are_in_aisles_of_the_others(tmp_path):
    season = a_season(tmp_path / "s.gpkg", team=team_of(2))
    one = season.plan_each(BEGINS)[0].route.plant
    key = scouts.let_in(season, "robot-2")
    scout = scouts.key_owner(season, key)
    for made in (day_document(season, scout, BEGINS), rest_document(season, scout, BEGINS, None)):
        runs = json.loads(made)["others"]
        theirs = {plant for low, high in runs for plant in range(low, high + 1)}
        assert not theirs & {*json.loads(made)["route"]["plants"]}
        assert theirs & {*one.tolist()}
