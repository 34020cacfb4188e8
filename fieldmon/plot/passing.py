"""Which aisles are driven through between two others, and after how many metres one is left."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import counted
from fieldmon.plot.travel import trace

if TYPE_CHECKING:
    from fieldmon.plot.travel import Aisles

# lanes of neighbouring rows that were measured lie at slightly different y: of the row spacing
_SAME_AISLE = 0.25
# a way from a lane's end on only touches its aisle
_TOUCHES_M = 0.1


class Leg(NamedTuple):
    """The way from one plant (or the gate) to another in another aisle, or stretch of one.

    Parameters
    ----------
    out_m
        Metres until the first one's aisle is left; 0 from the gate.
    length_m
        Metres of the whole way.
    end
        By which end it is left, as numbered in `TravelTable.between_m`.
    through
        Aisles, as in `PlantGrid.corridor`, that are driven through after that; where a headland
        opens half-way along an aisle, or an aisle is cut, one's own may be among them.
    """

    out_m: float
    length_m: float
    end: int
    through: tuple[int, ...]


@lru_cache(maxsize=8)
def legs_of(aisles: Aisles) -> Legs:
    """Return the legs of a plot; what was found of one is kept for its next day."""
    return Legs(aisles)


class Legs:
    """The legs of a plot, as `Aisles.path` drives them; ways between row ends are kept.

    Examples
    --------
    >>> from fieldmon.plot.layout import rectangle
    >>> from fieldmon.plot.travel import Aisles
    >>> Legs(Aisles.of(rectangle(3, 10))).leg(0, 25).through
    ()
    """

    def __init__(self, aisles: Aisles) -> None:
        self._aisles, grid = aisles, aisles.grid
        self._corridor = grid.corridor.tolist()
        self._row, self._along_m = grid.row.tolist(), grid.along_m.tolist()
        self._end_m, self._cut = grid.lane_x_m.tolist(), grid.cut_ends.tolist()
        ends = zip(aisles.roads.end.tolist(), self._corridor, strict=True)
        self._lane = {(min(a, b), max(a, b)): corridor for (a, b), corridor in ends}
        self._through: dict[tuple[int, int], tuple[int, ...]] = {}

    def __repr__(self) -> str:
        return f"<Legs of {counted(len(self._row), 'plant')}>"

    def leg(self, i: int, j: int) -> Leg:
        """Return the leg from plant i to plant j of another stretch of aisle; -1 is the gate."""
        between_m = self._aisles.travel.between_m
        _, out_m, a, b, length_m = min(
            (length_m, out_m, a, b, length_m)
            for a, out_m in self._exits(i)
            for b, back_m in self._exits(j)
            for length_m in (out_m + float(between_m[a, b]) + back_m,)
        )
        return Leg(out_m, length_m, a, self._between(a, b))

    def _exits(self, i: int) -> list[tuple[int, float]]:
        if i < 0:
            return [(2 * len(self._end_m), 0.0)]
        row, at_m = self._row[i], self._along_m[i]
        # by a cut end nobody leaves
        ends = [e for e in range(2) if not self._cut[row][e]] or range(2)
        return [(2 * row + e, abs(at_m - self._end_m[row][e])) for e in ends]

    def _between(self, a: int, b: int) -> tuple[int, ...]:
        """Return the aisles on the way between two lane ends, as numbered in `TravelTable`."""
        key = min(a, b), max(a, b)
        if key not in self._through:
            steps = pairwise(trace(self._aisles, *key))
            found = (aisle for u, v in steps for aisle in self._along(u, v))
            self._through[key] = tuple(dict.fromkeys(found))
        return self._through[key]

    def _along(self, u: int, v: int) -> list[int]:
        """Return the aisles that a way between two nodes next to each other lies in, in its order.

        One way may lie in several, where parts of a plot have their rows in line.
        """
        known = self._lane.get((min(u, v), max(u, v)))
        grid = self._aisles.grid
        if known is not None or grid.aisles_m is not None:
            return [] if known is None else [known]
        (ax, ay), (bx, by) = self._aisles.roads.xy_m[[u, v]].tolist()
        if abs(by - ay) > abs(bx - ax):
            return []
        low, high = (
            np.maximum(grid.lane_x_m[:, 0], min(ax, bx)),
            np.minimum(grid.lane_x_m[:, 1], max(ax, bx)),
        )
        middle = (low + high) / 2
        y = ay + (by - ay) * (middle - ax) / (bx - ax) if bx != ax else np.full(len(middle), ay)
        near = np.abs(grid.lane_y_m - y) <= _SAME_AISLE * grid.row_spacing_m
        rows = np.flatnonzero(near & (high - low > _TOUCHES_M))
        rows = rows[np.argsort(middle[rows] if bx > ax else -middle[rows], kind="stable")]
        return [int(corridor) for corridor in grid.corridor[rows]]
