"""Put a layer on the earth: its coordinate system, its order of axes, degrees WGS84 out."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.rounding_step import step_of
from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful, guessed, repaired, seen
from fieldmon.io.parse.crs import (
    Transformation,
    ask_for_crs,
    candidates,
    code_of,
    km_between,
    km_outside,
    middle_of,
    southern_zone,
    system,
    transformation_from,
    utm_zone,
)
from fieldmon.plot.local_clock import at_sea
from fieldmon.plot.projection import metres_per_unit

if TYPE_CHECKING:
    from collections.abc import Callable

    import pyproj
    from numpy.typing import NDArray

    from fieldmon.io.options import ReadOptions

    #: tells where coordinates lie with the second one first, ``(n, 2)``, if anybody asks
    Exchanged = Callable[[], NDArray[np.float64]]

_EARTH_KM = 6371.0
#: from here a file is doubted that should lie near a place, and from here it is asked about
_FAR_KM, _ASKED_KM = 20.0, 1000.0
#: outside of where its system is used; countries use one UTM zone far beyond its borders
_FAR_FROM_USE_KM, _FAR_FROM_ZONE_KM = 50.0, 600.0
#: systems of the whole earth put numbers of no size off the coast of Ghana
_OF_NOWHERE_DEG = 0.1
_NAMED = 3


@dataclass(frozen=True, eq=False)
class Georeferenced:
    """Coordinates on the earth.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees WGS84.
    step_m
        Coarsest step that all coordinates of the file are whole multiples of: how they are rounded.
    messages
        What was found on the way.
    """

    lonlat: NDArray[np.float64]
    step_m: float
    messages: tuple[ImportMessage, ...]


def place_geometry(
    geometry: NDArray[np.object_], stated: str | None, options: ReadOptions
) -> tuple[NDArray[np.object_], tuple[ImportMessage, ...]]:
    """Return geometries ``(n,)`` in degrees WGS84, lon/lat, and what was found on the way."""
    placed = place(np.asarray(shapely.get_coordinates(geometry)), stated, options)
    moved = geometry.copy()
    shapely.set_coordinates(moved, placed.lonlat)
    return moved, placed.messages


def place(xy: NDArray[np.float64], stated: str | None, options: ReadOptions) -> Georeferenced:
    """Return degrees WGS84 for a file's coordinates ``(n, 2)``; ask where they cannot be known."""
    messages: list[ImportMessage] = []
    if not np.isfinite(xy).all():
        raise FileProblem(
            worded(
                "All coordinates must be numbers, but some are infinite or "
                "none. Export the file again."
            )
        )
    if options.swap_axes:
        xy = xy[:, ::-1]
        messages.append(seen(worded("First and second coordinate were exchanged, as asked.")))
    if options.crs is not None and stated is not None:
        messages.append(seen(_named(options.crs, stated)))
    wanted = options.crs or stated
    if wanted is None:
        raise ask_for_crs(
            xy, options, worded("The file does not say in which coordinate system it is.")
        )
    crs = system(wanted)
    _check_range(xy, crs, options)
    xy, more = _without_zone(xy, crs)
    through = transformation_from(crs, middle_of(xy))
    lonlat = through.lonlat(xy)
    if options.crs is None:
        _check_metres(xy, lonlat, crs, options)
    exchanged = partial(_exchanged, xy, crs, through)
    _check_landing(lonlat, crs)
    _check_near(xy, (lonlat, exchanged), through.code, options)
    step_m = step_of(xy) * metres_per_unit(crs)
    doubts = _outside(xy, (lonlat, exchanged), crs, options)
    doubts += _distance(lonlat, exchanged, crs, options)
    doubts += _either_order((lonlat, exchanged), crs, options)
    return Georeferenced(lonlat, step_m, (*messages, *more, *through.messages(), *doubts))


def _named(crs: str, stated: str) -> str:
    """Return that a system was named by hand, and the file's own where that is another."""
    own = None
    with suppress(ChoiceNeeded):
        own = system(stated)
    if own is None or own.equals(system(crs), ignore_axis_order=True):
        return worded("The coordinate system named by hand, {crs}, was used.", crs=crs)
    return worded(
        "The coordinate system named by hand, {crs}, was used instead of the file's own, {own}.",
        crs=crs,
        own=own.name,
    )


def few_unplaceable(
    xy: NDArray[np.float64], stated: str | None, options: ReadOptions
) -> NDArray[np.bool_]:
    """Return which coordinates ``(n, 2)`` lie nowhere on the earth, as mistyped ones.

    None where most do: then it is the coordinate system or the order, and `place` asks.
    """
    wanted = options.crs or stated
    if wanted is None or not np.isfinite(xy).all():
        return np.zeros(len(xy), dtype=bool)
    if options.swap_axes:
        xy = xy[:, ::-1]
    crs = system(wanted)
    if _in_degrees(crs):
        lands = (np.abs(xy) <= (360, 90)).all(axis=1)
    else:
        lonlat = transformation_from(crs, middle_of(xy)).lonlat(xy)
        lands = np.isfinite(lonlat).all(axis=1) & (np.abs(lonlat[:, 1]) <= 90)
    wrong: NDArray[np.bool_] = np.asarray(~lands, dtype=bool)
    return wrong if 2 * np.count_nonzero(wrong) < len(xy) else np.zeros(len(xy), dtype=bool)


def written(xy: NDArray[np.float64]) -> str:
    """Return one position as a file has it."""
    first, second = xy.tolist()
    return f"{first:.12g} / {second:.12g}"


def _in_degrees(crs: pyproj.CRS) -> bool:
    return bool(crs.is_geographic and crs.axis_info[0].unit_name == "degree")


def _check_range(xy: NDArray[np.float64], crs: pyproj.CRS, options: ReadOptions) -> None:
    """Ask where degrees are none, or are in the wrong order."""
    if not _in_degrees(crs):
        return
    first, second = np.abs(xy[:, 0]), np.abs(xy[:, 1])
    wrong = (first > 360) | (second > 90)
    if not wrong.any():
        return
    if 2 * np.count_nonzero(wrong) <= len(xy):
        as_written = xy[wrong, ::-1] if options.swap_axes else xy[wrong]
        shown = first_few([written(one) for one in as_written[: _NAMED + 1]], _NAMED)
        raise FileProblem(
            worded(
                "{n} of {all_n} positions lie nowhere on the earth: {shown}. Correct them.",
                n=int(np.count_nonzero(wrong)),
                all_n=len(xy),
                shown=shown,
            )
        )
    if (second <= 360).all() and (first <= 90).all():
        raise ChoiceNeeded(
            worded(
                "Latitudes must lie in -90..90, but there is {value:.6g}: "
                "longitude and latitude seem to be in the wrong order. "
                "Exchange them if that is so.",
                value=xy[np.argmax(second), 1],
            ),
            "swap_axes",
            ("no" if options.swap_axes else "yes",),
        )
    raise ask_for_crs(
        xy,
        options,
        worded(
            "The file says {name}, in degrees, but its coordinates are no degrees.",
            name=crs.name,
        ),
    )


def _check_metres(
    xy: NDArray[np.float64], lonlat: NDArray[np.float64], crs: pyproj.CRS, options: ReadOptions
) -> None:
    """Ask where metres are as small as degrees, and lie where the system is not used."""
    if not crs.is_projected or (np.abs(xy) > (180, 90)).any():
        return
    lon, lat = middle_of(lonlat)
    if km_outside(crs, lon, lat) > 0 or abs(lon) + abs(lat) < _OF_NOWHERE_DEG:
        raise ask_for_crs(
            xy,
            options,
            worded("The file says {name}, but its coordinates look like degrees.", name=crs.name),
        )


def _without_zone(
    xy: NDArray[np.float64], crs: pyproj.CRS
) -> tuple[NDArray[np.float64], list[ImportMessage]]:
    """Return coordinates without the zone number that some offices write before the easting."""
    zone = utm_zone(crs)
    prefixed = np.floor(xy[:, 0] / 1e6)
    if zone is None or not (prefixed == zone).all() or crs.coordinate_operation is None:
        return xy, []
    false_easting = next(
        (p.value for p in crs.coordinate_operation.params if p.name == "False easting"), 500_000.0
    )
    if float(false_easting) > 1e6:  # the system itself counts the zone in
        return xy, []
    bare = xy - np.array([zone * 1e6, 0.0])
    return bare, [
        repaired(
            worded("The zone number {zone} in front of the eastings was taken off.", zone=zone)
        )
    ]


def _exchanged(
    xy: NDArray[np.float64], crs: pyproj.CRS, through: Transformation
) -> NDArray[np.float64]:
    """Return degrees ``(n, 2)`` as if the second coordinate came first; NaN: they lie nowhere."""
    other = xy[:, ::-1]
    lonlat = other if _in_degrees(crs) else through.lonlat(_without_zone(other, crs)[0])
    lands = np.isfinite(lonlat) & (np.abs(lonlat) <= (360, 90))
    return np.where(lands.all(axis=1, keepdims=True), lonlat, np.nan)


def _belongs(lonlat: NDArray[np.float64], crs: pyproj.CRS) -> bool:
    """Return whether positions lie where a projected system is used."""
    return bool(
        crs.is_projected and np.isfinite(lonlat).all() and km_outside(crs, *middle_of(lonlat)) == 0
    )


def _check_landing(lonlat: NDArray[np.float64], crs: pyproj.CRS) -> None:
    if not (np.isfinite(lonlat).all() and (np.abs(lonlat[:, 1]) <= 90).all()):
        raise FileProblem(
            worded(
                "All coordinates must lie where {name} is defined, but some "
                "do not. Check the coordinate system and name the right one.",
                name=crs.name,
            )
        )


def _outside(
    xy: NDArray[np.float64],
    either_way: tuple[NDArray[np.float64], Exchanged],
    crs: pyproj.CRS,
    options: ReadOptions,
) -> list[ImportMessage]:
    """Return a doubt where a file lies outside of where its coordinate system is used."""
    lonlat, exchanged = either_way
    lon, lat = middle_of(lonlat)
    away = km_outside(crs, lon, lat)
    if not away > (_FAR_FROM_ZONE_KM if utm_zone(crs) else _FAR_FROM_USE_KM):
        return []
    if _belongs(other := exchanged(), crs):
        there_lon, there_lat = middle_of(other)
        said = worded(
            "It lies at {lon:.4f}, {lat:.4f}, which is {away:.0f} km outside of where {name} is "
            "used; with easting and northing exchanged it lies within, at {there_lon:.2f}, "
            "{there_lat:.2f}. Exchange them if that is right.",
            lon=lon,
            lat=lat,
            away=away,
            name=crs.name,
            there_lon=there_lon,
            there_lat=there_lat,
        )
        return [doubtful(said, None, _exchange(crs, options))]
    if southern := southern_zone(crs, lon, lat):
        said = worded(
            "It lies at {lon:.4f}, {lat:.4f}, south of the equator: northings in {name} are "
            "negative there. It was read so; {southern} is the usual system, with northings "
            "10 000 000 m greater. Check that it lies there.",
            lon=lon, lat=lat, name=crs.name, southern=southern,
        )  # fmt: skip
        return [doubtful(said)]
    said = worded(
        "It lies at {lon:.4f}, {lat:.4f}, which is {away:.0f} km outside "
        "of where {name} is used, so the accuracy that PROJ states does "
        "not hold. Check the coordinate system.",
        lon=lon,
        lat=lat,
        away=away,
        name=crs.name,
    )
    others = [
        c
        for c in candidates(middle_of(xy), options.country, options.near)
        if c.code != code_of(crs)
    ]
    if not others:
        return [doubtful(said)]
    codes = tuple(c.code for c in others)
    return [
        doubtful(
            said,
            None,
            Remedy("crs", codes[0], worded("Read as {name}", name=others[0].name), codes[1:]),
        )
    ]


def _either_order(
    either_way: tuple[NDArray[np.float64], Exchanged], crs: pyproj.CRS, options: ReadOptions
) -> list[ImportMessage]:
    """Say which coordinate was taken as the easting, where either may be.

    With both a file lies on land where its system is used, as in Britain and in Portugal. A place
    nearby tells them apart.
    """
    lonlat, exchanged = either_way
    if options.near is not None or options.swap_axes or not _belongs(lonlat, crs):
        return []
    if crs.area_of_use is None or (crs.area_of_use.east - crs.area_of_use.west) % 360 == 0:
        return []  # a grid of the whole earth lies everywhere
    here, there = middle_of(lonlat), middle_of(other := exchanged())
    if not _belongs(other, crs) or at_sea(*there) or km_between(here, there) < _FAR_KM:
        return []
    said = worded(
        "Eastings were taken to come first: it lies at {lon:.4f}, {lat:.4f}. With northings first "
        "it would lie at {there_lon:.4f}, {there_lat:.4f}, where {name} is used, too.",
        lon=here[0],
        lat=here[1],
        there_lon=there[0],
        there_lat=there[1],
        name=crs.name,
    )
    return [guessed(said, None, _exchange(crs, options))]


def _exchange(crs: pyproj.CRS, options: ReadOptions) -> Remedy:
    label = worded("Exchange longitude and latitude")
    if crs.is_projected:
        label = worded("Exchange easting and northing")
    return Remedy("swap_axes", "no" if options.swap_axes else "yes", label)


def _check_near(
    xy: NDArray[np.float64],
    either_way: tuple[NDArray[np.float64], Exchanged],
    code: str,
    options: ReadOptions,
) -> None:
    """Ask where a file is said to lie near a place, but lies on another part of the earth."""
    lonlat, exchanged = either_way
    if options.near is None or options.crs is not None or options.swap_axes:
        return
    away = _nearest_km(lonlat, options.near)
    if away <= _ASKED_KM:
        return
    if _nearest_km(exchanged(), options.near) < away / 10:
        raise ChoiceNeeded(
            worded(
                "It lies {away:.0f} km from the plot or place nearby. Exchange its first and "
                "second coordinates if they are in the wrong order.",
                away=away,
            ),
            "swap_axes",
            ("yes",),
        )
    said = worded(
        "As {code} it lies {away:.0f} km from the plot or place nearby.", code=code, away=away
    )
    stay = worded("{code} keeps it there.", code=code)
    if (np.abs(xy) <= (180, 90)).all():  # degrees in any system
        raise ChoiceNeeded(
            worded("{said} Is it the right file? {stay}", said=said, stay=stay), "crs", (code,)
        )
    question = ask_for_crs(xy, options, said)
    raise ChoiceNeeded(
        worded("{question} {stay}", question=question, stay=stay),
        "crs",
        tuple(dict.fromkeys([*question.choices, code])),
    )


def _nearest_km(lonlat: NDArray[np.float64], place: tuple[float, float]) -> float:
    """Return how far the nearest of many positions ``(n, 2)`` is from a place, on a sphere."""
    if np.isnan(lonlat).any():
        return np.inf
    lon, lat = np.deg2rad(lonlat).T
    there_lon, there_lat = np.deg2rad(place)
    half = np.sin((lat - there_lat) / 2) ** 2
    half += np.cos(lat) * np.cos(there_lat) * np.sin((lon - there_lon) / 2) ** 2
    return float(2 * _EARTH_KM * np.arcsin(np.sqrt(np.clip(half.min(), 0, 1))))


def _distance(
    lonlat: NDArray[np.float64],
    exchanged: Exchanged,
    crs: pyproj.CRS,
    options: ReadOptions,
) -> list[ImportMessage]:
    """Return a doubt where the file lies far from the place named by hand."""
    if options.near is None:
        return []
    away = _nearest_km(lonlat, options.near)
    if away <= _FAR_KM:
        return []
    swapped = _nearest_km(exchanged(), options.near)
    if swapped < away / 10:
        told = {"away": away, "swapped": swapped}
        said = worded(
            "It lies {away:.0f} km from the plot or place nearby, but "
            "{swapped:.0f} km from it with longitude and latitude "
            "exchanged.",
            **told,
        )
        if crs.is_projected:
            said = worded(
                "It lies {away:.0f} km from the plot or place nearby, but {swapped:.0f} km from it "
                "with easting and northing exchanged.",
                **told,
            )
        return [doubtful(said, remedy=_exchange(crs, options))]
    if (other := _nearer_zone(lonlat, crs, options.near)) is not None:
        zone, there = other
        said = worded(
            "It lies {away:.0f} km from the plot or place nearby, but {there:.0f} km from it in "
            "UTM zone {zone}.",
            away=away,
            there=there,
            zone=zone[-2:] + ("S" if zone.startswith("EPSG:327") else "N"),
        )
        return [doubtful(said, None, Remedy("crs", zone, worded("Read as {name}", name=zone)))]
    return [doubtful(worded("It lies {away:.0f} km from the plot or place nearby.", away=away))]


# UTM on WGS 84, north and south, and on ETRS89: the last two digits are the zone
_UTM_CODE = re.compile(r"EPSG:(32[67]|258)\d\d")
_ZONE_DEG = 6.0


def _nearer_zone(
    lonlat: NDArray[np.float64], crs: pyproj.CRS, near: tuple[float, float]
) -> tuple[str, float] | None:
    """Return the code of the UTM zone in which positions would lie at a place, and how far off."""
    zone, code = utm_zone(crs), code_of(crs)
    if zone is None or not _UTM_CODE.fullmatch(code):
        return None
    here = int((near[0] + 180.0) // _ZONE_DEG) + 1
    others = [one for one in (here, here - 1, here + 1) if one != zone and 1 <= one <= 60]
    # coordinates of all zones are alike, six degrees further
    step = np.array([_ZONE_DEG, 0.0])
    away = {one: _nearest_km(lonlat + (one - zone) * step, near) for one in others}
    best = min(away, key=lambda one: away[one])
    return (f"{code[:-2]}{best:02d}", away[best]) if away[best] <= _FAR_KM else None
