"""Short names for values: the same for the same values only."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

if TYPE_CHECKING:
    from collections.abc import Callable


def digest(*parts: object, length: int = 64, end: bytes = b"\0") -> str:
    """Return the first `length` hexadecimal digits of the SHA-256 of some values.

    Digests stand in season files, in folders of studies and of routes: what is stored must come
    out again, so what a part is to SHA-256 never changes.

    Parameters
    ----------
    parts
        Arrays count by their bytes (say the type where it could vary), geometries by their WKB,
        mappings by their items in the order of the keys, bytes as they are, all else as Python
        writes it (`repr`).
    length
        How many digits; 64 are all there are.
    end
        What comes after each part, so that no other parts are the same in a row. Empty where
        nothing did when digests of that kind were first stored.
    """
    everything = hashlib.sha256()
    for part in parts:
        everything.update(_bytes(part) + end)
    return everything.hexdigest()[:length]


def _bytes(value: object) -> bytes:
    if isinstance(value, bytes):
        return value
    if isinstance(value, shapely.Geometry):
        return shapely.to_wkb(value)
    if isinstance(value, np.ndarray):
        return value.tobytes()
    return repr(sorted(value.items()) if isinstance(value, dict) else value).encode()


def places_by_name(most: int) -> Callable[[str], list[Any]]:
    """Return what gives each name, as of a `digest`, its own list, empty at first.

    What follows from a digest's parts can be kept there; of the `most` names asked for last.
    """
    return lru_cache(maxsize=most)(lambda _: [])
