"""Walks that know nothing: plants in W form, and plants drawn anywhere."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

# the corners of a W in a plot of width and height 1
_W = np.array([[0.0, 1.0], [0.25, 0.0], [0.5, 1.0], [0.75, 0.0], [1.0, 1.0]])
# each further W is walked between the looks of those before
_GOLDEN = 0.6180339887498949


def w_walk(grid: PlantGrid, looks: int, most: int) -> NDArray[np.int32]:
    """Return plants on walks in W form, `looks` on each, no plant twice, ``(k,)`` up to `most`.

    Parameters
    ----------
    grid
        The plants.
    looks
        Looks on one W, evenly along it; the nearest plant each.
    most
        Looks altogether; further Ws go between the looks of the first.
    """
    low = grid.xy_m.min(axis=0)
    size = np.maximum(np.ptp(grid.xy_m, axis=0), 1e-9)
    corners = low + _W * size
    legs = np.hypot(*np.diff(corners, axis=0).T)
    at = np.concatenate([[0.0], np.cumsum(legs)])
    walked: list[int] = []
    for turn in range(max(most // looks, 1) * 4):
        along = (np.arange(looks) + (0.5 + turn * _GOLDEN) % 1.0) / looks * at[-1]
        points = np.column_stack([np.interp(along, at, corners[:, k]) for k in range(2)])
        walked += grid.tree.query(points)[1].tolist()
        if len(dict.fromkeys(walked)) >= most:
            break
    return np.array(list(dict.fromkeys(walked))[:most], np.int32)


def random_walk(n: int, most: int, rng: np.random.Generator) -> NDArray[np.int32]:
    """Return plants drawn anywhere, no plant twice, ``(k,)``."""
    return rng.permutation(n)[:most].astype(np.int32)
