"""Degrees and metres: the one bridge between the map and the rows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from pyproj import CRS, Geod, Transformer
from pyproj.enums import TransformDirection

from fieldmon.compute.kinds import must_be_of
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError, SettingError

Float = NDArray[np.float64]
G = TypeVar("G", bound=shapely.Geometry)
#: the earth, for metres between degrees WGS 84
GEOD = Geod(ellps="WGS84")
_FARTHEST_M = 200_000.0
#: roughly, of latitude anywhere and of longitude at the equator
M_PER_DEGREE = 111_320.0
# longitudes that differ by more lie on both sides of 180, unless they are wrong
_ROUND_DEG = 350.0


def metres_per_unit(crs: CRS) -> float:
    """Return, roughly, how many metres one in the coordinates of a system is."""
    return M_PER_DEGREE if crs.is_geographic else 1.0


def goes_round(lon: ArrayLike) -> bool:
    """Return whether longitudes lie on both sides of 180, where they jump to -180."""
    return bool(np.ptp(lon) > _ROUND_DEG)


def on_both_sides() -> str:
    """Return what to say of a plot that does."""
    return worded(
        "A plot must lie on one side of longitude 180, but this one lies on both, and longitudes "
        "jump from 180 to -180 there. Write them from 0 to 360, or bring two plots: what lies east "
        "of it and what lies west."
    )


def turned_to(geometry: G, lon: float) -> G:
    """Return a lon/lat geometry whose longitudes are, by whole rounds, those nearest to `lon`.

    So all that belongs to a plot across 180 lies in one piece.
    """

    def turned(lonlat: Float) -> Float:
        rounds = np.round((lon - lonlat[:, 0]) / 360.0)
        return np.stack([lonlat[:, 0] + 360.0 * rounds, lonlat[:, 1]], axis=1)

    return shapely.transform(geometry, turned)


def _eastward(lonlat: Float) -> Float:
    return np.stack([lonlat[:, 0] % 360.0, lonlat[:, 1]], axis=1)


@lru_cache(maxsize=64)
def _transformer(lon: float, lat: float) -> Transformer:
    # what PROJ makes of EPSG:4326 and this plane; found anew, it takes each thread 16 ms, and every
    # click in the app is answered by a thread of its own
    return Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
        f"+step +proj=aeqd +lon_0={lon!r} +lat_0={lat!r} +ellps=WGS84"
    )


@dataclass(frozen=True)
class Frame:
    """A local plane in metres, centred on the plot and turned to its rows.

    Azimuthal equidistant on WGS84 (exact from the centre, within a millimetre per kilometre
    anywhere on a plot); x runs along the rows, y across them, 90 degrees to the left of x.

    Parameters
    ----------
    lon, lat
        Centre, degrees WGS84.
    bearing_deg
        Direction of x, degrees clockwise from true north.
    """

    lon: float
    lat: float
    bearing_deg: float = 90.0

    def __post_init__(self) -> None:
        if not (-180.0 <= self.lon <= 180.0 and -90.0 <= self.lat <= 90.0):
            raise SettingError(
                worded(
                    "A frame's centre must be a longitude in -180..180 and a "
                    "latitude in -90..90, but it is ({lon}, {lat}). Are the "
                    "coordinates in degrees?",
                    lon=self.lon,
                    lat=self.lat,
                )
            )
        must_be_of("A row bearing", "float", self.bearing_deg)
        if not math.isfinite(self.bearing_deg):
            raise SettingError(
                worded(
                    "A row bearing must be a number, but it is {bearing_deg}.",
                    bearing_deg=self.bearing_deg,
                )
            )

    def turned(self, bearing_deg: float) -> Frame:
        """Return the frame with the same centre and another row bearing."""
        return Frame(self.lon, self.lat, bearing_deg)

    def xy_m(self, lonlat: ArrayLike) -> Float:
        """Return metres ``(n, 2)`` for degrees ``(n, 2)``; raise `PlotError` where far off."""
        degrees = np.asarray(lonlat, dtype=np.float64).reshape(-1, 2)
        east, north = _transformer(self.lon, self.lat).transform(degrees[:, 0], degrees[:, 1])
        across, along = self._axes()
        with np.errstate(invalid="ignore"):  # PROJ says inf for what is not on Earth
            x, y = (east * axis[0] + north * axis[1] for axis in (along, across))
        xy = np.stack([x, y], axis=1)
        if xy.size and not (np.abs(xy) < _FARTHEST_M).all():
            if goes_round(degrees[:, 0]):
                raise PlotError(on_both_sides())
            raise PlotError(
                worded(
                    "Everything on a plot must lie within {value:.0f} km of "
                    "its centre ({lon:.5f}, {lat:.5f}), but some positions do "
                    "not. Check the coordinate system, the order of longitude and latitude, and "
                    "that all are of one zone.",
                    value=_FARTHEST_M / 1000,
                    lon=self.lon,
                    lat=self.lat,
                )
            )
        return xy

    def lonlat(self, xy_m: ArrayLike) -> Float:
        """Return degrees ``(n, 2)`` for metres ``(n, 2)``."""
        xy = np.asarray(xy_m, dtype=np.float64).reshape(-1, 2)
        across, along = self._axes()
        east = xy[:, 0] * along[0] + xy[:, 1] * across[0]
        north = xy[:, 0] * along[1] + xy[:, 1] * across[1]
        lon, lat = _transformer(self.lon, self.lat).transform(
            east, north, direction=TransformDirection.INVERSE
        )
        return np.stack([lon, lat], axis=1)

    def geometry_m(self, geometry: G) -> G:
        """Return a lon/lat geometry in metres of this frame."""
        return shapely.transform(geometry, self.xy_m)

    def geometry_lonlat(self, geometry: G) -> G:
        """Return a geometry in metres of this frame as lon/lat: across 180, from 0 to 360."""
        placed = shapely.transform(geometry, self.lonlat)
        lon = shapely.get_coordinates(placed)[:, 0]
        return shapely.transform(placed, _eastward) if len(lon) and goes_round(lon) else placed

    def _axes(self) -> tuple[tuple[float, float], tuple[float, float]]:
        turn = np.deg2rad(self.bearing_deg)
        sin, cos = float(np.sin(turn)), float(np.cos(turn))
        return (-cos, sin), (sin, cos)
