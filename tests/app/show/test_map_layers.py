"""What a day's map shows: made once for what it shows, and anew once something is recorded."""

from datetime import timedelta

import numpy as np
import pytest
from shapely import MultiPolygon, box

from app.show import map_layers
from app.show.maps import colours
from app.state import chosen_day
from app.words import texts
from fieldmon.infestation.hotspots import hot_spots
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring import Application
from tests.app.chosen import a_plot, chosen, in_season, records_at
from tests.app.shown_plants import plants_in
from tests.monitoring.seasons import BEGINS, Insects, a_season


@pytest.fixture(scope="module")
def choices():
    plot = a_plot()
    return chosen(plot, records_at(plot, [7, 9], [1, 0]))


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    season = a_season(tmp_path_factory.mktemp("layers") / "s.gpkg")
    season.record(Insects(season).look(0, in_season(season, BEGINS).plan().route.plant[:9]), "test")
    return season


def of_name(layers, name):
    return next(layer for layer in layers if layer.id == name)


def test_plants_by_chance_have_the_colours_of_their_chances_and_say_them(choices):
    shown = plants_in(of_name(map_layers.plants(choices), "plants-chance"))
    chance = chosen_day.chance(choices)
    shade = colours.by_chance(chance)
    assert shown.colour.tolist() == shade.table[shade.rank].tolist()
    assert shown.chance == pytest.approx(chance, abs=1e-7)


def test_each_chance_is_said_with_the_interval_that_the_season_believes(choices, season):
    for shown in (choices, in_season(season, BEGINS)):
        layer = of_name(map_layers.plants(shown), "plants-chance")
        level = chosen_day.level_range(shown)
        assert layer.tips["odds"] == pytest.approx([level.low, level.high], rel=1e-4)
        assert level.low < 1.0 < level.high
        assert layer.tips["between"] == ": {chance} chance ({low} to {high})"
    assert chosen_day.level_range(in_season(season, BEGINS)) == season.level_range(BEGINS)


def test_plants_by_state_say_it_and_finds_have_rings(choices):
    layers = map_layers.plants(choices)
    by_state = of_name(layers, "plants-state")
    shown = plants_in(by_state)
    notes = np.frombuffer(by_state.arrays["notes"], "<u2")
    said = [by_state.tips["notes"][note] for note in notes[[7, 9, 8]]]
    assert said == ["found 6 days ago", "clean 6 days ago", "never inspected"]
    assert shown.of_colour(colours.FOUND).tolist() == [7]
    assert shown.of_colour(colours.CLEAN).tolist() == [9]
    assert [len(layer.data) for layer in layers if layer.id.startswith("finds")] == [1, 1]


def test_finds_of_records_alone_have_a_sign_of_their_own_in_a_season(season):
    choices = in_season(season, BEGINS)
    layers = map_layers.plants(choices)
    own = np.flatnonzero(season.history.states(0) == 1).tolist()
    before = np.flatnonzero(season.history.recorded == 1).tolist()
    shown = plants_in(of_name(layers, "plants-state"))
    assert shown.of_colour(colours.FOUND).tolist() == own
    assert len(of_name(layers, "finds-recorded").data) == len({*before} - {*own}) > 0
    named = [name for part in map_layers.legend(choices) for _, _, name in part["items"]]
    assert texts.LEGEND_RECORDED in named


def test_plants_gone_or_not_inspected_say_so_and_have_a_sign_of_their_own(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    free = np.flatnonzero(season.history.recorded < 0)
    plants, on = free[:5], np.datetime64(BEGINS)
    results, notes = [CLEAN, FOUND, SKIPPED, SKIPPED, CLEAN], ["", "", "", "gone: burnt", ""]
    season.record(Inspections.of(plants, results, on, notes=np.array(notes, object)), "test")
    later = Inspections.of(plants[:2], [SKIPPED, SKIPPED], on + 1, notes=["", "gone"])
    season.record(later, "test")
    choices = in_season(season, BEGINS + timedelta(days=1))
    by_state = of_name(map_layers.plants(choices), "plants-state")
    notes = np.frombuffer(by_state.arrays["notes"], "<u2")[free[:6]]
    assert [by_state.tips["notes"][note] for note in notes] == [
        "clean 1 day ago, then could not inspect", "found 1 day ago, then gone",
        "could not inspect", "gone", "clean 1 day ago", "never inspected",
    ]  # fmt: skip
    shown = plants_in(by_state)
    assert shown.of_colour(colours.NOT_INSPECTED).tolist() == free[[2, 3]].tolist()
    assert {*free[[0, 4]].tolist()} <= {*shown.of_colour(colours.CLEAN).tolist()}
    untouched = a_season(tmp_path / "other.gpkg")
    for of, signed in ((choices, True), (in_season(untouched, BEGINS), False)):
        legend = map_layers.legend(of)
        named = [name for part in legend for _, _, name in part["items"]]
        assert (texts.LEGEND_NOT_INSPECTED in named) is signed
    assert [str(one) for one in chosen_day.not_inspected_said(choices)] == [
        "2 plants could not be inspected last time.", "2 plants are gone: plans leave them out.",
    ]  # fmt: skip


def test_plants_by_age_have_the_colours_of_the_days_since(season):
    shown = {}
    for day in (0, 3):
        on = BEGINS.replace(day=BEGINS.day + day)
        made = plants_in(of_name(map_layers.plants(in_season(season, on)), "plants-age"))
        shown[day] = set(made.of_colour(colours.AGE_COLOURS[0 if day == 0 else 2]).tolist())
        never = np.flatnonzero(chosen_day.ages(in_season(season, on)) == -1)
        assert made.of_colour(colours.NEVER).tolist() == never.tolist()
    # seen on the first day, and three days ago on the fourth
    assert set(season.history.inspections.plant.tolist()) <= shown[0] & shown[3]


def test_without_a_season_nobody_asks_how_long_ago(choices, season):
    assert [one.key for one in map_layers.shaded(choices)] == ["chance", "state"]
    in_one = in_season(season, BEGINS)
    assert [one.key for one in map_layers.shaded(in_one, "state")] == ["state", "chance", "age"]


def test_every_layer_of_plants_is_of_one_shade_so_that_one_of_them_shows(season):
    content = map_layers.day_map(in_season(season, BEGINS))
    of_shades = [name for shade in content.shades for name in shade.layers]
    assert len(of_shades) == len(set(of_shades))
    drawn = {layer.id for layer in content.layers}
    assert {name for name in drawn if name.startswith(("plants", "find", "found"))} == {*of_shades}


def test_every_layer_but_the_ground_of_all_and_the_gate_can_be_switched(season):
    choices = in_season(season, BEGINS)
    content = map_layers.day_map(choices)
    switched = {name for one in (*content.switches, *content.shades) for name in one.layers}
    drawn = {layer.id for layer in content.layers}
    assert drawn - switched == {"boundary", "gate"}
    assert {part["of"].removeprefix("shade:") for part in content.legend} >= {
        one.key for one in content.switches if set(one.layers) & drawn
    }


def test_what_is_off_at_first_is_off_and_the_rest_is_on(choices):
    content = map_layers.day_map(choices, off=("records", "route"))
    assert {one.key for one in content.switches if not one.on} == {"records", "route"}


def test_layers_are_made_once(choices):
    assert map_layers.plants(choices) is map_layers.plants(choices)
    route = choices.plan().route
    assert map_layers.route_of(choices, route) is map_layers.route_of(choices, route)


def test_what_is_recorded_shows_at_once(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    choices = in_season(season, BEGINS)
    before = plants_in(of_name(map_layers.plants(choices), "plants-state"))
    season.record(Insects(season).look(0, choices.plan().route.plant[:3]), "test")
    after = plants_in(of_name(map_layers.plants(choices), "plants-state"))
    changed = np.flatnonzero(before.rank != after.rank)
    assert changed.tolist() == sorted(season.history.inspections.plant.tolist())


def test_hot_spots_lie_under_the_plants_that_are_tapped_with_their_edges_above():
    plot = a_plot(0.001)
    near = np.flatnonzero(np.hypot(*(plot.grid.xy_m - plot.grid.xy_m[40]).T) < 12)
    every = np.arange(len(plot.grid))
    choices = chosen(plot, records_at(plot, every, np.isin(every, near)))
    assert len(hot_spots(plot.grid, chosen_day.states(choices)))
    ids = [layer.id for layer in map_layers.day_map(choices).layers]
    assert ids.index("hot") < ids.index("plants-chance") < ids.index("hot-edge")


def test_the_plan_is_below_and_above_is_above_all_else(choices):
    above = map_layers.plants(choices)[1:2]
    layers = map_layers.day_map(choices, above=above).layers
    assert layers[: len(map_layers.plan(choices))] == map_layers.plan(choices)
    assert layers[-1] == above[0]


def test_pointing_says_how_often_a_plant_was_inspected_and_found(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    for day, result in ((0, [1, 0, 2]), (2, [1, 0, 1])):
        on = np.datetime64(BEGINS) + day
        season.record(Inspections.of(np.array([4, 5, 6]), np.array(result), on), "test")
    layer = of_name(
        map_layers.plants(in_season(season, BEGINS.replace(day=BEGINS.day + 3))), "plants-chance"
    )
    notes = np.frombuffer(layer.arrays["notes"], "<u2")
    assert [layer.tips["notes"][notes[k]] for k in (4, 5, 6, 7)] == [
        "found 1 day ago, inspected 2 times, found 2 times", "clean 1 day ago, inspected 2 times",
        "found 1 day ago", "never inspected",
    ]  # fmt: skip


def test_a_day_is_played_anew_where_its_route_is_another_one(choices):
    first = map_layers.day_map(choices).play
    assert map_layers.day_map(choices).play["key"] == first["key"]
    route = choices.plan().route
    assert len(first["stops"]) == len(route)
    longer = chosen(choices.plot, choices.records, robot=choices.robot, day="2026-11-18")
    assert map_layers.day_map(longer).play["key"] != first["key"]


def test_what_was_treated_lately_is_shown_with_its_day_and_product(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    west, south, east, north = season.plot.field.boundary.bounds
    half = MultiPolygon([box(west, south, east, (south + north) / 2)])
    season.treat(BEGINS, 0.8, half, application=Application("soap"))
    done = season.treat(BEGINS + timedelta(days=3), 0.8)
    tips = ["treated on Mon 6 Apr: \u2068soap\u2069", "treated on Thu 9 Apr"]
    for days, said in ((0, tips[:1]), (3, tips), (13, tips), (14, tips[1:]), (17, [])):
        day = map_layers.day_map(in_season(season, BEGINS + timedelta(days=days)))
        shown = [layer for layer in day.layers if layer.id == "treated"]
        assert [row["t"] for layer in shown for row in layer.data] == said
        assert ("treated" in {one.key for one in day.switches if one.on}) == bool(said)
    season.undo(done.batch)
    day = map_layers.day_map(in_season(season, BEGINS + timedelta(days=3)))
    (shown,) = [layer for layer in day.layers if layer.id == "treated"]
    assert [row["t"] for row in shown.data] == tips[:1]
    # under the plants, which can be tapped
    ids = [layer.id for layer in day.layers]
    assert ids.index("treated") < ids.index("plants-chance")
