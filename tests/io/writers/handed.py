"""Days to hand off, for the tests of every format."""

from dataclasses import replace
from datetime import datetime
from functools import cache
from zoneinfo import ZoneInfo

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from fieldmon.io.writers import HandoffPlan
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import plan_work
from fieldmon.plot.block_cutting import blocks_from_outline
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.samplers import sampler
from tests.scenes import scene_on

#: metres: what is read back lies as near as this
CM = 0.01
START = datetime(2026, 11, 18, 7, 30)
METRES = np.array([96_200.0, 110_800.0])  # of a degree of longitude and latitude at 30 N, roughly


def day(grid, hours=1.5, plot='ענבים & "Söhne" <1>', start=START, seed=1, by="dynamic"):
    """Return a planned day whose robot comes back to the gate."""
    scene = scene_on(grid, hours=hours, seed=seed)
    route = route_of(scene, plan_work(scene, sampler(by)))
    return HandoffPlan(route, RouteNotes(plot, by, start))


@cache
def usual():
    """Return a day on a rectangle."""
    return day(rectangle(9, 14))


@cache
def long():
    """Return a day whose line has more than 500 points."""
    return day(rectangle(16, 40), hours=8.0, by="naive")


@cache
def empty():
    """Return a day without a stop."""
    return day(rectangle(9, 14), hours=0.005)


@cache
def crooked():
    """Return a day on an L-shaped plot with a hole, both faces of each plant inspected."""
    shape = Polygon(
        [(0, 0), (60, 8), (58, 30), (30, 28), (29, 55), (-4, 50)],
        [[(10, 8), (18, 9), (17, 16), (9, 15)]],
    )
    there = shapely.transform(shape, lambda xy: np.array([34.99, 29.95]) + xy / METRES)
    field = Field("L", MultiPolygon([there]))
    return day(lay(field, Planting(faces=2, plant_spacing_m=2.0)), hours=1.75)


@cache
def in_blocks():
    """Return a day on a plot of two blocks, each with rows of its own."""
    shape = Polygon([(0, 0), (60, 0), (60, 15), (15, 15), (15, 70), (0, 70)])
    there = shapely.transform(shape, lambda xy: np.array([8.0, 47.0]) + xy / (76_000, 111_200))
    field = Field("L", MultiPolygon([there]))
    whole = replace(field, blocks=blocks_from_outline(field))
    return day(lay(whole, Planting(row_spacing_m=3.0, plant_spacing_m=1.5)), hours=3.0)


NAMES = ("1", "2", "5A", "=<Top> 7/8", "4", "5")


def with_names(grid):
    """Return a grid of six rows with names, of which two have no number of their own."""
    numbers = np.array([1, 2, 101, 102, 4, 5])
    called = np.stack([numbers, numbers], axis=1)
    return replace(grid, line_called=called, line_named=np.array(NAMES))


@cache
def with_named_rows():
    """Return a day on a plot whose file names rows, two of them without a number of their own."""
    return day(with_names(rectangle(6, 9)))


@cache
def among_trees():
    """Return a day among trees that stand in no rows."""
    places = np.random.default_rng(0).permutation(np.indices((7, 7)).reshape(2, -1).T)[:40] * 6.0
    places += np.random.default_rng(1).uniform(-1.5, 1.5, places.shape)
    return day(Plot.among("park", Frame(8.0, 47.0).lonlat(places)).grid)


@cache
def of_team():
    """Return the day of one of a team, with a time zone and what no other route can exceed."""
    plan = day(rectangle(6, 9), start=START.replace(tzinfo=ZoneInfo("Asia/Kathmandu")))
    route = replace(plan.route, found_bound=plan.route.expected_finds + 0.123456)
    return HandoffPlan(route, replace(plan.notes, who="Дана & =1"))


@cache
def without_start():
    """Return a day of which nobody said when it begins."""
    return day(rectangle(4, 6), start=None)


DAYS = {"usual": usual, "long": long, "empty": empty, "crooked": crooked}


def apart_m(lonlat, other):
    """Return how far apart positions in degrees are, in metres."""
    here, there = (np.asarray(places, float).reshape(-1, 2) for places in (lonlat, other))
    assert here.shape == there.shape
    step = (here - there) * METRES
    return np.hypot(*step.T).max(initial=0.0)
