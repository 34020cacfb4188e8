"""One map for all pages: named for those who cannot see it, drawn when the page is done."""

import re

import pytest

from app.show import field_map
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.plot.robot import Robot
from tests.app.chosen import DAY, a_plot, chosen, in_season, records_at
from tests.app.driving import go, layer, map_of, plants


def test_the_map_says_what_is_on_it(app):
    said = re.fullmatch(
        r"Map of plot Gate\. Plants: (\d+); stops on the route: (\d+); found: (\d+)\.",
        map_of(app)["alt"].replace("\u2068", "").replace("\u2069", ""),
    )
    n, stops, finds = map(int, said.groups())
    assert n == len(plants(app))
    assert stops == len(map_of(app)["play"]["stops"]) > 3
    assert finds == len(layer(app, "found")["data"])
    go(app, "plot")
    assert "stops on the route: 0;" in map_of(app)["alt"]


@pytest.mark.usefixtures("session")
def test_a_map_is_wanted_until_the_next_run_begins(monkeypatch):
    drawn = []
    monkeypatch.setattr(field_map.map_view, "show", lambda *what: drawn.append(what))
    field_map.draw()
    field_map.want("map", "answers")
    assert field_map.wanted() == "map"
    field_map.draw()
    field_map.clear()
    field_map.draw()
    assert drawn == [("map", "answers")]
    assert field_map.wanted() is None


def test_the_view_belongs_to_the_plot_and_holds_all_of_it(tmp_path):
    plot = a_plot()
    first = field_map.of_plot(chosen(plot, records_at(plot, [3], [1])))
    later = field_map.of_plot(chosen(plot, day="2026-11-18", robot=Robot(hours=3.0)))
    begun = Season.create(tmp_path / "s.gpkg", plot, Records.none(), MonitoringSettings(DAY))
    in_one = field_map.of_plot(in_season(begun))
    assert first["place"] == later["place"] == in_one["place"]
    assert first["bounds"] == later["bounds"]
    assert field_map.of_plot(chosen(a_plot(0.001)))["place"] != first["place"]
    west, south, east, north = first["bounds"]
    lonlat = plot.grid.lonlat()
    assert ((lonlat > [west, south]) & (lonlat < [east, north])).all()
