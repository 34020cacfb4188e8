"""Days to hand off, for the tests of every format."""

from datetime import datetime
from functools import cache

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from fieldmon.io.writers import HandoffPlan
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import plan_work
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
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


DAYS = {"usual": usual, "long": long, "empty": empty, "crooked": crooked}


def apart_m(lonlat, other):
    """Return how far apart positions in degrees are, in metres."""
    here, there = (np.asarray(places, float).reshape(-1, 2) for places in (lonlat, other))
    assert here.shape == there.shape
    step = (here - there) * METRES
    return np.hypot(*step.T).max(initial=0.0)
