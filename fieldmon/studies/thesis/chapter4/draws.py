"""Where the random numbers of a run come from: portable streams, or ours."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.random_streams import RandomStreams

_MULTIPLIER, _MODULUS = 16807, 2**31 - 1


def portable(seed: int, stream: int, n: int) -> NDArray[np.float64]:
    """Return `n` numbers in (0, 1) of a stream that any language can repeat, ``(n,)``.

    The minimal standard generator (Park & Miller 1988, CACM 31), started at
    ``1 + (seed * 1000003 + 7919 * stream) mod (2^31 - 2)``, its first 20 numbers dropped. Streams:
    0 start, 1 nights, 2 steps.
    """
    x = 1 + (seed * 1_000_003 + 7919 * stream) % (_MODULUS - 1)
    numbers = np.empty(n + 20)
    for i in range(n + 20):
        x = _MULTIPLIER * x % _MODULUS
        numbers[i] = x
    return numbers[20:] / _MODULUS


def keys(streams: RandomStreams, replicates: int, days: int) -> NDArray[np.uint64]:
    """Return the names of each replicate's coin tables, ``(replicates, 2 + days)``.

    Columns: start, steps, then one a night. They hang on seed and replicate only, so every strategy
    meets the same insects.
    """
    table = np.empty((replicates, 2 + days), np.uint64)
    for replicate in range(replicates):
        table[replicate, 0] = streams.key("thesis-start", replicate)
        table[replicate, 1] = streams.key("thesis-steps", replicate)
        for day in range(days):
            table[replicate, 2 + day] = streams.key("thesis-night", replicate, day)
    return table
