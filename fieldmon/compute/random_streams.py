"""Named, independent random streams.

``RandomStreams(seed).of("spread", 3)`` is the generator for the spread of night 3, whatever
else was drawn before: every sampler meets the same insects, so comparisons are paired.
"""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inlined, inner_inlined, loop, routine
from fieldmon.compute.kinds import must_be_of
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_POOL = 4
_AT_ONCE = 32
_HASH, _HASH_TIMES = np.uint64(0x43B0D7E5), np.uint64(0x931E8875)
_STATE, _STATE_TIMES = np.uint64(0x8B51F9DD), np.uint64(0x58F38DED)
_MIX_LEFT, _MIX_RIGHT = np.uint64(0xCA01F9DD), np.uint64(0x4973F715)
_LOW_32, _S16, _S32 = np.uint64(0xFFFFFFFF), np.uint64(16), np.uint64(32)
_COIN_PARTS = 2.0**53
_S11, _S27, _S30, _S31 = np.uint64(11), np.uint64(27), np.uint64(30), np.uint64(31)


@dataclass(frozen=True)
class RandomStreams:
    """The root of all randomness of one season or study.

    Parameters
    ----------
    seed
        Any integer from 0.
    """

    seed: int

    def __post_init__(self) -> None:
        must_be_of("A seed", "int", self.seed)
        if self.seed < 0:
            raise SettingError(f"A seed must be 0 or more, but it is {self.seed}.")

    def of(self, name: str, *key: int) -> np.random.Generator:
        """Return the stream called ``name`` at ``key`` (a day, a replicate, ...)."""
        return np.random.default_rng(self._sequence(name, key))

    def key(self, name: str, *key: int) -> np.uint64:
        """Return 64 random bits that name a whole table of coins (see :func:`coin`)."""
        words = self._words(name, key)
        return np.uint64(_first_state(words, np.empty(_POOL, np.uint64)))

    def keys(self, name: str) -> Iterator[np.uint64]:
        """Yield the keys of ``name`` at 0, 1, 2, ... (2^32 of them): quicker than one by one."""
        words, pool = self._words(name, (0,)), np.empty(_POOL, np.uint64)
        for first in range(0, 2**32, _AT_ONCE):
            keys = np.empty(_AT_ONCE, np.uint64)
            _first_states(words, pool, keys, first)
            yield from keys

    def _words(self, name: str, key: tuple[int, ...]) -> NDArray[np.uint64]:
        words = _words(self.seed)
        words += [0] * (_POOL - len(words))
        for number in (zlib.crc32(name.encode()), *key):
            words += _words(number)
        return np.array(words, np.uint64)

    def _sequence(self, name: str, key: tuple[int, ...]) -> np.random.SeedSequence:
        return np.random.SeedSequence(self.seed, spawn_key=(zlib.crc32(name.encode()), *key))


def _words(number: int) -> list[int]:
    """Return a number from 0 in words of 32 bits, the lowest first."""
    words = [number & 0xFFFFFFFF]
    while number := number >> 32:
        words.append(number & 0xFFFFFFFF)
    return words


@loop
def _first_state(words: NDArray[np.uint64], pool: NDArray[np.uint64]) -> np.uint64:
    """Return the first 64 bits that `numpy.random.SeedSequence` makes of words of 32 bits.

    The same algorithm (O'Neill 2015, "Developing a seed_seq alternative"), as a season asks for
    three of them a day and numpy's costs as much as a night does.
    """
    factor = _HASH
    for i in range(_POOL):
        pool[i], factor = _hashed(words[i], factor, _HASH_TIMES)
    for i in range(words.size):
        for j in range(_POOL):
            if i != j:
                word = pool[i] if i < _POOL else words[i]
                word, factor = _hashed(word, factor, _HASH_TIMES)
                pool[j] = ((_MIX_LEFT * pool[j]) - (_MIX_RIGHT * word)) & _LOW_32
                pool[j] ^= pool[j] >> _S16
    low, factor = _hashed(pool[0], _STATE, _STATE_TIMES)
    high, factor = _hashed(pool[1], factor, _STATE_TIMES)
    return low | (high << _S32)


@loop
def _first_states(
    words: NDArray[np.uint64], pool: NDArray[np.uint64], states: NDArray[np.uint64], first: int
) -> None:
    """Find the same with `first` and the numbers after it for the last word."""
    for k in range(states.size):
        words[-1] = first + k
        states[k] = _first_state(words, pool)


@inner_inlined
def _hashed(word: np.uint64, factor: np.uint64, times: np.uint64) -> tuple[np.uint64, np.uint64]:
    word ^= factor
    factor = (factor * times) & _LOW_32
    word = (word * factor) & _LOW_32
    return word ^ (word >> _S16), factor


@inlined
def coin(key: np.uint64, i: int) -> float:
    """Return entry ``i`` of the table of uniform numbers in [0, 1) that ``key`` names.

    A counter-based generator: SplitMix64 (Steele, Lea & Flood 2014, OOPSLA) jumped to its i-th
    output, so that a plant's coin does not depend on which plants were asked before.
    """
    return float(coin_bits(key, i)) * (1.0 / _COIN_PARTS)


@inlined
def coin_bits(key: np.uint64, i: int) -> np.uint64:
    """Return the coin as a whole number of 2^-53: quicker to compare, see :func:`coin_limit`."""
    z = key + (np.uint64(i) + np.uint64(1)) * _GOLDEN
    z = (z ^ (z >> _S30)) * _MIX_1
    z = (z ^ (z >> _S27)) * _MIX_2
    z = z ^ (z >> _S31)
    return z >> _S11


def coin_limit(chance: float) -> np.uint64:
    """Return the bits below which a coin is below a chance in [0, 1], to the last bit."""
    return np.uint64(math.ceil(chance * _COIN_PARTS))


@routine
def coin_table(key: np.uint64, n: int) -> NDArray[np.float64]:
    """Return the first `n` entries of the table that `key` names, ``(n,)``."""
    table = np.empty(n)
    fill_coins(table, key)
    return table


@inner_inlined
def fill_coins(table: NDArray[np.float64], key: np.uint64) -> None:
    """Fill in the first entries ``(n,)`` of the table that `key` names.

    A loop does that entry by entry: for a whole array at once the compiler brings along the words
    of its refusal, whose compiling takes longer than most loops'.
    """
    for i in range(table.size):
        table[i] = coin(key, i)
