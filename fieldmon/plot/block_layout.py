"""Plants laid in blocks, each with rows of its own direction, spacings and bend."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from shapely import MultiLineString, MultiPolygon

from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError
from fieldmon.plot.aisle_lines import RowAisles
from fieldmon.plot.bent_layout import bent_grid
from fieldmon.plot.line_layout import LaidRows, copies, is_straight, rows_along
from fieldmon.plot.outline_bearing import area_bearing
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_detection import rows_from_lines
from fieldmon.plot.row_lines import Blocked, Ground, RowLines, row_aisles
from fieldmon.plot.strips import best_strips, check_size, fill, no_room

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.block import Block
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.planting import Planting
    from fieldmon.plot.projection import Frame
    from fieldmon.plot.strips import Intervals

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# rows farther apart than this many spacings have other ground between them
_APART = 1.5
# a drawn row belongs to the block in which most of it lies
_MOST = 0.5


class _BlockGround(NamedTuple):
    """A block on its plot: what is drivable of it, in metres, and the rows drawn in it."""

    block: Block
    area: MultiPolygon
    drawn: MultiLineString
    planting: Planting


def lay_blocks(
    field: Field, planting: Planting, obstacles: Callable[[Field, Frame], shapely.Geometry]
) -> PlantGrid:
    """Return plants in the rows of each block of a plot, wherever whole rows fit into it.

    Rows of a block run as they were drawn in it, as copies of the only one drawn in it, as its
    bearing says, or along its longest side; each block has headlands of its own.

    Parameters
    ----------
    field
        The plot with its blocks.
    planting
        What holds for blocks that do not say otherwise.
    obstacles
        Returns what stands in the way on a field, in metres of a frame.

    Raises
    ------
    PlotError
        If a block has no room for a plant, or is not on the plot.
    """
    grounds = [_ground(field, block, planting) for block in field.blocks]
    largest = max(grounds, key=lambda ground: ground.area.area)
    frame = field.frame(_bearing(field, largest))
    laid = [_laid(field, ground, frame) for ground in grounds]
    rows, aisles, blocked, plants = _together(laid, [g.planting for g in grounds])
    area = frame.geometry_m(field.drivable())
    ground = Ground(area, obstacles(field, frame), blocked, aisles)
    return bent_grid(frame, rows, plants, ground, planting)


def _ground(field: Field, block: Block, planting: Planting) -> _BlockGround:
    on_plot = shapely.intersection(block.area, field.drivable())
    # where nothing is left, GEOS has one part, which is empty
    parts = [
        part for part in shapely.get_parts(on_plot) if part.geom_type == "Polygon" and part.area > 0
    ]
    if not parts:
        raise PlotError(
            worded(
                "Blocks must lie on their plot, but block {name!r} does not "
                "overlap {plot!r} where plants may stand. Leave it out, or draw "
                "it again.",
                name=block.name,
                plot=field.name,
            )
        )
    stated = {
        name: value
        for name in ("row_bearing_deg", "row_spacing_m", "plant_spacing_m")
        if (value := getattr(block, name)) is not None
    }
    own = replace(planting, **stated)
    return _BlockGround(block, MultiPolygon(parts), drawn_in(field, block), own)


def drawn_in(field: Field, block: Block) -> MultiLineString:
    """Return the rows of a plot that were drawn in a block of it: those that lie there mostly."""
    return MultiLineString(
        [
            line
            for line in field.row_lines.geoms
            if shapely.intersection(line, block.area).length > _MOST * line.length
        ]
    )


def _bearing(field: Field, ground: _BlockGround) -> float:
    """Return the direction of a block's rows: as drawn, as said, or along its longest side."""
    if not ground.drawn.is_empty:
        return rows_from_lines(replace(field, row_lines=ground.drawn)).bearing_deg
    if ground.planting.row_bearing_deg is not None:
        return ground.planting.row_bearing_deg
    return area_bearing(field.frame().geometry_m(ground.area)).bearing_deg


def _laid(field: Field, ground: _BlockGround, frame: Frame) -> LaidRows:
    """Return the rows of a block with their plants, in metres of the plot's frame."""
    own = frame.turned(_bearing(field, ground))
    area = own.geometry_m(ground.area)
    name = f"{field.name}, block {ground.block.name}" if ground.block.name else field.name
    check_size(name, area, ground.planting)
    lines = [shapely.get_coordinates(own.geometry_m(line)) for line in ground.drawn.geoms]
    if len(lines) == 1 and is_straight(lines[0], ground.planting.row_spacing_m):
        lines = []
    if lines:
        whole = len(lines) == 1
        if whole:
            lines = copies(lines[0], area, ground.planting.row_spacing_m)
        there = [frame.xy_m(own.lonlat(line)) for line in lines]
        there_m = frame.geometry_m(ground.area)
        laid, planting = rows_along(frame, there, there_m, ground.planting, whole=whole)
        spacing_m = laid.rows.spacings(planting)
        laid = laid._replace(rows=laid.rows._replace(spacing_m=spacing_m))
    else:
        laid = _straight(area, (own, frame), ground.planting)
    if not len(laid.plants[0]):
        raise no_room(name, area, ground.planting)
    return laid


def _straight(area: MultiPolygon, frames: tuple[Frame, Frame], planting: Planting) -> LaidRows:
    """Return straight rows along x of the first frame, in metres of the second."""
    y, free = best_strips(area, planting)
    if not len(free.strip):
        return _nothing()
    pieces = fill(y, free, planting)
    own, frame = frames
    strip, first = np.unique(free.strip, return_index=True)
    low, high = free.low_x[first], np.maximum.reduceat(free.high_x, first)
    ends = np.stack([np.stack([low, y[strip]], 1), np.stack([high, y[strip]], 1)], axis=1)
    start = 2 * np.arange(len(strip) + 1)
    lines = Polylines.of(start, frame.xy_m(own.lonlat(ends.reshape(-1, 2))))
    block = np.cumsum(np.diff(y[strip], prepend=y[strip[0]]) > _APART * planting.row_spacing_m)
    each = np.tile([planting.row_spacing_m, planting.plant_spacing_m], (len(strip), 1))
    rows = RowLines(lines, block.astype(np.int64), each)
    place = np.searchsorted(strip, free.strip)
    row = np.searchsorted(y[strip], pieces.xy_m[:, 1] - planting.row_spacing_m / 2)
    xy_m = frame.xy_m(own.lonlat(pieces.xy_m))
    return LaidRows(rows, row_aisles(rows, planting), _between(free, place, low), (xy_m, row))


def _between(free: Intervals, row: Int, low_x: Float) -> Blocked:
    """Return the stretches of rows before, between and after those that are free."""
    first = np.diff(row, prepend=-1) != 0
    last = np.append(first[1:], True)
    begins, ends = free.low_x - low_x[row], free.high_x - low_x[row]
    before = np.where(first, begins - 2.0, np.append(0.0, ends[:-1]))
    all_row = np.concatenate([row, row[last]])
    from_m = np.concatenate([before, ends[last]])
    to_m = np.concatenate([begins, ends[last] + 2.0])
    order = np.lexsort((from_m, all_row))
    return Blocked(all_row[order].astype(np.int64), from_m[order], to_m[order])


def _nothing() -> LaidRows:
    none, nobody = np.empty(0, np.int64), Polylines.each([])
    rows = RowLines(nobody, none)
    aisles = RowAisles(nobody, none, none)
    return LaidRows(rows, aisles, Blocked.nowhere(), (np.empty((0, 2)), none))


def _together(laid: list[LaidRows], plantings: list[Planting]) -> LaidRows:
    """Return the rows of all blocks, numbered on from block to block."""
    n_rows = np.cumsum([0, *(len(one.rows.block) for one in laid)])
    n_aisles = np.cumsum([0, *(len(one.aisles.lines) for one in laid)])
    n_groups = np.cumsum([0, *(int(one.rows.block[-1]) + 1 for one in laid)])
    numbered = list(enumerate(laid))
    spacings = zip(laid, plantings, strict=True)
    rows = RowLines(
        _joined([one.rows.lines for one in laid]),
        np.concatenate([one.rows.block + n_groups[k] for k, one in numbered]),
        np.concatenate([one.rows.spacings(planting) for one, planting in spacings]),
        np.concatenate([np.full(len(one.rows.block), k) for k, one in numbered]),
    )
    aisles = RowAisles(
        _joined([one.aisles.lines for one in laid]),
        np.concatenate([one.aisles.right + n_aisles[k] for k, one in numbered]),
        np.concatenate([one.aisles.left + n_aisles[k] for k, one in numbered]),
    )
    blocked = Blocked(
        np.concatenate([one.blocked.row + n_rows[k] for k, one in numbered]),
        np.concatenate([one.blocked.from_m for one in laid]),
        np.concatenate([one.blocked.to_m for one in laid]),
    )
    xy_m = np.concatenate([one.plants[0] for one in laid])
    row = np.concatenate([one.plants[1] + n_rows[k] for k, one in numbered])
    return LaidRows(rows, aisles, blocked, (xy_m, row))


def _joined(lines: list[Polylines]) -> Polylines:
    return Polylines.each([each.line(k) for each in lines for k in range(len(each))])
