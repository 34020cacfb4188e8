"""Named, independent random streams.

``Chance(seed).of("spread", 3)`` is the generator for the spread of night 3, whatever else was drawn
before: every sampler meets the same insects, so comparisons are paired.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numba as nb
import numpy as np

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_S11, _S27, _S30, _S31 = np.uint64(11), np.uint64(27), np.uint64(30), np.uint64(31)


@dataclass(frozen=True)
class Chance:
    """The root of all randomness of one season or study.

    Parameters
    ----------
    seed
        Any integer from 0.
    """

    seed: int

    def __post_init__(self) -> None:
        if self.seed < 0:
            raise SettingError(f"A seed must be 0 or more, but it is {self.seed}.")

    def of(self, name: str, *key: int) -> np.random.Generator:
        """Return the stream called ``name`` at ``key`` (a day, a replicate, ...)."""
        return np.random.default_rng(self._sequence(name, key))

    def key(self, name: str, *key: int) -> np.uint64:
        """Return 64 random bits that name a whole table of coins (see :func:`coin`)."""
        return np.uint64(self._sequence(name, key).generate_state(1, np.uint64)[0])

    def _sequence(self, name: str, key: tuple[int, ...]) -> np.random.SeedSequence:
        return np.random.SeedSequence(self.seed, spawn_key=(zlib.crc32(name.encode()), *key))


@nb.njit(cache=True, inline="always")
def coin(key: np.uint64, i: int) -> float:
    """Return entry ``i`` of the table of uniform numbers in [0, 1) that ``key`` names.

    A counter-based generator: SplitMix64 (Steele, Lea & Flood 2014, OOPSLA) jumped to its i-th
    output, so that a plant's coin does not depend on which plants were asked before.
    """
    z = key + (np.uint64(i) + np.uint64(1)) * _GOLDEN
    z = (z ^ (z >> _S30)) * _MIX_1
    z = (z ^ (z >> _S27)) * _MIX_2
    z = z ^ (z >> _S31)
    return float(z >> _S11) * (1.0 / 9007199254740992.0)


@nb.njit(cache=True, nogil=True)
def coin_table(key: np.uint64, n: int) -> NDArray[np.float64]:
    """Return the first `n` entries of the table that `key` names, ``(n,)``."""
    table = np.empty(n)
    for i in range(n):
        table[i] = coin(key, i)
    return table
