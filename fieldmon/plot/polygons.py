"""The polygons of an area: what cuts and unions leave of lines and points beside them is none.

Nor is what is narrower than two hands: it comes of how plants were measured.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

# half of what is slim, between areas and in them
_SLIM_M = 0.1


def polygons_of(area: shapely.Geometry | NDArray[np.object_]) -> MultiPolygon:
    """Return the polygons of an area, or of several, without its lines and points.

    Examples
    --------
    >>> square, line = shapely.box(0, 0, 1, 1), shapely.LineString([(2, 0), (3, 0)])
    >>> polygons_of(shapely.GeometryCollection([square, line])).area
    1.0
    """
    return MultiPolygon([part for part in shapely.get_parts(area) if part.geom_type == "Polygon"])


def without_slits(areas: Sequence[MultiPolygon]) -> list[MultiPolygon]:
    """Return areas, metres, with what is narrower than some centimetres between and in them.

    Each holds all that it held but what another has; none overlap.

    Examples
    --------
    >>> west, east = (MultiPolygon([shapely.box(x, 0, x + 1, 1)]) for x in (0.0, 1.05))
    >>> whole = MultiPolygon([*west.geoms, *east.geoms])
    >>> [len(one.geoms) for one in without_slits([whole])]
    [1]
    """
    zones = np.array([*areas], dtype=object)
    apart = shapely.union_all(zones)
    whole = shapely.get_parts(shapely.union(apart, _grown(_grown(apart, _SLIM_M), -_SLIM_M)))
    beside, of_whole = shapely.STRtree(zones), shapely.STRtree(whole)
    made = zones.copy()
    for k, zone in enumerate(zones):
        around = _grown(zone, 2 * _SLIM_M)
        near = shapely.intersection(around, shapely.union_all(whole[of_whole.query(around)]))
        # those before it may reach as far
        others = beside.query(_grown(zone, 4 * _SLIM_M))
        own = shapely.difference(near, shapely.union_all(made[others[others != k]]))
        parts = shapely.get_parts(shapely.make_valid(own))
        mine = [one for one in polygons_of(parts).geoms if one.intersects(zone)]
        made[k] = MultiPolygon([_filled(one) for one in mine])
    return [*made]


def is_slim(area: shapely.Geometry) -> bool:
    """Return whether no part of an area, metres, is wider than some centimetres."""
    return bool(shapely.is_empty(shapely.buffer(area, -_SLIM_M)))


def _grown(area: shapely.Geometry, by_m: float) -> shapely.Geometry:
    return shapely.buffer(area, by_m, join_style="mitre")


def _filled(part: Polygon) -> Polygon:
    """Return a polygon without the holes that are slim."""
    return Polygon(part.exterior, [hole for hole in part.interiors if not is_slim(Polygon(hole))])
