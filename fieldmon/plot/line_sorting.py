"""Lines drawn in any order and either way, sorted into rows and blocks."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_order import ASTRAY_DEG, StrandPairs, StrandRows, counted_pairs, in_line
from fieldmon.plot.strands import Strands

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# lines are looked about from so many places of each
_LOOKS = 8


class DrawnRows(NamedTuple):
    """Lines sorted into rows: block by block, in each from right to left of their direction.

    ``lines`` of the rows, pieces of one joined; the ``block (r,)`` of each; and the usual distance
    between rows, NaN where none are beside each other.
    """

    lines: Polylines
    block: Int
    spacing_m: float

    def __repr__(self) -> str:
        return f"<DrawnRows: {len(self.block)} rows>"


def sorted_rows(lines: Polylines, reach_m: float) -> DrawnRows:
    """Return lines drawn in any order and either way as rows; neighbours are within a reach."""
    f = len(lines)
    line, share = np.repeat(np.arange(f), _LOOKS), np.tile((np.arange(_LOOKS) + 0.5) / _LOOKS, f)
    place = share * lines.length_m[line]
    at, ahead = lines.points(line, place), lines.ahead(line, place)
    strands = Strands(np.arange(len(at)), np.arange(f + 1) * _LOOKS, at, ahead)
    rows = StrandRows.of(strands, _neighbouring_lines(lines, strands, reach_m))
    joined = []
    for row in range(len(rows.block)):
        parts = in_line(strands, rows, np.flatnonzero(rows.row == row).tolist())
        turned = [lines.line(k)[:: -1 if rows.turned[k] else 1] for k in parts]
        joined.append(np.concatenate(turned))
    return DrawnRows(Polylines.each(joined), rows.block, rows.spacing_m)


def _neighbouring_lines(lines: Polylines, strands: Strands, reach_m: float) -> StrandPairs:
    """Return which lines run beside which: what is met at right angles to them."""
    shapes, owner = lines.shapes(), strands.owner
    tree = shapely.STRtree(shapes)
    left = np.stack([-strands.ahead[:, 1], strands.ahead[:, 0]], axis=1)
    found = []
    for sign in (1, -1):
        ends = strands.line_m + sign * reach_m * left
        ways = np.stack([strands.line_m, ends], axis=1)
        rays = np.asarray(shapely.linestrings(ways), np.object_)
        ray, hit = tree.query(rays, predicate="intersects")
        ray, hit = ray[owner[ray] != hit], hit[owner[ray] != hit]
        met = shapely.intersection(rays[ray], shapes[hit])
        off = shapely.distance(shapely.points(strands.line_m[ray]), met)
        order = np.lexsort((off, ray))
        first = order[np.unique(ray[order], return_index=True)[1]]
        ray, hit, off = ray[first], hit[first], off[first]
        place = shapely.line_locate_point(shapes[hit], shapely.points(strands.line_m[ray]))
        turn = np.einsum("ij,ij->i", lines.ahead(hit, place), strands.ahead[ray])
        ok = np.abs(turn) >= np.cos(np.deg2rad(ASTRAY_DEG))
        way = np.full(int(ok.sum()), sign)
        found.append((owner[ray][ok], hit[ok], way, np.sign(turn[ok]), off[ok]))
    columns = [np.concatenate(part) for part in zip(*found, strict=True)]
    return counted_pairs(len(lines), *columns)
