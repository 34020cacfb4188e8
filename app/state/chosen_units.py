"""The units and dates that a session wants, from its boxes."""

from __future__ import annotations

from ..words.units import Units
from . import widget_memory

#: the boxes' keys, which are the fields of `Units`
KEYS = ("length", "area", "date_like")


def units() -> Units:
    """Return how this session wants numbers written."""
    chosen = {name: widget_memory.value(name) for name in KEYS}
    return Units(**{name: value for name, value in chosen.items() if value})
