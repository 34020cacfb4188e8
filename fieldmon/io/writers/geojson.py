"""A day's route as GeoJSON (RFC 7946): the driven line, and the stops in order."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.io.writers.day_file import DECIMALS
from fieldmon.plot.grid import block_number, plant_numbers
from fieldmon.plot.local_clock import grid_clock
from fieldmon.plot.projection import goes_round

if TYPE_CHECKING:
    from datetime import datetime

    from numpy.typing import NDArray

    from fieldmon.infestation.forecast import Forecast
    from fieldmon.io.writers.day_file import DrivenRoute, HandoffPlan, RouteNotes
    from fieldmon.plot.grid import PlantGrid

_AHEAD = ("expected", "low", "high")


def summary(route: DrivenRoute, notes: RouteNotes) -> dict[str, Any]:
    """Return the figures of a route: stops, seconds, metres, expected finds, their bound."""
    grid = route.aisles.grid
    return {
        "plot": notes.plot,
        "sampler": notes.sampler,
        **({} if notes.who is None else {"who": notes.who}),
        "stops": len(route),
        "seconds": round(route.end_s, 3),
        "drive_m": round(route.drive_m, 3),
        "inspect_s": round(float((route.leave_s - route.arrive_s).sum()), 3),
        "infested_expected": round(float(route.believed.sum()), 3),
        **_bound(route),
        **({} if notes.start is None else {"start": _clock(grid, notes.start, 0.0)}),
        **({} if notes.start is None else {"end": _clock(grid, notes.start, route.end_s)}),
    }


def _ahead(ahead: Forecast) -> dict[str, Any]:
    """Return the infested plants of the next mornings, this evening's first."""
    columns = {name: getattr(ahead, name).round(1).tolist() for name in _AHEAD}
    return {**columns, "chance": 0.9, "basis": ahead.basis()}


def _bound(route: DrivenRoute) -> dict[str, Any]:
    """Return what is expected to be found and what no other route can exceed, if it is known."""
    if route.found_bound is None:
        return {}
    return {
        "finds_expected": round(route.expected_finds, 3),
        "finds_bound": math.ceil(1000.0 * route.found_bound) / 1000.0,
        "bound": route.bound_sentence,
    }


def route_geojson(route: DrivenRoute, notes: RouteNotes) -> str:
    """Return a route as GeoJSON text: first the driven line, then a point for every stop.

    A stop lies at its plant; its ``line_vertex`` tells where on the line the robot stands for it.
    ``found``, ``count``, ``who`` and ``notes`` are empty, to be filled in by whoever inspects;
    of one of a team ``who`` is its name. ``detects`` comes back with them: the chance to see an
    infested plant, by which a season reads them.
    """
    line_lonlat = np.round(route.line_lonlat(), DECIMALS)
    features = [_line_feature(route, notes, line_lonlat), *_stop_features(route, notes)]
    collection: dict[str, Any] = {"type": "FeatureCollection", "features": features}
    everything = np.concatenate([line_lonlat, np.round(route.stops_lonlat(), DECIMALS)])
    if len(everything):
        collection["bbox"] = _bbox(everything)
    return json.dumps(collection, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def _bbox(lonlat: NDArray[np.float64]) -> list[float]:
    """Return west, south, east, north; across longitude 180 west is the greater (RFC 7946, 5.2)."""
    lon, lat = lonlat.T
    west, east = lon.min(), lon.max()
    if goes_round(lon):
        west, east = lon[lon > 0].min(), lon[lon < 0].max()
    return [float(one) for one in (west, lat.min(), east, lat.max())]


def handed_geojson(plan: HandoffPlan) -> bytes:
    """Return a day to hand off as GeoJSON; see `route_geojson`."""
    return route_geojson(plan.route, plan.notes).encode()


def _line_feature(
    route: DrivenRoute, notes: RouteNotes, line_lonlat: NDArray[np.float64]
) -> dict[str, Any]:
    # a line needs two positions; a day without stops has no line
    line = line_lonlat.tolist() if len(line_lonlat) > 1 else None
    return {
        "type": "Feature",
        "id": "route",
        "geometry": line and {"type": "LineString", "coordinates": line},
        "properties": {
            "kind": "route",
            **summary(route, notes),
            **({} if notes.ahead is None else {"forecast": _ahead(notes.ahead())}),
            "vertex_s": np.round(route.line_s, 3).tolist(),
        },
    }


def _stop_features(route: DrivenRoute, notes: RouteNotes) -> list[dict[str, Any]]:
    grid = route.aisles.grid
    numbered, names = plant_numbers(grid, route.plant), grid.row_names if grid.in_rows else {}
    columns = zip(
        route.stops_lonlat().round(DECIMALS).tolist(),
        route.plant.tolist(),
        numbered.line.tolist(),
        numbered.number.tolist(),
        route.arrive_s.tolist(),
        route.leave_s.tolist(),
        route.believed.tolist(),
        route.detects.tolist(),
        route.line_stop.tolist(),
        block_number(grid, route.plant).tolist(),
        strict=True,
    )
    return [
        {
            "type": "Feature",
            "id": f"stop-{order}",
            "geometry": {"type": "Point", "coordinates": place},
            "properties": {
                "kind": "stop",
                "order": order,
                "plant": plant,
                **({"block": block} if grid.n_blocks > 1 else {}),
                **({"row": row} if grid.in_rows else {}),
                **({"row_name": names.get(row, "")} if names else {}),
                "number": number,
                "arrive_s": round(arrive_s, 3),
                **({} if notes.start is None else {"arrive": _clock(grid, notes.start, arrive_s)}),
                "inspect_s": round(leave_s - arrive_s, 3),
                "chance": round(chance, 6),
                "detects": round(sees, 6),
                "line_vertex": vertex,
                "found": None,
                "count": None,
                "who": notes.who,
                "notes": None,
            },
        }
        for order, (place, plant, row, number, arrive_s, leave_s, chance, sees, vertex, block) in (
            enumerate(columns, 1)
        )
    ]


def _clock(grid: PlantGrid, start: datetime, seconds: float) -> str:
    return grid_clock(grid).after(start, round(seconds)).isoformat()
