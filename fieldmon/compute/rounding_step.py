"""To which step numbers are rounded."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_LOOKED_AT = 5_000


def step_of(xy: NDArray[np.float64]) -> float:
    """Return the step of rounding: 0.001 where all coordinates have at most three decimals.

    0 where they are not rounded.
    """
    some = xy[:: max(1, len(xy) // _LOOKED_AT)]
    for decimals in range(9):
        if np.abs(np.round(some, decimals) - some).max(initial=0.0) < 1e-10:
            return float(10.0**-decimals)
    return 0.0
