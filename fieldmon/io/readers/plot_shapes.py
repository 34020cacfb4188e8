"""What is said of the shapes of plots: parts, holes, and the same outline twice."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from fieldmon.compute.wording import first_few, worded
from fieldmon.io.import_report import ImportMessage, doubtful, seen

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field


def said_of_shapes(fields: list[Field]) -> list[ImportMessage]:
    """Return what is said of parts, holes, islands in holes, and outlines that stand twice."""
    return [*_parts(fields), *_same_outlines(fields)]


def _parts(fields: list[Field]) -> list[ImportMessage]:
    """Say which plots have several parts, or holes."""
    shapes = [f.boundary for f in fields]
    polygons, plot = shapely.get_parts(shapes, return_index=True)
    n_parts = np.bincount(plot, minlength=len(fields))
    n_holes = np.bincount(plot, shapely.get_num_interior_rings(polygons), len(fields))
    is_around = [n > 1 and k > 0 and _has_island(one)
                 for n, k, one in zip(n_parts, n_holes, shapes, strict=True)]  # fmt: skip
    messages = []
    if (n_parts > 1).any():
        several = _names(fields, n_parts > 1)
        said = worded(
            "{n} {n:plot has|plots have} several parts, which were kept: {names}.",
            n=len(several), names=first_few(several),
        )  # fmt: skip
        own = worded("It has several parts, which were kept.")
        messages.append(replace(seen(said), each=tuple(seen(own, one) for one in several)))
    if n_holes.any():
        holed = _names(fields, n_holes > 0)
        said = worded(
            "{n} {n:plot has|plots have} holes, kept as places without plants: {names}.",
            n=len(holed), names=first_few(holed),
        )  # fmt: skip
        own = worded("It has holes, kept as places without plants.")
        messages.append(replace(seen(said), each=tuple(seen(own, one) for one in holed)))
    if any(is_around):
        around = _names(fields, np.array(is_around))
        said = worded(
            "{n} {n:plot has|plots have} a part in a hole of another, and routes lead "
            "straight across that hole: {names}. Where nobody can, make the part a plot.",
            n=len(around), names=first_few(around),
        )  # fmt: skip
        own = worded(
            "It has a part in a hole of another, and routes lead straight across that hole. Where "
            "nobody can, make the part a plot."
        )
        messages.append(replace(doubtful(said), each=tuple(doubtful(own, one) for one in around)))
    return messages


def _names(fields: list[Field], which: NDArray[np.bool_]) -> list[str]:
    return [fields[i].name for i in np.flatnonzero(which)]


def _has_island(boundary: MultiPolygon) -> bool:
    """Return whether a part of a plot lies in a hole of another."""
    tree = shapely.STRtree(list(boundary.geoms))
    holes = [Polygon(ring) for part in boundary.geoms for ring in part.interiors]
    return bool(tree.query(holes, predicate="contains").size)


def _same_outlines(fields: list[Field]) -> list[ImportMessage]:
    bounds = shapely.bounds([field.boundary for field in fields])
    _, same, times = np.unique(bounds, axis=0, return_inverse=True, return_counts=True)
    first: dict[bytes, str] = {}
    messages = []
    for i in np.flatnonzero(times[same.ravel()] > 1).tolist():
        field = fields[i]
        key = shapely.to_wkb(shapely.normalize(field.boundary))
        if key in first:
            said = worded("It has the same outline as {value}.", value=first[key])
            many = "{n} plots have the same outline as another"
            messages.append(doubtful(said, field.name, many=many))
        first.setdefault(key, field.name)
    return messages
