"""What a way must keep clear of: rows of plants, holes, what nobody may drive over."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numba as nb
import numpy as np
import shapely
from shapely import Polygon

from fieldmon.compute.jit import kept, routine
from fieldmon.compute.wording import counted
from fieldmon.plot.bent_ways import off_steps, row_steps, tallest_of
from fieldmon.plot.row_course import row_courses

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.clearance import Clearance
    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]
    Index = NDArray[np.intp]
    Mask = NDArray[np.bool_]

#: places so near each other are one
SAME_M = 1e-6
#: of so many corners at most ways go round
MOST_CORNERS = 100
# a lane may lie exactly on the boundary
_EDGE_M = 0.01
_CLEARANCE_M = 0.3
# the steps of a quarter circle, and what makes them no nearer than the circle
_QUARTER = 4
_ROUND = float(1.0 / np.cos(np.pi / (4 * _QUARTER)))


class Where(Enum):
    """Where a way may run, from preferred to last resort; never across a row."""

    INSIDE = "in the drivable area, half a robot's width off its boundary where there is room"
    TIGHT = "in the drivable area, as near to its boundary as need be"
    OUTSIDE = "outside the boundary too, but not over holes"
    ANYWHERE = "over holes too, but not over no-go areas"


ON_PLOT = (Where.INSIDE, Where.TIGHT)


@dataclass(frozen=True, eq=False)
class Obstacles:
    """What a straight way must not touch.

    Parameters
    ----------
    row_box_m
        ``(b, 4)`` low x, low y, high x, high y: boxes about the rows with a little clearance,
        sorted by low y. A straight row has one, a row measured plant by plant one a step.
    row_step_m
        ``(b, 4)`` the steps of rows that bend, from x, y to x, y, beside their boxes; None where
        the boxes say it all.
    clearance_m
        How far ways keep off such steps.
    drivable_m
        Where driving is fine.
    off_limits_m
        Its holes, and where driving is never fine.
    no_go_m
        Where driving is never fine.
    bare_m
        The same without what a robot keeps off it.
    edge_m
        The boundary, which ways keep `half_m` off if their ends do.
    half_m
        Half of the robot's width; 0: it is a point.
    """

    row_box_m: Float
    row_step_m: Float | None
    clearance_m: float
    drivable_m: shapely.Geometry
    off_limits_m: shapely.Geometry
    no_go_m: shapely.Geometry
    bare_m: shapely.Geometry
    edge_m: shapely.Geometry
    half_m: float = 0.0

    def __repr__(self) -> str:
        return f"<Obstacles: {counted(len(self.row_box_m), 'row piece')}>"

    @classmethod
    def of(
        cls, grid: PlantGrid, no_go_m: shapely.Geometry, clearance: Clearance | None = None
    ) -> Obstacles:
        """Return the obstacles on a plot, to a robot that needs some clearance."""
        if clearance is None:
            beyond_m = grid.beyond_plants_m
            # where a lane ends at its last plant nobody turns
            turned = (beyond_m > 0.0) & ~grid.cut_ends
            least_m = float(beyond_m.min(where=turned, initial=np.inf))
            clearance_m = min(_CLEARANCE_M, 0.4 * least_m)
        else:
            clearance_m = clearance.way_m
        drivable_m: shapely.Geometry = grid.ground_m
        if not shapely.is_valid(drivable_m):  # laid on a plane, parts by a hair may cross
            drivable_m = shapely.make_valid(drivable_m, method="structure", keep_collapsed=False)
        whole = filled(drivable_m)
        holes_m = shapely.difference(whole, drivable_m)
        half_m, off_m = 0.0, 0.0
        if clearance is not None and grid.in_rows:  # who stands beside a tree may be near a hole
            half_m, off_m = clearance.half_m, clearance.off_m
        off_limits_m = _wider(shapely.union(holes_m, no_go_m), off_m)
        inside_m: shapely.Geometry = shapely.buffer(drivable_m, _EDGE_M, join_style="mitre")
        off_limits_m = shapely.buffer(off_limits_m, -_EDGE_M, join_style="mitre")
        if off_m:
            inside_m = shapely.difference(inside_m, off_limits_m)
        never_m = shapely.buffer(_wider(no_go_m, off_m), -_EDGE_M, join_style="mitre")
        bare_m = shapely.buffer(no_go_m, -_EDGE_M, join_style="mitre")
        edge_m = shapely.boundary(whole)
        for area in (inside_m, off_limits_m, never_m, bare_m, edge_m):
            shapely.prepare(area)
        row_box_m, row_step_m = (
            (_row_boxes(grid, clearance_m), None)
            if grid.aisles_m is None
            else row_steps(grid, clearance_m)
        )
        areas = inside_m, off_limits_m, never_m, bare_m, edge_m
        return cls(row_box_m, row_step_m, clearance_m, *areas, half_m)

    def clear(self, from_m: Float, to_m: Float, where: Where = Where.INSIDE) -> Mask:
        """Tell of k straight ways, ``(k, 2)`` to ``(k, 2)``, whether they can be driven."""
        good = np.ones(len(from_m), np.bool_)
        if self.row_step_m is None:
            _off_boxes(self.row_box_m, from_m, to_m, good)
        else:
            off_steps((self.row_box_m, self.row_step_m), self.clearance_m, from_m, to_m, good)
        kept = np.flatnonzero(good)
        lines = np.asarray(shapely.linestrings(np.stack([from_m[kept], to_m[kept]], axis=1)))
        if where in ON_PLOT:
            good[kept] = shapely.covers(self.drivable_m, lines)
            if self.half_m and where is Where.INSIDE:
                kept, lines = kept[good[kept]], lines[good[kept]]
                good[kept] = self._off_edge(lines)
        else:
            good[kept] = ~np.asarray(shapely.intersects(self._off_limits(where), lines))
        return good

    def _off_edge(self, lines: NDArray[np.object_]) -> Mask:
        """Tell of lines whether they come no nearer to the boundary than they must.

        That is half the width, or less where the nearer of their ends is nearer.
        """
        near = np.flatnonzero(shapely.dwithin(self.edge_m, lines, self.half_m - _EDGE_M))
        ends_m = [shapely.distance(self.edge_m, shapely.get_point(lines[near], k)) for k in (0, -1)]
        least_m = np.minimum(np.minimum(*ends_m), self.half_m)
        off = np.ones(len(lines), np.bool_)
        off[near] = shapely.distance(self.edge_m, lines[near]) >= least_m - _EDGE_M
        return off

    def among_plants(self, at_m: Float) -> bool:
        """Tell whether a place ``(1, 2)`` is in a row of plants, or on a no-go area."""
        off = np.ones(1, np.bool_)
        _off_boxes(self.row_box_m, at_m, at_m, off)
        return bool(not off[0] or shapely.intersects_xy(self.bare_m, *at_m[0]))

    def within(self, from_m: Float, to_m: Float) -> Mask:
        """Tell of k straight ways, whatever plants stand there, whether they are on the plot."""
        lines = shapely.linestrings(np.stack([from_m, to_m], axis=1))
        inside: Mask = np.asarray(shapely.covers(self.drivable_m, lines))
        return inside

    def corners(self, where: Where) -> Float:
        """Return corners that ways may have to go round, ``(k, 2)``; of crowded ones a choice."""
        if where in ON_PLOT:
            area, sign = self.drivable_m, -1.0
            if self.half_m and where is Where.INSIDE:
                near = shapely.buffer(self.edge_m, self.half_m, quad_segs=2)
                area = shapely.difference(area, near)
        else:  # on the brink of what must not even be touched
            area, sign = self._off_limits(where), 1.0
            area = shapely.buffer(area, _EDGE_M, join_style="mitre")
        coarse_m, corners = _EDGE_M, _bends(area, _EDGE_M, sign)
        while len(corners) > MOST_CORNERS:
            coarse_m *= 2
            corners = _bends(area, coarse_m, sign)
        return corners

    def _off_limits(self, where: Where) -> shapely.Geometry:
        return self.off_limits_m if where is Where.OUTSIDE else self.no_go_m


def off_limits(grid: PlantGrid, no_go_m: shapely.Geometry | None, off_m: float) -> shapely.Geometry:
    """Return what ways keep off: holes and no-go areas, and so far around them."""
    holes_m = shapely.difference(filled(grid.ground_m), grid.ground_m)
    return _wider(holes_m if no_go_m is None else shapely.union(holes_m, no_go_m), off_m)


def filled(area: shapely.Geometry) -> shapely.Geometry:
    """Return an area without its holes, and without lines along which others only touch it."""
    parts = (part for part in shapely.get_parts(area) if part.geom_type == "Polygon")
    return shapely.union_all([Polygon(part.exterior) for part in parts])


def _wider(area: shapely.Geometry, by_m: float) -> shapely.Geometry:
    """Return an area and so much around it, round at its corners."""
    if not by_m:
        return area
    return shapely.buffer(area, by_m * _ROUND, quad_segs=_QUARTER)


def _bends(area: shapely.Geometry, coarse_m: float, sign: float) -> Float:
    """Return corners at which an area bulges (sign 1) or something bulges into it (sign -1)."""
    rings = shapely.get_rings(
        shapely.get_parts(shapely.orient_polygons(shapely.simplify(area, coarse_m)))
    )
    found = [np.empty((0, 2))]
    for ring in rings:
        corner = shapely.get_coordinates(ring)[:-1]
        ahead = np.roll(corner, -1, axis=0) - corner
        behind = np.roll(ahead, 1, axis=0)
        turn = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
        found.append(corner[sign * turn > 0])
    return np.concatenate(found)


@routine
def _off_boxes(box_m: Float, from_m: Float, to_m: Float, off: Mask) -> None:
    """Set `off` to False for the straight lines that touch a box; boxes are sorted by low y."""
    low_y = box_m[:, 1]
    tallest = tallest_of(box_m)
    for k in range(off.size):
        x, y = from_m[k]
        way_x, way_y = to_m[k, 0] - x, to_m[k, 1] - y
        b = np.searchsorted(low_y, min(y, y + way_y) - tallest)
        while off[k] and b < low_y.size and low_y[b] <= max(y, y + way_y):
            # the part of the line within the box's x, then of that within its y
            first, last = _within(x, way_x, box_m[b, 0], box_m[b, 2], (0.0, 1.0))
            first, last = _within(y, way_y, box_m[b, 1], box_m[b, 3], (first, last))
            off[k] = first > last
            b += 1


@kept
@nb.njit(inline="always")
def _within(
    at: float, way: float, low: float, high: float, part: tuple[float, float]
) -> tuple[float, float]:
    """Return the part of a line, as fractions, at which one coordinate is from low to high."""
    if way == 0.0:
        return part if low <= at <= high else (1.0, 0.0)
    enters, leaves = (low - at) / way, (high - at) / way
    return max(part[0], min(enters, leaves)), min(part[1], max(enters, leaves))


def _row_boxes(grid: PlantGrid, clearance_m: float) -> Float:
    corner, row = _corner_plants(grid), grid.unbroken_row
    step = np.flatnonzero(row[corner[1:]] == row[corner[:-1]])
    alone = _alone(grid)
    start = grid.xy_m[np.append(corner[step], alone)]
    end = grid.xy_m[np.append(corner[step + 1], alone)]
    box_m = np.concatenate(
        [np.minimum(start, end) - clearance_m, np.maximum(start, end) + clearance_m], axis=1
    )
    return box_m[np.argsort(box_m[:, 1])]


def row_lines(grid: PlantGrid) -> NDArray[np.object_]:
    """Return each unbroken row as a line through its plants, first to last, ``(w,)``.

    Plants in the middle of a row along x are left out. A row of one plant is a line of no length.
    Where rows bend they bend on between plants that are far apart.
    """
    if grid.aisles_m is not None:
        return row_courses(grid)
    plant = np.sort(np.append(_corner_plants(grid), _alone(grid)))
    row = grid.unbroken_row[plant]
    return np.asarray(shapely.linestrings(grid.xy_m[plant], indices=row), np.object_)


def _alone(grid: PlantGrid) -> Index:
    """Return the plants that are all of their row."""
    start = grid.unbroken_start
    alone: Index = start[:-1][np.diff(start) == 1]
    return alone


def _corner_plants(grid: PlantGrid) -> Index:
    """Return the plants at which rows start, end or leave the direction of x, ascending."""
    y = grid.xy_m[:, 1]
    level = np.abs(np.diff(y)) < SAME_M
    inner = np.zeros(len(grid), np.bool_)
    inner[1:-1] = level[1:] & level[:-1]
    start = grid.unbroken_start
    inner[start[:-1]] = inner[start[1:] - 1] = False
    return np.flatnonzero(~inner)
