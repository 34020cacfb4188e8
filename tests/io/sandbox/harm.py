"""What a reading process is told to do to itself; it loads nothing else for it."""

import sys


def endless(n):
    """Call itself for ever."""
    return endless(n + 1)


def hungry(n):
    """Ask for so many bytes; the system gives them only when they are written to."""
    return len(bytearray(n))


def loaded():
    """Return which packages of tables are loaded."""
    return [name for name in ("geopandas", "pandas") if name in sys.modules]
