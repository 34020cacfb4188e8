"""A treatment as ISO 11783-10 task data (ISOXML), as terminals of tractors read it.

Where to spray is said by polygons, or by a grid of cells in a binary file beside the XML.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.writers.zipped import zipped
from fieldmon.io.writers.zone_cells import ZoneCells

if TYPE_CHECKING:
    from collections.abc import Iterable

    from shapely import MultiPolygon

#: data dictionary identifier 1: setpoint volume per area, counted in 0.01 mm3/m2 (1 l/ha = 10 000)
_VOLUME_PER_AREA, _PER_L_HA = "0001", 10_000
_PARTFIELD, _ZONE = "1", "2"
_OUTER, _INNER = "1", "2"
_MINOR = {3: "3", 4: "3"}
_GRID = "GRD00001"
_MOST_LETTERS = 32  # of a designator, as the standard has it
_END_LETTERS = 10  # that a shortened one keeps of its end


def isoxml_taskdata(
    title: str,
    boundary: MultiPolygon,
    zones: Iterable[MultiPolygon] | ZoneCells,
    rate_l_ha: float,
    product: str,
    *,
    version: int = 4,
) -> bytes:
    """Return a zip with ``TASKDATA/TASKDATA.XML``: a planned task with treatment zones.

    Zone 1 has the rate, zone 0 nothing; where the position is lost or outside the plot the rate
    is 0 too.

    Parameters
    ----------
    title, product
        Names of the plot and of what is sprayed; shortened to 32 letters, as the standard has it.
    boundary
        Lon/lat.
    zones
        Areas, lon/lat, which become polygons; or cells, which become a grid.
    rate_l_ha
        Litres a hectare.
    version
        Major version of the standard, 3 or 4.

    Raises
    ------
    SettingError
        If there is no such version.
    """
    if version not in _MINOR:
        raise SettingError(
            worded(
                "Task data can be of version 3 or 4, but not of {version}.",
                version=version,
            )
        )
    root = ET.Element(
        "ISO11783_TaskData",
        VersionMajor=str(version),
        VersionMinor=_MINOR[version],
        ManagementSoftwareManufacturer="fieldmon",
        ManagementSoftwareVersion="1",
        DataTransferOrigin="1",
    )
    ET.SubElement(root, "PDT", A="PDT1", B=_named(product or "product"))
    name = _named(title)
    area = str(round(area_m2(boundary)))
    partfield = ET.SubElement(root, "PFD", A="PFD1", C=name, D=area)
    _polygons(partfield, boundary, _PARTFIELD)
    task = ET.SubElement(root, "TSK", A="TSK1", B=name, E="PFD1", G="1", H="0", I="0", J="0")
    binary = _treatment_zones(task, zones, rate_l_ha)
    scale = f"{1 / _PER_L_HA:.9f}"
    ET.SubElement(root, "VPN", A="VPN1", B="0", C=scale, D="1", E="l/ha")
    written = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    files = {"TASKDATA.XML": written, **binary}
    return zipped({f"TASKDATA/{name}": data for name, data in files.items()})


def _treatment_zones(
    task: ET.Element, zones: Iterable[MultiPolygon] | ZoneCells, rate_l_ha: float
) -> dict[str, bytes]:
    """Add what is sprayed and what is not; return the grid's binary file, if there is one."""
    _rate(ET.SubElement(task, "TZN", A="0", B="not sprayed"), 0.0)
    treated = ET.SubElement(task, "TZN", A="1", B="zones")
    if not isinstance(zones, ZoneCells):
        for zone in zones:
            _polygons(treated, zone, _ZONE)
        _rate(treated, rate_l_ha)
        return {}
    # of the other kind the cells themselves hold the rates
    _rate(treated, rate_l_ha if zones.kind == 1 else 0.0)
    return {f"{_GRID}.bin": _grid(task, zones, rate_l_ha)}


def _grid(task: ET.Element, cells: ZoneCells, rate_l_ha: float) -> bytes:
    """Add the grid to a task; return its binary file, the southernmost row first."""
    high, wide = cells.sprayed.shape
    if cells.kind == 1:
        data = cells.sprayed.astype(np.uint8).tobytes()
    else:
        rates = np.where(cells.sprayed, round(rate_l_ha * _PER_L_HA), 0)
        data = rates.astype("<i4").tobytes()
    grid = ET.SubElement(
        task, "GRD", A=f"{cells.south:.9f}", B=f"{cells.west:.9f}", C=f"{cells.north_size:.12f}",
        D=f"{cells.east_size:.12f}", E=str(wide), F=str(high), G=_GRID, H=str(len(data)),
        I=str(cells.kind),
    )  # fmt: skip
    if cells.kind == 2:
        grid.set("J", "1")
    return data


def _rate(zone: ET.Element, rate_l_ha: float) -> None:
    value = str(round(rate_l_ha * _PER_L_HA))
    ET.SubElement(zone, "PDV", A=_VOLUME_PER_AREA, B=value, C="PDT1", E="VPN1")


def _polygons(parent: ET.Element, area: MultiPolygon, kind: str) -> None:
    for part in shapely.get_parts(area):
        polygon = ET.SubElement(parent, "PLN", A=kind)
        for ring, way in ((part.exterior, _OUTER), *((hole, _INNER) for hole in part.interiors)):
            line = ET.SubElement(polygon, "LSG", A=way)
            for lon, lat in ring.coords:
                ET.SubElement(line, "PNT", A="2", C=f"{lat:.9f}", D=f"{lon:.9f}")


def _named(text: str) -> str:
    """Return text as a designator: of 32 letters at most, and none that XML forbids.

    Names that are too long keep their end: plots of a file often differ by a number there.
    """
    plain = "".join(letter for letter in text if letter.isprintable())
    if len(plain) <= _MOST_LETTERS:
        return plain
    end = plain[-_END_LETTERS:]
    return f"{plain[: _MOST_LETTERS - 2 - len(end)].rstrip()}..{end.lstrip()}"
