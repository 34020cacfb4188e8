"""The lines of traced rows: over wide gaps they bend on as they do on either side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.plot.polylines import Polylines
from fieldmon.plot.strands import Strands, lines_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.row_tracing import TracedRows

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# gaps so many plants wide are gone over as the row bends before and behind, as so many plants tell
_MANY_MISSING, _TELLING, _FEWEST = 4.0, 9, 5


def row_lines_of(traced: TracedRows) -> Polylines:
    """Return the lines of traced rows; that of a single plant is short, and along x.

    Over gaps of many plants they go on bending as they do on either side.
    """
    ahead = np.tile([1.0, 0.0], (len(traced.plant), 1))
    lines = lines_of(Strands(traced.plant, traced.row_start, traced.line_m, ahead))
    return _bent_over_gaps(lines, _MANY_MISSING * traced.plant_spacing_m)


def _bent_over_gaps(lines: Polylines, wide_m: float) -> Polylines:
    """Return lines whose steps wider than this are curves, smooth at both ends."""
    step_m = np.diff(lines.at_m)
    step_m[lines.start[1:-1] - 1] = 0.0
    at, made = [np.empty(0, np.int64)], [np.empty((0, 2))]
    for k in np.flatnonzero(step_m > wide_m):
        line = int(np.searchsorted(lines.start, k, side="right")) - 1
        before = lines.xy_m[lines.start[line] : k + 1]
        after = lines.xy_m[k + 1 : lines.start[line + 1]]
        if min(len(before), len(after)) < _FEWEST:
            continue
        curve = _curve(before, after, int(step_m[k] / wide_m * _MANY_MISSING))
        at.append(np.full(len(curve), k + 1))
        made.append(curve)
    added = np.concatenate(at)
    xy_m = np.insert(lines.xy_m, added, np.concatenate(made), axis=0)
    return Polylines.of(lines.start + np.searchsorted(added, lines.start, side="right"), xy_m)


def _curve(before: Float, after: Float, n: int) -> Float:
    """Return n points ``(n, 2)`` from the end of one line to the start of another (Hermite's).

    None where the two do not lead to each other.
    """
    way = after[0] - before[-1]
    far = float(np.hypot(*way))
    out, into = _end_way(before[::-1]), -_end_way(after)
    if min(out @ way, into @ way) < 0.5 * far:
        return np.empty((0, 2))
    t = (np.arange(1, n + 1) / (n + 1))[:, None]
    on: Float = before[-1] + way * t * t * (3 - 2 * t)
    return on + far * (out * t * (1 - t) ** 2 - into * t * t * (1 - t))


def _end_way(line: Float) -> Float:
    """Return the direction ``(2,)`` in which a line ends that is given from its end back."""
    last = min(_TELLING, len(line)) - 1
    here, near, there = line[0], line[last // 2], line[last]
    a, b = float(np.hypot(*(near - here))), float(np.hypot(*(there - here)))
    # of the parabola through three places
    way = (here - near) * b / (a * (b - a)) - (here - there) * a / (b * (b - a))
    unit: Float = way / max(float(np.hypot(*way)), 1e-12)
    return unit
