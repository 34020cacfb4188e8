"""Names of files made from names of plots and people."""

from __future__ import annotations

# a name of a file may be 255 bytes long; Hebrew and Arabic take two a letter
_BYTES = 120


def plain_name(name: str) -> str:
    """Return a name without what a file's name must not hold; `plot` where nothing is left.

    Examples
    --------
    >>> plain_name("Gate 2/3 (north)")
    'Gate_2_3__north_'
    """
    kept = "".join(c if c.isalnum() or c in "-_" else "_" for c in name)
    return kept.encode()[:_BYTES].decode(errors="ignore") or "plot"
