"""Along which of its sides a plot's rows are laid, also where its outline was walked with a phone.

Between fixes a few metres apart an outline runs anywhere: its edges are mostly noise, and its sides
show only from further away. How far is judged from how far fixes stray from the line between those
some way before and after them.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.plot.row_detection import main_bearing

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field
    from fieldmon.plot.planting import Planting

    Float = NDArray[np.float64]

# who walks an outline takes so many fixes, of which no two are further apart than this part of it,
# but for the gap where the walk began and ended, which is this many times as long
_FIXES, _LONGEST_STEP, _GAP = 20, 1 / 12, 2
# every other fix turns back from the way of the last one, or the way turns as much as noise does
_TURN_DEG, _TURNING_BACK, _ANYHOW_DEG = 3.0, 0.5, 40.0
# strays are judged up to this part of the outline before and after a fix: most are on one side then
_REACH = 24
# this share of normally strewn strays is within _STRAY sigma of the line between two other fixes
_SHARE, _STRAY = 0.35, 0.454 * np.sqrt(1.5)
# corners stray from the sides by more sigma than fixes do
_SIGMAS = 4.0
# a side of fewer fixes is the line between its corners
_FEW = 4
# another side that is this near to the longest may be it
_AS_LONG, _OTHER_WAY_DEG = 0.9, 15.0


class OutlineBearing(NamedTuple):
    """The direction of an outline's longest side, and how sure that is."""

    bearing_deg: float  # 0..180
    off_deg: float = 0.0  # by how much it may be off (2 sigma); 0: not ragged
    or_deg: float | None = None  # of another side, about as long


def bearing_of(field: Field) -> OutlineBearing:
    """Return the direction in which most of the edge of a plot's largest part runs."""
    return area_bearing(field.frame().geometry_m(field.boundary))


def guessed_bearing(field: Field, planting: Planting) -> OutlineBearing | None:
    """Return along which of its sides a plot's rows are laid; None where that is known."""
    drawn = field.plants is not None or field.blocks or not field.row_lines.is_empty
    if drawn or not field.in_rows or planting.row_bearing_deg is not None:
        return None
    return bearing_of(field)


def doubt_of_bearing(field: Field, planting: Planting) -> str:
    """Return the doubt that rows may run otherwise, by more than a row spacing at their ends.

    Empty where there is none.
    """
    bearing = guessed_bearing(field, planting)
    if bearing is None or not bearing.off_deg:
        return ""
    rows = {"along": bearing.bearing_deg, "off": max(bearing.off_deg, 1.0)}
    if bearing.or_deg is not None:
        return worded(
            "Rows are laid along {along:.0f} degrees, the longest side of a ragged outline, but "
            "that along {other:.0f} degrees is about as long: say the rows' bearing.",
            other=bearing.or_deg,
            **rows,
        )
    frame = field.frame(bearing.bearing_deg)
    long_m = np.ptp(frame.xy_m(shapely.get_coordinates(field.boundary))[:, 0])
    if long_m * np.tan(np.deg2rad(min(bearing.off_deg, 80.0))) <= planting.row_spacing_m:
        return ""
    return worded(
        "Rows are laid along {along:.0f} degrees, the longest side of a ragged outline. It may be "
        "off by {off:.0f} {off:degree|degrees}: say the rows' bearing.",
        **rows,
    )


def area_bearing(area: shapely.Geometry) -> OutlineBearing:
    """Return the direction in which most of the edge of the largest part runs, in metres."""
    main = max(shapely.get_parts(area), key=shapely.area)
    return outline_bearing(shapely.get_coordinates(main.exterior))


def outline_bearing(ring_m: Float) -> OutlineBearing:
    """Return the direction in which most of an outline runs.

    Parameters
    ----------
    ring_m
        ``(n, 2)`` metres, east and north; the last corner is the first one.
    """
    fixes = ring_m[np.append(True, np.any(np.diff(ring_m, axis=0) != 0.0, axis=1))]
    if not is_ragged(fixes):
        return OutlineBearing(main_bearing(np.diff(ring_m, axis=0)))
    sides, off = _sides(fixes)
    bearing_deg = main_bearing(sides)
    length = np.hypot(*sides.T)
    along = _alike(sides, bearing_deg)
    other_deg = main_bearing(sides[~along]) if not along.all() else bearing_deg
    other = _alike(sides, other_deg) & ~along
    as_long = length[other].sum() > _AS_LONG * length[along].sum()
    off_deg = float(np.average(off[along], weights=length[along]))
    return OutlineBearing(bearing_deg, off_deg, other_deg if as_long else None)


def is_ragged(ring_m: Float) -> bool:
    """Return whether an outline's edges tell nothing of its sides, as those of a walked one."""
    edges = np.diff(ring_m, axis=0)
    length = np.hypot(*edges.T)
    if len(edges) < _FIXES:
        return False
    second, longest = np.sort(length)[-2:]
    step = second if longest > _GAP * second else longest
    if step > _LONGEST_STEP * length.sum():
        return False
    way = _bearings(edges, 360.0)
    turn = (np.diff(way, append=way[0]) + 180.0) % 360.0 - 180.0
    back = (np.abs(turn) > _TURN_DEG) & (turn * np.roll(turn, -1) < 0)
    return bool(back.mean() >= _TURNING_BACK or np.median(np.abs(turn)) >= _ANYHOW_DEG)


def _sides(ring_m: Float) -> tuple[Float, Float]:
    """Return the sides of a ragged outline ``(k, 2)``, and by how many degrees each may be off."""
    fixes = ring_m[:-1]
    # from a corner on: nothing is farther from the middle
    first = int(np.argmax(np.hypot(*(fixes - fixes.mean(axis=0)).T)))
    fixes = np.roll(fixes, -first, axis=0)
    ring = shapely.Polygon(fixes)
    width_m = 2 * ring.area / ring.length
    near_m = min(_SIGMAS * _stray_m(fixes), width_m / 2)
    closed = np.concatenate([fixes, fixes[:1]])
    kept = shapely.LineString(closed).simplify(near_m, preserve_topology=False)
    corners = _places(closed, shapely.get_coordinates(kept))
    fitted = [_fitted(closed[a : b + 1], near_m) for a, b in pairwise(corners)]
    return np.array([side for side, _ in fitted]), np.array([off for _, off in fitted])


def _stray_m(fixes: Float) -> float:
    """Return how far fixes are off (1 sigma), by those some way before and after."""
    farthest = max(1, len(fixes) // _REACH)
    steps = {min(2**k, farthest) for k in range(farthest.bit_length() + 1)}
    return max(_beside_m(fixes, step) for step in steps)


def _beside_m(fixes: Float, step: int) -> float:
    before, after = np.roll(fixes, step, axis=0), np.roll(fixes, -step, axis=0)
    chord, to = after - before, fixes - before
    length = np.maximum(np.hypot(*chord.T), 1e-9)
    beside = np.abs(chord[:, 0] * to[:, 1] - chord[:, 1] * to[:, 0]) / length
    return float(np.quantile(beside, _SHARE) / _STRAY)


def _places(closed: Float, kept: Float) -> list[int]:
    """Return which fixes were kept, in their order."""
    places, place = [], 0
    for corner in kept[:-1]:
        while np.any(closed[place] != corner):
            place += 1
        places.append(place)
    return [*places, len(closed) - 1]


def _fitted(side: Float, near_m: float) -> tuple[Float, float]:
    """Return a side as the line through its fixes, and by how many degrees it may be off."""
    whole = side[-1] - side[0]
    length = float(np.hypot(*whole))
    if length == 0.0:
        return whole, 90.0
    along = (side - side[0]) @ whole / length
    inner = side[(along > near_m) & (along < length - near_m)]
    if len(inner) < _FEW:
        return whole, float(np.rad2deg(np.arctan2(near_m, length)))
    inner = inner - inner.mean(axis=0)
    way = np.linalg.svd(inner, full_matrices=False)[2][0]
    way = way if way @ whole > 0 else -way
    beside = inner @ np.array([-way[1], way[0]])
    spread = np.ptp(inner @ way) * np.sqrt(_own(beside) / 12)
    return way * length, float(np.rad2deg(np.arctan2(2 * beside.std(), spread)))


def _own(beside: Float) -> float:
    """Return as how many fixes these count: neighbours stray alike."""
    crossings = 1.0 + 2.0 * np.count_nonzero(np.diff(np.sign(beside)))
    alike = float(np.sum(beside[1:] * beside[:-1])) / max(float(np.sum(beside**2)), 1e-9)
    own = min(float(crossings), len(beside) * (1.0 - alike) / (1.0 + alike))
    return max(own, 1.0)


def _alike(sides: Float, bearing_deg: float) -> NDArray[np.bool_]:
    """Return which sides ``(k,)`` run about along a bearing."""
    off = (_bearings(sides) - bearing_deg + 90.0) % 180.0 - 90.0
    alike: NDArray[np.bool_] = np.abs(off) < _OTHER_WAY_DEG
    return alike


def _bearings(edges: Float, turn_deg: float = 180.0) -> Float:
    bearings: Float = np.rad2deg(np.arctan2(edges[:, 0], edges[:, 1])) % turn_deg
    return bearings
