"""The one way of a planned day into a file of the format that its name tells, or that is asked.

A new format is a file beside this one, with a function from a `HandoffPlan` to bytes, and a line in
`FORMATS`.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.arguments import must_be
from fieldmon.compute.wording import Worded, worded
from fieldmon.errors import SettingError
from fieldmon.io.atomic_write import write_whole

if TYPE_CHECKING:
    from fieldmon.io.writers.day_file import HandoffPlan


class HandoffFormat(NamedTuple):
    """A format that can be handed off.

    Parameters
    ----------
    writer
        Module beside this one and its function, as ``"gpx:route_gpx"``; it is imported when a file
        is made, as some need libraries that take a while to load. It takes a `HandoffPlan` and
        returns the file's bytes.
    endings
        That tell it; the first is the usual one.
    reader
        Who reads it, in a few words: the app says them.
    several
        Whether it takes several files; the function then returns their bytes by ending, the main
        one first.
    """

    writer: str
    endings: tuple[str, ...]
    reader: Worded
    several: bool = False

    def make(self, plan: HandoffPlan) -> dict[str, bytes]:
        """Return file contents by what is put after the stem of the name, the main file first."""
        module, _, name = self.writer.partition(":")
        made = getattr(import_module(f"{__package__}.{module}"), name)(plan)
        return dict(made) if self.several else {self.endings[0]: made}


#: by name, the commonest first
FORMATS = {
    "gpx": HandoffFormat("gpx:route_gpx", (".gpx",), worded("GPS handhelds and hiking apps")),
    "kml": HandoffFormat("kml:route_kml", (".kml",), worded("Google Earth, map apps on phones")),
    "sheet": HandoffFormat(
        "field_sheet:route_sheet", (".html", ".htm"), worded("a printer: a scout without a phone")
    ),
    "csv": HandoffFormat("csv:route_csv", (".csv",), worded("spreadsheets")),
    "geojson": HandoffFormat(
        "geojson:handed_geojson", (".geojson", ".json"), worded("QGIS, phones, web maps")
    ),
    "gpkg": HandoffFormat("gis:route_gpkg", (".gpkg",), worded("QGIS, QField, ArcGIS")),
    "shapefile": HandoffFormat(
        "gis:route_shapefile", (".shp.zip", ".zip"), worded("older map programs and consoles")
    ),
    "waypoints": HandoffFormat(
        "nav2:waypoints_yaml", (".waypoints.yaml", ".yaml", ".yml"), worded("robots of any kind")
    ),
    "nav2": HandoffFormat(
        "nav2:nav2_files", (".nav2.geojson",), worded("robots with Nav2 (ROS 2)"), several=True
    ),
    "nav2-pauses": HandoffFormat(
        "nav2:nav2_files_with_pauses",
        (".pauses.nav2.geojson",),
        worded("robots with Nav2 and a plugin for pauses"),
        several=True,
    ),
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
    must_be("A file must be given by its path", to, (str, Path), 'Give "route.gpx", for instance.')
    target = Path(to)
    chosen = format_of(target, as_format)
    known = (e for e in chosen.endings if target.name.lower().endswith(e))
    ending = next(known, target.suffix)
    stem = target.name[: len(target.name) - len(ending)]
    made = chosen.make(plan)
    # the main file keeps the name it was given, whatever that ends in
    paths = (target, *(target.with_name(f"{stem}{more}") for more in list(made)[1:]))
    for path, data in zip(paths, made.values(), strict=True):
        write_whole(path, data)
    return paths


def format_of(target: Path, name: str | None = None) -> HandoffFormat:
    """Return the format of a file by its name, or the one that is named; see `write_handoff`."""
    if name is not None:
        if name.lower() not in FORMATS:
            raise SettingError(
                worded(
                    "A route can be written as {names}, but not as {name!r}.",
                    names=", ".join(FORMATS),
                    name=name,
                )
            )
        return FORMATS[name.lower()]
    told = {ending: chosen for chosen in FORMATS.values() for ending in chosen.endings}
    # the longest tells: .nav2.geojson ends in .geojson, too
    if ends := [ending for ending in told if target.name.lower().endswith(ending)]:
        _refuse_packed(target)
        return told[max(ends, key=len)]
    endings = ", ".join(told)
    raise SettingError(
        worded(
            "The name of a route file must end in one of {endings}, but it is "
            "{name!r}. Choose another name, or name the format.",
            endings=endings,
            name=target.name,
        )
    )


def _refuse_packed(target: Path) -> None:
    """Raise `SettingError` where a name asks for another format than the shapefile in a zip."""
    stem, dot, end = target.name.rpartition(".")
    packed = [ending for one in FORMATS.values() for ending in one.endings]
    if dot and end.lower() == "zip" and stem.lower().endswith(tuple(packed)):
        raise SettingError(
            worded(
                "Only a shapefile is written as a zip, but the name is {name!r}. Leave out .zip, "
                "or end it in .shp.zip.",
                name=target.name,
            )
        )
