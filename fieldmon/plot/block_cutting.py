"""Blocks as they are drawn, cut by a line, or guessed from the outline of a plot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import LineString, MultiLineString, MultiPolygon, Polygon
from shapely.ops import split

from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError
from fieldmon.plot.block import Block
from fieldmon.plot.outline_bearing import area_bearing

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field

    Float = NDArray[np.float64]

# less of a block than this is a sliver left by drawing
_LEAST_M2 = 1.0
_TWO = 2
# a cut ends this far beyond the outline, so that it passes through
_BEYOND_M = 2.0
# blocks are guessed where rows get so much fewer by them, and no finer than this
_FEWER, _MOST_GUESSED = 0.8, 12
# an outline is looked at without what is smaller than this, and no corner is flatter
_COARSE_M, _CORNER_DEG, _MOST_CORNERS = 1.0, 10.0, 24
_NEAR_M = 0.01


@checked
def cut_blocks(field: Field, line: LineString | MultiLineString) -> tuple[Block, ...]:
    """Return the blocks of a plot, those that a line passes through in two.

    A plot without blocks is one that is cut. Both parts keep what was stated of the block, but
    its direction: each has the rows that suit it. What was said of rows by hand is no part of a
    field: say it again, as below.

    Parameters
    ----------
    field
        The plot as it is known, with or without blocks. It stays as it is.
    line
        Where to cut, degrees ``(lon, lat)``; it may end a little short of the edge.

    Returns
    -------
    tuple of Block
        All blocks of the plot, for ``replace(field, blocks=...)``; parts are called ``north 1``,
        ``north 2``.

    Raises
    ------
    PlotError
        If the line passes through nothing.

    Examples
    --------
    >>> import fieldmon as fm, shapely
    >>> from dataclasses import replace
    >>> field = fm.read_plot("sample_data/paran_estate.zip", feature="Gate").field
    >>> by_hand = fm.Planting(row_spacing_m=2.5, plant_spacing_m=1.5)
    >>> west, south, east, north = field.boundary.bounds
    >>> across = shapely.LineString([(west, south), (east, north)])
    >>> plot = fm.Plot.of(replace(field, blocks=fm.cut_blocks(field, across)), by_hand)
    >>> plot.grid.n_blocks, plot.grid.row_spacing_m
    (2, 2.5)
    """
    frame = field.frame()
    knives = [_longer(part) for part in shapely.get_parts(frame.geometry_m(line))]
    made: list[Block] = []
    whole = Block("", field.boundary)
    n_before = max(len(field.blocks), 1)
    for block in field.blocks or (whole,):
        parts: list[shapely.Geometry] = [
            frame.geometry_m(shapely.intersection(block.area, field.boundary))
        ]
        for knife in knives:
            parts = [piece for part in parts for piece in _in_two(part, knife)]
        if len(parts) == 1:
            made.append(block)
            continue
        for number, part in enumerate(parts, 1):
            name = f"{block.name} {number}".strip()
            area = MultiPolygon(list(shapely.get_parts(frame.geometry_lonlat(part))))
            made.append(Block(name, area, None, block.row_spacing_m, block.plant_spacing_m))
    if len(made) == n_before:
        raise PlotError(
            worded(
                "A cut must pass through plot {name!r} from one side to the other, but this line "
                "parts nothing. Draw it across the plot.",
                name=field.name,
            )
        )
    return tuple(made)


def _longer(line: LineString, by_m: float = _BEYOND_M) -> LineString:
    """Return a line a little longer at both ends, so that one drawn to the edge reaches it."""
    corners = shapely.get_coordinates(line)
    first, last = corners[0] - corners[1], corners[-1] - corners[-2]
    ends = [end / max(float(np.hypot(*end)), 1e-9) * by_m for end in (first, last)]
    return LineString([corners[0] + ends[0], *corners, corners[-1] + ends[1]])


def _in_two(area: shapely.Geometry, knife: LineString) -> list[MultiPolygon]:
    """Return what is left and right of a line in an area; the area where it does not part it."""
    left: list[Polygon] = []
    right: list[Polygon] = []
    whole: list[Polygon] = []
    for polygon in shapely.get_parts(area):
        pieces = _pieces(polygon, knife)
        if len(pieces) < 2:
            whole.append(polygon)
            continue
        for piece in pieces:
            (left if _is_left(piece, knife) else right).append(piece)
    if not left or not right:
        return [MultiPolygon(whole)] if len(whole) == 1 else [MultiPolygon([*left, *right, *whole])]
    # a part that the line does not touch goes with the nearer side
    for polygon in whole:
        near = shapely.distance(polygon, MultiPolygon(left)) <= shapely.distance(
            polygon, MultiPolygon(right)
        )
        (left if near else right).append(polygon)
    return [MultiPolygon(left), MultiPolygon(right)]


def _pieces(area: shapely.Geometry, knife: LineString) -> list[Polygon]:
    """Return the pieces into which a line cuts an area, but for slivers."""
    cut = shapely.get_parts(split(area, knife))
    return [p for p in cut if p.geom_type == "Polygon" and p.area >= _LEAST_M2]


def _is_left(piece: Polygon, knife: LineString) -> bool:
    """Tell whether a piece is on the left of the line that cut it off."""
    inside = shapely.point_on_surface(piece)
    at = knife.project(inside)
    a, b = (np.array(knife.interpolate(max(at + by, 0.0)).coords[0]) for by in (-0.01, 0.01))
    (ax, ay), (bx, by) = b - a, np.array(inside.coords[0]) - a
    return bool(ax * by - ay * bx > 0)


def blocks_from_outline(field: Field) -> tuple[Block, ...]:
    """Return the blocks in which rows would be much fewer and longer than in one; () for none.

    Parts of the plot that lie apart are blocks where their sides run in other directions, and a
    part with a corner that points inwards is cut there, where rows along the sides of each piece
    are at most four fifths as many as before. It is a guess: the outline does not show the rows.
    """
    frame = field.frame()
    area = frame.geometry_m(field.boundary)
    parts = sorted(shapely.get_parts(area), key=lambda p: -p.area)
    pieces = [piece for part in parts for piece in _guessed(part)]
    width = sum(_width_m(piece, area_bearing(piece).bearing_deg) for piece in pieces)
    main = area_bearing(parts[0]).bearing_deg
    if len(pieces) < 2 or width > _FEWER * sum(_width_m(part, main) for part in parts):
        return ()
    return tuple(
        Block(f"{number}", frame.geometry_lonlat(MultiPolygon([piece])))
        for number, piece in enumerate(pieces, 1)
    )


def _guessed(area: Polygon, most: int = _MOST_GUESSED) -> list[Polygon]:
    """Return the pieces of an area whose rows are fewest, along each one's own sides."""
    known = _width_m(area, area_bearing(area).bearing_deg)
    best, pieces = _FEWER * known, [area]
    for knife in _knives(area) if most > 1 else ():
        halves = _pieces(area, knife)
        if len(halves) != _TWO:
            continue
        width = sum(_width_m(half, area_bearing(half).bearing_deg) for half in halves)
        if width < best:
            best, pieces = width, halves
    if len(pieces) == 1:
        return pieces
    return [piece for half in pieces for piece in _guessed(half, most // 2)]


def _edges(area: Polygon) -> Float:
    edges: Float = np.diff(shapely.get_coordinates(area.exterior), axis=0)
    return edges


def _width_m(area: Polygon, bearing_deg: float) -> float:
    """Return how wide an area is across a direction: as many metres as rows have to cover."""
    turn = np.deg2rad(bearing_deg)
    east, north = shapely.get_coordinates(area.exterior).T
    return float(np.ptp(east * np.cos(turn) - north * np.sin(turn)))


def _knives(area: Polygon) -> list[LineString]:
    """Return straight cuts on from the sides at corners that point inwards, and between these."""
    coarse_m = _COARSE_M
    corners, into, out = _inward(area, coarse_m)
    while len(corners) > _MOST_CORNERS:
        coarse_m *= 2
        corners, into, out = _inward(area, coarse_m)
    far_m = float(np.hypot(*np.ptp(_edges(area).cumsum(axis=0), axis=0)))
    ways = [(corners, corners + far_m * _unit(into)), (corners, corners - far_m * _unit(out))]
    one, other = np.triu_indices(len(corners), 1)
    ways.append((corners[one], corners[other]))
    knives = []
    for start, end in ways:
        for a, b in zip(start, end, strict=True):
            inside = shapely.get_parts(shapely.intersection(area, LineString([a, b])))
            near = inside[shapely.distance(inside, shapely.points(a)) < _NEAR_M]
            near = near[shapely.length(near) > 1.0]
            knives += [_longer(line, _NEAR_M) for line in near[:1]]
    return knives


def _inward(area: Polygon, coarse_m: float) -> tuple[Float, Float, Float]:
    """Return the corners of an outline that point inwards, and its sides there, in and out."""
    ring = shapely.simplify(area.exterior, coarse_m)
    corners = shapely.get_coordinates(ring)[:-1]
    if shapely.is_ccw(ring):
        corners = corners[::-1]
    into, out = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    left = into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0]
    turn = np.arctan2(left, np.einsum("ij,ij->i", into, out))
    # against the clock's way round, who turns left turns inwards
    inward = turn > np.deg2rad(_CORNER_DEG)
    return corners[inward], into[inward], out[inward]


def _unit(way: Float) -> Float:
    units: Float = way / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)[:, None]
    return units
