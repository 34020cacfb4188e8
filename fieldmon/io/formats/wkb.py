"""Shapes as files keep them (WKB, or WKT), understood, with the rings that nobody closed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

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
    geometry, mended = understood(wkb)
    broken = np.flatnonzero(shapely.is_missing(geometry) & _there(wkb))
    messages = [closed(n)] if (n := int(mended.sum())) else []
    if len(broken):
        said = worded(
            "The shape of {n} {n:feature|features} cannot be understood; left out.", n=len(broken)
        )
        messages.append(dropped(said, f"feature {broken[0] + 1}"))
    return geometry, messages


def understood(
    wkb: NDArray[np.object_], wkt: NDArray[np.object_] | None = None
) -> tuple[NDArray[np.object_], NDArray[np.bool_]]:
    """Return geometries ``(n,)`` of shapes in bytes or in text, and those whose rings were closed.

    None where there is none, or none that can be understood; a shape stands in one of both.
    """
    geometry = _read(wkb, wkt, "ignore")
    there = _there(wkb) if wkt is None else _there(wkb) | _there(wkt)
    lost = shapely.is_missing(geometry) & there
    if lost.any():
        geometry[lost] = _read(wkb[lost], None if wkt is None else wkt[lost], "fix")
    return geometry, lost & ~shapely.is_missing(geometry)


def _read(
    wkb: NDArray[np.object_], wkt: NDArray[np.object_] | None, on_invalid: Literal["ignore", "fix"]
) -> NDArray[np.object_]:
    if wkt is None:
        return np.asarray(shapely.from_wkb(wkb, on_invalid=on_invalid), dtype=object)
    geometry = np.asarray(shapely.from_wkt(wkt, on_invalid=on_invalid), dtype=object)
    in_bytes = _there(wkb)
    geometry[in_bytes] = shapely.from_wkb(wkb[in_bytes], on_invalid=on_invalid)
    return geometry


def _there(cells: NDArray[np.object_]) -> NDArray[np.bool_]:
    return np.array([one is not None for one in cells], dtype=bool)


def closed(n_features: int) -> ImportMessage:
    """Return what to say of features whose rings were closed."""
    return repaired(
        worded(
            "The outline of {n_features} {n_features:feature|features} did not end where it "
            "began; it was closed by a straight line.",
            n_features=n_features,
        )
    )
