"""What stands behind the pages, without a page."""

import base64
from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from shapely import MultiPolygon, box

from app import maps, ruler
from app.comparing import Arm, Asked, Comparison, curve, outcomes
from app.edits import Edit, edited, points_of
from app.units import DATES, Units
from fieldmon.errors import SettingError
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot

SQUARE = MultiPolygon([box(35.15, 30.36, 35.1506, 30.3606)])
SHORT = [Arm(name, 1.0, 40.0) for name in ("naive", "dynamic")]


@pytest.fixture(scope="module")
def plot():
    return Plot.of(Field("square", SQUARE, gate=(35.15, 30.36)))


def compared(plot, arms, seeds=4):
    rng = np.random.default_rng(3)
    chance = np.where(rng.random(len(plot.grid)) < 0.1, 0.5, 0.001)
    asked = Asked(tuple(arms), n_days=5, share=0.05, rate=0.1, seeds=seeds)
    running = Comparison(asked, plot, chance, Robot())
    running.start()
    running.wait(120)
    assert running.done == running.total
    return running


def test_an_arm_compared_with_its_own_twin_differs_by_nothing(plot):
    once, again = (compared(plot, SHORT).seasons() for _ in range(2))
    for arm in SHORT:
        for one, other in zip(once[arm], again[arm], strict=True):
            assert one.left.tolist() == other.left.tolist()


def test_every_arm_meets_the_same_insects_on_the_first_morning(plot):
    seasons = compared(plot, SHORT).seasons()
    starts = [[int(s.new[0]) for s in walked] for walked in seasons.values()]
    assert starts[0] == starts[1]
    assert len(set(starts[0])) > 1


def test_more_looking_and_more_hours_lose_less(plot):
    arms = [Arm("dynamic", 1.0, 20.0), Arm("dynamic", 4.0, 40.0)]
    ranked = outcomes(compared(plot, arms).seasons())
    assert ranked[0].arm == arms[1]
    assert ranked[0].behind is None
    assert ranked[1].behind.mean == pytest.approx(ranked[1].loss.mean - ranked[0].loss.mean)


def test_a_stopped_comparison_goes_on_where_it_stood(plot):
    asked = Asked(tuple(SHORT), n_days=3, share=0.05, rate=0.1, seeds=200)
    running = Comparison(asked, plot, np.full(len(plot.grid), 0.01), Robot())
    running.start()
    running.stop()
    running.wait(60)
    part = running.done
    assert part < running.total
    assert not running.running
    running.start()
    while running.done <= part:
        pass
    running.stop()
    running.wait(60)
    assert running.done > part


def test_curves_stay_within_their_interval_and_percent(plot):
    walked = next(iter(compared(plot, SHORT).seasons().values()))
    mean, low, high = curve(walked)
    assert (low <= mean).all()
    assert (mean <= high).all()
    assert low.min() >= 0
    assert high.max() <= 100


def test_a_no_go_area_leaves_the_plot_and_a_gate_moves():
    field = Field("square", SQUARE)
    area = Edit("no_go", ((35.1502, 30.3602), (35.1504, 30.3602), (35.1504, 30.3604)))
    made = edited(field, (area, Edit("gate", ((35.15, 30.3603),))))
    assert made.gate == (35.15, 30.3603)
    assert made.drivable().area == pytest.approx(SQUARE.area - 0.5 * 0.0002 * 0.0002)
    path = Edit("path", ((35.15, 30.36), (35.1506, 30.3606)))
    assert len(edited(field, (path, path)).paths.geoms) == 2


@pytest.mark.parametrize("kind", ["gate", "path", "no_go"])
def test_too_few_points_are_refused(kind):
    with pytest.raises(SettingError, match="needs"):
        Edit(kind, ())


@pytest.mark.parametrize("text", ["35", "x,y", "35.1,91", "200,3", "1,2,3"])
def test_typed_positions_that_are_none_are_refused(text):
    with pytest.raises(SettingError):
        points_of(text)


def test_typed_positions_are_read_in_any_layout():
    assert points_of("35.1,30.2 35.3,30.4;\n1, 2") == ((35.1, 30.2), (35.3, 30.4), (1.0, 2.0))


def test_units_say_what_they_measure():
    feet = Units("ft", "acre", "11/16/2026")
    assert feet.metres(0.3048 * 100) == "100 ft"
    assert feet.metres(1609.344 * 2) == "2.00 mi"
    assert feet.square(4046.8564224) == "1.00 acre"
    assert feet.day("2026-11-16") == "11/16/2026"
    assert Units(area="dunam").square(1000.0) == "1.00 dunam"
    assert Units().metres(1500.0) == "1.50 km"
    assert {Units(date_like=like).day("2026-11-16") for like in DATES} == set(DATES)


def test_the_scale_bar_is_round_and_fits():
    for unit, factor in (("m", 1.0), ("ft", 0.3048)):
        for room_m in (1.0, 7.0, 33.0, 480.0, 990.0):
            bar_m, text = Units(unit).bar_m(room_m)
            number = bar_m / factor
            assert number == pytest.approx(round(number))
            assert f"{number:.0f}"[0] in "125"
            assert 0.35 * room_m < bar_m <= room_m
            assert text == f"{number:.0f} {unit}"


def test_long_scale_bars_are_in_kilometres_or_miles():
    assert Units("m").bar_m(3000.0) == (2000.0, "2 km")
    assert Units("ft").bar_m(3500.0) == (2 * 1609.344, "2 mi")
    assert Units("m").bar_m(0.01) == (0.1, "0.1 m")
    for unit in ("m", "ft"):
        metres = [length_m for length_m, _ in Units(unit).lengths()]
        assert metres == sorted(metres)


def test_each_click_on_a_map_is_heard_once_though_the_browser_tells_of_the_last_ones(monkeypatch):
    state = {"ruler_a": {"points": [[5, 35.1, 30.1], [9, 35.2, 30.2]]}}
    monkeypatch.setattr(ruler.st, "session_state", state)
    assert ruler.new_points("ruler_a") == ((35.1, 30.1), (35.2, 30.2))
    assert ruler.new_points("ruler_a") == ()
    state["ruler_a"] = {"points": [[9, 35.2, 30.2], [11, 35.3, 30.3], [12, 35.4, 30.4]]}
    assert ruler.new_points("ruler_a") == ((35.3, 30.3), (35.4, 30.4))
    state["ruler_a"] = {"points": None}
    assert ruler.new_points("ruler_a") == ()


def test_each_pixel_of_a_picture_shows_the_most_important_plant_on_it(monkeypatch):
    monkeypatch.setattr(maps, "_PICTURE_AT_MOST", 7)
    grid = rectangle(20, 30)
    shade = maps.by_state(np.random.default_rng(3).choice([-1, 0, 1], 600, p=[0.8, 0.1, 0.1]))
    layer = maps._picture(grid, shade)
    packed = layer.image.value.split(",")[1]
    image = np.array(Image.open(BytesIO(base64.b64decode(packed))).convert("RGBA"))
    (west, south), _, (east, north), _ = layer.bounds
    across, down = ((grid.lonlat() - [west, north]) / [east - west, south - north]).T
    tall, wide = image.shape[:2]
    pixel = (down * tall).astype(int) * wide + (across * wide).astype(int)
    best = np.zeros(tall * wide, int)
    np.maximum.at(best, pixel, shade.rank + 1)
    table = np.vstack([[0, 0, 0, 0], shade.table])
    assert (image.reshape(-1, 4) == table[best]).all()
    assert len(np.unique(best)) > 2


def test_numbers_of_stops_do_not_cover_each_other_where_the_whole_route_is_in_view(plot):
    chance = np.random.default_rng(1).random(len(plot.grid))
    route = plan_from(plot, chance, PlanSettings()).route
    numbers = next(layer for layer in maps.route(route) if layer.id == "numbers")
    shown = [int(row["n"]) for row in numbers.data]
    assert 1 in shown
    assert 5 < len(shown) < len(route)
    here = np.array([row["p"] for row in numbers.data])
    span = np.ptp(route.stops_lonlat(), axis=0) * [np.cos(np.radians(here[0, 1])), 1.0]
    px = (here[:, None] - here) * [np.cos(np.radians(here[0, 1])), 1.0] / span.max() * 300
    beside = (np.abs(px) >= [29.9, 16.9]).any(axis=2)
    assert beside[~np.eye(len(here), dtype=bool)].all()
