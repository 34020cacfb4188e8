"""Plants laid into a crooked boundary, or taken from positions measured on the plot."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from fieldmon.compute.arrays import offsets, runs
from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError, SettingError
from fieldmon.plot import adjacency
from fieldmon.plot.block_layout import lay_blocks
from fieldmon.plot.clear_lanes import measured_clear
from fieldmon.plot.ends_within import lanes_within
from fieldmon.plot.grid import PlantGrid
from fieldmon.plot.line_layout import copies, is_straight, lay_along
from fieldmon.plot.measured_rows import (
    SaidRows,
    bent_rows,
    measured_grid,
    rows_in_blocks,
    said_rows,
)
from fieldmon.plot.outline_bearing import bearing_of
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.planting import Planting
from fieldmon.plot.polygons import polygons_of
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_detection import (
    distinct,
    frame_around,
    rows_from_lines,
    rows_from_plants,
    split_lines,
)
from fieldmon.plot.row_lines import Ground
from fieldmon.plot.strips import (
    SLACK_M,
    Intervals,
    Pieces,
    best_strips,
    check_size,
    fill,
    free_intervals,
    no_room,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field
    from fieldmon.plot.row_detection import Rows
    from fieldmon.plot.row_tracing import TracedRows

    Float = NDArray[np.float64]

_PARAN = (35.15, 30.36)
_LOWER, _UPPER = 1, -1


def lay(field: Field, planting: Planting) -> PlantGrid:
    """Return plants in straight rows wherever a whole row and its headlands fit into the plot.

    A row takes a strip as wide as the row spacing. Where the whole strip is inside the boundary
    and outside holes and no-go areas, plants stand at least a headland from its two ends, and
    lanes end in the middle of the headlands; so the row, its aisle and its row ends are all on
    the plot. Rows are placed across the plot, and plants along the rows, such that most fit.
    Where rows were drawn, or the plot has blocks, plants stand along these, or in each of those.
    Raise `PlotError` if there is no room for a plant.
    """
    if field.blocks:
        return lay_blocks(field, planting, _obstacles)
    if (along := _drawn_rows(field, planting)) is not None:
        return along
    bearing_deg = planting.row_bearing_deg
    if not field.row_lines.is_empty:
        bearing_deg = rows_from_lines(field).bearing_deg
    elif bearing_deg is None:
        bearing_deg = bearing_of(field).bearing_deg
    frame = field.frame(bearing_deg)
    area = frame.geometry_m(field.drivable())
    check_size(field.name, area, planting)
    y, free = best_strips(area, planting)
    if not len(free.strip):
        raise no_room(field.name, area, planting)
    return assemble(frame, fill(y, free, planting), area, planting)


def _drawn_rows(field: Field, planting: Planting) -> PlantGrid | None:
    """Return plants along the rows that were drawn; None where straight ones do as well."""
    if field.row_lines.is_empty:
        return None
    frame = field.frame(rows_from_lines(field).bearing_deg)
    lines = [shapely.get_coordinates(line) for line in frame.geometry_m(field.row_lines).geoms]
    area = frame.geometry_m(field.drivable())
    whole = len(lines) == 1
    if whole:
        if is_straight(lines[0], planting.row_spacing_m):
            return None
        check_size(field.name, area, planting)
        lines = copies(lines[0], area, planting.row_spacing_m)
    elif away_m := float(shapely.distance(area, frame.geometry_m(field.row_lines))):
        raise PlotError(
            worded(
                "Rows must be drawn on their plot, but of {n} none is on {name!r}: the nearest is "
                "{away} away. Choose the plot's own rows, or check the coordinate systems.",
                n=len(lines),
                name=field.name,
                away=distance_figure(away_m),
            )
        )
    ground = Ground(area, _obstacles(field, frame))
    return lay_along(field.name, frame, lines, ground, planting, whole=whole)


def found_planting(lonlat: Float, planting: Planting | None = None) -> Planting:
    """Return a planting with the bearing and the spacings in which measured plants stand.

    Spacings that the plants do not show (of a single row, say) stay as in the given planting;
    its row bearing, if any, says about where to look.
    """
    planting = planting or Planting()
    return planting_in(rows_from_plants(lonlat, planting.row_bearing_deg), planting)


def planting_in(found: Rows, planting: Planting) -> Planting:
    """Return a planting with the bearing and the spacings of rows that were found."""
    return replace(
        planting,
        row_bearing_deg=found.bearing_deg,
        row_spacing_m=found.row_spacing_m or planting.row_spacing_m,
        plant_spacing_m=found.plant_spacing_m or planting.plant_spacing_m,
    )


def grid_from_plants(
    lonlat: Float,
    planting: Planting | None = None,
    field: Field | None = None,
    said: SaidRows | None = None,
) -> PlantGrid:
    """Return plants as they were measured, sorted into rows.

    Rows are straight and run one way, unless plants stand much better in rows that bend, or in
    blocks of several directions.

    A gap in a row is missing plants; only holes and no-go areas of the field cut a row. Aisles
    run midway between the plants of neighbouring rows, lanes end half a headland beyond the last
    plants. A robot may drive where the field's boundary says, or without a field wherever the
    rows with their aisles and headlands reach. Lanes that would end outside end before the
    boundary if there is room; about rows that have no end within it one may drive outside.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees, in any order. `nearest_plants` leads back from them to the grid.
    planting
        Bearing and spacings as found or given (see `found_planting`); None: found.
    field
        Boundary, holes and no-go areas to keep, or None.
    said
        What decides; None: the names of the field's rows, and a bearing in the planting.

    Raises
    ------
    PlotError
        If plants share a position, or none stands on the field.
    """
    lonlat = np.asarray(lonlat, dtype=np.float64).reshape(-1, 2)
    check_apart(lonlat)
    if said is None:
        bearing = planting is not None and planting.row_bearing_deg is not None
        names = PlantNames() if field is None else PlantNames.of(field)
        said = said_rows(lonlat, names, field, bearing=bearing)
    if planting is None or planting.row_bearing_deg is None:
        planting = found_planting(lonlat, planting)
    frame = (field.frame() if field else frame_around(lonlat)).turned(
        planting.row_bearing_deg or 0.0
    )
    xy_m = frame.xy_m(lonlat)
    line = split_lines(xy_m[:, 1], planting.row_spacing_m)
    obstacles = _obstacles(field, frame)
    bent: TracedRows | None
    called = None
    if said.block is not None and said.block.any():
        bent, called = rows_in_blocks(lonlat, frame, said)
    else:
        bent = bent_rows(xy_m, line, planting.row_spacing_m, said)
    if bent is not None:
        area = None if field is None else held_area(field, frame, xy_m)
        grid = measured_grid(frame, xy_m, (bent, called), Ground(area, obstacles), planting)
        return measured_clear(grid, obstacles)
    order = np.lexsort((xy_m[:, 0], line))
    xy_m, line = xy_m[order], line[order]
    pieces = _pieces(xy_m, line, _aisles(xy_m[:, 1], line, planting), obstacles, planting)
    if field is None:
        reach = shapely.difference(_reach(pieces, planting), obstacles)
        return assemble(frame, pieces, polygons_of(reach), planting)
    area = held_area(field, frame, xy_m)
    pieces, shut = _within(pieces, area, planting)
    grid = measured_clear(assemble(frame, pieces, area, planting), obstacles)
    if not shut.any():
        return grid
    reach = shapely.difference(_reach(pieces, planting, shut), obstacles)
    return replace(grid, beyond_m=polygons_of(shapely.difference(reach, area)))


def held_area(field: Field, frame: Frame, xy_m: Float) -> MultiPolygon:
    """Return where one may drive on a field, which must hold some of the plants."""
    area = frame.geometry_m(field.drivable())
    if not shapely.contains_xy(area, xy_m).any():
        raise PlotError(
            worded(
                "Measured plants must stand on plot {name!r}, but none of {n} "
                "does. Choose the plants' own plot, or check the coordinate "
                "systems.",
                name=field.name,
                n=len(xy_m),
            )
        )
    return area


def rectangle(
    n_rows: int,
    n_plants: int,
    planting: Planting | None = None,
    centre: tuple[float, float] = _PARAN,
) -> PlantGrid:
    """Return exactly ``n_rows`` rows of ``n_plants`` plants about a (lon, lat), as in the thesis.

    Rows point east unless the planting says otherwise.
    """
    if n_rows < 1 or n_plants < 1:
        raise SettingError(
            worded(
                "A rectangle of plants must have at least 1 row of 1 plant, but {n_rows} rows "
                "of {n_plants} plants were asked for.",
                n_rows=n_rows,
                n_plants=n_plants,
            )
        )
    planting = planting or Planting()
    bearing_deg = 90.0 if planting.row_bearing_deg is None else planting.row_bearing_deg
    y: Float = (np.arange(n_rows, dtype=float) - (n_rows - 1) / 2) * planting.row_spacing_m
    half = (n_plants - 1) / 2 * planting.plant_spacing_m + planting.headland_m
    free = Intervals(np.arange(n_rows), np.full(n_rows, -half), np.full(n_rows, half))
    half_y = n_rows / 2 * planting.row_spacing_m
    area = MultiPolygon([shapely.box(-half, -half_y, half, half_y)])
    return assemble(Frame(*centre, bearing_deg), fill(y, free, planting), area, planting)


def assemble(frame: Frame, pieces: Pieces, area: MultiPolygon, planting: Planting) -> PlantGrid:
    """Return the grid of the given pieces of rows, with one face or two."""
    if planting.faces == 2:
        return _two_faced(frame, pieces, area, planting)
    r = len(pieces.row_line)
    row = np.repeat(np.arange(r), np.diff(pieces.row_start))
    spacings = (planting.row_spacing_m, planting.plant_spacing_m)
    return PlantGrid(
        frame,
        pieces.xy_m,
        pieces.row_start,
        pieces.row_line,
        pieces.aisle_y_m[:, 1].copy(),
        pieces.lane_x_m,
        np.arange(r, dtype=np.int32),
        np.full(r, _UPPER, np.int8),
        area,
        *spacings,
        *adjacency.along(pieces.xy_m[:, 0], row, planting.plant_spacing_m),
        *adjacency.across(pieces.xy_m, pieces.row_line[row], *spacings),
        np.full(len(pieces.xy_m), -1, np.int32),
        half_canopy_m=planting.half_canopy_m,
    )


def _two_faced(frame: Frame, pieces: Pieces, area: MultiPolygon, planting: Planting) -> PlantGrid:
    """Return each piece as two rows: its lower face, then its upper face.

    Insects stay on a face or go to the other face of the same vine; so ``across`` holds the
    twin, and nobody across the aisle.
    """
    r = len(pieces.row_line)
    piece, upper = np.tile(np.arange(r), 2), np.repeat([0, 1], r)
    order = np.lexsort((piece, upper, pieces.row_line[piece]))
    piece, upper = piece[order], upper[order]
    lane_y, lane_x = pieces.aisle_y_m[piece, upper], pieces.lane_x_m[piece]
    corridor = _corridors(lane_y, lane_x)
    if not planting.outer_faces:
        sides = [np.bincount(corridor, upper == side) > 0 for side in (0, 1)]
        inner = (sides[0] & sides[1])[corridor]
        if not inner.any():
            raise PlotError(
                worded(
                    "Two rows or more must face each other if outer faces are not inspected, but "
                    "no two do. Inspect outer faces too, or one face only."
                )
            )
        piece, upper, lane_y, lane_x = piece[inner], upper[inner], lane_y[inner], lane_x[inner]
        corridor = np.unique(corridor[inner], return_inverse=True)[1]
    n_plants = np.diff(pieces.row_start)[piece]
    start = offsets(n_plants)
    plant, row = runs(pieces.row_start[piece], n_plants)
    place = plant - pieces.row_start[piece][row]
    xy_m = pieces.xy_m[plant]
    twin_row = np.full((r, 2), -1)
    twin_row[piece, 1 - upper] = np.arange(len(piece))
    other = twin_row[piece, upper][row]
    twin = np.where(other >= 0, start[other] + place, -1)
    lower = np.flatnonzero(twin > np.arange(len(twin)))
    return PlantGrid(
        frame,
        xy_m,
        start,
        pieces.row_line[piece],
        lane_y,
        lane_x,
        corridor.astype(np.int32),
        np.where(upper == 1, _UPPER, _LOWER).astype(np.int8),
        area,
        planting.row_spacing_m,
        planting.plant_spacing_m,
        *adjacency.along(xy_m[:, 0], row, planting.plant_spacing_m),
        *adjacency.lists(len(twin), lower, twin[lower]),
        twin.astype(np.int32),
        half_canopy_m=planting.half_canopy_m,
    )


def _corridors(lane_y: Float, lane_x: Float) -> NDArray[np.intp]:
    """Return a number for each row: the same where lanes of one aisle touch or overlap."""
    # the y of one aisle, come from the row on either side, may differ in its last digits
    across = np.argsort(lane_y, kind="stable")
    aisle = np.empty(len(across), np.intp)
    aisle[across] = np.cumsum(np.diff(lane_y[across], prepend=-np.inf) > 1e-3)
    order = np.lexsort((lane_x[:, 0], aisle))
    low, high = lane_x[order, 0], lane_x[order, 1]
    shift = aisle[order] * (high.max() - low.min() + 1.0)
    reached = np.maximum.accumulate(high + shift)
    apart = np.append(True, (low + shift)[1:] > reached[:-1] + SLACK_M)
    corridor = np.empty(len(order), np.intp)
    corridor[order] = np.cumsum(apart) - 1
    return corridor


def check_apart(lonlat: Float) -> None:
    """Raise `PlotError` where two plants stand in one place."""
    alone = distinct(lonlat)
    if len(alone) < len(lonlat):
        first = int(np.setdiff1d(np.arange(len(lonlat)), alone)[0])
        raise PlotError(
            worded(
                "No two plants may stand in one place, but {n} of {all} are within 5 cm of an "
                "earlier one, the first of them plant {plant} at ({lon:.7f}, {lat:.7f}). Leave "
                "doubles out.",
                n=len(lonlat) - len(alone),
                all=len(lonlat),
                plant=first + 1,
                lon=lonlat[first, 0],
                lat=lonlat[first, 1],
            )
        )


def _obstacles(field: Field | None, frame: Frame) -> shapely.Geometry:
    """Return holes and no-go areas in metres of the frame."""
    if field is None:
        return MultiPolygon()
    holes = [Polygon(ring) for part in field.boundary.geoms for ring in part.interiors]
    return frame.geometry_m(shapely.union_all([*holes, field.no_go]))


def _aisles(y_m: Float, line: NDArray[np.intp], planting: Planting) -> Float:
    """Return y of the aisles below and above each line, ``(lines, 2)``.

    Midway between the plants on both sides, or half a row spacing off where no row follows.
    """
    first = np.searchsorted(line, np.arange(line[-1] + 1))
    lowest, highest = np.minimum.reduceat(y_m, first), np.maximum.reduceat(y_m, first)
    room = np.concatenate([[np.inf], lowest[1:] - highest[:-1], [np.inf]])
    half = np.minimum(room, planting.row_spacing_m) / 2
    return np.stack([lowest - half[:-1], highest + half[1:]], axis=1)


def _pieces(
    xy_m: Float,
    line: NDArray[np.intp],
    aisle_y_m: Float,
    obstacles: shapely.Geometry,
    planting: Planting,
) -> Pieces:
    """Return the lines of plants, cut where an obstacle stands in a row or its aisles."""
    x, half = xy_m[:, 0], planting.headland_m / 2
    # beyond plants and obstacles (an empty one's bounds are NaN) every strip is free
    bounds = shapely.bounds(obstacles)
    low_x = float(np.fmin(x.min(), bounds[0])) - planting.headland_m - 1.0
    high_x = float(np.fmax(x.max(), bounds[2])) + planting.headland_m + 1.0
    around = shapely.box(low_x, aisle_y_m[0, 0] - 1, high_x, aisle_y_m[-1, 1] + 1)
    # one face needs the way from its plants to the aisle above, two need both aisles
    lowest_y = aisle_y_m[:, 0] if planting.faces == 2 else aisle_y_m.mean(axis=1)
    free = free_intervals(shapely.difference(around, obstacles), lowest_y, aisle_y_m[:, 1])
    # a plant beside an obstacle belongs to the nearer end of it
    stretch = high_x - low_x + 1.0
    parting = (free.high_x[:-1] + free.low_x[1:]) / 2
    same = free.strip[:-1] == free.strip[1:]
    place = np.where(same, parting, low_x) + free.strip[1:] * stretch
    piece = np.searchsorted(place, x + line * stretch, side="right")
    planted, row_start = np.unique(piece, return_index=True)
    row_start = np.append(row_start, len(x))
    first, last = x[row_start[:-1]], x[row_start[1:] - 1]
    # lanes end before the obstacle, but always clear of the last plant
    clear = [
        np.clip(room / 2, planting.plant_spacing_m / 4, half)
        for room in (first - free.low_x[planted], free.high_x[planted] - last)
    ]
    row_line = line[row_start[:-1]]
    return Pieces(
        xy_m,
        row_start.astype(np.int64),
        row_line.astype(np.int32),
        aisle_y_m[row_line],
        np.stack([first - clear[0], last + clear[1]], axis=1),
    )


def _within(
    pieces: Pieces, area: MultiPolygon, planting: Planting
) -> tuple[Pieces, NDArray[np.bool_]]:
    """Return pieces whose lanes end within an area, and which ``(r,)`` have no such end."""
    x = pieces.xy_m[:, 0]
    plant_x = np.stack([x[pieces.row_start[:-1]], x[pieces.row_start[1:] - 1]], axis=1)
    beyond_m = np.abs(pieces.lane_x_m - plant_x)
    sides = []
    for side in (0, 1) if planting.faces == 2 else (1,):
        y = np.broadcast_to(pieces.aisle_y_m[:, side, None], plant_x.shape)
        steps = np.stack([plant_x, y, pieces.lane_x_m, y], axis=2).reshape(-1, 2, 2)
        sides.append(np.asarray(shapely.linestrings(steps), np.object_))
    known_m, shut = lanes_within(beyond_m, sides, area)
    moved = np.where(known_m < beyond_m, plant_x + known_m * [-1.0, 1.0], pieces.lane_x_m)
    return pieces._replace(lane_x_m=moved), shut


def _reach(
    pieces: Pieces, planting: Planting, some: NDArray[np.bool_] | None = None
) -> shapely.Geometry:
    """Return what rows, their aisles and headlands cover, bridged from each line to the next.

    Of `some` ``(r,)``, or of all.
    """
    beyond = planting.headland_m / 2 * np.array([-1.0, 1.0])
    boxes = _boxes(pieces.lane_x_m + beyond, pieces.aisle_y_m)
    line = pieces.row_line
    if some is not None:
        boxes, line = boxes[some], line[some]
    first = np.flatnonzero(np.diff(line, prepend=-1))
    lines = [shapely.union_all(boxes[a:b]) for a, b in pairwise([*first.tolist(), len(boxes)])]
    next_ = np.diff(line[first]) == 1
    bridged = [
        shapely.convex_hull(shapely.union(*pair))
        for pair, bridge in zip(pairwise(lines), next_, strict=True)
        if bridge
    ]
    return shapely.union_all([*lines, *bridged])


def _boxes(x_m: Float, y_m: Float) -> NDArray[np.object_]:
    return shapely.box(x_m[:, 0], y_m[:, 0], x_m[:, 1], y_m[:, 1])
