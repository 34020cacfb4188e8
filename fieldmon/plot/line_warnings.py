"""What people must know of a driven line: where it leaves the plot, or a robot's body does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import LineString, Point

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import worded
from fieldmon.plot.obstacles import filled, off_limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.clearance import Clearance
    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]

# a lane may lie exactly on the boundary, and a body by a hair over it
_EDGE_M = 0.02
# less of a line is not worth a word
_LEAST_M = 0.1
_LOOKS_M = 0.25


def line_said(
    grid: PlantGrid,
    places: tuple[Float, shapely.Geometry | None],
    needs: Clearance | None,
    line_m: Float,
) -> tuple[str, ...]:
    """Return in sentences how a driven line ``(m, 2)``, or the body on it, leaves the plot.

    `places` are the gate, and where nobody may drive. The way from a gate outside to the plot is
    not meant.
    """
    gate_m, no_go_m = places
    if len(line_m) < 2 or not np.ptp(line_m, axis=0).any():
        return ()
    area, line = grid.drivable_m, LineString(line_m)
    entry = shapely.shortest_line(Point(gate_m), area)
    half_m = 0.0 if needs is None else needs.half_m
    said = [_outside(area, line, entry), _body_over(area, half_m, line, entry)]
    if needs is not None and not grid.in_rows:
        said.append(_near_plants(grid, needs.way_m, line))
    if needs is not None and needs.off_m:
        off = off_limits(grid, no_go_m, needs.off_m)
        said.append(
            _near_holes(
                shapely.difference(off, shapely.buffer(entry, needs.off_m)), needs.off_m, line
            )
        )
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


def _near_plants(grid: PlantGrid, way_m: float, line: LineString) -> str:
    """Return how much of a line comes too near to plants in no rows, in a sentence; or ""."""
    plants = shapely.union_all(shapely.buffer(shapely.points(grid.xy_m), way_m - _EDGE_M))
    near = shapely.intersection(line, plants)
    if near.length < _LEAST_M:
        return ""
    return worded(
        "Among plants in no rows, ways keep no width off plants: on {metres} of the way the robot "
        "comes nearer than {way_m:.2f} m to the middle of one.",
        metres=distance_figure(float(near.length)),
        way_m=way_m,
    )


def _near_holes(off: shapely.Geometry, off_m: float, line: LineString) -> str:
    """Return how much of a line comes too near to holes, in a sentence; "" if nothing."""
    near = shapely.intersection(line, shapely.buffer(off, -2 * _EDGE_M))
    if near.length < _LEAST_M:
        return ""
    return worded(
        "On {metres} of the way the robot comes nearer than {off_m:.2f} m to a hole or a no-go "
        "area, or over a hole: no other way leads there.",
        metres=distance_figure(float(near.length)),
        off_m=off_m,
    )


def _body_over(
    area: shapely.Geometry, half_m: float, line: LineString, entry: shapely.Geometry
) -> str:
    """Return how far a robot's body reaches over the boundary, in a sentence; "" if nowhere."""
    if not half_m:
        return ""
    edge = shapely.boundary(filled(area))
    on_plot = shapely.intersection(line, area)
    on_plot = shapely.difference(on_plot, shapely.buffer(entry, half_m + _EDGE_M))
    tight = shapely.intersection(on_plot, shapely.buffer(edge, half_m - _EDGE_M))
    if tight.length < _LEAST_M:
        return ""
    return worded(
        "The robot's body reaches up to {far_m:.2f} m over the plot's boundary, on {metres} of the "
        "way: there it has no room for its width.",
        far_m=half_m - float(shapely.distance(tight, edge)),
        metres=distance_figure(float(tight.length)),
    )
