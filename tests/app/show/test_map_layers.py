"""A day's layers are made once for what they show, and anew once something is recorded."""

import pytest

from app.show import map_layers
from app.show.maps import colours
from app.state import chosen_day
from tests.app.chosen import a_plot, chosen, in_season, records_at
from tests.monitoring.seasons import BEGINS, Insects, a_season


@pytest.fixture(scope="module")
def choices():
    plot = a_plot()
    return chosen(plot, records_at(plot, [7, 9], [1, 0]))


def points(layers):
    return next(layer for layer in layers if layer.id == "plants").data


def test_plants_by_chance_say_their_chance(choices):
    shown = points(map_layers.plants(choices, "chance"))
    chance = chosen_day.chance(choices)
    assert [row["t"].split(": ")[1] for row in shown] == [f"{c:.1%} chance" for c in chance]


def test_plants_by_state_say_it_and_finds_have_rings(choices):
    layers = map_layers.plants(choices, "state")
    shown = points(layers)
    assert shown[7]["t"].endswith(": found")
    assert shown[9]["t"].endswith(": looked clean")
    assert shown[8]["t"].endswith(": never inspected")
    assert [len(layer.data) for layer in layers if layer.id.startswith("finds")] == [1, 1]


def test_plants_by_age_have_the_colours_of_ages(choices):
    assert {tuple(row["c"][:3]) for row in points(map_layers.plants(choices, "age"))} == {
        colours.NEVER,
        colours.AGE_COLOURS[2],  # records of six days ago
    }


def test_layers_are_made_once(choices):
    assert map_layers.plants(choices, "chance") is map_layers.plants(choices, "chance")
    route = choices.plan().route
    once = map_layers.route(choices, route, numbers=True)
    assert once is map_layers.route(choices, route, numbers=True)
    assert once is not map_layers.route(choices, route, numbers=False)


def test_what_is_recorded_shows_at_once(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    choices = in_season(season, BEGINS)
    before = map_layers.plants(choices, "state")
    season.record(Insects(season).look(0, choices.plan().route.plant[:3]), "test")
    after = map_layers.plants(choices, "state")
    changed = [
        a["i"] for a, b in zip(points(after), points(before), strict=True) if a["c"] != b["c"]
    ]
    assert sorted(changed) == sorted(season.history.inspections.plant.tolist())


def test_marks_are_shown_where_they_are_asked_for(choices):
    plants = map_layers.plants(choices, "chance")
    assert [layer.id for layer in map_layers.with_marks(choices, plants, [])] == ["plants"]
    with_records = map_layers.with_marks(choices, plants, ["records"])
    assert [layer.id for layer in with_records] == ["plants", "records"]
