"""The route on a map: its line, its direction, where it begins, and what plays it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pydeck import Layer

from ...words import texts
from .colours import CASING, CASING_IN_DARK, GATE, ROUTE, ROUTE_IN_DARK
from .plant_layers import drawn_at

if TYPE_CHECKING:
    from datetime import datetime

    from fieldmon.planning.route import Route
    from fieldmon.plot.travel import Aisles

_ARROWS = 40


def route(the_route: Route, *, dark: bool = False) -> list[Layer]:
    """Return the driven line in its casing, and arrows in its direction."""
    if not len(the_route):
        return []
    colour = list(ROUTE_IN_DARK if dark else ROUTE)
    line = np.round(the_route.line_lonlat(), 7).tolist()
    return [
        Layer(
            "PathLayer", [{"path": line}], id="casing", get_path="path",
            get_color=[*(CASING_IN_DARK if dark else CASING), 255], get_width=1.6,
            width_min_pixels=2.4, width_max_pixels=6, joint_rounded=True, cap_rounded=True,
        ),
        Layer(
            "PathLayer", [{"path": line}], id="route", get_path="path", get_color=colour,
            get_width=0.8, width_min_pixels=1.3, width_max_pixels=3, joint_rounded=True,
        ),
        Layer(
            "PolygonLayer", _arrows(the_route), id="arrows", get_polygon="a",
            get_fill_color=colour, stroked=False,
        ),
    ]  # fmt: skip


def gate(aisles: Aisles) -> Layer:
    """Return the ring of the gate, where each day begins and ends."""
    place = aisles.grid.frame.lonlat(aisles.gate_m)[0].tolist()
    return Layer(
        "ScatterplotLayer", [{"p": place, "t": texts.TIP_GATE}], id="gate",
        get_position="p", get_radius=3, radius_min_pixels=7,
        # from near, it would cover a small plot
        radius_max_pixels=14, filled=True,
        get_fill_color=[255, 255, 255], stroked=True, get_line_color=list(GATE),
        line_width_min_pixels=4, line_width_max_pixels=4,
    )  # fmt: skip


def _arrows(the_route: Route) -> list[dict[str, list[list[float]]]]:
    """Return triangles at even distances along the line, pointing the way it is driven."""
    line = the_route.line_m
    step = np.diff(line, axis=0)
    length = np.hypot(*step.T)
    way = np.append(0.0, np.cumsum(length))
    if not way[-1]:  # the one stop is where the day begins: there is no way to point
        return []
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
    return [{"a": corner} for corner in lonlat.tolist()]


def playback(the_route: Route, begins: datetime) -> dict[str, object] | None:
    """Return what plays the day on the map: where who drives is at which second, and the stops."""
    if not len(the_route):
        return None
    midnight = begins.replace(hour=0, minute=0, second=0, microsecond=0)
    # each stop twice, on arrival and on leaving: nobody creeps on while a plant is inspected
    after, at_stop = the_route.line_stop + 1, the_route.line_stop
    line, line_s = the_route.line_lonlat(), the_route.line_s
    line = np.insert(line, after, line[at_stop], axis=0)
    line_s = np.insert(line_s, after, the_route.leave_s)
    return {
        "line": np.round(line, 7).tolist(),
        "at_s": np.round(line_s, 1).tolist(),
        "stops": np.round(drawn_at(the_route.aisles.grid, the_route.plant), 7).tolist(),
        "leave_s": np.round(the_route.leave_s, 1).tolist(),
        "starts_s": (begins - midnight).total_seconds(),
    }
