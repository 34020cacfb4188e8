"""Today: the sentence, the chance map, the route and the figures of the sample estate."""

import re
from dataclasses import replace

from fieldmon.planning.members import team_of
from tests.app.driving import headline, layer, map_of, metric, plants, texts_of


def test_the_first_screen_shows_the_sample_estate_with_a_route(app):
    assert not app.exception
    n = len(plants(app))
    assert n > 3000
    assert len(layer(app, "route")["data"][0]["path"]) > 100
    assert "hot" in {one["id"] for one in map_of(app)["layers"]}
    assert metric(app, "Plants to inspect").endswith(f"/ {n:,}")
    assert app.get("download_button")
    bounds = [said.value for said in app.caption if "of these hours" in said.value]
    assert len(bounds) == 1
    assert "expected" not in bounds[0], "what the sentence and the figure say is not said again"


def test_the_first_sentence_says_what_to_do_in_the_route_s_own_figures(app):
    said = re.fullmatch(
        r"Inspect ([\d,]+) plants in rows (\d+)–(\d+) on Mon 16 Nov, ([\d.]+) h: "
        r"about ([\d.]+) finds expected\.",
        headline(app),
    )
    stops = len(map_of(app)["play"]["stops"])
    assert said[1].replace(",", "") == str(stops)
    assert metric(app, "Plants to inspect").startswith(f"{stops} /")
    (table,) = (frame.value for frame in app.dataframe if "row" in frame.value)
    assert [int(said[2]), int(said[3])] == [table["row"].min(), table["row"].max()]
    assert metric(app, "Hours") == f"{said[4]} h"
    assert said[5] == metric(app, "Expected finds")


def test_layers_can_be_switched_and_records_are_there_but_off_at_first(app):
    off = {one["key"]: one["off"] for one in map_of(app)["switches"]}
    assert set(off) == {"route", "hot", "records", "numbers", "rows", "plan"}
    assert [name for name in off if off[name]] == ["records"]
    assert len(layer(app, "records")["data"]) > 100


def test_a_first_day_of_a_season_says_so(season_app):
    assert "first day of the season" in texts_of(season_app)
    assert [one["key"] for one in map_of(season_app)["shades"]] == ["chance", "state", "age"]


def test_of_a_team_each_has_a_day_of_its_own(season_app, season):
    before = season().settings
    season().change(replace(before, team=team_of(2, before.robot.with_hours(1))), before)
    both = []
    for who in ("robot-1", "robot-2"):
        season_app.run()
        season_app.segmented_control(key="whose_day").set_value(who).run()
        assert not season_app.exception
        (table,) = (frame.value for frame in season_app.dataframe if "row" in frame.value)
        both.append(set(zip(table["row"], table["plant"], strict=True)))
    assert both[0]
    assert not both[0] & both[1]
