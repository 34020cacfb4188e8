"""Positions of plants, lines of rows and paths, and positions out of the columns of a table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiLineString

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.geodata.columns import find
from fieldmon.geodata.findings import Finding, Imported, dropped, seen
from fieldmon.geodata.geometry import sort_out
from fieldmon.geodata.layers import Layer, text
from fieldmon.geodata.placing import place, place_geometry
from fieldmon.geodata.values import all_degrees, numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.geodata.options import ReadOptions


@dataclass(frozen=True, eq=False)
class Plants:
    """Measured positions of plants, with what the file calls them.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees.
    row, plant
        ``(n,)`` labels of the row and of the plant; empty where the file has none.
    """

    lonlat: NDArray[np.float64]
    row: NDArray[np.str_]
    plant: NDArray[np.str_]

    def __post_init__(self) -> None:
        for values in (self.lonlat, self.row, self.plant):
            values.setflags(write=False)

    def __len__(self) -> int:
        """Return the number of plants."""
        return len(self.lonlat)


def plants_of(layer: Layer, options: ReadOptions) -> Imported[Plants]:
    """Return the plants of a layer of points, or of a table with positions."""
    layer, lonlat, findings = located(layer, options)
    if len(layer) == 0:
        raise FileProblem(f"{layer.name} must hold positions of plants, but holds none.")
    taken: set[str] = set()
    labels = []
    for role in ("row", "plant"):
        named = options.column(role) or find(role, layer.columns, frozenset(taken))
        if named is None:
            labels.append(np.full(len(layer), "", dtype=np.str_))
            continue
        taken.add(named)
        findings.append(seen(f"Column {named!r} names the {role}s."))
        labels.append(np.array([text(v) for v in layer.column(named)], dtype=np.str_))
    return Imported(Plants(lonlat, *labels), (*layer.findings, *findings))


def lines_of(layer: Layer, options: ReadOptions) -> Imported[MultiLineString]:
    """Return the lines of a layer (outlines of areas too), lon/lat."""
    if layer.geometry is None:
        raise FileProblem(f"{layer.name} must hold lines, but it is a plain table.")
    areas, lines, points = sort_out(layer.geometry)
    if not lines.any():
        raise FileProblem(
            f"{layer.name} must hold lines, but it holds {int(areas.sum())} area(s) and "
            f"{int(points.sum())} point(s). Choose another file or layer."
        )
    findings = []
    others = len(layer) - int(lines.sum())
    if others:
        findings.append(dropped(f"{others} feature(s) that are no lines were left out."))
    placed, more = place_geometry(layer.geometry[lines], layer.crs, options)
    parts = shapely.get_parts(shapely.get_parts(placed))
    is_line = np.isin(shapely.get_type_id(parts), (1, 2))
    has_length = is_line & (shapely.length(parts) > 0)
    if has_length.sum() < is_line.sum():
        n_points = int(is_line.sum() - has_length.sum())
        more.append(dropped(f"{n_points} line(s) that do not lead anywhere were left out."))
    whole = MultiLineString(list(parts[has_length]))
    return Imported(whole, (*layer.findings, *findings, *more))


def located(layer: Layer, options: ReadOptions) -> tuple[Layer, NDArray[np.float64], list[Finding]]:
    """Return the features that have a position, and that position ``(n, 2)``, lon/lat."""
    if layer.geometry is None:
        lonlat, findings = table_positions(layer, options)
        there = np.isfinite(lonlat).all(axis=1)
        if not there.all():
            lost = int((~there).sum())
            findings.append(dropped(f"{lost} record(s) without a usable position were left out."))
        return layer.take(np.flatnonzero(there)), lonlat[there], findings
    areas, lines, points = sort_out(layer.geometry)
    if not points.any():
        raise FileProblem(
            f"{layer.name} must hold points, but it holds {int(areas.sum())} area(s) and "
            f"{int(lines.sum())} line(s). Choose another file or layer."
        )
    findings = []
    others = len(layer) - int(points.sum())
    if others:
        findings.append(dropped(f"{others} feature(s) that are no points were left out."))
    single, index = shapely.get_parts(layer.geometry[points], return_index=True)
    kept = layer.take(np.flatnonzero(points)[index])
    lonlat, more = place(shapely.get_coordinates(single), layer.crs, options)
    return kept, lonlat, [*findings, *more]


def table_points(layer: Layer, options: ReadOptions) -> tuple[NDArray[np.float64], list[Finding]]:
    """Return the positions in a table's columns ``(k, 2)``, lon/lat, those without left out."""
    lonlat, findings = table_positions(layer, options)
    return lonlat[np.isfinite(lonlat).all(axis=1)], findings


def table_positions(
    layer: Layer, options: ReadOptions
) -> tuple[NDArray[np.float64], list[Finding]]:
    """Return the position of every record of a table ``(n, 2)``, lon/lat; NaN where it has none."""
    lon, lat = (options.column(r) or find(r, layer.columns) for r in ("lon", "lat"))
    x, y = (options.column(r) or find(r, layer.columns) for r in ("x", "y"))
    by_hand = {role for role, _ in options.columns}
    if x and y and (not (lon and lat) or by_hand & {"x", "y"}):
        return _placed(layer, options, (x, y), None)
    if lon and lat:
        return _placed(layer, options, (lon, lat), "OGC:CRS84")
    raise ChoiceNeeded(
        f"{layer.name} must have a column of longitudes and one of latitudes (or eastings and "
        f"northings), but none were recognised among: {', '.join(layer.columns)}. Name them.",
        "columns",
        tuple(layer.columns),
    )


def _placed(
    layer: Layer, options: ReadOptions, names: tuple[str, str], crs: str | None
) -> tuple[NDArray[np.float64], list[Finding]]:
    parse = numbers if crs is None else all_degrees
    xy: NDArray[np.float64] = np.stack(
        [parse(layer.column(name), options.decimal) for name in names], axis=1
    )
    there = np.isfinite(xy).all(axis=1)
    if not there.any():
        raise FileProblem(
            f"Columns {names[0]!r} and {names[1]!r} of {layer.name} must hold positions, "
            "but not one record has any. Name other columns."
        )
    lonlat = np.full_like(xy, np.nan)
    lonlat[there], findings = place(xy[there], crs, options)
    return lonlat, [seen(f"Positions are in columns {names[0]!r} and {names[1]!r}."), *findings]
