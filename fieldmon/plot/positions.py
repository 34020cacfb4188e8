"""Positions on the map, as a program hands them over."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fieldmon.compute.array_arguments import array_of
from fieldmon.errors import ObservationError
from fieldmon.plot.plant_columns import column_called

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_FARTHEST_DEG = (360.0, 90.0)
# what columns of a table are called, as `plain` has them
_LON, _LAT = ("lon", "long", "lng", "longitude", "x"), ("lat", "latitude", "y")


def lonlat_of(
    what: str, given: object, instead: str = "", *, nowhere: bool = False
) -> NDArray[np.float64]:
    """Return positions ``(m, 2)`` in degrees, longitude first; raise an error for anything else.

    Parameters
    ----------
    what
        Whose they are, in the sentence: ``"Positions of records"``.
    given
        What was handed over. A DataFrame may have any order and other columns if its columns are
        called lon and lat.
    instead
        What else to do.
    nowhere
        Whether NaN will do: of what nobody says where it was.

    Examples
    --------
    >>> lonlat_of("Plants", [[30.0, 135.0]])
    Traceback (most recent call last):
    ...
    fieldmon.errors.ObservationError: Plants must be longitude and latitude in degrees, but one is 30, 135. Give longitude first.
    """  # noqa: E501 - a sentence
    import numpy as np  # noqa: PLC0415 - commands that only print their help do not wait for it

    points = array_of(np.float64, what, _by_name(given))
    if points.size == 0 and points.ndim:
        return points.reshape(-1, 2)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ObservationError(
            f"{what} must be pairs of longitude and latitude, but they have the shape "
            f"{points.shape}."
        )
    wrong = (np.abs(points) > _FARTHEST_DEG).any(axis=1)
    if not nowhere:
        wrong |= np.isnan(points).any(axis=1)
    if wrong.any():
        lon, lat = points[wrong][0]
        raise ObservationError(
            f"{what} must be longitude and latitude in degrees, but one is {lon:g}, {lat:g}. "
            f"Give longitude first{instead}."
        )
    return points


def _by_name(given: Any) -> Any:  # noqa: ANN401 - anything
    """Return the longitudes and latitudes of a DataFrame whose columns say which they are."""
    if not hasattr(given, "iloc") or getattr(given, "ndim", 0) != 2:
        return given
    names = [str(name) for name in given.columns]
    places = [column_called(words, names) for words in (_LON, _LAT)]
    found = [names.index(one) for one in places if one is not None]
    return given.iloc[:, found] if len(found) == len(places) else given
