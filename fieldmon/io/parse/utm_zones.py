"""UTM zones that files name in a column, and features of a file that lie in different ones."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyproj

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import guessed
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.crs import km_between, middle_of, system, transformation_from, utm_zone
from fieldmon.plot.local_clock import at_sea

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.options import ReadOptions

    Float = NDArray[np.float64]

# a number in the first is a zone; in the others it may be one of anything
_SURE_COLUMNS = {"utmzone", "zoneutm", "zonautm", "huso", "fuseau", "gridzone", "utm"}
_ZONE_COLUMNS = _SURE_COLUMNS | {"zone", "zona"}
# so few are zones of a farm, and so many next to each other are those of UTM
_FARM_ZONES, _NEIGHBOURS = 9, 2
#: of eight degrees each, from 80 south; from the equator to 90 south are 10 000 km of northing
_BANDS, _M_PER_DEGREE = "CDEFGHJKLMNPQRSTUVWX", 1e7 / 90
_SHOWN = 3
# nobody plants farther south
_SOUTHERNMOST_DEG = -60.0
# a zone is six degrees wide, and used a little beyond
_WIDE_DEG, _HALF_DEG = 6.0, 3.6
# plots so far from the others are of another zone if they would lie so near to them there
_APART_DEG, _NEAR_KM = 4.0, 50.0


def stated_zone(
    layer: Layer, xy: Float, options: ReadOptions, own: str | None = None
) -> tuple[str | None, list[ImportMessage]]:
    """Return the UTM system of a column of zones such as 34H or 36; ask where there are several.

    Parameters
    ----------
    layer
        Features with columns.
    xy
        ``(n, 2)`` a position of each, as it is written.
    options
        What was chosen; a system that was named by hand counts.
    own
        The system that the file states; None: none. Zones are only asked about where features do
        not lie in theirs by it.
    """
    name = next((one for one in layer.columns if plain(one) in _ZONE_COLUMNS), None)
    known = np.isfinite(xy).all(axis=1)
    if name is None or not known.any():
        return None, []
    cells = np.array([text(v).strip().upper() for v in layer.column(name)])
    stated = sorted({*cells[known].tolist()} - {""})
    is_sure = plain(name) in _SURE_COLUMNS
    if not is_sure and not _may_be_zones(stated):
        return None, []
    read = [_systems(one, xy[known & (cells == one)], options) for one in stated]
    if not stated or not all(read):
        return None, []  # zones of something else
    codes = sorted({codes[0] for codes in read})
    wanted = options.crs or own
    if len(codes) > 1:
        if wanted is None or not _in_their_zones(xy[known], cells[known], wanted):
            raise _of_several(name, stated)
        return None, []
    if wanted is not None:
        return None, []
    if len(read[0]) > 1:
        raise _which_half(name, stated[0], read[0], middle_of(xy[known]))
    said = worded(
        "Column {name!r} names UTM zone {zone}, which was read as {crs}.",
        name=name,
        zone=first_few(stated, _SHOWN),
        crs=f"{pyproj.CRS(codes[0]).name} ({codes[0]})",
    )
    return codes[0], [guessed(said)]


def _may_be_zones(stated: list[str]) -> bool:
    """Return whether cells of a column that may hold any zones are none of a farm's numbers."""
    numbers = [int(one) for one in stated if one.isdecimal()]
    return all(one > _FARM_ZONES for one in numbers) and (
        not numbers or max(numbers) - min(numbers) < _NEIGHBOURS
    )


def _systems(zone: str, xy: Float, options: ReadOptions) -> tuple[str, ...]:
    """Return the codes of the UTM systems that a cell may name, the likelier first."""
    number = re.fullmatch(r"0?([1-9]|[1-5]\d|60)", zone)
    if number is None:
        code = _lettered(zone, xy[:, 1])
        return () if code is None else (code,)
    both = {f"EPSG:{half}{int(number[1]):02d}": half == 326 for half in (326, 327)}
    landed = {code: _landing(code, middle_of(xy), is_north=north) for code, north in both.items()}
    found = {code: at for code, at in landed.items() if at is not None}
    if options.near is None or not found:
        return tuple(found)
    near = options.near
    return (min(found, key=lambda code: km_between(near, found[code])),)


def _lettered(zone: str, northing_m: Float) -> str | None:
    """Return the code of a UTM zone with its band, if northings lie in that.

    S is a band of the north, and the south: northings tell which, but over the southern ocean.
    """
    found = re.fullmatch(r"0?([1-9]|[1-5]\d|60)\s?([C-HJ-NP-X])", zone)
    if found is None or not len(northing_m):
        return None
    number, band = int(found[1]), found[2]
    lowest, north = 8 * _BANDS.index(band) - 80, float(np.median(northing_m)) / _M_PER_DEGREE
    south = band < "N" or (band == "S" and not lowest - 1 < north < lowest + 9)
    lat = north - 90 * south
    if band not in "NS" and not lowest - 1 < lat < lowest + 13:
        return None
    return f"EPSG:{327 if south else 326}{number:02d}"


def _landing(code: str, xy: tuple[float, float], *, is_north: bool) -> tuple[float, float] | None:
    """Return where a position lies in a UTM system; None: nowhere where anybody plants."""
    easting, northing = xy[0] % 1e6, xy[1]  # some write the zone before it
    if not (1e5 <= easting <= 9e5 and 0.0 <= northing <= 1e7):
        return None
    at = np.array([[easting, northing]])
    lon, lat = transformation_from(system(code), (easting, northing)).lonlat(at)[0].tolist()
    inside = 0.0 <= lat <= 84.0 if is_north else _SOUTHERNMOST_DEG <= lat < 0.0
    return (lon, lat) if inside and not at_sea(lon, lat) else None


def _in_their_zones(xy: Float, cells: NDArray[np.str_], wanted: str) -> bool:
    """Return whether features lie in the zones that they name, by the system that is used."""
    crs = system(wanted)
    if utm_zone(crs) is None:
        return True  # it is none of UTM: they name theirs for other uses
    lon = transformation_from(crs, middle_of(xy)).lonlat(xy)[:, 0]
    zone = np.array([int(found[0]) if (found := re.match(r"\d+", one)) else 0 for one in cells])
    off_deg = np.abs((lon - (_WIDE_DEG * zone - 183.0) + 180.0) % 360.0 - 180.0)
    return bool((off_deg[zone > 0] <= _HALF_DEG).all())


def _of_several(name: str, stated: list[str]) -> ChoiceNeeded:
    return ChoiceNeeded(
        worded(
            "All positions must be in one UTM zone, but column {name!r} names {n}: {names}. "
            "Bring all into one, or choose those of one of them.",
            name=name,
            n=len(stated),
            names=first_few(stated, _SHOWN),
        ),
        "where",
        tuple(f"{name}={value}" for value in stated),
    )


def _which_half(
    name: str, zone: str, codes: tuple[str, ...], xy: tuple[float, float]
) -> ChoiceNeeded:
    """Return the question whether a zone without a letter is north or south of the equator."""
    places = [_landing(code, xy, is_north=code[5:8] == "326") or xy for code in codes]
    listed = "; ".join(
        f"{code} ({pyproj.CRS(code).name}) would put it at {lon:.4f}, {lat:.4f}"
        for code, (lon, lat) in zip(codes, places, strict=True)
    )
    return ChoiceNeeded(
        worded(
            "Column {name!r} names UTM zone {zone}, but not whether it is north or south of the "
            "equator. Name the coordinate system: {listed}.",
            name=name,
            zone=zone,
            listed=listed,
        ),
        "crs",
        codes,
    )


class AnotherZone(NamedTuple):
    """Features that lie far from the others, and would lie near them in another UTM zone.

    ``which (n,)``; how far they are now, and would be in that ``zone``.
    """

    which: NDArray[np.bool_]
    zone: int
    away_km: float
    near_km: float


def of_another_zone(lonlat: Float, zone: int) -> AnotherZone | None:
    """Return which features ``(n, 2)``, read in one UTM zone, seem to be of a neighbouring one.

    What lies six degrees off, as near to the others' latitude as they are to each other, was
    written in the next zone: coordinates of all zones are alike.
    """
    if len(lonlat) < _NEIGHBOURS or not np.isfinite(lonlat).all():
        return None
    order = np.argsort(lonlat[:, 0], kind="stable")
    gaps = np.diff(lonlat[order, 0])
    at = int(np.argmax(gaps))
    if not _APART_DEG < gaps[at] < 2 * _WIDE_DEG:
        return None
    west = np.zeros(len(lonlat), np.bool_)
    west[order[: at + 1]] = True
    n_west = np.count_nonzero(west)
    fewer = west if 2 * n_west < len(west) or (2 * n_west == len(west) and not west[0]) else ~west
    side = 1 if fewer is west else -1
    moved = lonlat[fewer] + np.array([side * _WIDE_DEG, 0.0])
    near_km, away_km = (_apart_km(one, lonlat[~fewer]) for one in (moved, lonlat[fewer]))
    if near_km > _NEAR_KM:
        return None
    return AnotherZone(fewer, (zone + side - 1) % 60 + 1, away_km, near_km)


def _apart_km(one: Float, other: Float) -> float:
    """Return about how far two groups of positions are from each other."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

    flat = np.array([np.cos(np.radians(np.median(other[:, 1]))), 1.0])
    off, nearest = cKDTree(other * flat).query(one * flat)
    k = int(np.argmin(off))
    (lon, lat), (near_lon, near_lat) = one[k].tolist(), other[nearest[k]].tolist()
    return km_between((lon, lat), (near_lon, near_lat))
