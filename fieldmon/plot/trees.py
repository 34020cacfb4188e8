"""Trees in no rows: each is visited by itself, over ways from tree to tree by nearness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError
from fieldmon.plot import adjacency
from fieldmon.plot.grid import PlantGrid
from fieldmon.plot.layout import held_area
from fieldmon.plot.polygons import polygons_of
from fieldmon.plot.row_detection import frame_around

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# the ways between all trees are kept as a table: these take 290 MB
_MOST = 3_000
# one stands so far beside a tree, in metres and in parts of the way to the nearest one
_STAND_OFF_M, _STAND_OFF = 0.5, 0.2
# one walks this many usual distances about each tree where nobody drew a boundary
_ABOUT = 1.5
_UPPER = -1


def trees_grid(lonlat: Float, field: Field | None = None) -> PlantGrid:
    """Return trees as they were measured, in no rows.

    They are numbered on in bands from side to side, so that neighbours in number are near each
    other. Next to each other are those between which no third one stands (Gabriel's
    neighbours), if they are not much farther apart than is usual.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees, in any order, no two in one place.
    field
        Boundary, holes and no-go areas to keep, or None: one walks about all trees.

    Raises
    ------
    PlotError
        If there are more than 3 000, or none stands on the field.
    """
    n = len(lonlat)
    if n > _MOST:
        raise PlotError(
            worded(
                "Trees in no rows can be {most} on a plot, since the ways between all of them are "
                "kept, but there are {n}. Part them into plots, or let them be visited along "
                "lines.",
                most=_MOST,
                n=n,
            )
        )
    frame = field.frame() if field else frame_around(lonlat)
    xy_m = frame.xy_m(lonlat)
    pairs = adjacency.gabriel_pairs(xy_m)
    apart = xy_m[pairs[:, 0]] - xy_m[pairs[:, 1]]
    length_m = np.hypot(apart[:, 0], apart[:, 1])
    usual_m = float(np.median(length_m)) if len(pairs) else 3.0
    order = _in_bands(xy_m, 2 * usual_m)
    xy_m, place = xy_m[order], np.argsort(order)
    near = place[pairs[length_m <= adjacency.NEXT * usual_m]]
    stand_off_m = (
        min(_STAND_OFF_M, _STAND_OFF * float(length_m.min())) if len(pairs) else _STAND_OFF_M
    )
    alone = np.arange(n + 1)
    nobody = np.zeros(n + 1, np.int32), np.empty(0, np.int32)
    return PlantGrid(
        frame,
        xy_m,
        alone.astype(np.int64),
        np.zeros(n, np.int32),
        xy_m[:, 1] + stand_off_m,
        np.repeat(xy_m[:, :1], 2, axis=1),
        alone[:-1].astype(np.int32),
        np.full(n, _UPPER, np.int8),
        _ground(xy_m, usual_m, field),
        usual_m,
        usual_m,
        *nobody,
        *adjacency.lists(n, near[:, 0], near[:, 1]),
        np.full(n, -1, np.int32),
        in_rows=False,
    )


def _in_bands(xy_m: Float, wide_m: float) -> Int:
    """Return points in bands from side to side: one there, the next one back."""
    band = np.floor((xy_m[:, 1] - xy_m[:, 1].min()) / wide_m).astype(np.int64)
    return np.lexsort((np.where(band % 2 == 0, xy_m[:, 0], -xy_m[:, 0]), band))


def _ground(xy_m: Float, usual_m: float, field: Field | None) -> MultiPolygon:
    """Return where one may walk: on the field and about the trees, but over no obstacle."""
    about = shapely.union_all(shapely.buffer(shapely.points(xy_m), _ABOUT * usual_m, quad_segs=4))
    if field is not None:
        frame = field.frame()
        area = held_area(field, frame, xy_m)
        if shapely.contains_xy(area, xy_m).all():
            return area
        no_go = frame.geometry_m(field.no_go)
        about = shapely.difference(shapely.union(area, about), no_go)
    return polygons_of(about)
