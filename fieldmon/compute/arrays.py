"""Arrays that hold lists of different lengths one after the other, and arrays nobody may change."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

A = TypeVar("A", bound="NDArray[np.generic]")


def read_only(array: A) -> A:
    """Return the same array, which nobody can change from now on."""
    array.setflags(write=False)
    return array


def as_seen(array: A) -> A:
    """Return the same numbers, which nobody can change through what is returned."""
    return read_only(array.view())


def as_kept(array: A) -> A:
    """Return the same numbers, which nobody can change: a copy, unless nobody can already.

    Examples
    --------
    >>> import numpy as np
    >>> chance = read_only(np.zeros(3))
    >>> as_kept(chance) is chance, as_kept(chance[1:]).base is chance
    (True, True)
    >>> kept = as_kept(given := np.zeros(3))
    >>> given[0] = 1.0
    >>> kept.tolist()
    [0.0, 0.0, 0.0]
    """
    owner: Any = array
    while type(owner) is np.ndarray and not owner.flags.writeable:
        if owner.base is None:
            return array
        owner = owner.base
    return read_only(array.copy())


def as_compiled(array: A) -> A:
    """Return the array, or a copy, as loops are compiled for it: without gaps, to be written to.

    Numba compiles a loop once more for a slice with steps, and for an array nobody may change.
    """
    made: A = np.require(array, requirements=["C_CONTIGUOUS", "WRITEABLE"])
    return made


def offsets(count: NDArray[np.integer]) -> NDArray[np.int64]:
    """Return where each of k lists starts, and the last one ends, ``(k + 1,)``.

    The lists hold ``count`` ``(k,)`` entries and stand one after the other (compressed sparse
    rows): list i is ``entry[offsets[i]:offsets[i + 1]]``.
    """
    start = np.zeros(len(count) + 1, np.int64)
    np.cumsum(count, out=start[1:])
    return start


def runs(
    first: NDArray[np.integer], count: NDArray[np.integer]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return k runs of whole numbers, one after the other, and of which run each number is.

    Run i is ``first[i], first[i] + 1, ...``, ``count[i]`` of them; both arrays are ``(k,)``, and
    what is returned, numbers and runs, has one entry a number.
    """
    run = np.repeat(np.arange(len(count)), count)
    return np.arange(len(run)) + (first - offsets(count)[:-1])[run], run


def run_ends(numbers: NDArray[np.integer]) -> NDArray[np.integer]:
    """Return the first and the last of each run of ascending whole numbers, ``(k, 2)``."""
    parted = np.diff(numbers) > 1
    first, last = np.append(True, parted), np.append(parted, True)
    n = len(numbers)
    return np.stack([numbers[first[:n]], numbers[last[:n]]], axis=1)
