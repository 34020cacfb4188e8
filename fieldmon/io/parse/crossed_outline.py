"""Outlines that cross themselves: what of a plot that loses, and corners in the wrong order."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import LineString, MultiPolygon, Polygon

if TYPE_CHECKING:
    from numpy.typing import NDArray

# a loop smaller than this share of the area is a slip of the pen
_SLIP = 0.01
# in the right order an outline holds so much more than was kept, or the order is not to blame
_MORE = 1.1
# of more corners nobody mistakes the order
_MOST_CORNERS = 60


def crossed_at(drawn: MultiPolygon) -> tuple[float, float] | None:
    """Return where an outline crosses itself so that a loop of some size is lost; None: nowhere."""
    for part in drawn.geoms:
        if _lost_share(part) > _SLIP:
            _, _, place = shapely.is_valid_reason(Polygon(part.exterior)).partition("[")
            x, y = place.rstrip("]").split()[:2]
            return float(x), float(y)
    return None


def in_order(drawn: MultiPolygon, kept_area: float) -> Polygon | None:
    """Return an outline around the same corners that crosses nowhere; None: none holds more.

    `kept_area` is what was kept of the outline as drawn, in the square of its unit. Crossing edges
    are exchanged until there are none, which makes the outline shorter each time.
    """
    if len(drawn.geoms) != 1 or drawn.geoms[0].interiors:
        return None
    corners = np.array(drawn.geoms[0].exterior.coords)[:-1, :2]
    if len(corners) > _MOST_CORNERS:
        return None
    while (pair := _crossing(corners)) is not None:
        first, last = pair
        corners[first + 1 : last + 1] = corners[first + 1 : last + 1][::-1].copy()
    made = Polygon(corners)
    return made if shapely.is_valid(made) and made.area > _MORE * kept_area else None


def _lost_share(part: Polygon) -> float:
    """Return which share of what a ring holds is drawn against the rest, or twice."""
    outline = Polygon(part.exterior)
    if shapely.is_valid(outline):
        return 0.0
    area: float = shapely.make_valid(outline, method="structure", keep_collapsed=False).area
    return abs(area - outline.area) / area if area else 0.0


def _crossing(corners: NDArray[np.float64]) -> tuple[int, int] | None:
    """Return two edges that cross, by the corners ``(n, 2)`` at which they begin; None: none do."""
    edges = [LineString(pair) for pair in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    return next(
        ((i, j) for i, j in combinations(range(len(edges)), 2) if edges[i].crosses(edges[j])), None
    )
