"""Random plots in which something stands in the aisles, and which plants a wide robot can reach.

The latter knows nothing of rows in pieces: it asks for a connected free area.
"""

import numpy as np
import shapely
from shapely import MultiPolygon, box

from fieldmon.plot.clear_lanes import REACH_M, lane_lines
from fieldmon.plot.field import Field
from fieldmon.plot.layout import grid_from_plants
from fieldmon.plot.obstacles import row_lines
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles

FRAME = Frame(35.15, 30.36)
WIDE = Robot(width_m=1.1, length_m=1.4)
#: how far ways of `WIDE` keep off what stands in an aisle
OFF_M = 0.65
#: and off rows, with usual canopies
WAY_M = 0.9
ROW_M, PLANT_M = 4.0, 2.0
# by so much less or more the reach of plants is asked
SLACK_M = 0.06


def on_plot(area):
    return MultiPolygon(list(shapely.get_parts(FRAME.geometry_lonlat(area))))


def cut_plot(seed, *, n_rows=5, n_plants=14, faces=1, robot=WIDE):
    """Return the ways of a wide robot and of one without a width, and what stands in the aisles."""
    rng = np.random.default_rng(seed)
    long_m = PLANT_M * (n_plants - 1)
    x, y = np.meshgrid(np.arange(n_plants) * PLANT_M, np.arange(n_rows) * ROW_M)
    there = np.ones(x.size, bool)
    if rng.random() < 0.3:
        there = rng.random(x.size) < 0.9
    sheds = []
    for k in range(rng.integers(1, 4)):
        middle_m = (rng.integers(0, n_rows - 1) + 0.5) * ROW_M
        begins_m = rng.uniform(0.2, 0.6) * long_m if k == 0 else rng.uniform(0.0, long_m)
        ends_m, gap_m = begins_m + rng.uniform(0.3, 5.0), rng.uniform(0.05, 0.5)
        # in the upper or lower half of the aisle: a robot without a width passes beside it
        low, high = np.sort(middle_m + (1 if rng.random() < 0.5 else -1) * np.array([gap_m, 1.4]))
        sheds.append(box(begins_m, low, ends_m, high))
    shut = shapely.union_all(sheds)
    area = shapely.difference(box(-6, -6, long_m + 6, (n_rows - 1) * ROW_M + 6), shut)
    field = Field("plot", on_plot(area))
    lonlat = FRAME.lonlat(np.stack([x.ravel(), y.ravel()], axis=1)[there])
    grid = grid_from_plants(lonlat, Planting(row_bearing_deg=90.0, faces=faces), field)
    aisles = Aisles.of(grid)
    return aisles.for_robot(robot), aisles, grid.frame.geometry_m(on_plot(shut))


def reachable(aisles, point, shed_m, off_rows_m, lanes):
    """Return which lanes ``(n,)`` a wide robot gets to whose middle keeps so far off rows."""
    rows = shapely.union_all(
        [shapely.buffer(line, off_rows_m, cap_style="flat") for line in row_lines(point.grid)]
    )
    shut = shapely.union(shapely.buffer(shed_m, OFF_M), rows)
    parts = shapely.get_parts(shapely.difference(point.grid.drivable_m, shut))
    own = parts[np.argmin(shapely.distance(parts, shapely.Point(aisles.gate_m)))]
    return shapely.intersects(lanes, own)


def surely_reachable(aisles, point, shed_m):
    """Return which plants ``(n,)`` a robot gets to that stays in the middle of its aisles."""
    lanes = shapely.intersection(
        lane_lines(point.grid)[point.grid.row], _about(point.grid, -SLACK_M)
    )
    return reachable(aisles, point, shed_m, ROW_M / 2 - 0.01, lanes)


def perhaps_reachable(aisles, point, shed_m):
    """Return which plants ``(n,)`` it gets to at most, though it drives wherever there is room."""
    return reachable(aisles, point, shed_m, WAY_M - 0.05, _about(point.grid, SLACK_M))


def _about(grid, slack_m):
    """Return for each plant the places in its aisle from which it is inspected."""
    at = np.stack([grid.xy_m[:, 0], grid.stop_m[:, 1]], axis=1)[:, None]
    reach = np.array([[-1.0, 0.0], [1.0, 0.0]]) * (REACH_M + slack_m)
    return shapely.linestrings(at + reach)
