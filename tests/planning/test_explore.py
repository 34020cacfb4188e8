"""The map of a day in a notebook: what is drawn where, in which colour, and what it says."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.planning.explore import deck_of
from fieldmon.planning.plan import plan_in
from fieldmon.plot.layout import rectangle
from fieldmon.samplers import sampler
from tests.scenes import scene_on

GRID = rectangle(12, 20)


@pytest.fixture(scope="module")
def day():
    return plan_in(scene_on(GRID, hours=1.0, seed=2), sampler("dynamic"))


@pytest.fixture(scope="module")
def layers(day):
    return {layer.id: layer for layer in deck_of(day.route, day.chance).layers}


def test_every_plant_is_drawn_at_its_place_and_says_its_chance(day, layers):
    drawn = layers["plants"].data
    np.testing.assert_allclose([one["at"] for one in drawn], GRID.lonlat(), atol=1e-8)
    assert drawn[21]["text"] == f"row 2, plant 2: chance {100 * day.chance[21]:.1f} %"


def test_a_more_suspected_plant_is_never_drawn_paler(day, layers):
    # brightness as the eye weighs it (Rec. 709), so that it holds without hue too
    bright = [np.dot(one["colour"], (0.2126, 0.7152, 0.0722)) for one in layers["plants"].data]
    by_chance = np.array(bright)[np.argsort(day.chance)]
    assert (np.diff(by_chance) <= 0).all()
    assert by_chance[0] > by_chance[-1] + 50


@pytest.mark.parametrize("chance", [0.0, 0.01, 0.5, 1.0])
def test_every_chance_has_a_colour(day, chance):
    scene = replace(day.scene, chance=np.full(len(GRID), chance))
    colours = {tuple(one["colour"]) for one in _plants(replace(day, scene=scene))}
    assert len(colours) == 1
    assert all(0 <= part <= 255 for part in colours.pop())


def _plants(day):
    return next(
        layer for layer in deck_of(day.route, day.chance).layers if layer.id == "plants"
    ).data


def test_neither_the_plot_nor_stops_hide_plants(layers):
    assert not layers["plot"].filled
    assert layers["plot"].stroked
    assert not layers["stops"].filled
    assert layers["stops"].stroked
    said = {name for name, layer in layers.items() if getattr(layer, "pickable", False)}
    assert said == {"plants", "stops"}


def test_the_route_is_the_line_that_is_driven_and_its_stops_say_when(day, layers):
    (line,) = layers["route"].data
    np.testing.assert_allclose(line["path"], day.route.line_lonlat())
    stops = layers["stops"].data
    assert len(stops) == len(day.route)
    np.testing.assert_allclose([one["at"] for one in stops], day.route.stops_lonlat(), atol=1e-8)
    minutes = round(day.route.arrive_s[-1] / 60)
    clock = f"{minutes // 60} h {minutes % 60:02d} min"
    assert f"stop {len(stops)}: " in stops[-1]["text"]
    assert f"after {clock}" in stops[-1]["text"]


@pytest.mark.parametrize("grid", [rectangle(1, 1), rectangle(2, 60), rectangle(60, 2)])
def test_the_view_shows_the_whole_plot_on_a_map_of_600_by_450_pixels(grid):
    day = plan_in(scene_on(grid, hours=1.0), sampler("naive"))
    view = deck_of(day.route, day.chance).initial_view_state
    world_px = 512 * 2.0**view.zoom
    lon, lat = grid.lonlat().T
    east = (lon - view.longitude) / 360 * world_px
    stretched = np.log(np.tan(np.pi / 4 + np.radians([*lat, view.latitude]) / 2))
    north = (stretched[:-1] - stretched[-1]) / (2 * np.pi) * world_px
    assert np.abs(east).max() <= 300
    assert np.abs(north).max() <= 225


def test_nothing_is_asked_of_a_map_provider(day):
    assert deck_of(day.route, day.chance).map_provider is None or deck_of(
        day.route, day.chance
    ).map_style in (None, "")
