"""The polygons of an area: what cuts and unions leave of lines and points beside them is none."""

from __future__ import annotations

from typing import TYPE_CHECKING

import shapely
from shapely import MultiPolygon

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def polygons_of(area: shapely.Geometry | NDArray[np.object_]) -> MultiPolygon:
    """Return the polygons of an area, or of several, without its lines and points.

    Examples
    --------
    >>> square, line = shapely.box(0, 0, 1, 1), shapely.LineString([(2, 0), (3, 0)])
    >>> polygons_of(shapely.GeometryCollection([square, line])).area
    1.0
    """
    return MultiPolygon([part for part in shapely.get_parts(area) if part.geom_type == "Polygon"])
