"""Shapes as files keep them (WKB), with the rings that nobody closed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import ImportMessage, dropped, repaired

if TYPE_CHECKING:
    from numpy.typing import NDArray


def shapes(wkb: NDArray[np.object_]) -> tuple[NDArray[np.object_], list[ImportMessage]]:
    """Return geometries ``(n,)``, None where there is none, and what was closed or left out.

    A ring that does not end where it begins is closed by a straight line.
    """
    geometry = shapely.from_wkb(wkb, on_invalid="ignore")
    there = np.array([one is not None for one in wkb], dtype=bool)
    lost = np.flatnonzero(shapely.is_missing(geometry) & there)
    if not len(lost):
        return geometry, []
    geometry[lost] = shapely.from_wkb(wkb[lost], on_invalid="fix")
    broken = lost[shapely.is_missing(geometry[lost])]
    messages = []
    if len(lost) > len(broken):
        messages.append(closed(len(lost) - len(broken)))
    if len(broken):
        said = worded(
            "The shape of {n} {n:feature|features} cannot be understood; left out.", n=len(broken)
        )
        messages.append(dropped(said, f"feature {broken[0] + 1}"))
    return geometry, messages


def closed(n_features: int) -> ImportMessage:
    """Return what to say of features whose rings were closed."""
    return repaired(
        worded(
            "The outline of {n_features} {n_features:feature|features} did not end where it "
            "began; it was closed by a straight line.",
            n_features=n_features,
        )
    )
