"""Put a layer on the earth: its coordinate system, its order of axes, degrees WGS84 out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.geodata.crs import ask_for_crs, system, way_from
from fieldmon.geodata.findings import Finding, seen

if TYPE_CHECKING:
    import pyproj
    from numpy.typing import NDArray

    from fieldmon.geodata.options import ReadOptions


def place_geometry(
    geometry: NDArray[np.object_], stated: str | None, options: ReadOptions
) -> tuple[NDArray[np.object_], list[Finding]]:
    """Return geometries ``(n,)`` in degrees WGS84, lon/lat, and what was found on the way."""
    xy = np.asarray(shapely.get_coordinates(geometry), dtype=np.float64)
    lonlat, findings = place(xy, stated, options)
    moved = geometry.copy()
    shapely.set_coordinates(moved, lonlat)
    return moved, findings


def place(
    xy: NDArray[np.float64], stated: str | None, options: ReadOptions
) -> tuple[NDArray[np.float64], list[Finding]]:
    """Return degrees WGS84 ``(n, 2)`` for a file's coordinates; ask where they cannot be known."""
    if len(xy) == 0:
        return xy, []
    findings: list[Finding] = []
    if options.crs is not None and stated is not None:
        findings.append(seen(f"The coordinate system named by hand, {options.crs}, was used."))
    wanted = options.crs or stated
    if wanted is None:
        raise ask_for_crs(xy, options, "The file does not say in which coordinate system it is.")
    crs = system(wanted)
    if options.swap_axes:
        xy = xy[:, ::-1]
        findings.append(seen("First and second coordinate were exchanged, as asked."))
    _check_range(xy, crs, options)
    way = way_from(crs, (float(np.median(xy[:, 0])), float(np.median(xy[:, 1]))))
    lonlat = way.lonlat(xy)
    _check_landing(lonlat, crs)
    return lonlat, [*findings, *way.findings()]


def _check_range(xy: NDArray[np.float64], crs: pyproj.CRS, options: ReadOptions) -> None:
    """Ask where degrees are none, or are in the wrong order."""
    if not crs.is_geographic:
        return
    first, second = np.abs(xy[:, 0]), np.abs(xy[:, 1])
    if (first <= 360).all() and (second <= 90).all():
        return
    if (second <= 360).all() and (first <= 90).all():
        raise ChoiceNeeded(
            f"Latitudes must lie in -90..90, but there is {xy[np.argmax(second), 1]:.6g}: "
            "longitude and latitude seem to be in the wrong order. Exchange them if that is so.",
            "swap_axes",
            ("yes",),
        )
    raise ask_for_crs(
        xy,
        options,
        f"Degrees must lie in -180..180, but the file says {crs.name} and holds metres.",
    )


def _check_landing(lonlat: NDArray[np.float64], crs: pyproj.CRS) -> None:
    if not (np.isfinite(lonlat).all() and (np.abs(lonlat[:, 1]) <= 90).all()):
        raise FileProblem(
            f"All coordinates must lie where {crs.name} is defined, but some do not. "
            "Check the coordinate system and name the right one."
        )
