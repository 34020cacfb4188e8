"""Plants on a map: what is seen of them is what is known of them."""

import base64
import json
from dataclasses import replace

import numpy as np
import pytest

from app.show.maps import colours, labels, plant_layers
from app.show.maps.plant_layers import PlantNotes
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.layout import rectangle
from tests.app.chosen import a_plot, chosen
from tests.app.shown_plants import plants_in, shown_plants
from tests.paths import ROOT

GRID = rectangle(6, 8)
STATE = np.tile(np.array([-1, 0, 1], np.int8), 16)
# a centimetre, in degrees
CM = 1e-7


def test_every_plant_is_sent_with_its_place_its_row_and_number_and_the_colour_of_its_state():
    shown = plants_in(plant_layers.plants(GRID, colours.by_state(STATE)))
    numbered = plant_numbers(GRID, np.arange(len(GRID)))
    assert shown.lonlat == pytest.approx(GRID.lonlat(), abs=CM)
    assert (shown.row, shown.number) == (
        pytest.approx(numbered.line),
        pytest.approx(numbered.number),
    )
    assert shown.rank.tolist() == (STATE + 1).tolist()
    assert shown.of_colour(colours.FOUND).tolist() == np.flatnonzero(STATE == 1).tolist()


def test_two_faces_are_drawn_beside_each_other_and_named():
    grid = a_plot(faces=2).grid
    layer = plant_layers.plants(grid, colours.plain(len(grid)))
    lonlat = plants_in(layer, faces=2).lonlat
    first = np.flatnonzero(grid.vine == np.arange(len(grid)))
    apart_m = np.hypot(
        *(grid.frame.xy_m(lonlat[first]) - grid.frame.xy_m(lonlat[grid.twin[first]])).T
    )
    least_m = min(grid.plant_spacing_m, grid.row_spacing_m)
    assert apart_m == pytest.approx(np.full(len(first), least_m / 2), abs=0.02)
    towards = np.einsum("ij,ij->i", grid.frame.xy_m(lonlat) - grid.xy_m, grid.stop_m - grid.xy_m)
    assert (towards > 0).all()
    assert layer.tips["faces"] == "{number}, face {face}"
    of = np.frombuffer(layer.arrays["places"], "<i4", len(grid), 48 + 16 * len(grid))
    assert {*of[first]} == {1}
    assert {*of[grid.twin[first]]} == {2}
    (ring, _) = plant_layers.chosen(grid, 0)
    assert ring.data[0]["p"] == pytest.approx(lonlat[0].tolist(), abs=1e-6)
    route = chosen(a_plot(faces=2)).plan().route
    places = [one["p"] for one in labels.stops(route) if one["k"] == "stop"]
    assert places == pytest.approx(lonlat[route.plant], abs=1e-6)


def test_a_million_plants_keep_their_places_to_the_centimetre():
    grid = rectangle(1000, 1000)
    shown = plants_in(plant_layers.plants(grid, colours.plain(len(grid))))
    assert np.abs(shown.lonlat - grid.lonlat()).max() < 5 * CM
    assert len(plant_layers.plants(grid, colours.plain(len(grid))).arrays["places"]) < 17e6


def test_places_are_written_once_for_all_shades_of_a_plot():
    by_state, plain = (
        plant_layers.plants(GRID, shade) for shade in (colours.by_state(STATE), colours.plain(48))
    )
    assert by_state.arrays["places"] is plain.arrays["places"]
    assert by_state.arrays["ranks"] != plain.arrays["ranks"]


def test_chances_are_said_of_each_plant_or_a_sentence_of_each_rank_but_nothing_unasked():
    chance = np.linspace(0, 1, len(GRID))
    told = plant_layers.plants(GRID, colours.by_chance(chance), PlantNotes(chance))
    assert plants_in(told).chance == pytest.approx(chance, abs=1e-7)
    assert "{chance}" in told.tips["values"]
    sentences = PlantNotes(by_rank=("a", "b", "c"))
    by_rank = plant_layers.plants(GRID, colours.by_state(STATE), sentences)
    assert by_rank.tips["ranks"] == ["a", "b", "c"]
    assert "values" not in by_rank.arrays
    assert set(plant_layers.plants(GRID, colours.plain(48)).tips) == {"text"}
    named = replace(GRID, line_named=np.full(len(GRID.line_number), "Top"))
    assert plant_layers.plants(named, colours.plain(48)).tips["rows"][1] == "1 · Top"


def test_points_touch_no_neighbour():
    layer = plant_layers.plants(GRID, colours.plain(48))
    assert layer.radius < layer.apart / 2
    assert layer.apart == pytest.approx(min(GRID.plant_spacing_m, GRID.row_spacing_m))


def test_finds_have_two_rings_and_a_dot_where_they_are():
    state = np.zeros(len(GRID), np.int8)
    state[[5, 20]] = 1
    layers = plant_layers.finds(GRID, state)
    assert [layer.id for layer in layers] == ["finds0", "finds1", "found"]
    for layer in layers:
        here = np.array([row["p"] for row in layer.data])
        assert here == pytest.approx(GRID.lonlat()[[5, 20]], abs=CM)


def test_the_plant_whose_history_is_shown_has_a_ring_of_its_own():
    for layer in plant_layers.chosen(GRID, 11):
        assert layer.data[0]["p"] == pytest.approx(GRID.lonlat()[11], abs=CM)


def test_plants_that_are_selected_have_a_ring_each():
    rows = plant_layers.picked(GRID, np.array([3, 30])).data
    assert np.array([row["p"] for row in rows]) == pytest.approx(GRID.lonlat()[[3, 30]], abs=CM)


def test_what_the_map_s_own_tests_read_is_what_is_written_here():
    """The file is read by app/map_view/tests; `python -m tests.app.show.maps.plants_file`."""
    kept = json.loads((ROOT / "app" / "map_view" / "tests" / "plants.json").read_text())
    grid = rectangle(kept["rows"], kept["plants"])
    layer = plant_layers.plants(grid, colours.plain(len(grid)))
    now = plants_in(layer)
    places = base64.b64decode(kept["places"])
    then = shown_plants({**layer.arrays, "places": places}, layer.table)
    assert len(layer.arrays["places"]) == len(places)
    assert then.lonlat == pytest.approx(now.lonlat, abs=1e-12)
    assert np.array(kept["lonlat"]) == pytest.approx(now.lonlat, abs=1e-12)
    assert then.row.tolist() == kept["row"] == now.row.tolist()
    assert then.number.tolist() == kept["number"] == now.number.tolist()
