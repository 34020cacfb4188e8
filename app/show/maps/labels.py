"""Words and numbers on a map: the browser shows as many as have room, the first ones first."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from fieldmon.plot.grid import before_rows

from ...words import texts

if TYPE_CHECKING:
    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plot import Plot

    #: ``{"p": [lon, lat], "t": words, "k": kind}``; with ``from``, ``to``: at these zooms only
    Label = dict[str, Any]

# a stop's number has room where plants are this far apart on the screen
_STOP_PX = 16.0
_EARTH_M, _TILE_PX = 40_075_016.686, 512


def stops(route: Route) -> list[Label]:
    """Return the numbers of legs from far, of stops from near.

    A leg is what is inspected without leaving an aisle.
    """
    if not len(route):
        return []
    grid = route.aisles.grid
    lonlat = np.round(route.stops_lonlat(), 7)
    near = _zoom(grid, float(lonlat[0, 1]))
    aisle = grid.corridor[grid.row[route.plant]]
    first = np.flatnonzero(np.append(True, np.diff(aisle) != 0))
    middle = (first + np.append(first[1:], len(route))) // 2
    legs = [
        {"p": lonlat[k].tolist(), "t": f"{number}", "k": "leg", "to": near}
        for number, k in enumerate(middle.tolist(), start=1)
    ]
    own = [
        {"p": place, "t": f"{number}", "k": "stop", "from": near}
        for number, place in enumerate(lonlat.tolist(), start=1)
    ]
    return [*legs, *own]


def rows(grid: PlantGrid) -> list[Label]:
    """Return each row's number before its first plant, every tenth row before the others."""
    if not grid.in_rows:
        return []
    line, first = np.unique(grid.row_line, return_index=True)
    before_m = before_rows(grid, first, 1.5 * grid.plant_spacing_m)
    lonlat = np.round(grid.frame.lonlat(before_m), 7).tolist()
    made = [
        {"p": place, "t": f"{number + 1}", "k": "row", "row": number + 1}
        for number, place in zip(line.tolist(), lonlat, strict=True)
    ]
    tens = {"0", "1"}
    return sorted(made, key=lambda one: (one["t"][-1] not in tens, one["t"][-1] != "5"))


def places(plot: Plot) -> list[Label]:
    """Return the names of the gate and of areas that are not driven through."""
    grid, gap = plot.grid, 1.5 * plot.grid.row_spacing_m
    # beside the ring of the gate, away from the rows
    x, y = plot.aisles.gate_m
    gate = grid.frame.lonlat(np.array([[x, y - gap if y < grid.xy_m[:, 1].mean() else y + gap]]))
    named = [(gate[0], texts.LABEL_GATE)]
    inner = shapely.point_on_surface(shapely.get_parts(plot.field.no_go))
    named += [(place, texts.LABEL_NO_GO) for place in shapely.get_coordinates(inner)]
    return [{"p": np.round(p, 7).tolist(), "t": said, "k": "place"} for p, said in named]


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
