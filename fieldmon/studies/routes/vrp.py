"""PyVRP's prize-collecting mode on a reward matrix: a general solver, for comparison.

PyVRP is optional (``pip install fieldmon[bench]``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.errors import SettingError
from fieldmon.studies.routes.drive import Walker

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# rewards are counted in thousandths and so much that steps only decide between equal rewards
_PRIZE = 10**9
MOST_PLANTS = 1200


def collect(reward: Float, budget: int, seconds: float = 10.0, seed: int = 1) -> Int:
    """Return the places of the walk that PyVRP finds in so many seconds."""
    try:
        from pyvrp import Model  # type: ignore[import-not-found,unused-ignore]  # noqa: PLC0415
        from pyvrp.stop import (  # type: ignore[import-not-found,unused-ignore]  # noqa: PLC0415
            MaxRuntime,
        )
    except ImportError as error:
        raise SettingError(
            "PyVRP must be installed to compare with it, but it is not: pip install fieldmon[bench]"
        ) from error
    row, column = np.nonzero(reward)
    if len(row) > MOST_PLANTS:
        raise SettingError(
            f"An instance for PyVRP must have {MOST_PLANTS} plants with a reward at most, but this "
            f"has {len(row)}: every pair of them is told to it."
        )
    places = np.concatenate([[[0, 0]], np.stack([row, column + 1], axis=1)])
    steps = _steps(places, reward.shape[1])
    model: Any = Model()
    nodes = [model.add_location(0, 0) for _ in places]
    depot = model.add_depot(nodes[0])
    for node, prize in zip(nodes[1:], reward[row, column], strict=True):
        model.add_client(node, prize=round(prize * _PRIZE), required=False)
    model.add_vehicle_type(start_depot=depot, end_depot=depot, max_distance=budget)
    for i, one in enumerate(nodes):
        for j, other in enumerate(nodes):
            if i != j:
                model.add_edge(one, other, distance=int(steps[i, j]))
    result = model.solve(MaxRuntime(seconds), seed=seed, display=False)
    walker = Walker(reward.shape[1])
    if result.is_feasible():
        for route in result.best.routes():
            # clients are numbered from the depot on
            for visit in route.visits():
                _walk(walker, *places[visit].tolist())
    return _home(walker)


def _steps(places: Int, n: int) -> Int:
    """Return the steps between all places, ``(k, k)``."""
    row, column = places.T
    across = np.abs(row[:, None] - row)
    by_left = column[:, None] + column
    by_right = 2 * (n + 1) - by_left
    other = across + np.minimum(by_left, by_right)
    steps: Int = np.where(across == 0, np.abs(column[:, None] - column), other)
    return steps


def _walk(walker: Walker, row: int, column: int) -> None:
    if row != walker.row:
        by_left = walker.column + column <= walker.far * 2 - walker.column - column
        side = 0 if by_left else walker.far
        if walker.column != side:
            walker.along(side)
        walker.to_row(row)
    if walker.column != column:
        walker.along(column)


def _home(walker: Walker) -> Int:
    _walk(walker, 0, 0)
    return np.array(walker.places, np.int64)
