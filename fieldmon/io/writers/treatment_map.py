"""Where to treat, as sprayers, farm programs and phones read it: rates by area, lon/lat."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import shapely
from shapely import MultiPolygon

from fieldmon.compute.units import Units
from fieldmon.compute.wording import joined, worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.atomic_write import why_not_written, write_whole
from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.spray_rate import must_be_rate
from fieldmon.io.writers.isoxml import isoxml_taskdata
from fieldmon.io.writers.qml import GPKG_VERSION
from fieldmon.io.writers.zipped import zipped_folder
from fieldmon.io.writers.zone_cells import (
    MOST_CELLS,
    ZoneCells,
    beside_and_missed,
    cell_for,
    rates_geotiff,
    zone_cells,
)
from fieldmon.plot.polygons import is_slim, polygons_of, without_slits
from fieldmon.plot.projection import Frame, turned_to

if TYPE_CHECKING:
    from collections.abc import Callable

    import geopandas as gpd

_WGS84 = "EPSG:4326"
_IN_CELLS = re.compile(r"\.grid\d|\.tif$")
_GRID_DEG = 1e-8  # a millimetre, as GeoJSON is written: nothing collapses there


@dataclass(frozen=True, eq=False)
class TreatmentMap:
    """What is to be sprayed where.

    Parameters
    ----------
    title
        Name of the plot.
    boundary
        The whole plot, lon/lat.
    zones
        Areas to spray, lon/lat; elsewhere the rate is 0.
    rate_l_ha
        Litres a hectare in the zones, above 0.
    product
        What is sprayed; empty: not said.

    Raises
    ------
    SettingError
        If the rate cannot be, or there is no zone.
    """

    title: str
    boundary: MultiPolygon
    zones: list[MultiPolygon]
    rate_l_ha: float
    product: str = ""

    def __post_init__(self) -> None:
        must_be_rate(self.rate_l_ha)
        if not self.zones:
            raise SettingError(
                worded(
                    "A treatment map needs a zone or more, but spraying pays nowhere. No zones are "
                    "written."
                )
            )

    @cached_property
    def areas(self) -> tuple[list[MultiPolygon], MultiPolygon]:
        """The zones and the rest of the plot as they are written, see `_clean_areas`."""
        return _clean_areas(self)

    @cached_property
    def cells(self) -> ZoneCells:
        """The same as cells of a grid: all files of a map, and what is said of them, have these."""
        zones, _ = self.areas
        return zone_cells(self.boundary, zones, cell_for(self.boundary, zones)[1])

    def __repr__(self) -> str:
        return f"<TreatmentMap {self.title}: {self.rate_l_ha:g} l/ha>"


def write_treatment_map(of: TreatmentMap, to: str | Path) -> Path:
    """Write a treatment map as the ending of its name tells, whole or not at all.

    ``.xml.zip`` is ISO 11783-10 TASKDATA version 4 with polygons, ``.v3.xml.zip`` version 3;
    ``.grid1.xml.zip`` and ``.grid2.xml.zip``, likewise with ``.v3`` before them, have a grid of
    zones or of rates instead. ``.tif`` is a GeoTIFF of rates; ``.shp.zip``, ``.gpkg``,
    ``.geojson`` and ``.kml`` have a column ``RATE`` and ``UNIT``, ``l/ha``.

    Raises
    ------
    SettingError
        If the ending tells no format.
    FileProblem
        If the file cannot be written.
    """
    path = Path(to)
    write_whole(path, treatment_map_bytes(of, path.name))
    return path


def treatment_map_bytes(of: TreatmentMap, name: str) -> bytes:
    """Return a treatment map as the ending of a file's name tells, see `write_treatment_map`.

    Raises
    ------
    SettingError
        If the ending tells no format.
    """
    return MAP_FORMATS[checked_ending(name)](of)


def checked_ending(name: str) -> str:
    """Return which ending of `MAP_FORMATS` a name has; raise `SettingError` where it has none."""
    ending = next((ending for ending in MAP_FORMATS if name.lower().endswith(ending)), None)
    if ending is None:
        raise SettingError(
            worded(
                "A treatment map must be called *{names}, but it is {name!r}.",
                names=", *".join(MAP_FORMATS),
                name=name,
            )
        )
    return ending


def _clean_areas(of: TreatmentMap) -> tuple[list[MultiPolygon], MultiPolygon]:
    """Return the zones of a map and the rest of its plot, lon/lat: polygons, of which none overlap.

    What is narrower than some centimetres between and in zones is theirs, and beside them nobody's.
    """
    middle = of.boundary.envelope.centroid
    frame = Frame(middle.x - 360.0 if middle.x > 180.0 else middle.x, middle.y)
    zones = [frame.geometry_m(zone) for zone in of.zones]
    made = without_slits(zones)
    rest = _polygons(shapely.difference(frame.geometry_m(of.boundary), shapely.union_all(made)))
    rest = MultiPolygon([one for one in rest.geoms if not is_slim(one)])
    degrees = (turned_to(frame.geometry_lonlat(one), middle.x) for one in (*made, rest))
    *sprayed, rest = (_polygons(one, _GRID_DEG) for one in degrees)
    return sprayed, rest


def _polygons(area: shapely.Geometry, grid: float = 0.0) -> MultiPolygon:
    """Return the polygons of an area, at corners of a grid of such size."""
    whole = shapely.set_precision(shapely.make_valid(area), grid)
    return polygons_of(shapely.get_parts(whole))  # those of collections in collections, too


def _frame(of: TreatmentMap) -> gpd.GeoDataFrame:
    """Return a row a zone and one for the rest of the plot, whose rate is 0."""
    import geopandas as gpd  # noqa: PLC0415 - half a second to import

    zones, rest = of.areas
    areas = [*zones, *([] if rest.is_empty else [rest])]
    n = len(zones)
    more = len(areas) - n
    return gpd.GeoDataFrame(
        {
            "ZONE": [*range(1, n + 1), *([0] * more)],
            "RATE": [*([float(of.rate_l_ha)] * n), *([0.0] * more)],
            "UNIT": ["l/ha"] * len(areas),
            "PRODUCT": [of.product[:80]] * len(areas),
        },
        geometry=areas,
        crs=_WGS84,
    )


def _gpkg(of: TreatmentMap) -> bytes:
    return _one_file(of, "treatment.gpkg", "GPKG", layer="treatment", VERSION=GPKG_VERSION)


def _geojson(of: TreatmentMap) -> bytes:
    return _one_file(of, "treatment.geojson", "GeoJSON", RFC7946="YES", COORDINATE_PRECISION="8")


def _kml(of: TreatmentMap) -> bytes:
    frame = _frame(of)
    frame["Name"] = [f"zone {zone}" if zone else "not sprayed" for zone in frame["ZONE"]]
    return _one_file(of, "treatment.kml", "KML", frame)


def _shapefile(of: TreatmentMap) -> bytes:
    with working_folder() as folder:
        _write(_frame(of), Path(folder) / "treatment.shp", "ESRI Shapefile", encoding="UTF-8")
        return zipped_folder(Path(folder))


def _one_file(
    of: TreatmentMap, name: str, driver: str, frame: gpd.GeoDataFrame | None = None, **more: str
) -> bytes:
    with working_folder() as folder:
        path = Path(folder) / name
        _write(_frame(of) if frame is None else frame, path, driver, **more)
        return path.read_bytes()


def _write(frame: gpd.GeoDataFrame, path: Path, driver: str, **more: str) -> None:
    import pyogrio  # noqa: PLC0415

    try:
        pyogrio.write_dataframe(
            frame, path, driver=driver, geometry_type="MultiPolygon", promote_to_multi=True, **more
        )
    except (OSError, pyogrio.errors.DataSourceError) as error:
        raise FileProblem(
            worded(
                "The treatment map could not be made in the folder for temporary files "
                "({error}). Make room there.",
                error=why_not_written(error),
            )
        ) from error


def _taskdata(version: int, grid: int | None = None) -> Callable[[TreatmentMap], bytes]:
    def make(of: TreatmentMap) -> bytes:
        zones = of.areas[0] if grid is None else replace(of.cells, kind=grid)
        return isoxml_taskdata(
            of.title, of.boundary, zones, of.rate_l_ha, of.product, version=version
        )

    return make


def said_of_cells(of: TreatmentMap, name: str, units: Units | None = None) -> str:
    """Return what cells spray beside the zones, and miss; "" for a file whose format has none."""
    if not _IN_CELLS.search(checked_ending(name)):
        return ""
    units = units or Units()
    zones, _ = of.areas
    should, is_m = cell_for(of.boundary, zones)
    beside, missed = beside_and_missed(zones, of.cells)
    m2 = sum(map(area_m2, zones))
    said = worded(
        "Cells of {cell} spray {beside} beside the zones and miss {missed} of their {whole}.",
        cell=units.metres(is_m, 2), beside=units.square(beside * m2),
        missed=units.square(missed * m2), whole=units.square(m2),
    )  # fmt: skip
    if is_m == should:
        return said
    coarser = worded(
        "They are coarser than {should}, since a grid may hold {most:,} cells: where that matters, "
        "take a file of areas.",
        should=units.metres(should, 2), most=MOST_CELLS,
    )  # fmt: skip
    return joined(" ", [said, coarser])


def _geotiff(of: TreatmentMap) -> bytes:
    return rates_geotiff(of.cells, of.rate_l_ha)


#: by ending; one whose ending ends another's comes later
MAP_FORMATS: dict[str, Callable[[TreatmentMap], bytes]] = {
    **{
        f"{of}.grid{kind}.xml.zip": _taskdata(version, kind)
        for of, version in ((".v3", 3), ("", 4))
        for kind in (1, 2)
    },
    ".v3.xml.zip": _taskdata(3),
    ".xml.zip": _taskdata(4),
    ".shp.zip": _shapefile,
    ".gpkg": _gpkg,
    ".geojson": _geojson,
    ".kml": _kml,
    ".tif": _geotiff,
}
