"""Words and numbers on a map: the browser shows as many as have room, the first ones first."""

from __future__ import annotations

from typing import TYPE_CHECKING, NotRequired, TypedDict

import numpy as np
import shapely

from fieldmon.plot.grid import before_rows

from ...words import texts
from .plant_layers import drawn_at

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plot import Plot

    Float = NDArray[np.float64]

#: a place, words and their kind; with `from` and `to`: at these zooms only; with `away` (lon/lat)
#: and `gap` (pixels): beyond the place, in that direction
Label = TypedDict(
    "Label",
    {
        "p": list[float],
        "t": str,
        "k": str,
        "from": NotRequired[float],
        "to": NotRequired[float],
        "away": NotRequired[list[float]],
        "gap": NotRequired[int],
        "row": NotRequired[int],
        "plot": NotRequired[int],
        "tight": NotRequired[bool],
    },
)

# a stop's number has room where plants are this far apart on the screen
_STOP_PX = 16.0
# so far from its place the word beside a ring begins
_RING_PX = 12
# an outline farther than this from the gate or a row's end, in rows, is not that of its headland
_NEAR_ROWS = 4
_EARTH_M, _TILE_PX = 40_075_016.686, 512


def stops(route: Route) -> list[Label]:
    """Return the numbers of legs from far, of stops from near.

    A leg is what is inspected without leaving an aisle, or a stretch of one.
    """
    if not len(route):
        return []
    grid = route.aisles.grid
    lonlat = np.round(drawn_at(grid, route.plant), 7)
    near = _zoom(grid, float(lonlat[0, 1]))
    stretch = grid.stretches[grid.row[route.plant]]
    first = np.flatnonzero(np.append(True, np.diff(stretch) != 0))
    middle = (first + np.append(first[1:], len(route))) // 2
    legs: list[Label] = [
        {"p": lonlat[k].tolist(), "t": f"{number}", "k": "leg", "to": near}
        for number, k in enumerate(middle.tolist(), start=1)
    ]
    own: list[Label] = [
        {"p": place, "t": f"{number}", "k": "stop", "from": near}
        for number, place in enumerate(lonlat.tolist(), start=1)
    ]
    return [*legs, *own]


def rows(grid: PlantGrid) -> list[Label]:
    """Return each row's number beyond its headland; the browser shows those that have room."""
    if not grid.in_rows:
        return []
    line, first = np.unique(grid.row_line, return_index=True)
    plant_m, lane_m = grid.xy_m[grid.row_start[first]], before_rows(grid, first)
    # a lane ends in the middle of the headland, whose end is the outline, or inside it
    out_m = 2.0 * (lane_m - plant_m)
    ahead = out_m / np.maximum(np.hypot(*out_m.T), 1e-9)[:, None]
    out_m += _beyond_outline(grid, plant_m + out_m, ahead)[:, None] * ahead
    ends_m = [plant_m + times * out_m for times in (1.0, 1.5)]
    places = [np.round(grid.frame.lonlat(one), 7).tolist() for one in ends_m]
    return [
        {"p": place, "away": away, "t": sign, "k": "row", "row": at + 1}
        for at, sign, place, away in zip(
            line.tolist(), grid.line_signs.values(), *places, strict=True
        )
    ]


def _beyond_outline(grid: PlantGrid, end_m: Float, ahead: Float) -> Float:
    """Return how far the outline is beyond row ends ``(r, 2)``, as wide as a row; 0: it is there.

    Where it runs askew it is met on both sides of a row, in which a number stands.
    """
    edges = shapely.boundary(grid.drivable_m)
    steps, ring = shapely.get_coordinates(shapely.get_parts(edges), return_index=True)
    inner = ring[1:] == ring[:-1]
    sides = np.array(shapely.linestrings(np.stack([steps[:-1][inner], steps[1:][inner]], axis=1)))
    tree = shapely.STRtree(sides)
    beyond_m = np.zeros(len(end_m))
    for beside in (-0.5, 0.0, 0.5):
        start_m = end_m + beside * grid.row_spacing_m * ahead[:, ::-1] * [-1.0, 1.0]
        stop_m = start_m + _NEAR_ROWS * grid.row_spacing_m * ahead
        rays = np.array(shapely.linestrings(np.stack([start_m, stop_m], axis=1)))
        ray, side = tree.query(rays, predicate="intersects")
        meets = shapely.intersection(rays[ray], sides[side])
        met = shapely.get_coordinates(shapely.centroid(meets))
        far_m = ((met - start_m[ray]) * ahead[ray]).sum(axis=1)
        first_m = np.full(len(end_m), np.inf)
        np.minimum.at(first_m, ray, far_m)
        beyond_m = np.maximum(beyond_m, np.where(np.isfinite(first_m), first_m, 0.0))
    return beyond_m


def places(plot: Plot) -> list[Label]:
    """Return the names of the gate and of areas that are not driven through."""
    grid = plot.grid
    # beside the ring of the gate, away from the rows, beyond the outline if that is near
    x, y = plot.aisles.gate_m
    side = 1.0 if y > grid.xy_m[:, 1].mean() else -1.0
    out = side * _to_outline(plot, (x, y), side * _NEAR_ROWS * grid.row_spacing_m)
    ends_m = np.array([[x, y + out], [x, y + out + side]])
    at, away = np.round(grid.frame.lonlat(ends_m), 7).tolist()
    gate: Label = {"p": at, "away": away, "gap": _RING_PX, "t": texts.LABEL_GATE, "k": "gate"}
    inner = shapely.point_on_surface(shapely.get_parts(plot.field.no_go))
    no_go = np.round(shapely.get_coordinates(inner), 7).tolist()
    inside: list[Label] = [{"p": p, "t": texts.LABEL_NO_GO, "k": "place"} for p in no_go]
    return [gate, *inside]


def _to_outline(plot: Plot, place_m: tuple[float, float], far_m: float) -> float:
    """Return how far the outline is from a place in y; 0: farther than `far_m`."""
    x, y = place_m
    edge = shapely.transform(plot.field.boundary.boundary, plot.grid.frame.xy_m)
    met = shapely.get_coordinates(edge.intersection(shapely.LineString([(x, y), (x, y + far_m)])))
    return float(np.abs(met[:, 1] - y).max()) if len(met) else 0.0


def blocks(grid: PlantGrid) -> list[Label]:
    """Return each block's name in its middle, where there are several."""
    if grid.block is None or grid.n_blocks < 2:
        return []
    of_plant = grid.block[grid.row]
    middles = [grid.xy_m[of_plant == k].mean(axis=0) for k in range(grid.n_blocks)]
    lonlat = np.round(grid.frame.lonlat(np.array(middles)), 7).tolist()
    return [
        {"p": p, "t": texts.LABEL_BLOCK.format(n=k), "k": "block"}
        for k, p in enumerate(lonlat, start=1)
    ]


def _zoom(grid: PlantGrid, lat: float) -> float:
    """Return the zoom from which stops are numbered."""
    metres_per_px = grid.plant_spacing_m / _STOP_PX
    return float(np.log2(_EARTH_M * np.cos(np.deg2rad(lat)) / (_TILE_PX * metres_per_px)))
