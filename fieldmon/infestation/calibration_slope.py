"""How far the differences between plants' chances came true, as a season's inspections tell it.

The calibration slope (Cox 1958, Biometrika 45:562) is what the logarithm of the odds that were
stated is to be multiplied by: 1 where plants said to be likelier are infested that much more often,
0 where what was said tells no plant from another.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inner_inlined, inner_loop

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# inspections, and sums over them: of the logarithm of the odds, of finds, of the logarithm squared,
# and of the logarithm where something was found; and the slope believed before them
_N, _SAID, _FOUND, _SQUARED, _SAID_OF_FINDS, _FIRST = range(6)
# a plant known to be infested tells of no difference
_KNOWN = 0.99
# the first slope counts like so much information (of a logistic regression), and what is not known
# is taken off by so many standard errors (our choice)
_PRIOR_INFORMATION, _ERRORS = 6.0, 1.0
# the differences of a first map count by half where the logarithm of its odds has this variance
# (our choice)
_HALF = 0.1


def no_inspections(chance: Floats | None = None) -> Floats:
    """Return the sums before anything was inspected, ``(6,)``.

    What records, edges or a raster say of the plants' first `chance` ``(n,)`` is believed; of a map
    that tells no plant from another there is nothing to believe.
    """
    sums = np.zeros(_FIRST + 1)
    if chance is not None:
        varies = float(np.log(chance / (1.0 - chance)).var())
        sums[_FIRST] = varies / (varies + _HALF)
    return sums


@inner_loop
def note_inspection(sums: Floats, chance: float, found: bool) -> None:  # noqa: FBT001 - a result
    """Add an inspection of a plant that was given a chance to the sums ``(6,)``, in place."""
    if chance > _KNOWN:
        return
    said = np.log(chance / (1.0 - chance))
    sums[_N] += 1.0
    sums[_SAID] += said
    sums[_SQUARED] += said * said
    sums[_FOUND] += found
    sums[_SAID_OF_FINDS] += said * found


def finds_noted(sums: Floats) -> float:
    """Return how many finds were added to the sums ``(6,)``."""
    return float(sums[_FOUND])


@inner_inlined
def proved_slope(sums: Floats) -> float:
    """Return the least slope, 0 to 1, that a season's inspections speak for.

    The first step of a logistic regression that begins with the first slope, less the standard
    error as far as that slope was none. So who has seen little relies on what was known before.
    """
    n, first = sums[_N], sums[_FIRST]
    if n < 1.0:
        return float(first)
    rate = sums[_FOUND] / n
    brought = sums[_SAID_OF_FINDS] - sums[_SAID] * rate
    spread = sums[_SQUARED] - sums[_SAID] * sums[_SAID] / n
    information = spread * rate * (1.0 - rate) + _PRIOR_INFORMATION
    slope = (brought + _PRIOR_INFORMATION * first) / information
    slope -= _ERRORS * (1.0 - first) / np.sqrt(information)
    return float(min(max(slope, 0.0), 1.0))
