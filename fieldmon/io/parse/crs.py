"""From the coordinates of a file to degrees WGS84, with the accuracy that PROJ states."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyproj
from pyproj.aoi import AreaOfInterest
from pyproj.database import query_crs_info
from pyproj.enums import PJType
from pyproj.exceptions import CRSError, ProjError
from pyproj.transformer import TransformerGroup

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import WGS84
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful, seen
from fieldmon.plot.local_clock import at_sea
from fieldmon.plot.projection import GEOD

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from pyproj.database import CRSInfo

    from fieldmon.io.options import ReadOptions

# national grids that people forget to name, the Israeli ones first
_COMMON = (
    *("EPSG:2039", "EPSG:28193", "EPSG:28191", "EPSG:6984", "EPSG:32636", "EPSG:32637"),
    *("EPSG:3857", "EPSG:27700", "EPSG:29902", "EPSG:2157", "EPSG:2154", "EPSG:27572"),
    *("EPSG:25829", "EPSG:25830", "EPSG:25831", "EPSG:25832", "EPSG:25833", "EPSG:25834"),
    *("EPSG:3763", "EPSG:28992", "EPSG:31370", "EPSG:3812", "EPSG:2056", "EPSG:21781"),
    *("EPSG:31466", "EPSG:31467", "EPSG:31468", "EPSG:4647", "EPSG:5650", "EPSG:31287"),
    *("EPSG:3003", "EPSG:3004", "EPSG:2100", "EPSG:2180", "EPSG:5514", "EPSG:23700"),
    *("EPSG:3844", "EPSG:3765", "EPSG:3006", "EPSG:3301", "EPSG:3346", "EPSG:5253"),
    *("EPSG:22175", "EPSG:31982", "EPSG:31983", "EPSG:5880", "EPSG:6372", "EPSG:2326"),
    *("EPSG:3310", "EPSG:26910", "EPSG:26911", "EPSG:28354", "EPSG:28355", "EPSG:2193"),
)
_MOST_TRIED = 1000
_MOST_OFFERED = 8
_NEAR_KM = 300.0
_MOST_ALIKE = 4
#: what files call a system whose name they do not have
_NAMELESS = frozenset({"unnamed", "unknown"})


class CrsCandidate(NamedTuple):
    """A coordinate system that could be meant, and where the data would land with it."""

    code: str
    name: str
    lon: float
    lat: float
    km_away: float


@dataclass(frozen=True)
class Transformation:
    """How coordinates of one system become degrees WGS84.

    Parameters
    ----------
    code, name
        Of the source system.
    accuracy_m
        As PROJ states it; None where it states none.
    transformer
        Always x, y in; longitude, latitude out. None: they are degrees WGS84 already.
    missing_grid
        File that a better one would need and that is not on this machine.
    datum_lost
        Whether nothing says how the datum lies to WGS84.
    alike
        Code and name of known systems of the same projection, on datums of their own.
    """

    code: str
    name: str
    accuracy_m: float | None = None
    transformer: pyproj.Transformer | None = None
    missing_grid: str | None = None
    datum_lost: bool = False
    alike: tuple[tuple[str, str], ...] = ()

    def lonlat(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return degrees ``(n, 2)``; not finite where the system does not reach."""
        if self.transformer is None:
            return xy
        lon, lat = self.transformer.transform(xy[:, 0], xy[:, 1])
        return np.stack([lon, lat], axis=1)

    def messages(self) -> list[ImportMessage]:
        """Return what there is to say about the accuracy."""
        if self.transformer is None:
            return []
        if self.datum_lost:
            return [self._of_lost_datum()]
        stated = worded("PROJ states no accuracy for this")
        if self.accuracy_m is not None:
            stated = worded("PROJ states {accuracy_m:g} m for this", accuracy_m=self.accuracy_m)
        how = worded("Positions were transformed from {name} ({code}); {stated}.",
                     name=self.name, code=self.code, stated=stated)  # fmt: skip
        if self.missing_grid is None:
            return [seen(how)]
        return [
            doubtful(
                worded(
                    "{how} A better transformation needs the grid file {grid}, which is not on "
                    "this machine: add it to PROJ's data folder if that is too coarse.",
                    how=how,
                    grid=self.missing_grid,
                )
            )
        ]

    def _of_lost_datum(self) -> ImportMessage:
        """Return the doubt where everything may lie, with the systems that may be meant."""
        said = worded(
            "The datum of {name} is not known, so all may lie some 100 m beside its place.",
            name=self.name,
        )
        if not self.alike:
            how = worded("{said} Name the coordinate system, as in crs=EPSG:2039.", said=said)
            return doubtful(how)
        listed = ", ".join(f"{code} ({name})" for code, name in self.alike)
        said = worded(
            "{said} Name the coordinate system; of the same projection are {listed}.",
            said=said,
            listed=listed,
        )
        (code, name), *others = self.alike
        label = worded("Read as {name}", name=name)
        return doubtful(said, None, Remedy("crs", code, label, tuple(c for c, _ in others)))


def system(text: str) -> pyproj.CRS:
    """Return the coordinate system that is named; raise `ChoiceNeeded` where it is unknown."""
    wanted = f"EPSG:{text}" if text.strip().isdecimal() else text
    try:
        return pyproj.CRS.from_user_input(wanted)
    except CRSError:
        shown = text if len(text) < 80 else f"{text[:77]}..."
        raise ChoiceNeeded(
            worded(
                "A coordinate system must be named as in EPSG:2039, but it is "
                "{shown!r}. Name another one.",
                shown=shown,
            ),
            "crs",
        ) from None


# PROJ looks for it longer than all else of a small file takes, and it is asked for again and again
@lru_cache(maxsize=64)
def transformation_from(crs: pyproj.CRS, centre: tuple[float, float]) -> Transformation:
    """Return the best transformation on this machine to degrees, for data around a centre."""
    flat = _horizontal(crs)
    code, name = code_of(flat), flat.name
    if flat.equals(pyproj.CRS(WGS84), ignore_axis_order=True):
        return Transformation(code, name)
    if flat.is_geocentric:
        raise FileProblem(
            worded(
                "Places must be in degrees or on a map, but {name} counts metres from the middle "
                "of the earth, and heights are not read. Save the file in EPSG:4326.",
                name=name,
            )
        )
    try:
        rough = _some_way(flat).transform(*centre)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # a missing grid is a message of ours
            group = TransformerGroup(flat, WGS84, always_xy=True, area_of_interest=_around(*rough))
    except ProjError as bad:
        raise FileProblem(
            worded(
                "There must be a way from {name} to WGS84, but PROJ finds none ({bad}).",
                name=name,
                bad=bad,
            )
        ) from bad
    if not group.transformers:
        raise FileProblem(
            worded("There must be a way from {name} to WGS84, but PROJ finds none.", name=name)
        )
    best = group.transformers[0]
    missing = None
    if not group.best_available and group.unavailable_operations:
        grids = group.unavailable_operations[0].grids
        missing = next((grid.short_name for grid in grids if not grid.available), None)
    accuracy = best.accuracy if best.accuracy >= 0 else None
    # where PROJ knows nothing of the datum it takes it for WGS84, and calls that ballpark; MapInfo
    # files that lose theirs are left with WGS84 itself
    lost = _is_ballpark(best) and _is_unknown(flat)
    alike = _alike(flat, *rough) if lost or not _is_named(flat) else ()
    return Transformation(code, name, accuracy, best, missing, lost or bool(alike), alike)


@lru_cache(maxsize=128)
def _some_way(crs: pyproj.CRS) -> pyproj.Transformer:
    return pyproj.Transformer.from_crs(crs, WGS84, always_xy=True)


def _is_ballpark(way: pyproj.Transformer) -> bool:
    return "Ballpark" in way.description


def _is_unknown(crs: pyproj.CRS) -> bool:
    """Return whether PROJ knows no way from a datum to WGS84 anywhere."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        ways = TransformerGroup(crs, WGS84, always_xy=True, allow_ballpark=True)
    return not ways.unavailable_operations and all(map(_is_ballpark, ways.transformers))


def _is_named(crs: pyproj.CRS) -> bool:
    """Return whether a system is one that people know, or has a name of its own."""
    return crs.name not in _NAMELESS or crs.to_authority(min_confidence=70) is not None


def _alike(crs: pyproj.CRS, lon: float, lat: float) -> tuple[tuple[str, str], ...]:
    """Return code and name of systems used at a place that project as this one does."""
    own = _projection(crs)
    if own is None or not (np.isfinite(lon) and np.isfinite(lat)):
        return ()
    found = []
    for code, info in _projected().items():
        if not _covers(info, lon, lat):
            continue
        other = pyproj.CRS(code)
        if _projection(other) == own:
            differs = _ellipsoid(other) != _ellipsoid(crs)
            found.append((differs, code not in _COMMON, _extent(info), code, info.name))
    return tuple((code, name) for *_, code, name in sorted(found)[:_MOST_ALIKE])


def _ellipsoid(crs: pyproj.CRS) -> tuple[float, float] | None:
    """Return the size and the flattening of the earth of a system, as far as texts keep them."""
    body = crs.ellipsoid
    if body is None:
        return None
    return round(body.semi_major_metre, 1), round(body.inverse_flattening, 4)


def _projection(crs: pyproj.CRS) -> dict[str, float] | None:
    """Return the figures of a projection that has any, rounded to what texts keep of them."""
    way = crs.coordinate_operation
    if not crs.is_projected or way is None:
        return None
    figures = {p.name: round(float(p.value) * p.unit_conversion_factor, 7) for p in way.params}
    return {name: value for name, value in figures.items() if value}


def middle_of(xy: NDArray[np.float64]) -> tuple[float, float]:
    """Return the median of positions ``(n, 2)``."""
    return float(np.median(xy[:, 0])), float(np.median(xy[:, 1]))


def code_of(crs: pyproj.CRS) -> str:
    """Return the code of a system as people write it, or its name where it has none."""
    authority = crs.to_authority(min_confidence=70)
    return ":".join(authority) if authority else crs.name


def ask_for_crs(xy: NDArray[np.float64], options: ReadOptions, why: str) -> ChoiceNeeded:
    """Return the question for the coordinate system, with candidates by where they lead."""
    centre = middle_of(xy)
    offered = candidates(centre, options.country, options.near)
    lines = [
        f"{c.code} ({c.name}) would put it at {c.lon:.4f}, {c.lat:.4f}"
        + (f", {c.km_away:.1f} km from the plot or place nearby" if np.isfinite(c.km_away) else "")
        for c in offered
    ]
    listed = "; ".join(lines) if lines else "none of the usual ones fits the coordinates"
    question = worded(
        "{why} The coordinates are around {value:.10g}, {y:.10g}. "
        "Name the coordinate system. Candidates: {listed}.",
        why=why,
        value=centre[0],
        y=centre[1],
        listed=listed,
    )
    if options.near is None:
        question = worded(
            "{question} All systems of a place nearby are listed with near=LON,LAT.",
            question=question,
        )
    return ChoiceNeeded(question, "crs", tuple(c.code for c in offered))


def candidates(
    centre: tuple[float, float],
    country: str | None = None,
    near: tuple[float, float] | None = None,
) -> list[CrsCandidate]:
    """Return the systems in which coordinates would land where the system is used, best first.

    Without a place nearby those come last that bring them into the open sea.
    """
    found: list[CrsCandidate] = []
    if abs(centre[0]) <= 180 and abs(centre[1]) <= 90:
        found.append(CrsCandidate("EPSG:4326", "WGS 84", *centre, _km(near, *centre)))
    for info in _possible(centre, country, near):
        landed = _landing(info, centre)
        if landed is not None:
            code = f"{info.auth_name}:{info.code}"
            found.append(CrsCandidate(code, info.name, *landed, _km(near, *landed)))
    if near is not None:
        found.sort(key=lambda c: round(c.km_away))
        found = [c for c in found if c.km_away < _NEAR_KM] or found
    else:
        found.sort(key=lambda c: at_sea(c.lon, c.lat))
    return [_exactly(c, centre, near) for c in _distinct(found)[:_MOST_OFFERED]]


def _exactly(
    rough: CrsCandidate, centre: tuple[float, float], near: tuple[float, float] | None
) -> CrsCandidate:
    """Return a candidate with its datum taken into account, which takes a hundred times longer."""
    way = _some_way(pyproj.CRS(rough.code))
    bare = centre if rough.code == "EPSG:4326" else _without_zone(_projected()[rough.code], centre)
    lon, lat = (float(v) for v in way.transform(*bare))
    return rough._replace(lon=lon, lat=lat, km_away=_km(near, lon, lat))


def _possible(
    centre: tuple[float, float], country: str | None, near: tuple[float, float] | None
) -> list[CRSInfo]:
    """Return the systems worth a try, likeliest first."""
    known = _projected()
    zone = int(centre[0] // 1e6)
    prefixed = (f"EPSG:258{zone:02d}", f"EPSG:326{zone:02d}", f"EPSG:327{zone:02d}")
    usual = [known[code] for code in (*prefixed, *_COMMON) if code in known]
    if near is not None:
        local = [info for info in known.values() if _covers(info, *near)]
        usual = [info for info in usual if _covers(info, *near)]
    elif country is not None:
        local = [info for info in known.values() if _is_in(info, country)]
        usual = [info for info in usual if _is_in(info, country)]
    else:
        local = []
    local.sort(key=_extent)
    return list(dict.fromkeys([*usual, *local]))[:_MOST_TRIED]


@lru_cache(maxsize=1)
def _projected() -> dict[str, CRSInfo]:
    infos = query_crs_info(auth_name="EPSG", pj_types=[PJType.PROJECTED_CRS])
    return {f"EPSG:{info.code}": info for info in infos if info.area_of_use is not None}


def _covers(info: CRSInfo, lon: float, lat: float) -> bool:
    area = info.area_of_use
    if area is None or not area.south - 1 <= lat <= area.north + 1:
        return False
    if area.west <= area.east:
        return area.west - 1 <= lon <= area.east + 1
    return lon >= area.west - 1 or lon <= area.east + 1


def _is_in(info: CRSInfo, country: str) -> bool:
    area = info.area_of_use
    return area is not None and country.casefold() in (area.name or "").casefold()


def _extent(info: CRSInfo) -> float:
    area = info.area_of_use
    return 1e9 if area is None else ((area.east - area.west) % 360) * (area.north - area.south)


def _landing(info: CRSInfo, centre: tuple[float, float]) -> tuple[float, float] | None:
    """Return about where coordinates land, the datum aside; None where the system is not used."""
    try:
        lon, lat = pyproj.Proj(f"{info.auth_name}:{info.code}")(
            *_without_zone(info, centre), inverse=True
        )
    except (CRSError, ProjError):
        return None
    if not (np.isfinite(lon) and np.isfinite(lat) and _covers(info, lon, lat)):
        return None
    return float(lon), float(lat)


def _without_zone(info: CRSInfo, centre: tuple[float, float]) -> tuple[float, float]:
    """Return coordinates without the zone number that may stand before a UTM easting."""
    zone = int(centre[0] // 1e6)
    if zone > 0 and re.search(rf"UTM zone {zone}[NS]$", info.name):
        return centre[0] - zone * 1e6, centre[1]
    return centre


def _distinct(found: list[CrsCandidate]) -> list[CrsCandidate]:
    """Return the candidates without those that land within 300 m of a likelier one."""
    kept: list[CrsCandidate] = []
    for one in found:
        if all(_km((other.lon, other.lat), one.lon, one.lat) > 0.3 for other in kept):
            kept.append(one)
    return kept


def km_between(one: tuple[float, float], other: tuple[float, float]) -> float:
    """Return how far two places (lon, lat) are from each other."""
    return float(GEOD.inv(*one, *other)[2]) / 1000


def km_outside(crs: pyproj.CRS, lon: float, lat: float) -> float:
    """Return how far a place is from where a projected system is used; 0 in it, NaN if unknown."""
    if not crs.is_projected:
        return 0.0
    area = crs.area_of_use
    if area is None:
        authority = crs.to_authority(min_confidence=70)
        area = None if authority is None else pyproj.CRS(":".join(authority)).area_of_use
    if area is None:
        return float("nan")
    width = (area.east - area.west) % 360 or 360.0
    east = (lon - area.west) % 360
    nearest = lon if east <= width else area.east if east - width < 360 - east else area.west
    return km_between((lon, lat), (nearest, min(max(lat, area.south), area.north)))


def southern_zone(crs: pyproj.CRS, lon: float, lat: float) -> str:
    """Return what a northern UTM zone is called south of the equator, where a place lies there.

    Its northings are negative there, and the place is the same. Empty: it lies elsewhere.
    """
    area = crs.area_of_use
    if area is None or not -80 <= lat < 0 or not re.search(r"UTM zone \d+N$", crs.name):
        return ""
    return f"{crs.name[:-1]}S" if km_outside(crs, lon, -lat) == 0 else ""


def utm_zone(crs: pyproj.CRS) -> int | None:
    """Return the number of the UTM zone of a system, or None."""
    zone = re.match(r"\d+", crs.utm_zone or "")
    return int(zone.group()) if zone else None


def _km(near: tuple[float, float] | None, lon: float, lat: float) -> float:
    return np.inf if near is None else km_between(near, (lon, lat))


def _around(lon: float, lat: float) -> Any:  # noqa: ANN401 - pyproj types it twice
    if not (np.isfinite(lon) and np.isfinite(lat) and abs(lon) < 179 and abs(lat) < 89):
        return None
    return AreaOfInterest(lon - 0.01, lat - 0.01, lon + 0.01, lat + 0.01)


def _horizontal(crs: pyproj.CRS) -> pyproj.CRS:
    """Return the part of a system that says where on the map."""
    if crs.is_compound:
        return next(part for part in crs.sub_crs_list if not part.is_vertical)
    if crs.is_bound and crs.source_crs is not None:
        return crs
    return crs.to_2d()
