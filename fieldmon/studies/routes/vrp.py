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

# the highest reward in steps, which cost 1 each: with much more, or with steps that cost nothing,
# PyVRP finds less or no walk that fits
_PRIZE = 10_000
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
    for node, share in zip(nodes[1:], reward[row, column] / reward.max(), strict=True):
        model.add_client(node, prize=round(share * _PRIZE), required=False)
    model.add_vehicle_type(start_depot=depot, end_depot=depot, max_distance=budget)
    for i, one in enumerate(nodes):
        for j, other in enumerate(nodes):
            if i != j:
                model.add_edge(one, other, distance=int(steps[i, j]))
    result = model.solve(MaxRuntime(seconds), seed=seed, display=False)
    return _walked(places, reward.shape[1], result)


def _walked(places: Int, n: int, result: Any) -> Int:  # noqa: ANN401 - PyVRP's own
    """Return the places of the walk through the clients of a result, in its order."""
    walker = Walker(n)
    for route in result.best.routes() if result.is_feasible() else ():
        for stop in route:
            if stop.is_client():
                # clients are numbered among themselves; the depot is the first place
                _walk(walker, *places[stop.idx + 1].tolist())
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
