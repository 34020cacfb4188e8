"""Which way the rows run and how far apart plants stand, found from what is known of a plot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from scipy.ndimage import gaussian_filter1d

from fieldmon.errors import PlotError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.field import Field

    Float = NDArray[np.float64]

_BINS_PER_DEG = 4
_EDGE_SMOOTH_DEG = 2.0


@dataclass(frozen=True)
class Rows:
    """How rows run on a plot, and how that is known.

    Parameters
    ----------
    bearing_deg
        Direction of the rows in 0..180, clockwise from true north.
    row_spacing_m, plant_spacing_m
        Typical distances, or None where the evidence does not show them.
    how
        The evidence in words, for people.
    """

    bearing_deg: float
    row_spacing_m: float | None
    plant_spacing_m: float | None
    how: str


def rows_from_boundary(field: Field) -> Rows:
    """Return rows along the direction in which most of the largest part's edge runs."""
    parts = shapely.get_parts(field.boundary)
    main = parts[np.argmax(shapely.area(parts))]
    edge_m = np.diff(field.frame().xy_m(shapely.get_coordinates(main.exterior)), axis=0)
    return Rows(_main_bearing(edge_m), None, None, "along the long side of the plot")


def rows_from_lines(field: Field) -> Rows:
    """Return the direction and spacing of the rows that were drawn; raise `PlotError` if none."""
    if field.row_lines.is_empty:
        raise PlotError(
            f"Rows of plot {field.name!r} must be drawn to find their direction, but none are."
        )
    lines = shapely.get_parts(field.row_lines)
    points, line = shapely.get_coordinates(lines, return_index=True)
    frame = field.frame()
    edges_m = np.diff(frame.xy_m(points), axis=0)[line[1:] == line[:-1]]
    bearing_deg = _main_bearing(edges_m)
    middles = shapely.get_coordinates(shapely.line_interpolate_point(lines, 0.5, normalized=True))
    gaps = np.diff(np.sort(frame.turned(bearing_deg).xy_m(middles)[:, 1]))
    # pieces of one row lie on one line: their gap is no spacing
    apart = gaps[gaps > 0.3]
    spacing_m = float(np.median(apart)) if len(apart) else None
    return Rows(bearing_deg, spacing_m, None, f"from {len(lines)} drawn rows")


def _main_bearing(edges_m: Float) -> float:
    """Return the bearing (0..180) that most metres of edge share, within a few degrees."""
    length = np.hypot(*edges_m.T)
    bearing_deg = np.rad2deg(np.arctan2(edges_m[:, 0], edges_m[:, 1])) % 180.0
    n = 180 * _BINS_PER_DEG
    metres = np.bincount((bearing_deg * _BINS_PER_DEG).astype(int) % n, length, n)
    smooth = gaussian_filter1d(metres, _EDGE_SMOOTH_DEG * _BINS_PER_DEG, mode="wrap")
    peak = (np.argmax(smooth) + 0.5) / _BINS_PER_DEG
    off = (bearing_deg - peak + 90.0) % 180.0 - 90.0
    near = np.abs(off) <= 2 * _EDGE_SMOOTH_DEG
    return float((peak + np.average(off[near], weights=length[near])) % 180.0)
