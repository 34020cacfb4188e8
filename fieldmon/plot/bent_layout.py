"""Plants in rows that bend, in blocks that turn: their lanes, neighbours and headlands."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.compute.arrays import offsets, runs
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError
from fieldmon.plot import adjacency
from fieldmon.plot.aisle_lines import aisles_of
from fieldmon.plot.grid import PlantGrid

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.aisle_lines import RowAisles
    from fieldmon.plot.planting import Planting
    from fieldmon.plot.polylines import Polylines
    from fieldmon.plot.projection import Frame

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_LOWER, _UPPER = 1, -1
# longer than any row
_FAR_M = 1e6
_RIGHT, _LEFT = 0, 1
# a strip beside a row reaches to one aisle, or to both
_ONE, _BOTH = 1, 2
# a lane ends this far at least from the rows of another block, if there is room
_CLEAR_M = 0.8
# a lane may end on the boundary
_SLACK_M = 1e-4
# strips along rows are looked at so finely beside obstacles, in plant spacings
_FINE = 0.25


class RowLines(NamedTuple):
    """Rows as lines in metres of a plot's frame.

    Parameters
    ----------
    lines
        The rows, block by block, in each from right to left of their direction.
    block
        ``(r,)`` the block of each row, ascending from 0 without gaps.
    spacing_m
        ``(r, 2)`` from each row to the next and from plant to plant in it, where blocks are
        planted differently; None: as the planting says.
    called
        ``(r,)`` the block that people mean, ascending, where it has several of these; None: each
        is one.
    """

    lines: Polylines
    block: Int
    spacing_m: Float | None = None
    called: Int | None = None

    def __repr__(self) -> str:
        return f"<RowLines: {len(self.block)} rows>"

    def spacings(self, planting: Planting) -> Float:
        """Return ``(r, 2)`` from each row to the next and from plant to plant in it."""
        if self.spacing_m is not None:
            return self.spacing_m
        each = [planting.row_spacing_m, planting.plant_spacing_m]
        return np.tile(each, (len(self.block), 1))


class Blocked(NamedTuple):
    """Where rows cannot go on: row, from which place on its line, and to which; ascending."""

    row: Int
    from_m: Float
    to_m: Float

    def __repr__(self) -> str:
        return f"<Blocked: {len(self.row)} stretches>"

    @classmethod
    def nowhere(cls) -> Blocked:
        """Return no such stretch."""
        return cls(np.empty(0, np.int64), np.empty(0), np.empty(0))


class Ground(NamedTuple):
    """Where rows and lanes may be, metres of the frame.

    Parameters
    ----------
    area
        Where one may drive; None: wherever rows with their aisles and headlands reach.
    obstacles
        What stands in the way of rows and lanes.
    blocked
        Where rows cannot go on if that is known already, else None.
    aisles
        The aisles of the rows if they are known already, else None.
    """

    area: MultiPolygon | None
    obstacles: shapely.Geometry
    blocked: Blocked | None = None
    aisles: RowAisles | None = None


class BentPieces(NamedTuple):
    """Unbroken pieces of rows, by row, then along it: r pieces of n plants together.

    What has two columns is of the aisle to the right and of that to the left.
    """

    xy_m: Float
    row_start: Int
    row: Int  # (r,) the row of each piece
    block: Int  # (r,) as people call it
    spacing_m: Float  # (r, 2) as in `RowLines`
    aisle: Int  # (r, 2)
    place_m: Float  # (n, 2)
    off_m: Float  # (n, 2)
    lane_m: Float  # (r, 2, 2): aisle, then low and high end

    def __repr__(self) -> str:
        return f"<BentPieces: {len(self.xy_m)} plants>"


def bent_grid(
    frame: Frame,
    rows: RowLines,
    plants: tuple[Float, Int],
    ground: Ground,
    planting: Planting,
) -> PlantGrid:
    """Return plants in rows that run as lines.

    Parameters
    ----------
    frame
        The plane of all that is in metres.
    rows
        The rows; those without a plant are left out.
    plants
        Positions ``(n, 2)``, row by row along each, and the row of each, ``(n,)``.
    ground
        Where rows and lanes may be.
    planting
        Spacings, headland and faces.
    """
    aisles = ground.aisles or row_aisles(rows, planting)
    blocked = ground.blocked
    if blocked is None:
        blocked = blocked_by(ground.obstacles, rows, aisles, planting)
    pieces = _pieces(rows, aisles, plants, blocked, planting)
    area = _around(rows, aisles, pieces, ground, planting)
    return _assembled(frame, pieces, aisles.lines, area, planting)


def row_aisles(rows: RowLines, planting: Planting) -> RowAisles:
    """Return the aisles of rows, out into their headlands."""
    beyond_m = 2 * planting.headland_m
    return aisles_of(rows.lines, rows.block, rows.spacings(planting)[:, 0], beyond_m)


def _around(
    rows: RowLines, aisles: RowAisles, pieces: BentPieces, ground: Ground, planting: Planting
) -> MultiPolygon:
    """Return where one may drive: the area that is known, if it holds all lanes."""
    if ground.area is not None:
        lane = np.repeat(pieces.aisle[:, _LEFT], 2)
        ends = aisles.lines.points(lane, pieces.lane_m[:, _LEFT].ravel())
        grown = shapely.buffer(ground.area, _SLACK_M)
        shapely.prepare(grown)
        if shapely.covers(grown, shapely.points(ends)).all():
            return ground.area
    reach = _reach(rows, planting)
    reach = shapely.union(reach, _beyond(reach, aisles, pieces))
    reach = shapely.difference(reach, ground.obstacles)
    return _polygons(reach if ground.area is None else shapely.union(ground.area, reach))


def blocked_by(
    obstacles: shapely.Geometry, rows: RowLines, aisles: RowAisles, planting: Planting
) -> Blocked:
    """Return where something stands between rows and the aisle they are inspected from."""
    if shapely.is_empty(obstacles):
        return Blocked.nowhere()

    def shut(shapes: NDArray[np.object_]) -> NDArray[np.bool_]:
        met: NDArray[np.bool_] = shapely.intersects(obstacles, shapes)
        return met

    return shut_stretches(rows, aisles, planting, shut)


def shut_stretches(
    rows: RowLines,
    aisles: RowAisles,
    planting: Planting,
    shut: Callable[[NDArray[np.object_]], NDArray[np.bool_]],
    *,
    whole: bool = False,
) -> Blocked:
    """Return the stretches of rows whose strip to the aisle is shut, headlands included.

    `shut` tells of shapes ``(k,)`` whether they are; it is asked of long strips first, and of
    fine ones where these are. The `whole` strip reaches to both aisles, whichever is needed.
    """
    sides = _BOTH if whole or planting.faces == 2 else _ONE
    far_m = planting.headland_m + 1.0
    plant_m = float(rows.spacings(planting)[:, 1].min())
    coarse_m = 16 * plant_m
    n = np.ceil((rows.lines.length_m + 2 * far_m) / coarse_m).astype(np.int64)
    k, row = runs(np.zeros(len(n), np.int64), n)
    from_m = np.asarray(k * coarse_m - far_m, np.float64)
    to_m: Float = np.minimum(from_m + coarse_m, rows.lines.length_m[row] + far_m)
    hit = np.flatnonzero(shut(_strips(rows, aisles, sides, (row, from_m, to_m))))
    m = int(np.ceil(coarse_m / (_FINE * plant_m)))
    j, of = runs(np.zeros(len(hit), np.int64), np.full(len(hit), m))
    row, step = row[hit][of], ((to_m - from_m)[hit] / m)[of]
    from_m = from_m[hit][of] + j * step
    to_m = from_m + step
    shut_ones = np.flatnonzero(shut(_strips(rows, aisles, sides, (row, from_m, to_m))))
    row, from_m, to_m = row[shut_ones], from_m[shut_ones], to_m[shut_ones]
    if not len(row):
        return Blocked.nowhere()
    new = np.append(True, (np.diff(row) > 0) | (from_m[1:] > to_m[:-1] + 1e-6))
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(row)) - 1
    return Blocked(row[first], from_m[first], to_m[last])


def _strips(
    rows: RowLines, aisles: RowAisles, sides: int, stretches: tuple[Int, Float, Float]
) -> NDArray[np.object_]:
    """Return the ground between rows and the middle of their aisle, or both, as polygons.

    With every corner of either side: a lane lies on the edge.
    """
    row, from_m, to_m = stretches

    def aisle_middle(side: int) -> Polylines:
        aisle = (aisles.left if side == _LEFT else aisles.right)[row]
        ends = (rows.lines.points(row, place_m) for place_m in (from_m, to_m))
        low, high = (aisles.lines.project(end, aisle)[0] for end in ends)
        return aisles.lines.stretches(aisle, low, high)

    left = aisle_middle(_LEFT)
    right = aisle_middle(_RIGHT) if sides == _BOTH else rows.lines.stretches(row, from_m, to_m)
    owner = np.concatenate([np.repeat(np.arange(len(row)), np.diff(right.start)),
                            np.repeat(np.arange(len(row)), np.diff(left.start))[::-1]])  # fmt: skip
    corners = np.concatenate([right.xy_m, left.xy_m[::-1]])
    order = np.argsort(owner, kind="stable")
    rings = shapely.linearrings(corners[order], indices=owner[order])
    return np.asarray(shapely.polygons(rings), np.object_)


def _pieces(
    rows: RowLines,
    aisles: RowAisles,
    plants: tuple[Float, Int],
    blocked: Blocked,
    planting: Planting,
) -> BentPieces:
    """Return the rows of plants, cut where they cannot go on."""
    xy_m, row = plants
    on_row, _ = rows.lines.project(xy_m, row)
    if not (np.diff(_key(row, on_row)) >= 0).all():
        order = np.lexsort((on_row, row))
        xy_m, row, on_row = xy_m[order], row[order], on_row[order]
    cut = np.searchsorted(_key(blocked.row, (blocked.from_m + blocked.to_m) / 2), _key(row, on_row))
    new = (np.diff(row, prepend=row[:1]) > 0) | (np.diff(cut, prepend=cut[:1]) > 0)
    piece = np.cumsum(new.astype(np.int64))
    start = offsets(np.bincount(piece))
    first, last = start[:-1], start[1:] - 1
    of = row[first]
    aisle = np.stack([aisles.right[of], aisles.left[of]], axis=1)
    place, off = np.empty((len(xy_m), 2)), np.empty((len(xy_m), 2))
    for side in (_RIGHT, _LEFT):
        at, left = aisles.lines.project(xy_m, aisle[piece, side])
        # plants measured side by side keep their order along the row
        place[:, side] = _rising(at, piece)
        off[:, side] = np.abs(left)
    room = _room(on_row, of, (first, last), blocked)
    spacing = rows.spacings(planting)[of]
    clear = np.clip(room / 2, spacing[:, 1:] / 4, planting.headland_m / 2)
    lane = np.stack([place[first] - clear[:, :1], place[last] + clear[:, 1:]], axis=2)
    lane = _off_other_blocks(lane, rows, aisles, (of, aisle), (place[first], place[last]))
    called = rows.block if rows.called is None else rows.called
    return BentPieces(xy_m, start, of, called[of], spacing, aisle, place, off, lane)


def _key(row: Int, place_m: Float) -> Float:
    """Return one ascending axis for all rows."""
    return row * _FAR_M + place_m


def _rising(at_m: Float, piece: Int) -> Float:
    """Return places that never fall within a piece."""
    shift = (float(np.ptp(at_m)) + 1.0) * piece
    rising: Float = np.maximum.accumulate(at_m + shift) - shift
    return rising


def _room(on_row: Float, of: Int, ends: tuple[Int, Int], blocked: Blocked) -> Float:
    """Return how far it is from each piece's ends to where its row is blocked, ``(r, 2)``."""
    low, high = (on_row[end] for end in ends)
    if not len(blocked.row):
        return np.full((len(of), 2), np.inf)
    middle_m = (blocked.from_m + blocked.to_m) / 2
    before = np.searchsorted(_key(blocked.row, middle_m), _key(of, low))
    known = np.append(blocked.row, -1)
    from_m, to_m = np.append(blocked.from_m, 0.0), np.append(blocked.to_m, 0.0)
    room_low = np.where((before > 0) & (known[before - 1] == of), low - to_m[before - 1], np.inf)
    room_high = np.where(known[before] == of, from_m[before] - high, np.inf)
    return np.stack([room_low, room_high], axis=1)


def _off_other_blocks(
    lane_m: Float,
    rows: RowLines,
    aisles: RowAisles,
    of: tuple[Int, Int],
    plants_at: tuple[Float, Float],
) -> Float:
    """Return lanes that end clear of the rows of other blocks, as far as there is room."""
    if rows.block[-1] == 0:
        return lane_m
    row, aisle = of
    lines = rows.lines.simpler(0.05).shapes()
    moved = lane_m.copy()
    for block in np.unique(rows.block):
        others = shapely.union_all(lines[rows.block != block])
        shapely.prepare(others)
        mine = np.flatnonzero(rows.block[row] == block)
        for side in (_RIGHT, _LEFT):
            for end in range(2):
                plant_m = plants_at[end][mine, side]
                beyond = moved[mine, side, end] - plant_m
                share = np.full(len(mine), 0.25)
                for part in (0.5, 0.75, 1.0):
                    at = aisles.lines.points(aisle[mine, side], plant_m + part * beyond)
                    off = shapely.distance(others, shapely.points(at))
                    good = off >= np.minimum(part * np.abs(beyond), _CLEAR_M)
                    share[good & (share >= part - 0.25)] = part
                moved[mine, side, end] = plant_m + share * beyond
    return moved


def _assembled(
    frame: Frame, pieces: BentPieces, aisles: Polylines, area: MultiPolygon, planting: Planting
) -> PlantGrid:
    """Return the grid of pieces of rows, with one face or two."""
    piece, upper = _faces(pieces, planting)
    n_plants = np.diff(pieces.row_start)[piece]
    start = offsets(n_plants)
    plant, row = runs(pieces.row_start[piece], n_plants)
    xy_m, place_m = pieces.xy_m[plant], pieces.place_m[plant, upper[row]]
    aisle, lane_m = pieces.aisle[piece, upper], pieces.lane_m[piece, upper]
    row_m, plant_m = pieces.spacing_m[piece[row]].T
    if planting.faces == 2:
        twin = _twins(pieces, piece, upper, (start, plant, row))
        lower = np.flatnonzero(twin > np.arange(len(twin)))
        corridor = _corridors(aisle, lane_m)
        across = adjacency.lists(len(twin), lower, twin[lower])
    else:
        twin, corridor = np.full(len(xy_m), -1), np.arange(len(piece))
        sides = pieces.aisle[row], pieces.place_m, pieces.off_m
        across = adjacency.across_aisles(*sides, row_m, plant_m)
    return PlantGrid(
        frame,
        xy_m,
        start,
        np.unique(pieces.row, return_inverse=True)[1][piece].astype(np.int32),
        np.zeros(len(piece)),
        lane_m.copy(),
        corridor.astype(np.int32),
        np.where(upper == 1, _UPPER, _LOWER).astype(np.int8),
        area,
        float(np.median(row_m)),
        float(np.median(plant_m)),
        *adjacency.along(place_m, row, plant_m),
        *across,
        twin.astype(np.int32),
        np.unique(pieces.block, return_inverse=True)[1][piece].astype(np.int32),
        place_m,
        aisle.astype(np.int32),
        aisles.start,
        aisles.xy_m,
        planting.half_canopy_m,
    )


def _faces(pieces: BentPieces, planting: Planting) -> tuple[Int, Int]:
    """Return the piece and the side of each row of the grid: one face a piece, or two."""
    r = len(pieces.row)
    if planting.faces == 1:
        return np.arange(r), np.full(r, _LEFT)
    piece, upper = np.tile(np.arange(r), 2), np.repeat([_RIGHT, _LEFT], r)
    order = np.lexsort((piece, upper, pieces.row[piece]))
    piece, upper = piece[order], upper[order]
    if planting.outer_faces:
        return piece, upper
    corridor = _corridors(pieces.aisle[piece, upper], pieces.lane_m[piece, upper])
    sides = [np.bincount(corridor, upper == side) > 0 for side in (_RIGHT, _LEFT)]
    inner = (sides[0] & sides[1])[corridor]
    if not inner.any():
        raise PlotError(
            worded(
                "Two rows or more must face each other if outer faces are not "
                "inspected, but no two do. Inspect outer faces too, or one "
                "face only."
            )
        )
    return piece[inner], upper[inner]


def _twins(
    pieces: BentPieces, piece: Int, upper: Int, plants: tuple[Int, Int, Int]
) -> NDArray[np.int64]:
    start, plant, row = plants
    twin_row = np.full((len(pieces.row), 2), -1)
    twin_row[piece, 1 - upper] = np.arange(len(piece))
    other = twin_row[piece, upper][row]
    place = plant - pieces.row_start[piece][row]
    return np.where(other >= 0, start[other] + place, -1)


def _corridors(aisle: Int, lane_m: Float) -> Int:
    """Return a number for each row: the same where lanes of one aisle touch or overlap."""
    order = np.lexsort((lane_m[:, 0], aisle))
    low, high = lane_m[order, 0], lane_m[order, 1]
    shift = aisle[order] * (float(high.max() - low.min()) + 1.0)
    reached = np.maximum.accumulate(high + shift)
    apart = np.append(True, (low + shift)[1:] > reached[:-1] + 1e-6)
    corridor = np.empty(len(order), np.int64)
    corridor[order] = np.cumsum(apart) - 1
    return corridor


def _reach(rows: RowLines, planting: Planting) -> shapely.Geometry:
    """Return what rows, their aisles and headlands cover."""
    long = rows.lines.extended(planting.headland_m).simpler(0.05).shapes()
    # neighbours are at most 1.7 spacings apart
    half_m = 0.9 * rows.spacings(planting)[:, 0]
    wide = shapely.buffer(long, half_m, cap_style="flat", quad_segs=2)
    return shapely.union_all(wide)


def _beyond(reach: shapely.Geometry, aisles: RowAisles, pieces: BentPieces) -> shapely.Geometry:
    """Return the ground about lane ends that lie beyond what rows reach.

    An aisle beside a row that bends at its end may end farther out than the row's headland.
    """
    lane = np.repeat(pieces.aisle[:, _LEFT], 2)
    ends_m = aisles.lines.points(lane, pieces.lane_m[:, _LEFT].ravel())
    shapely.prepare(reach)
    beyond = ~shapely.covers(reach, shapely.points(ends_m))
    half_m = np.repeat(pieces.spacing_m[:, 0], 2)[beyond] / 2
    ground: shapely.Geometry = shapely.union_all(
        shapely.buffer(shapely.points(ends_m[beyond]), half_m, quad_segs=2)
    )
    return ground


def _polygons(area: shapely.Geometry) -> MultiPolygon:
    return MultiPolygon([part for part in shapely.get_parts(area) if part.geom_type == "Polygon"])
