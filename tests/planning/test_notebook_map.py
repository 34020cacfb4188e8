"""The map of a day in a notebook: what is drawn where, in which colour, and what it says."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.wording import chance_figure
from fieldmon.planning.notebook_map import deck_of
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
    text = f"row 2, plant 2: chance {chance_figure(day.chance[21], 1)}"
    assert drawn[21]["text"] == text


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


def test_a_colour_begins_at_each_of_seven_chances_and_holds_up_to_the_next(day):
    begins = [0.0, 0.01, 0.02, 0.05, 0.10, 0.25, 0.50]
    chance = np.zeros(len(GRID))
    chance[:7] = begins
    chance[7:13] = np.nextafter(begins[1:], 0.0)
    chance[13] = 1.0
    told = deck_of(day.route, chance).layers
    colours = [tuple(one["colour"]) for layer in told if layer.id == "plants" for one in layer.data]
    assert len({*colours[:7]}) == 7
    assert colours[7:13] == colours[:6]
    assert colours[13] == colours[6]
    assert {*colours[14:]} == {colours[0]}


def test_each_stop_says_its_order_place_clock_and_chance(day):
    arrive_s = np.linspace(29.0, 7205.0, len(day.route))
    route = replace(day.route, arrive_s=arrive_s)
    (stops,) = [layer.data for layer in deck_of(route, day.chance).layers if layer.id == "stops"]
    for order, (stop, plant, at_s) in enumerate(zip(stops, route.plant, arrive_s, strict=True), 1):
        hours, minutes = divmod(round(at_s / 60), 60)
        assert stop["text"] == (
            f"stop {order}: row {plant // 20 + 1}, plant {plant % 20 + 1}, after {hours} h "
            f"{minutes:02d} min, chance {100 * day.route.chance[order - 1]:.1f} %"
        )


@pytest.mark.parametrize("grid", [rectangle(30, 30), rectangle(2, 60), rectangle(60, 2)])
def test_the_view_is_filled_to_two_thirds_at_least(grid):
    day = plan_in(scene_on(grid, hours=1.0), sampler("naive"))
    view = deck_of(day.route, day.chance).initial_view_state
    west, south, east, north = grid.frame.geometry_lonlat(grid.drivable_m).bounds
    px = 512 * 2.0**view.zoom / 360
    wide, high = (east - west) * px, (north - south) * px / np.cos(np.radians(view.latitude))
    assert max(wide / 600, high / 450) == pytest.approx(1.0, abs=1 / 3)
    assert (view.longitude, view.latitude) == pytest.approx(
        ((west + east) / 2, (south + north) / 2)
    )
