"""How numbers of things are said."""

from __future__ import annotations


def counted(number: int, thing: str) -> str:
    """Return so many things in words: "1 plant", "12 plants"."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"
