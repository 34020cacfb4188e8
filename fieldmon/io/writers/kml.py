"""A day as KML 2.2: the stops and the driven line, for Google Earth and map apps on phones."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from fieldmon.compute.wording import chance_figure, written
from fieldmon.io.writers.day_file import DECIMALS, add_text
from fieldmon.io.writers.geojson import summary

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.io.writers.day_file import HandoffPlan, Stop

_NAMESPACE = "http://www.opengis.net/kml/2.2"
_LINE_COLOUR = "ff0080ff"  # opacity, blue, green, red: orange
_STOP_COLOUR = "ff00d7ff"  # yellow


def route_kml(plan: HandoffPlan) -> bytes:
    """Return a day as KML, the elements of each feature in the order of OGC 07-147r2.

    Arrivals are local times without a zone, as KML allows. The empty ``found``, ``count`` and
    ``notes`` of each stop can be filled in where an app edits extended data.
    """
    ET.register_namespace("", _NAMESPACE)
    root = ET.Element("kml", {"xmlns": _NAMESPACE})
    document = ET.SubElement(root, "Document")
    figures = summary(plan.route, plan.notes)
    add_text(document, "name", plan.title)
    n = figures["stops"]
    told = f"{n} {written(n, 'stop|stops')}, {figures['drive_m']:.0f} m"
    add_text(document, "description", f"{told}. {plan.bound}" if plan.bound else told)
    _styles(document)
    if len(plan.line_lonlat) > 1:
        line = ET.SubElement(document, "Placemark", {"id": "route"})
        add_text(line, "name", plan.title)
        add_text(line, "styleUrl", "#driven")
        shape = ET.SubElement(line, "LineString")
        add_text(shape, "tessellate", "1")
        add_text(shape, "coordinates", _coordinates(plan.line_lonlat))
    folder = ET.SubElement(document, "Folder")
    add_text(folder, "name", "stops")
    for stop in plan.stops:
        _stop(ET.SubElement(folder, "Placemark", {"id": f"stop-{stop.order}"}), stop, plan)
    made: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return made


def _styles(document: ET.Element) -> None:
    driven = ET.SubElement(ET.SubElement(document, "Style", {"id": "driven"}), "LineStyle")
    add_text(driven, "color", _LINE_COLOUR)
    add_text(driven, "width", "3")
    # no address of a picture: without the internet it would be a red cross, or nothing
    icon = ET.SubElement(ET.SubElement(document, "Style", {"id": "stop"}), "IconStyle")
    add_text(icon, "color", _STOP_COLOUR)
    add_text(icon, "scale", "0.6")


def _stop(placemark: ET.Element, stop: Stop, plan: HandoffPlan) -> None:
    add_text(placemark, "name", stop.label)
    add_text(
        placemark, "description", f"stay {stop.look_s:g} s; chance {chance_figure(stop.chance, 1)}"
    )
    if stop.arrive:
        add_text(ET.SubElement(placemark, "TimeStamp"), "when", stop.arrive)
    add_text(placemark, "styleUrl", "#stop")
    extended = ET.SubElement(placemark, "ExtendedData")
    values = {
        "stop": stop.order,
        "plant": stop.plant,
        **({"block": stop.block} if plan.has_blocks else {}),
        **({"row": stop.row} if plan.in_rows else {}),
        **({"row_name": stop.row_name} if plan.has_row_names else {}),
        "number": stop.number,
        **({"face": stop.face} if plan.has_faces else {}),
        "arrive_s": stop.arrive_s,
        "inspect_s": stop.inspect_s,
        "chance": stop.chance,
        "detects": stop.detects,
        "found": "",
        "count": "",
        "who": plan.notes.who or "",
        "notes": "",
    }
    for name, value in values.items():
        add_text(ET.SubElement(extended, "Data", {"name": name}), "value", str(value))
    point = ET.SubElement(placemark, "Point")
    add_text(point, "coordinates", f"{stop.lon:.{DECIMALS}f},{stop.lat:.{DECIMALS}f}")


def _coordinates(lonlat: NDArray[np.float64]) -> str:
    return " ".join(f"{lon:.{DECIMALS}f},{lat:.{DECIMALS}f}" for lon, lat in lonlat.tolist())
