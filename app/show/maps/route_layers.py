"""The route on a map: its line, its direction, its stops, and how far it is driven by a moment."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from pydeck import Layer

from ...words import texts
from .colours import GATE, ROUTE, ROUTE_IN_DARK

if TYPE_CHECKING:
    from fieldmon.planning.route import Route

_ARROWS = 40
_NUMBERS = 24
# how large a stop's number is, and how long the route on a small map
_NUMBER_PX, _ROUTE_PX = (30, 17), 300


def route(the_route: Route, *, numbers: bool = True, dark: bool = False) -> list[Layer]:
    """Return the driven line with arrows in its direction, the gate, and stop numbers."""
    if not len(the_route):
        return []
    colour = list(ROUTE_IN_DARK if dark else ROUTE)
    line = np.round(the_route.line_lonlat(), 7).tolist()
    gate = the_route.aisles.grid.frame.lonlat(the_route.aisles.gate_m)[0].tolist()
    layers = [
        Layer(
            "PathLayer", [{"path": line}], id="route", get_path="path", get_color=[*colour, 190],
            get_width=0.5, width_min_pixels=1.5,
        ),
        Layer(
            "PolygonLayer", _arrows(the_route), id="arrows", get_polygon="p",
            get_fill_color=colour, stroked=False,
        ),
        Layer(
            "ScatterplotLayer", [{"p": gate, "t": texts.TIP_GATE}], id="gate",
            get_position="p", get_radius=3, radius_min_pixels=7, filled=False, stroked=True,
            get_line_color=list(GATE), line_width_min_pixels=3, pickable=True,
        ),
    ]  # fmt: skip
    return [*layers, *_numbers(the_route)] if numbers else layers


def _numbers(the_route: Route) -> list[Layer]:
    n = len(the_route)
    every = max(1, int(np.ceil(n / _NUMBERS)))
    lonlat = the_route.stops_lonlat()
    span = np.ptp(lonlat, axis=0)
    # as wide and as high as a number where the whole route is in view, in degrees
    flat = np.cos(np.radians(lonlat[0, 1]))
    room = max(span[0] * flat, span[1]) / _ROUTE_PX * np.array(_NUMBER_PX) / [flat, 1.0]
    shown: list[int] = []
    for k in (0, n - 1, *range(every, n - 1, every)):
        if k not in shown and not (np.abs(lonlat[shown] - lonlat[k]) < room).all(axis=1).any():
            shown.append(k)
    here = np.round(lonlat[shown], 7).tolist()
    rows = [{"p": p, "n": str(k + 1)} for p, k in zip(here, shown, strict=True)]
    return [
        Layer(
            "TextLayer", rows, id="numbers", get_position="p", get_text="n", get_size=12,
            get_color=[10, 30, 90], background=True, get_background_color=[255, 255, 255, 220],
            background_padding=[3, 1],
        )
    ]  # fmt: skip


def _arrows(the_route: Route) -> list[dict[str, Any]]:
    """Return triangles at even distances along the line, pointing the way it is driven."""
    line = the_route.line_m
    step = np.diff(line, axis=0)
    length = np.hypot(*step.T)
    way = np.append(0.0, np.cumsum(length))
    at = (np.arange(_ARROWS) + 0.5) / _ARROWS * way[-1]
    leg = np.searchsorted(way, at, side="right") - 1
    ahead = step[leg] / length[leg][:, None]
    left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    tip = line[leg] + ahead * (at - way[leg])[:, None]
    size = np.clip(np.hypot(*np.ptp(line, axis=0)) / 90.0, 0.4, 6.0)
    corners = np.stack(
        [tip + ahead * size, tip - ahead * size + left * size * 0.7,
         tip - ahead * size - left * size * 0.7], axis=1
    )  # fmt: skip
    frame = the_route.aisles.grid.frame
    lonlat = np.round(frame.lonlat(corners.reshape(-1, 2)), 7).reshape(-1, 3, 2)
    return [{"p": corner} for corner in lonlat.tolist()]


def playback(the_route: Route, second: float, *, dark: bool = False) -> list[Layer]:
    """Return the line driven up to a second of the day, the stops made, and the robot."""
    if not len(the_route):
        return []
    line, at_s = the_route.line_lonlat(), the_route.line_s
    gone = int(np.searchsorted(at_s, second, side="right"))
    here = [float(np.interp(second, at_s, line[:, axis])) for axis in (0, 1)]
    path = [*np.round(line[:gone], 7).tolist(), here]
    done = the_route.leave_s <= second
    colour = ROUTE_IN_DARK if dark else ROUTE
    stops = np.round(the_route.stops_lonlat()[done], 7).tolist()
    return [
        Layer(
            "PathLayer", [{"path": path}], id="trail", get_path="path",
            get_color=[*colour, 230], get_width=0.6, width_min_pixels=2.5,
        ),
        Layer(
            "ScatterplotLayer", [{"p": p} for p in stops], id="stops", get_position="p",
            get_fill_color=[*colour, 150], get_radius=0.5, radius_min_pixels=2,
        ),
        Layer(
            "ScatterplotLayer", [{"p": here, "t": texts.TIP_HERE}], id="robot", get_position="p",
            get_fill_color=[255, 210, 0], get_radius=1.5, radius_min_pixels=8, stroked=True,
            get_line_color=[0, 0, 0], line_width_min_pixels=3, pickable=True,
        ),
    ]  # fmt: skip
