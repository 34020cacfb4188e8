"""How far the differences between plants' chances came true, as a season's inspections tell it.

The calibration slope (Cox 1958, Biometrika 45:562) is what the logarithm of the odds that were
stated is to be multiplied by: 1 where plants said to be likelier are infested that much more often,
0 where what was said tells no plant from another.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inlined, part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# inspections, and sums over them: of the logarithm of the odds, of finds, of the logarithm squared,
# and of the logarithm where something was found
_N, _SAID, _FOUND, _SQUARED, _SAID_OF_FINDS = range(5)
# a plant known to be infested tells of no difference
_KNOWN = 0.99
# a slope of 0 is believed like so much information (of a logistic regression) at first, and no
# more of it than is left after so many standard errors (our choice)
_PRIOR_INFORMATION, _ERRORS = 6.0, 1.0


def no_inspections() -> Floats:
    """Return the sums before anything was inspected, ``(5,)``."""
    return np.zeros(5)


@part
def note_inspection(sums: Floats, chance: float, found: bool) -> None:  # noqa: FBT001 - a result
    """Add an inspection of a plant that was given a chance to the sums ``(5,)``, in place."""
    if chance > _KNOWN:
        return
    said = np.log(chance / (1.0 - chance))
    sums[_N] += 1.0
    sums[_SAID] += said
    sums[_SQUARED] += said * said
    sums[_FOUND] += found
    sums[_SAID_OF_FINDS] += said * found


@inlined
def proved_slope(sums: Floats) -> float:
    """Return the least slope, 0 to 1, that a season's inspections speak for.

    The first step of a logistic regression, as if a plot of slope 0 had been inspected before, less
    its standard error. So who has seen little relies on no differences.
    """
    n = sums[_N]
    if n < 1.0:
        return 0.0
    rate = sums[_FOUND] / n
    brought = sums[_SAID_OF_FINDS] - sums[_SAID] * rate
    spread = sums[_SQUARED] - sums[_SAID] * sums[_SAID] / n
    information = spread * rate * (1.0 - rate) + _PRIOR_INFORMATION
    slope = brought / information - _ERRORS / np.sqrt(information)
    return float(min(max(slope, 0.0), 1.0))
