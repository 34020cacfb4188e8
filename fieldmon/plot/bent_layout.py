"""Plants in rows that bend, in blocks that turn, as a grid with its headlands."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.compute.arrays import offsets, runs
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError
from fieldmon.plot import adjacency
from fieldmon.plot.bent_pieces import bent_pieces
from fieldmon.plot.ends_within import lanes_within
from fieldmon.plot.grid import PlantGrid
from fieldmon.plot.polygons import polygons_of
from fieldmon.plot.row_lines import LEFT, RIGHT, blocked_by, row_aisles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.aisle_lines import RowAisles
    from fieldmon.plot.bent_pieces import BentPieces
    from fieldmon.plot.planting import Planting
    from fieldmon.plot.polylines import Polylines
    from fieldmon.plot.projection import Frame
    from fieldmon.plot.row_lines import Ground, RowLines

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_LOWER, _UPPER = 1, -1


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
    pieces = bent_pieces(rows, aisles, plants, blocked, planting)
    if ground.area is None:
        area = _about(rows, np.arange(len(rows.block)), (aisles, pieces), ground, planting)
        return _assembled(frame, pieces, aisles.lines, area, planting)
    pieces, shut = _within(pieces, aisles.lines, ground.area, planting)
    grid = _assembled(frame, pieces, aisles.lines, ground.area, planting)
    if not shut.any():
        return grid
    some = pieces._replace(
        aisle=pieces.aisle[shut], lane_m=pieces.lane_m[shut], spacing_m=pieces.spacing_m[shut]
    )
    reach = _about(rows, np.unique(pieces.row[shut]), (aisles, some), ground, planting)
    return replace(grid, beyond_m=polygons_of(shapely.difference(reach, ground.area)))


def _within(
    pieces: BentPieces, aisles: Polylines, area: MultiPolygon, planting: Planting
) -> tuple[BentPieces, NDArray[np.bool_]]:
    """Return pieces whose lanes end within an area, and which ``(r,)`` have no such end."""
    ends = np.stack([pieces.row_start[:-1], pieces.row_start[1:] - 1], axis=1)
    lane_m, shut = pieces.lane_m.copy(), np.zeros(len(pieces.row), np.bool_)
    for side in (RIGHT, LEFT) if planting.faces == 2 else (LEFT,):
        plant_m, aisle = pieces.place_m[ends, side], np.repeat(pieces.aisle[:, side], 2)
        beyond_m = np.abs(lane_m[:, side] - plant_m)
        outwards = aisles.stretches(aisle, plant_m.ravel(), lane_m[:, side].ravel()).shapes()
        known_m, out = lanes_within(beyond_m, [outwards], area)
        moved = plant_m + known_m * [-1.0, 1.0]
        lane_m[:, side] = np.where(known_m < beyond_m, moved, lane_m[:, side])
        shut |= out
    return pieces._replace(lane_m=lane_m), shut


def _about(
    rows: RowLines,
    some: Int,
    lanes: tuple[RowAisles, BentPieces],
    ground: Ground,
    planting: Planting,
) -> MultiPolygon:
    """Return where some rows with their pieces, aisles and headlands reach."""
    reach = _reach(rows, some, planting)
    reach = shapely.union(reach, _beyond(reach, *lanes))
    return polygons_of(shapely.difference(reach, ground.obstacles))


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
        return np.arange(r), np.full(r, LEFT)
    piece, upper = np.tile(np.arange(r), 2), np.repeat([RIGHT, LEFT], r)
    order = np.lexsort((piece, upper, pieces.row[piece]))
    piece, upper = piece[order], upper[order]
    if planting.outer_faces:
        return piece, upper
    corridor = _corridors(pieces.aisle[piece, upper], pieces.lane_m[piece, upper])
    sides = [np.bincount(corridor, upper == side) > 0 for side in (RIGHT, LEFT)]
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


def _reach(rows: RowLines, some: Int, planting: Planting) -> shapely.Geometry:
    """Return what some rows, their aisles and headlands cover."""
    long = rows.lines.extended(planting.headland_m).simpler(0.05).shapes()[some]
    # neighbours are at most 1.7 spacings apart
    half_m = 0.9 * rows.spacings(planting)[some, 0]
    wide = shapely.buffer(long, half_m, cap_style="flat", quad_segs=2)
    return shapely.union_all(wide)


def _beyond(reach: shapely.Geometry, aisles: RowAisles, pieces: BentPieces) -> shapely.Geometry:
    """Return the ground about lane ends that lie beyond what rows reach.

    An aisle beside a row that bends at its end may end farther out than the row's headland.
    """
    lane = np.repeat(pieces.aisle[:, LEFT], 2)
    ends_m = aisles.lines.points(lane, pieces.lane_m[:, LEFT].ravel())
    shapely.prepare(reach)
    beyond = ~shapely.covers(reach, shapely.points(ends_m))
    half_m = np.repeat(pieces.spacing_m[:, 0], 2)[beyond] / 2
    ground: shapely.Geometry = shapely.union_all(
        shapely.buffer(shapely.points(ends_m[beyond]), half_m, quad_segs=2)
    )
    return ground
