"""A day as GPX 1.1: a waypoint for every stop, the route to follow, the track to see."""

from __future__ import annotations

from datetime import UTC
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import numpy as np

from fieldmon.compute.wording import chance_figure, written
from fieldmon.io.writers.day_file import DECIMALS, add_text, pieces
from fieldmon.io.writers.geojson import summary
from fieldmon.plot.projection import goes_round

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.writers.day_file import HandoffPlan, Stop

#: many handhelds read a route or a track up to here, and drop the rest without a word
MOST_POINTS = 250
_NAMESPACE = "http://www.topografix.com/GPX/1/1"
_SCHEMA = f"{_NAMESPACE} http://www.topografix.com/GPX/1/1/gpx.xsd"
_INSTANCE = "http://www.w3.org/2001/XMLSchema-instance"


def route_gpx(plan: HandoffPlan) -> bytes:
    """Return a day as GPX 1.1, its elements in the order that the schema demands.

    Waypoints lie at the plants. Route and track run along the driven line, so that a handheld that
    goes straight from point to point crosses no row; both are cut after `MOST_POINTS` points, and
    each piece begins where the one before it ends. Times in GPX are UTC: that of the start is
    written where it is known; the local arrival stands in each waypoint's description, since a
    waypoint's time would say that somebody was there.
    """
    ET.register_namespace("", _NAMESPACE)
    root = ET.Element(
        "gpx",
        {
            "xmlns": _NAMESPACE,
            "xmlns:xsi": _INSTANCE,
            "xsi:schemaLocation": _SCHEMA,
            "version": "1.1",
            "creator": "fieldmon",
        },
    )
    _metadata(ET.SubElement(root, "metadata"), plan)
    for stop in plan.stops:
        _waypoint(ET.SubElement(root, "wpt", _place(stop.lon, stop.lat)), stop)
    names = {stop.vertex: stop.label for stop in plan.stops}
    runs = pieces(len(plan.line_lonlat), MOST_POINTS)
    for part, run in enumerate(runs, 1):
        route = _part(root, "rte", plan, part, len(runs))
        for vertex in range(run.start, run.stop):
            point = ET.SubElement(route, "rtept", _place(*plan.line_lonlat[vertex]))
            if vertex in names:
                add_text(point, "name", names[vertex])
    for part, run in enumerate(runs, 1):
        segment = ET.SubElement(_part(root, "trk", plan, part, len(runs)), "trkseg")
        for lon, lat in plan.line_lonlat[run]:
            ET.SubElement(segment, "trkpt", _place(lon, lat))
    written: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return written


def _metadata(metadata: ET.Element, plan: HandoffPlan) -> None:
    figures = summary(plan.route, plan.notes)
    add_text(metadata, "name", plan.title)
    n = figures["stops"]
    stops = f"{n} {written(n, 'stop|stops')}"
    told = f"{stops}, {figures['drive_m']:.0f} m, {figures['seconds']:.0f} s"
    add_text(metadata, "desc", f"{told}. {plan.bound}" if plan.bound else told)
    if plan.begins is not None:
        add_text(metadata, "time", f"{plan.begins.astimezone(UTC):%Y-%m-%dT%H:%M:%SZ}")
    if len(plan.line_lonlat):
        _bounds(metadata, plan)


def _bounds(metadata: ET.Element, plan: HandoffPlan) -> None:
    stops = np.array([(stop.lon, stop.lat) for stop in plan.stops])
    everything: NDArray[np.float64] = np.concatenate([plan.line_lonlat, stops.reshape(-1, 2)])
    if goes_round(np.where(everything[:, 0] >= 180, -180.0, everything[:, 0])):
        return  # bounds from the least to the greatest would go round the earth
    low, high = _place(*everything.min(axis=0)), _place(*everything.max(axis=0))
    corners = {f"min{k}": v for k, v in low.items()} | {f"max{k}": v for k, v in high.items()}
    ET.SubElement(metadata, "bounds", corners)


def _waypoint(waypoint: ET.Element, stop: Stop) -> None:
    arrive = f"arrive {stop.arrive}; " if stop.arrive else f"after {stop.arrive_s:.0f} s; "
    add_text(waypoint, "name", stop.label)
    chance = chance_figure(stop.chance, 1)
    looks = f"stay {stop.look_s:g} s; chance {chance}; detects {stop.detects:.6g}"
    told = f"plant {stop.plant}; {arrive}{looks}"
    # converters and devices keep one of the two, and not the same one
    add_text(waypoint, "cmt", told)
    add_text(waypoint, "desc", told)
    add_text(waypoint, "sym", "Flag, Blue")
    add_text(waypoint, "type", "stop")


def _part(root: ET.Element, kind: str, plan: HandoffPlan, part: int, parts: int) -> ET.Element:
    element = ET.SubElement(root, kind)
    add_text(element, "name", plan.title if parts == 1 else f"{plan.title} {part}/{parts}")
    add_text(element, "number", str(part))
    return element


def _place(lon: float, lat: float) -> dict[str, str]:
    # the schema has longitudes up to, but not including, 180
    return {"lat": f"{lat:.{DECIMALS}f}", "lon": f"{-180.0 if lon >= 180 else lon:.{DECIMALS}f}"}
