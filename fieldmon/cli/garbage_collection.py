"""How often Python looks for objects that only hold each other: seldom, within a command.

A command imports a thousand modules, which is a million objects, and next to none of them are ever
thrown away. Looking through them again and again, and once more as the program ends, took a tenth
of all its time.
"""

from __future__ import annotations

import atexit
import gc
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

# of the youngest objects, of the older, of the old: as Python counts them (700, 10, 10)
_SELDOM = 100_000, 50, 100


@contextmanager
def cycles_seldom_looked_for() -> Iterator[None]:
    """Look through young objects only where there are many; through none as the program ends."""
    before = gc.get_threshold()
    gc.set_threshold(*_SELDOM)
    atexit.unregister(gc.freeze)
    atexit.register(gc.freeze)  # what is frozen is not looked through
    try:
        yield
    finally:
        gc.set_threshold(*before)
