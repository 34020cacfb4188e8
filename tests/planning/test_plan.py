"""A day planned by the library: what the command plans, as Python objects."""

from datetime import UTC, date, datetime
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
import shapely
import shapely.affinity

from fieldmon.errors import SettingError
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import PRESENT, Records
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.planning.plan import (
    PlanSettings,
    first_day,
    plan_believed,
    plan_day,
    plan_from,
    plan_in,
)
from fieldmon.planning.wishes import Wishes
from fieldmon.planning.workday import plan_work
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER
from fieldmon.samplers.sweeps import Naive

ROBOT = Robot(hours=1)


@pytest.fixture(scope="module")
def plot():
    grid = rectangle(12, 20, Planting())
    return Plot(Field("Square", grid.frame.geometry_lonlat(grid.drivable_m)), Aisles.of(grid))


@pytest.fixture(scope="module")
def day(plot):
    return plan_day(plot, on="2026-11-18", robot=ROBOT)


@pytest.mark.parametrize(
    "on",
    [
        *("2026-11-18", date(2026, 11, 18), np.datetime64("2026-11-18"), datetime(2026, 11, 18, 6)),
        *(pd.Timestamp("2026-11-18"), pd.Timestamp(2026, 11, 18, 6)),
    ],
)
def test_a_day_is_named_in_any_usual_way(plot, day, on):
    same = plan_day(plot, on=on, robot=ROBOT)
    assert same.route.plant.tolist() == day.route.plant.tolist()
    assert same.route.notes == day.route.notes
    assert same.route.notes.start == datetime(2026, 11, 18, 6)


@pytest.mark.parametrize("on", ["2026-11-18 00:00", datetime(2026, 11, 18)])
def test_who_says_midnight_starts_then(plot, on):
    assert plan_day(plot, on=on, robot=ROBOT).route.notes.start == datetime(2026, 11, 18)


def test_no_day_is_today(plot):
    assert plan_day(plot, robot=ROBOT).route.notes.start.date() == local_clock(plot.field).today()


def test_a_record_raises_the_chance_about_it_on_its_day_and_less_later(plot):
    at = plot.grid.lonlat(np.array([130]))
    records = Records.of(at, np.array([PRESENT], np.int8), np.array(["2026-11-18"], "M8[D]"))
    plain, soon, late = (
        plan_day(plot, given, on, robot=ROBOT).chance[130]
        for given, on in [(None, "2026-11-18"), (records, "2026-11-18"), (records, "2026-12-18")]
    )
    assert plain < late < soon


def test_what_was_planned_cannot_be_changed_by_accident(plot):
    day = plan_day(plot, on="2026-11-18", robot=Robot(hours=0.5))
    for array in (day.chance, day.route.plant, day.route.arrive_s, day.route.line_m):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_a_sampler_is_named_or_brought(plot):
    named = plan_day(plot, on="2026-11-18", robot=ROBOT, sampler="naive").route
    brought = plan_day(plot, on="2026-11-18", robot=ROBOT, sampler=Naive()).route
    assert named.plant.tolist() == brought.plant.tolist()
    assert (named.notes.sampler, brought.notes.sampler) == ("naive", "Naive")


def test_plants_tell_chance_and_place_on_the_route(day):
    plants = day.plants
    said = ["plant", "row", "number", "chance", "order", "arrive_s", "geometry"]
    assert plants.columns.tolist() == said
    assert plants["order"].min() == 1
    assert plants["chance"].tolist() == day.chance.tolist()
    route = plants.dropna(subset="order").sort_values("order")
    assert route["plant"].tolist() == day.route.plant.tolist()
    assert route["arrive_s"].tolist() == day.route.arrive_s.tolist()
    assert plants["order"].isna().sum() == len(plants) - len(day.route)


def test_stops_come_out_in_order_and_the_line_begins_at_the_first_row_end(day, plot):
    stops = day.route.to_geopandas()
    assert stops.index.tolist() == list(range(1, len(stops) + 1))
    assert stops["arrive_s"].is_monotonic_increasing
    assert ((stops["leave_s"] - stops["arrive_s"]).round(6) == ROBOT.visit_s).all()
    assert np.allclose(np.c_[stops.geometry.x, stops.geometry.y], day.route.stops_lonlat())
    gate = plot.grid.frame.lonlat(plot.aisles.gate_m[None])[0]
    assert day.route.line.coords[0] == pytest.approx(tuple(gate))


def test_a_route_is_written_with_its_plot_sampler_and_start(day, tmp_path):
    (written,) = day.route.to_file(tmp_path / "day.geojson")
    text = written.read_text()
    assert '"plot":"Square"' in text
    assert '"sampler":"adaptive"' in text
    assert '"start":"2026-11-18T06:00:00"' in text


def test_a_map_for_notebooks_asks_no_map_provider_and_shows_every_plant(day):
    deck = day.explore()
    layers = {layer.id: layer for layer in deck.layers}
    assert list(layers) == ["plot", "plants", "route", "stops"]
    assert len(layers["plants"].data) == len(day.chance)
    assert len(layers["stops"].data) == len(day.route)
    assert '"mapProvider": null' in deck.to_json() or "mapProvider" not in deck.to_json()


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"on": "tomorrow"}, "2026-11-18"),
        ({"sampler": "best"}, "must be one of"),
        ({"robot": Robot(hours=0.001)}, "long enough"),
    ],
)
def test_what_cannot_be_planned_is_said(plot, wrong, sentence):
    with pytest.raises(SettingError, match=sentence):
        plan_day(plot, **({"robot": ROBOT} | wrong))


@pytest.mark.parametrize(
    "place", [(5.0, 45.0, 30.0), (35.0, 30.0, 0.0), (-70.0, -33.0, 179.0), (20.0, 68.0, 90.0)]
)
def test_a_plot_is_planned_alike_wherever_it_lies_and_however_it_is_turned(place):
    def planned(lon, lat, turned_deg):
        ground = shapely.affinity.rotate(shapely.box(-30, -25, 30, 25), turned_deg, origin=(0, 0))
        area = Frame(lon, lat).geometry_lonlat(shapely.MultiPolygon([ground]))
        return plan_day(Plot.of(Field("p", area)), on="2026-11-18", robot=ROBOT).route

    here, there = planned(5.0, 45.0, 0.0), planned(*place)
    assert there.plant.tolist() == here.plant.tolist()
    assert there.arrive_s == pytest.approx(here.arrive_s, abs=0.01)


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ({"records": [[35.1, 30.2]]}, "Records must be fm.Records"),
        ({"robot": 4}, "must be"),
        ({"plot": "gate.kml"}, "must be"),
    ],
)
def test_what_is_no_plot_no_robot_and_no_records_is_refused_by_name(plot, asked, sentence):
    with pytest.raises(SettingError, match=sentence):
        plan_day(**{"plot": plot, "on": "2026-11-18", "robot": Robot(hours=0.2), **asked})


def test_a_start_that_names_its_zone_is_the_plot_s_own_time():
    field = Field("there", Frame(35.0, 30.5).geometry_lonlat(
        shapely.MultiPolygon([shapely.box(-30, -25, 30, 25)])))  # fmt: skip
    there = Plot.of(field)
    starts = [plan_day(there, on=on, robot=ROBOT).route.notes.start for on in (
        "2026-11-17T23:30:00+00:00", datetime(2026, 11, 18, 1, 30),
        datetime(2026, 11, 17, 23, 30, tzinfo=UTC))]  # fmt: skip
    # two hours ahead in winter: by then it is the next day there
    assert starts == [datetime(2026, 11, 18, 1, 30)] * 3
    at = there.grid.lonlat(np.array([20]))
    records = Records.of(at, np.array([PRESENT], np.int8), np.array(["2026-11-18"], "M8[D]"))
    late, same = (plan_day(there, records, on, robot=ROBOT).chance for on in (
        "2026-11-17T23:30:00+00:00", "2026-11-18"))  # fmt: skip
    assert late.tolist() == same.tolist()


def test_a_risk_is_one_more_way_of_being_infested_where_it_says_something(plot, day):
    risk = np.full(len(plot.grid), np.nan)
    risk[:50], risk[50:60] = 0.3, 0.0
    chance = plan_day(plot, on="2026-11-18", robot=ROBOT, risk=risk).chance
    assert chance[50:].tolist() == pytest.approx(day.chance[50:].tolist())
    assert 1.0 - chance[:50] == pytest.approx(0.7 * (1.0 - day.chance[:50]))


def test_a_day_is_planned_in_a_scene_of_what_is_known_before_anything_was_inspected(plot):
    prior = PriorSettings(background_chance=0.04)
    plans = PlanSettings(Robot(hours=0.5, look_s=25.0), Naive(), prior)
    records = Records.of(plot.grid.lonlat(np.array([130])), np.array([PRESENT], np.int8),
                              np.array(["2026-11-10"], "M8[D]"))  # fmt: skip
    on_day = np.datetime64("2026-11-18")
    chance = prior_chance(plot.grid, plot.field, records, on_day, prior)
    made = first_day(plot, records, on_day, plans)
    believed = TracedPairs.of(plot.grid, chance)
    again = plan_believed(plot, (chance, believed), plans)
    for day in (made, plan_from(plot, chance, plans), again):
        scene = day.scene
        assert scene.chance.tolist() == chance.tolist() == day.chance.tolist()
        assert scene.pair_chance == pytest.approx(believed.pair_chance)
        for told, traces in zip(scene.traces[1:], believed.traces[1:], strict=True):
            assert np.array_equal(told, traces)
        assert (scene.last_inspected == NEVER).all()
        assert (scene.at, scene.seconds_left, scene.supposed) == (GATE, 1800.0, False)
        assert (scene.robot, scene.aisles.grid) == (plans.robot, plot.grid)
        work = plan_work(scene, plans.sampler)
        assert day.work.plant.tolist() == work.plant.tolist() == day.route.plant.tolist()
        assert day.route.arrive_s.tolist() == work.arrive_s.tolist()


def test_wishes_reach_every_way_to_plan_a_first_day_and_change_no_belief(plot):
    plans = PlanSettings(ROBOT, Adaptive())
    chance = np.random.default_rng(2).random(len(plot.grid)) * 0.1
    plain = plan_from(plot, chance, plans)
    wanted = np.setdiff1d(np.arange(len(plot.grid)), plain.route.plant)[:3]
    wishes = Wishes(tuple(wanted.tolist()), tuple(plain.route.plant[:2].tolist()))
    known = chance, TracedPairs.of(plot.grid, chance)
    for day in (plan_believed(plot, known, plans, wishes),
                plan_in(plain.scene, plans.sampler, wishes)):  # fmt: skip
        assert not len(wishes.unmet(day.route))
        assert not np.isin(plain.route.plant[:2], day.route.plant).any()
        assert day.chance.tolist() == chance.tolist()
        assert (day.scene.last_inspected == NEVER).all()


def test_a_day_says_its_stops_its_way_and_its_hours(day):
    line_m = day.route.line_m
    km = sum(np.hypot(*(b - a)) for a, b in pairwise(line_m)) / 1000
    said = f"<DayPlan: {len(day.route)} of 240 plants, {km:.2f} km, {day.work.end_s / 3600:.2f} h>"
    assert repr(day) == said


def test_by_default_a_usual_robot_goes_where_most_is_expected(plot):
    usual = PlanSettings()
    assert usual == PlanSettings(Robot(), Adaptive(), PriorSettings())
    day = plan_day(plot, on="2026-11-18")
    assert (day.scene.robot, day.scene.seconds_left) == (Robot(), 12 * 3600.0)
    assert day.route.notes.sampler == "adaptive"
