"""Plants that stand much nearer to another one than plants do: perhaps one seen twice."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.plot.row_detection import frame_around, nearest_m

if TYPE_CHECKING:
    from numpy.typing import NDArray

# nearer than so much of the usual distance, plants may be one; where more plants stand a little
# farther off than that, or many as near, as in double rows, they are none
_NEAR, _USUAL, _MOST = 0.35, 0.6, 0.4
# fewer plants do not tell
_ENOUGH = 20


class NearDoubles(NamedTuple):
    """What to say of such plants, and within how many metres of each other they stand."""

    sentence: str
    within_m: float


def near_doubles(lonlat: NDArray[np.float64]) -> NearDoubles | None:
    """Return what to say of plants ``(n, 2)`` that stand much nearer than usual; None: none do."""
    if len(lonlat) < _ENOUGH:
        return None
    xy_m = frame_around(lonlat).xy_m(lonlat)
    near_m = nearest_m(xy_m)
    usual_m = float(np.median(near_m))
    close = near_m < _NEAR * usual_m
    between = np.count_nonzero(near_m < _USUAL * usual_m) - np.count_nonzero(close)
    n = int(np.count_nonzero(close))
    if n <= between or n > _MOST * len(lonlat):
        return None
    within_m = ceil(float(near_m[close].max()) * 100 + 1e-6) / 100
    said = worded(
        "{n} of {all} plants stand within {within_m:.2f} m of another one, where others are "
        "{usual_m:.2f} m apart: some may have been found twice.",
        n=n,
        all=len(lonlat),
        within_m=within_m,
        usual_m=usual_m,
    )
    return NearDoubles(said, within_m)
