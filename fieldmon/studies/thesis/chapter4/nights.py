"""What the insects do in a night according to the listings, slips and all.

Faces are numbered as in the listings: ``q = 1 + side * plants + j``, from 1. Every infested face
with a successful coin spreads once; whether it is infested is read before the night begins.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.jit import routine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SNAKE, NEIGHBOR, RANDOM_SNAKE = 5, 6, 7
"""The listings A.5, A.6 and A.7 by their number."""

ABORTED = -1


class Night(NamedTuple):
    """What a night needs to know (see `ListingErrors` for the switches)."""

    plants: int
    sides: int
    listing: int
    severity: float
    other_face_slip: bool
    row_index_slip: bool
    phantoms: bool


@routine
def _reach(infested: NDArray[np.bool_], q: int) -> int:
    """Infest face `q`; return 1 if it was clean, else 0."""
    new = 0 if infested[q - 1] else 1
    infested[q - 1] = True
    return new


@routine
def _along_side(night: Night, infested: NDArray[np.bool_], q: int) -> tuple[int, int]:
    """Spread from `q` as listing A.5 does; return (counted, infested)."""
    side, j = divmod(q - 1, night.plants)
    new = phantom = 0
    if j > 0:
        new += _reach(infested, q - 1)
    if j < night.plants - 1:
        new += _reach(infested, q + 1)
    if side % 2 == 0 and 2 <= side <= night.sides - 2:
        new += _reach(infested, q - night.plants)
    elif side % 2 == 1 and side <= night.sides - 3:
        if not night.other_face_slip or j in (0, night.plants - 1):
            new += _reach(infested, q + night.plants)
        elif not infested[q + night.plants - 1]:
            phantom = 1
    return new + phantom, new


@routine
def _by_number(night: Night, infested: NDArray[np.bool_], q: int) -> tuple[int, int]:
    """Spread from `q` as A.6 and A.7 do on the first row, by number; return (counted, infested)."""
    if q == 1:
        return 1, _reach(infested, q + 1)
    if q == night.plants:
        return 1, _reach(infested, q - 1)
    new = _reach(infested, q - 1) + _reach(infested, q + 1)
    return (2 if night.listing == RANDOM_SNAKE else new), new


@routine
def _inner_face(night: Night, infested: NDArray[np.bool_], q: int) -> tuple[int, int]:
    """Spread from `q` to both numbers beside it and one row back; return (counted, infested)."""
    before = _reach(infested, q - 1)
    after = _reach(infested, q + 1) + _reach(infested, q - night.plants)
    return (before if night.listing == RANDOM_SNAKE else before + after), before + after


@routine
def _stuck_row(
    night: Night, infested: NDArray[np.bool_], q: int, row_index: int
) -> tuple[int, int]:
    """Spread from `q` with the row index as it sticks; return (counted, infested)."""
    if row_index == 2 and (q - 1) // night.plants == 1:
        return _along_side(night, infested, q)
    if q == night.plants * night.sides:
        return ABORTED, 0
    if row_index == 1:
        return _by_number(night, infested, q)
    return _inner_face(night, infested, q)


@routine
def _true_row(night: Night, infested: NDArray[np.bool_], q: int) -> tuple[int, int]:
    """Spread from `q` with the row index put right; A.6 and A.7 still count in their own way."""
    side, j = divmod(q - 1, night.plants)
    if side == 0:
        return _by_number(night, infested, q)
    inner = 0 < j < night.plants - 1
    if night.listing == RANDOM_SNAKE and side % 2 == 0 and inner:
        return _inner_face(night, infested, q)
    return _along_side(night, infested, q)


@routine
def spread(
    night: Night, infested: NDArray[np.bool_], coins: NDArray[np.float64]
) -> tuple[int, int]:
    """Let insects spread for one night, in place; return (counted, infested) faces.

    `infested` and `coins` are ``(T,)``. `counted` is `ABORTED` where the listing would stop with an
    index beyond the field.
    """
    before = infested.copy()
    counted = true = 0
    row_index = 1
    for q in range(1, infested.size + 1):
        if not before[q - 1] or coins[q - 1] >= night.severity:
            continue
        if night.listing == SNAKE:
            more_counted, more = _along_side(night, infested, q)
        elif night.row_index_slip:
            more_counted, more = _stuck_row(night, infested, q, row_index)
            if q == night.plants:
                row_index = 2
        else:
            more_counted, more = _true_row(night, infested, q)
        if more_counted == ABORTED:
            return ABORTED, true
        counted += more_counted if night.phantoms else more
        true += more
    return counted, true
