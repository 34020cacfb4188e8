"""What a plan leaves on the disk."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.cli.outputs import (
    check_outputs,
    day_in_words,
    refuse_what_is_read,
    write_chance_map,
    write_routes,
)
from fieldmon.compute.wording import estimate
from fieldmon.errors import FieldmonError, SettingError
from fieldmon.infestation.records import Records
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.planning.plan import PlanSettings, first_day
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from tests.cli.estate import ZIP

AREA = Frame(5.0, 45.0).geometry_lonlat(MultiPolygon([shapely.box(-30, -25, 30, 25)]))
PLOT = Plot.of(Field("square", AREA))
DAY = np.datetime64("2026-11-02")
NOTES = RouteNotes("square", "adaptive", DAY.astype("datetime64[s]").item())


@pytest.fixture(scope="module")
def today():
    return first_day(PLOT, Records.none(), DAY, PlanSettings(Robot(hours=0.5)))


def test_a_route_is_written_as_geojson_unless_said_otherwise(today, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    route = replace(today.route, notes=NOTES)
    write_routes(route, None)
    _, *stops = json.loads((tmp_path / "route.geojson").read_text(encoding="utf-8"))["features"]
    assert len(stops) == len(today.route)
    assert capsys.readouterr().out == "Route written to route.geojson\n"
    write_routes(route, [tmp_path / "a.csv", tmp_path / "b.gpx"])
    assert {path.name for path in tmp_path.iterdir()} == {"route.geojson", "a.csv", "b.gpx"}
    assert len(capsys.readouterr().out.splitlines()) == 2


def test_a_chance_map_is_written_where_it_is_asked_for(today, tmp_path, capsys):
    write_chance_map(None, PLOT, today.chance)
    assert capsys.readouterr().out == ""
    to = tmp_path / "chance.tif"
    write_chance_map(to, PLOT, today.chance)
    assert to.stat().st_size > 500
    assert capsys.readouterr().out.startswith(f"Chance map written to {to} (")


def test_a_day_in_words_says_its_stops_its_hours_and_what_to_expect(today):
    words = day_in_words(today.route)
    assert words.startswith(f"{len(today.route)} of {len(PLOT.grid)} plants in 0.5 h, ")
    seen = estimate(today.route.expected_visible)
    assert f"about {seen} of them infested, about" in words
    assert day_in_words(today.route, today.route.expected_visible) == words
    more = day_in_words(today.route, 99.0)
    assert f"about 99 of them infested, about {seen} so that it can be seen, about" in more


def test_a_day_in_words_says_where_its_way_leaves_the_plot(today):
    far_m = np.array([[0.0, 500.0]])
    away = replace(today.route, line_m=np.concatenate([today.route.line_m[:-1], far_m]))
    (said,) = away.ways_said
    assert re.match(r"\d+ m of the way lie outside the plot's boundary, up to \d+ m", said)
    assert day_in_words(away).splitlines()[-1] == said
    assert "outside" not in day_in_words(today.route)


@pytest.mark.parametrize(
    ("outputs", "chance_map", "says"),
    [
        (["a.gpx", "none/b.gpx"], None, "folder .*none must exist"),
        (["a.gpx", "b.xyz"], None, "must end in one of"),
        (["a.gpx", "folder.csv"], None, "must be a file to write to, but it is a folder"),
        (["a.gpx"], "chance.png", "must end in .tif, but it is 'chance.png'"),
        (["a.gpx"], "none/chance.tif", "folder .*none must exist"),
    ],
)
def test_files_that_could_not_be_written_are_refused_before(tmp_path, outputs, chance_map, says):
    (tmp_path / "folder.csv").mkdir()
    paths = [tmp_path / name for name in outputs]
    check_outputs(paths[:1], tmp_path / "chance.tif")
    with pytest.raises(FieldmonError, match=says):
        check_outputs(paths, chance_map and tmp_path / chance_map)


@pytest.mark.parametrize("what", ["plot", "season", "team"])
def test_a_plan_writes_none_of_its_files_where_one_cannot_be(run, season, what):
    words = {"plot": [ZIP, "--feature", "Nursery"], "season": [season]}
    words["team"] = [*words["plot"], "--robots", "2"]
    before = season.read_bytes()
    code, out, err, made = run("plan", *words[what], "-o", "a.gpx", "-o", "none/b.gpx")
    assert (code, out, made) == (2, "", set())
    assert "folder none must exist" in err
    assert season.read_bytes() == before


def test_no_file_is_written_over_that_the_same_command_reads(tmp_path):
    read, other = tmp_path / "plots.geojson", tmp_path / "route.geojson"
    read.write_text("{}")
    link = tmp_path / "link.geojson"
    link.symlink_to(read)
    for told in ({"output": [other, link]}, {"chance_map": read}, {"output": read}):
        with pytest.raises(SettingError, match="must be another file than those that are read"):
            refuse_what_is_read({"plot": read, "hours": 4.0} | told)
    refuse_what_is_read({"plot": read, "output": [other], "chance_map": None})
    other.write_text("{}")
    refuse_what_is_read({"plot": read, "output": [other], "also": [read]})


@pytest.mark.parametrize("command", [["plan"], ["decide", "--threshold", "5%"]])
def test_a_season_is_planned_and_decided_into_any_file_but_a_season(run, season, tmp_path, command):
    other = tmp_path / "other.gpkg"
    other.write_bytes(season.read_bytes())
    before = season.read_bytes()
    code, _, err, made = run(command[0], season, *command[1:], "-o", season)
    assert (code, made) == (2, set())
    assert "must be another file than those that are read" in err
    code, _, err, made = run(
        command[0], season, *command[1:], "-o", tmp_path / "a.kml", "-o", other
    )
    assert (code, made) == (2, set())
    assert "holds a season" in err
    assert season.read_bytes() == other.read_bytes() == before
