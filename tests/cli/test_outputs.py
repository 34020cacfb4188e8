"""What a plan leaves on the disk."""

import json
from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.cli.outputs import day_in_words, write_chance_map, write_routes
from fieldmon.infestation.observations import Observations
from fieldmon.io.writers.geojson import RouteNotes
from fieldmon.planning.plan import PlanSettings, first_day
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot

AREA = Frame(5.0, 45.0).geometry_lonlat(MultiPolygon([shapely.box(-30, -25, 30, 25)]))
PLOT = Plot.of(Field("square", AREA))
DAY = np.datetime64("2026-11-02")
NOTES = RouteNotes("square", "adaptive", DAY.astype("datetime64[s]").item())


@pytest.fixture(scope="module")
def today():
    return first_day(PLOT, Observations.none(), DAY, PlanSettings(Robot(hours=0.5)))


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
    assert f"about {today.route.expected_finds:.1f} of them infested" in words
