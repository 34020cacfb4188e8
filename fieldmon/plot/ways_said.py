"""What people must know of a driven line: where it leaves the plot, or a robot's body does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import LineString, Point

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import worded
from fieldmon.plot.obstacles import filled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.travel import Aisles

    Float = NDArray[np.float64]

# a lane may lie exactly on the boundary, and a body by a hair over it
_EDGE_M = 0.02
# less of a line is not worth a word
_LEAST_M = 0.1
_LOOKS_M = 0.25


def line_said(aisles: Aisles, line_m: Float) -> tuple[str, ...]:
    """Return in sentences how a driven line ``(m, 2)``, or the body on it, leaves the plot.

    The way from a gate outside to the plot is not meant.
    """
    if len(line_m) < 2 or not np.ptp(line_m, axis=0).any():
        return ()
    area, line = aisles.grid.drivable_m, LineString(line_m)
    entry = shapely.shortest_line(Point(aisles.gate_m), area)
    said = (_outside(area, line, entry), _body_over(aisles, line, entry))
    return tuple(one for one in said if one)


def _outside(area: shapely.Geometry, line: LineString, entry: shapely.Geometry) -> str:
    """Return how much of a line lies outside an area, in a sentence; "" if nothing."""
    known = shapely.union(shapely.buffer(area, _EDGE_M), shapely.buffer(entry, _EDGE_M))
    away = shapely.difference(line, known)
    if away.length < _LEAST_M:
        return ""
    looks = shapely.points(shapely.get_coordinates(shapely.segmentize(away, _LOOKS_M)))
    return worded(
        "{metres} of the way lie outside the plot's boundary, up to {far} from it: within it not "
        "all rows can be reached.",
        metres=distance_figure(float(away.length)),
        far=distance_figure(float(shapely.distance(area, looks).max())),
    )


def _body_over(aisles: Aisles, line: LineString, entry: shapely.Geometry) -> str:
    """Return how far a robot's body reaches over the boundary, in a sentence; "" if nowhere."""
    needs = aisles.clearance
    if needs is None or not needs.half_m:
        return ""
    area = aisles.grid.drivable_m
    edge = shapely.boundary(filled(area))
    on_plot = shapely.intersection(line, area)
    on_plot = shapely.difference(on_plot, shapely.buffer(entry, needs.half_m + _EDGE_M))
    tight = shapely.intersection(on_plot, shapely.buffer(edge, needs.half_m - _EDGE_M))
    if tight.length < _LEAST_M:
        return ""
    return worded(
        "The robot's body reaches up to {far_m:.2f} m over the plot's boundary, on {metres} of the "
        "way: there it has no room for its width.",
        far_m=needs.half_m - float(shapely.distance(tight, edge)),
        metres=distance_figure(float(tight.length)),
    )
