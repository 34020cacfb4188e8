"""Which line of a frame each plant is: plants are numbered along rows, not as a frame has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from fieldmon.compute.units import distance_figure
from fieldmon.errors import PlotError
from fieldmon.plot.grid import plant_numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Int = NDArray[np.int64]

#: as near as this a line of a frame is the plant
SAME_M = 0.5
# the two faces of a plant are in one place: lines of a frame as near as this
_ONE_PLACE_M = 0.01


def nearest_lines(
    grid: PlantGrid, lonlat: NDArray[np.float64], face: NDArray[np.integer]
) -> tuple[Int, NDArray[np.float64]]:
    """Return the nearest of the given places ``(m, 2)`` of each plant, and how far it is in metres.

    Of two lines in one place, a plant is that of its own face: `face` ``(m,)`` is 1 or 2, 0 where
    nobody said. Raise `PlotError` where both are of one face: a column may say two things of it.
    """
    tree = cKDTree(grid.frame.xy_m(lonlat))
    away_m, line = tree.query(grid.xy_m, k=[1, 2])
    own = np.where(grid.twin < 0, 1, np.where(np.arange(len(grid)) < grid.twin, 1, 2))
    first, second = line[:, 0], np.minimum(line[:, 1], len(lonlat) - 1)
    in_one = away_m[:, 1] - away_m[:, 0] < _ONE_PLACE_M
    twice = np.flatnonzero(in_one & (away_m[:, 0] < SAME_M) & (face[first] == face[second]))
    if len(twice):
        one = int(twice[0])
        raise PlotError(
            f"Each plant must have one line in the frame, but {_called(grid, one)} has two, "
            f"{min(first[one], second[one])} and {max(first[one], second[one])} from 0. Leave "
            "doubles out."
        )
    turned = in_one & (face[second] == own)
    return np.where(turned & (face[first] != own), second, first), away_m[:, 0]


def must_be_lines(grid: PlantGrid, line: Int, away_m: NDArray[np.float64]) -> None:
    """Raise `PlotError` unless each plant is near a line, and no two plants are the same."""
    far = np.flatnonzero(away_m > SAME_M)
    if len(far):
        worst = int(far[np.argmax(away_m[far])])
        raise PlotError(
            f"Each plant must have a line in the frame, but {len(far):,} of {len(grid):,} have "
            f"none within {distance_figure(SAME_M)}: {_called(grid, worst)} is "
            f"{distance_figure(float(away_m[worst]))} from the nearest. Give the frame of this "
            "plot's plants."
        )
    vine = grid.vine
    first = np.unique(line, return_index=True)[1]
    shared = np.flatnonzero(vine[first][np.searchsorted(line[first], line)] != vine)
    if len(shared):
        one = int(shared[0])
        other = int(np.flatnonzero(line == line[one])[0])
        raise PlotError(
            f"Each plant must have a line of its own in the frame, but {_called(grid, other)} and "
            f"{_called(grid, one)} are nearest to the same one. Give the frame of this plot's "
            "plants."
        )


def said_of_order(grid: PlantGrid, lonlat: NDArray[np.float64], what: str = "gdf") -> list[str]:
    """Return that plants are numbered otherwise than they were given, ``(m, 2)``; nothing: alike.

    `what` is how an example calls what they were given in.
    """
    line, _ = nearest_lines(grid, lonlat, np.zeros(len(lonlat), np.int64))
    # both faces of a plant are one line
    line = line[np.unique(grid.vine)]
    turned = np.flatnonzero(np.diff(line) < 0)
    if not len(turned):
        return []
    plant = int(np.flatnonzero(line != np.arange(len(line)))[0])
    said = (
        f"Plants were numbered along rows, not as they were given: plant {plant} was number "
        f"{line[plant]} of the points, both from 0. A column of theirs goes to other plants as it "
        f'is: bring it over with gdf["risk"].to_numpy()[plot.order_in({what})].'
    )
    return [said]


def _called(grid: PlantGrid, plant: int) -> str:
    numbered = plant_numbers(grid, np.array([plant]))
    where = f" of row {numbered.line[0]}" if grid.in_rows else ""
    return f"plant {numbered.number[0]}{where}"
