"""Which records of a file are of one visit: a robot that passes a plant tells of it each time."""

from __future__ import annotations

from math import dist
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: records no farther apart than this are of one visit
VISIT_S = 600.0
# places are the same within a position's accuracy, which must tell plants apart, and within this
_SAME_M = 0.5
_TELLS_PLANTS_M = 1.0
_EXACT_M = 0.01


def first_of_visits(alike: Iterable[Hashable], at_s: Floats) -> NDArray[np.intp]:
    """Return the first record of each visit, in the file's order.

    Parameters
    ----------
    alike
        What each says of what; only those that say the same can be of one visit.
    at_s
        ``(k,)`` seconds from anywhere; NaN where no time is known: one visit each.
    """
    keys, first = list(alike), list[int]()
    began: dict[object, float] = {}
    for k in np.argsort(at_s, kind="stable").tolist():  # those of no time come last
        at = float(at_s[k])
        key = keys[k], at != at  # noqa: PLR0124 - NaN
        if key not in began or at - began[key] > VISIT_S:
            began[key] = at
            first.append(k)
    return np.sort(np.array(first, np.intp))


def same_places(xy_m: Floats, accuracy_m: Floats) -> NDArray[np.intp]:
    """Return the number of the first record at the place of each, ``(k,)``.

    Parameters
    ----------
    xy_m
        ``(k, 2)`` positions in metres.
    accuracy_m
        ``(k,)`` of them; NaN where it is not known: they are the same where they are equal.
    """
    _, first, same = np.unique(np.round(xy_m, 3), axis=0, return_index=True, return_inverse=True)
    place = first[same.ravel()]
    told = accuracy_m <= _TELLS_PLANTS_M  # false where it is not known
    reach_m = np.clip(accuracy_m, _EXACT_M, _SAME_M).tolist()
    at_m: list[tuple[float, float]] = [(x, y) for x, y in xy_m.tolist()]
    cells: dict[tuple[int, int], list[int]] = {}
    for k in np.flatnonzero(told & (place == np.arange(len(place)))).tolist():
        column, row = (int(c // _SAME_M) for c in at_m[k])
        around = ((column + i, row + j) for i in (-1, 0, 1) for j in (-1, 0, 1))
        others = (one for cell in around for one in cells.get(cell, ()))
        apart = ((dist(at_m[one], at_m[k]), one) for one in others)
        near = min(
            (one for one in apart if one[0] <= min(reach_m[one[1]], reach_m[k])), default=None
        )
        if near is None:
            cells.setdefault((column, row), []).append(k)
        else:
            place[k] = near[1]
    return place[place]
