"""The one door: a planned day into a file of the format that its name tells, or that is asked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.errors import SettingError
from fieldmon.io.atomic_write import write_whole

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.io.writers.day_file import HandoffPlan

    #: file contents by what is put after the stem of the name: ``{".geojson": b"..."}``
    Made = dict[str, bytes]


class Format(NamedTuple):
    """A format that can be handed off.

    Parameters
    ----------
    make
        Returns the contents by ending, the main file first.
    endings
        That tell it; the first is the usual one.
    reader
        Who reads it, in a few words.
    several
        Whether it takes several files.
    """

    make: Callable[[HandoffPlan], Made]
    endings: tuple[str, ...]
    reader: str
    several: bool = False


def _geojson(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers.geojson import route_geojson  # noqa: PLC0415 - see FORMATS

    return {".geojson": route_geojson(plan.route, plan.notes).encode()}


def _csv(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers.csv import route_csv  # noqa: PLC0415

    return {".csv": route_csv(plan)}


def _gpx(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers.gpx import route_gpx  # noqa: PLC0415

    return {".gpx": route_gpx(plan)}


def _kml(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers.kml import route_kml  # noqa: PLC0415

    return {".kml": route_kml(plan)}


def _gpkg(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers.gis import route_gpkg  # noqa: PLC0415

    return {".gpkg": route_gpkg(plan)}


def _shapefile(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers.gis import route_shapefile  # noqa: PLC0415

    return {".zip": route_shapefile(plan)}


def _nav2(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers import nav2  # noqa: PLC0415

    return {
        ".nav2.geojson": nav2.route_graph(plan),
        ".datum.yaml": nav2.datum_yaml(plan),
        ".waypoints.yaml": nav2.waypoints_yaml(plan),
    }


def _waypoints(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers import nav2  # noqa: PLC0415

    return {".yaml": nav2.waypoints_yaml(plan)}


def _sheet(plan: HandoffPlan) -> Made:
    from fieldmon.io.writers.field_sheet import route_sheet  # noqa: PLC0415

    return {".html": route_sheet(plan)}


#: by name; one whose ending ends another's comes later. Each is imported when it is written, as
#: some need libraries that take a while to load
FORMATS = {
    "nav2": Format(_nav2, (".nav2.geojson",), "robots with Nav2 (ROS 2)", several=True),
    "waypoints": Format(_waypoints, (".waypoints.yaml", ".yaml", ".yml"), "robots of any kind"),
    "geojson": Format(_geojson, (".geojson", ".json"), "QGIS, phones, web maps"),
    "gpkg": Format(_gpkg, (".gpkg",), "QGIS, QField, ArcGIS"),
    "shapefile": Format(_shapefile, (".shp.zip", ".zip"), "older map programs and consoles"),
    "csv": Format(_csv, (".csv",), "spreadsheets"),
    "kml": Format(_kml, (".kml",), "Google Earth, map apps on phones"),
    "gpx": Format(_gpx, (".gpx",), "GPS handhelds and hiking apps"),
    "sheet": Format(_sheet, (".html", ".htm"), "a printer: a scout without a phone"),
}


def write_handoff(
    plan: HandoffPlan, to: str | Path, as_format: str | None = None
) -> tuple[Path, ...]:
    """Write a planned day, and return the files written, the main one first.

    Parameters
    ----------
    plan
        The day.
    to
        The file. Formats of several files put the others beside it, with the same stem.
    as_format
        One of `FORMATS`; None: as the name's ending tells.

    Raises
    ------
    SettingError
        Where there is no such format, or the ending tells none.
    FileProblem
        Where a file cannot be written. Each file appears whole or not at all, and none is touched
        before all are made.
    """
    target = Path(to)
    chosen = _format_of(target, as_format)
    known = (e for e in chosen.endings if target.name.lower().endswith(e))
    ending = next(known, target.suffix)
    stem = target.name[: len(target.name) - len(ending)]
    made = chosen.make(plan)
    # the main file keeps the name it was given, whatever that ends in
    paths = (target, *(target.with_name(f"{stem}{more}") for more in list(made)[1:]))
    for path, data in zip(paths, made.values(), strict=True):
        write_whole(path, data)
    return paths


def _format_of(target: Path, name: str | None) -> Format:
    if name is not None:
        if name.lower() not in FORMATS:
            raise SettingError(
                f"A route can be written as {', '.join(FORMATS)}, but not as {name!r}."
            )
        return FORMATS[name.lower()]
    for chosen in FORMATS.values():
        if target.name.lower().endswith(chosen.endings):
            return chosen
    endings = ", ".join(ending for chosen in FORMATS.values() for ending in chosen.endings)
    raise SettingError(
        f"The name of a route file must end in one of {endings}, but it is {target.name!r}. "
        "Choose another name, or name the format."
    )
