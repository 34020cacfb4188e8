"""The outline of a plot from positions in their order around it, as somebody walks it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import ImportMessage, doubtful, repaired, seen
from fieldmon.io.parse.columns import plain

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: an outline has no more positions
MOST_CORNERS = 1000
# columns that number corners in their order
_ORDER = {"corner", "corners", "cornerno", "cornernumber", "vertex"}
# loops up to this part of the outline's size are noise, and no fix is farther from what is left
_LOOP = 0.12
# ends up to this part of the way apart are one place
_NEAR = 0.05
# a way that holds less than this part of the circle as long goes out and back, not around
_AROUND = 0.1
_TRIANGLE = 3


class WalkedOutline(NamedTuple):
    """An outline, and how many corners and cut off loops it has."""

    area: shapely.Polygon
    n_corners: int
    n_loops: int

    @property
    def messages(self) -> list[ImportMessage]:
        """Return what is said of an outline that was taken from positions."""
        said = []
        if self.n_loops:
            said.append(
                repaired(
                    worded(
                        "The outline crossed itself in {n} small {n:loop, which was|loops, which "
                        "were} cut off.",
                        n=self.n_loops,
                    )
                )
            )
        if self.n_corners == _TRIANGLE:
            said.append(
                doubtful(
                    worded(
                        "3 corners make a triangle: if the plot has a fourth corner, add it to "
                        "the file."
                    )
                )
            )
        return said


def outline_of(xy: Floats) -> WalkedOutline | None:
    """Return the outline through positions ``(n, 2)`` in their order; None where they have none.

    Small loops, as of somebody who stood at a corner, are cut off.
    """
    if not _TRIANGLE <= len(xy) <= MOST_CORNERS:
        return None
    apart = xy[np.any(xy != np.roll(xy, 1, axis=0), axis=1)]
    whole = shapely.Polygon(xy)
    if whole.is_valid or len(apart) < _TRIANGLE:
        return WalkedOutline(whole, len(apart), 0) if whole.area else None
    most = _LOOP * float(np.hypot(*np.ptp(apart, axis=0)))
    ring, n_loops = _without_loops(apart, most)
    if len(ring) < _TRIANGLE or not n_loops:
        return None
    area = shapely.Polygon(ring)
    if not area.is_valid or not goes_round(area):
        return None
    off = shapely.distance(area.exterior, shapely.points(apart))
    return WalkedOutline(area, len(ring), n_loops) if off.max() <= most else None


def nearly_closed(line: shapely.Geometry) -> WalkedOutline | None:
    """Return the outline of a line, its parts one after the other, that ends about where it begins.

    None where it does not, or goes around nothing.
    """
    xy = shapely.get_coordinates(line)
    length = float(np.hypot(*np.diff(xy, axis=0).T).sum())
    if len(xy) <= _TRIANGLE or np.hypot(*(xy[-1] - xy[0])) > _NEAR * length:
        return None
    found = outline_of(xy)
    return found if found is not None and goes_round(found.area) else None


def goes_round(area: shapely.Polygon) -> bool:
    """Return whether an outline holds something: a way out and back does not."""
    return bool(area.area > _AROUND * area.length**2 / (4 * np.pi))


def in_order(layer: Layer) -> Layer:
    """Return a layer of corners in the order that a column of their numbers says."""
    name = next((name for name in layer.columns if plain(name).replace("_", "") in _ORDER), None)
    if name is None:
        return layer
    try:
        numbers = [float(text(value)) for value in layer.columns[name]]
    except ValueError:
        return layer
    order = np.argsort(numbers, kind="stable")
    if len({*numbers}) < len(numbers) or (np.diff(order) > 0).all():
        return layer
    said = worded("Corners were taken in the order of column {name!r}.", name=name)
    return layer.take(order).saying(seen(said))


def not_in_order(name: str, n_points: int) -> FileProblem:
    """Return what is said of a few positions that are no outline in their order."""
    return FileProblem(
        worded(
            "A plot must be an area, but the outline through the {n} positions of {name} crosses "
            "itself. Put the corners in their order around the plot, or number them in a column "
            "called corner.",
            n=n_points,
            name=name,
        )
    )


def _without_loops(xy: Floats, most: float) -> tuple[Floats, int]:
    """Return a closed way without its small loops, and how many these were."""
    xy, n_cut = xy.copy(), 0
    while len(xy) > _TRIANGLE:
        cuts = _loops(xy, most)
        if not cuts:
            break
        kept = np.ones(len(xy), bool)
        put: list[tuple[int, Floats]] = []
        for first, n, crossing in cuts:
            inside = (first + 1 + np.arange(n)) % len(xy)
            # two loops that share a fix or an edge go one after the other
            if not kept[[first, *inside, (first + n + 1) % len(xy)]].all():
                continue
            kept[inside] = False
            put.append((int(inside[0]), crossing))
            n_cut += 1
        for place, crossing in put:
            xy[place], kept[place] = crossing, True
        xy = xy[kept]
    return xy, n_cut


def _loops(xy: Floats, most: float) -> list[tuple[int, int, Floats]]:
    """Return loops up to a size, the smallest first.

    Of each: the edge that enters it, how many fixes it has, and where it crosses itself.
    """
    n = len(xy)
    edges = np.array(shapely.linestrings(np.stack([xy, np.roll(xy, -1, axis=0)], axis=1)))
    one, other = shapely.STRtree(edges).query(edges, predicate="intersects")
    apart = (other - one) % n
    some = (one < other) & (apart > 1) & (apart < n - 1)
    found = []
    for a, b in zip(one[some].tolist(), other[some].tolist(), strict=True):
        first, size = (a, b - a) if b - a <= n // 2 else (b, n - (b - a))
        inside = xy[(first + 1 + np.arange(size)) % n]
        if np.hypot(*np.ptp(inside, axis=0)) <= most:
            crossing = shapely.get_coordinates(shapely.intersection(edges[a], edges[b]))
            # edges that only just touch may have nothing in common by rounding
            found.append((first, size, crossing[0] if len(crossing) else xy[b]))
    return sorted(found, key=lambda loop: loop[1])
