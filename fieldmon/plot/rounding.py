"""How positions are rounded, and whether plants can be told apart by what is left."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import worded
from fieldmon.plot.row_detection import frame_around, nearest_m

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.errors import FieldmonError

    Float = NDArray[np.float64]

# rounded to a greater part of how far plants stand apart, rows are to be looked at, and seen where
# there are none
_DOUBTED, _REFUSED = 1 / 3, 0.55
# fewer plants do not tell
_ENOUGH = 20
# plants that were put down exactly, as by a drawing, fill a lattice of columns and lines, but for
# this, are so evenly apart, and few share a place
_SPARSE, _EVEN, _SHARED = 1.5, 0.02, 0.1


class Rounding(NamedTuple):
    """A rounding too coarse for plants: what to say, and whether it hides their rows."""

    sentence: str
    hides_rows: bool


def doubts_of_rounding(
    lonlat: Float, step_m: float, row: NDArray[np.str_] | None, refusal: type[FieldmonError]
) -> list[str]:
    """Return a doubt where plants ``(n, 2)`` are rounded too coarsely.

    Raise the `refusal` where that hides rows: those that a name in `row` tells are not hidden.
    """
    named = row is not None and bool((row != "").all())
    rounding = too_coarse(lonlat, step_m, named=named)
    if rounding is None:
        return []
    if rounding.hides_rows:
        raise refusal(rounding.sentence)
    return [rounding.sentence]


def too_coarse(lonlat: Float, step_m: float, *, named: bool) -> Rounding | None:
    """Return what to say of plants ``(n, 2)`` rounded to a step; None where they stand far enough.

    Rows that are `named` stay what they are.
    """
    if not step_m or len(lonlat) < _ENOUGH:
        return None
    places, times = np.unique(lonlat, axis=0, return_counts=True)
    if len(places) < 2:
        return None
    xy_m = frame_around(places).xy_m(places)
    near_m = nearest_m(xy_m)
    apart_m = float(np.median(near_m))
    hidden = step_m > _REFUSED * apart_m
    exact = _is_even(times, near_m) and (not hidden or _is_filled(places))
    if step_m <= _DOUBTED * apart_m or exact:
        return None
    kinds = {"step": distance_figure(step_m), "apart": distance_figure(apart_m)}
    if hidden and not named:
        said = worded(
            "Plants must be placed more exactly than they stand apart, but positions are rounded "
            "to {step} and the nearest ones are {apart} apart: rows would be seen where there "
            "are none. Export them with 7 decimals of a degree, or with centimetres.",
            **kinds,
        )
        return Rounding(said, hides_rows=True)
    said = worded(
        "Positions are rounded to {step}, and the nearest ones are {apart} apart: plants stand "
        "elsewhere than the file says, and rows may be others. Look at them, or export positions "
        "with 7 decimals of a degree, or with centimetres.",
        **kinds,
    )
    return Rounding(said, hides_rows=False)


def _is_even(times: NDArray[np.intp], near_m: Float) -> bool:
    """Return whether places are evenly apart, and shared by few plants or by as many each."""
    n, n_all = len(times), int(times.sum())
    low_m, high_m = np.quantile(near_m, [0.1, 0.9])
    few = n_all - n < _SHARED * n_all or np.ptp(times) == 0
    return bool(few and high_m - low_m < _EVEN * np.median(near_m))


def _is_filled(places: Float) -> bool:
    """Return whether places ``(n, 2)`` fill the lattice of their columns and lines."""
    columns, lines = (len(np.unique(one)) for one in places.T)
    return columns * lines < _SPARSE * len(places)
