"""Plants laid along rows that are known as lines: drawn, copied from one, or along contours."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from shapely import LineString, Point
from shapely.ops import substring

from fieldmon.compute.arrays import offsets, runs
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError
from fieldmon.plot.bent_layout import bent_grid
from fieldmon.plot.line_sorting import sorted_rows
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_lines import Blocked, RowLines, blocked_stretches, row_aisles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.aisle_lines import RowAisles
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.planting import Planting
    from fieldmon.plot.projection import Frame
    from fieldmon.plot.row_lines import Ground

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_SLACK_M = 1e-6
# rows that come so near to each other cross, touch or are one
_APART_M = 0.05
# rows are neighbours up to so many times the row spacing that was said or is usual
_REACH = 4.0
# strips that only touch the boundary are on the plot
_EDGE_M = 1e-3
# a line that strays by less than this part of the row spacing from straight is straight
_STRAIGHT = 0.1


def is_straight(line_m: Float, row_spacing_m: float) -> bool:
    """Tell whether a line ``(k, 2)`` is as good as straight."""
    ends = shapely.linestrings(line_m[[0, -1]])
    off_m = shapely.distance(ends, shapely.points(line_m))
    return bool(off_m.max() <= _STRAIGHT * row_spacing_m)


def copies(line_m: Float, area: shapely.Geometry, row_spacing_m: float) -> list[Float]:
    """Return a row and its likes beside it, a row spacing apart, as far as an area reaches."""
    size_m = float(np.hypot(*np.ptp(shapely.get_coordinates(area), axis=0)))
    far_m = size_m + shapely.distance(area, LineString(line_m)) + row_spacing_m
    long = LineString(Polylines.each([line_m]).extended(far_m).line(0))
    rows = []
    for k in range(-int(far_m / row_spacing_m), int(far_m / row_spacing_m) + 1):
        moved = long if k == 0 else shapely.offset_curve(long, k * row_spacing_m, quad_segs=16)
        rows += [
            row for part in shapely.get_parts(moved) if (row := _within(part, area)) is not None
        ]
    return rows


def _within(line: LineString, area: shapely.Geometry) -> Float | None:
    """Return a line from where it first enters an area to where it last leaves it."""
    parts = shapely.get_parts(shapely.intersection(line, area))
    parts = parts[shapely.length(parts) > 0]
    if not len(parts):
        return None
    ends = [line.project(Point(at)) for at in shapely.get_coordinates(parts)]
    inner: Float = shapely.get_coordinates(substring(line, min(ends), max(ends)))
    return inner if len(inner) > 1 else None


class LaidRows(NamedTuple):
    """Rows with plants on them, before their neighbours and ways are found; as `bent_grid` has it.

    ``plants`` are positions ``(n, 2)`` and the row of each, ``(n,)``.
    """

    rows: RowLines
    aisles: RowAisles
    blocked: Blocked
    plants: tuple[Float, Int]

    def __repr__(self) -> str:
        return f"<LaidRows: {len(self.plants[0])} plants>"


def lay_along(
    name: str,
    frame: Frame,
    lines_m: list[Float],
    ground: Ground,
    planting: Planting,
    *,
    whole: bool = False,
) -> PlantGrid:
    """Return plants along rows, wherever row, aisle and headlands fit into an area.

    Parameters
    ----------
    name
        What the plot is called.
    frame
        The plane of all that is in metres.
    lines_m
        Each row's line ``(k, 2)``, in any order and either way.
    ground
        The area; None: plants stand on the whole of each line.
    planting
        Spacing of the plants, headland and faces. Rows are as far apart as they are.
    whole
        Whether the strips on both sides of a row must fit, as where straight rows are laid. Rows
        that somebody drew may run along the boundary.

    Raises
    ------
    PlotError
        If there is no room for a plant, or rows that were drawn cross.
    """
    laid, planting = rows_along(frame, lines_m, ground.area, planting, whole=whole)
    if not len(laid.plants[0]):
        raise PlotError(
            worded(
                "A plot must have room for one plant on its rows, but "
                "{name!r} has none: rows end {headland_m:g} m (the headland) "
                "before its boundary. Choose a smaller headland, or check the "
                "rows and the boundary.",
                name=name,
                headland_m=planting.headland_m,
            )
        )
    known = ground._replace(blocked=laid.blocked, aisles=laid.aisles)
    return bent_grid(frame, laid.rows, laid.plants, known, planting)


def rows_along(
    frame: Frame,
    lines_m: list[Float],
    area: shapely.Geometry | None,
    planting: Planting,
    *,
    whole: bool,
) -> tuple[LaidRows, Planting]:
    """Return plants along rows as `lay_along` does, and the planting with their distance."""
    drawn = sorted_rows(Polylines.each(lines_m), _REACH * planting.row_spacing_m)
    if not whole:
        _refuse_crossing(frame, drawn.lines, area)
    if np.isfinite(drawn.spacing_m):
        planting = replace(planting, row_spacing_m=drawn.spacing_m)
    rows = RowLines(drawn.lines, drawn.block)
    aisles = row_aisles(rows, planting)
    blocked = _outside(rows, aisles, (area, whole), planting)
    return LaidRows(rows, aisles, blocked, _filled(rows.lines, blocked, planting)), planting


def _refuse_crossing(frame: Frame, rows: Polylines, area: shapely.Geometry | None) -> None:
    """Raise `PlotError` where rows cross or touch on an area; None: anywhere."""
    shapes = rows.shapes()
    one, other = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=_APART_M)
    one, other = one[one < other], other[one < other]
    met = shapely.intersection(shapes[one], shapely.buffer(shapes[other], _APART_M))
    if area is not None:
        met = shapely.intersection(met, area)
    met = met[~shapely.is_empty(met)]
    if len(met):
        lon, lat = frame.lonlat(shapely.get_coordinates(shapely.point_on_surface(met[0])))[0]
        raise PlotError(
            worded(
                "Rows must lie beside each other, but of those that were drawn {n} {n:pair "
                "crosses or touches|pairs cross or touch}, the first at ({lon:.7f}, {lat:.7f}). "
                "Draw them apart.",
                n=len(met),
                lon=lon,
                lat=lat,
            )
        )


def _outside(
    rows: RowLines,
    aisles: RowAisles,
    ground: tuple[shapely.Geometry | None, bool],
    planting: Planting,
) -> Blocked:
    """Return the stretches of rows that are not wholly on an area with their aisles."""
    area, whole = ground
    if area is None:
        return Blocked.nowhere()
    area = shapely.buffer(area, _EDGE_M)
    shapely.prepare(area)

    def is_blocked(shapes: NDArray[np.object_]) -> NDArray[np.bool_]:
        out: NDArray[np.bool_] = ~np.asarray(shapely.covers(area, shapes))
        return out

    return blocked_stretches(rows, aisles, planting, is_blocked, whole=whole)


def _filled(lines: Polylines, blocked: Blocked, planting: Planting) -> tuple[Float, Int]:
    """Return plants ``(n, 2)`` on what is free of rows, and the row of each."""
    row, low, high = _free(lines, blocked, planting.headland_m)
    step = planting.plant_spacing_m
    n = np.floor((high - low + _SLACK_M) / step).astype(np.int64) + 1
    room = n > 0
    row, low, high, n = row[room], low[room], high[room], n[room]
    first = low + (high - low - (n - 1) * step) / 2
    place, of = runs(np.zeros(len(n), np.int64), n)
    line = row[of]
    return lines.points(line, first[of] + place * step), line


def _free(lines: Polylines, blocked: Blocked, headland_m: float) -> tuple[Int, Float, Float]:
    """Return where plants may stand on rows: the row, from which place and to which."""
    length = lines.length_m
    n_blocked = np.bincount(blocked.row, minlength=len(lines))
    begins = offsets(n_blocked)
    low = np.insert(blocked.to_m + headland_m, begins[:-1], 0.0)
    high = np.insert(blocked.from_m - headland_m, begins[1:], length)
    row = np.repeat(np.arange(len(lines)), n_blocked + 1)
    return row, np.maximum(low, 0.0), np.minimum(high, length[row])
