"""A day as GeoPackage and as zipped shapefile: a layer of stops and one of the driven line."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import geopandas as gpd
import pandas as pd
import pyogrio
from shapely import LineString, Point

from fieldmon.compute.wording import worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import FileProblem
from fieldmon.io.atomic_write import why_not_written
from fieldmon.io.writers import qml
from fieldmon.io.writers.day_file import plain_text
from fieldmon.io.writers.geojson import summary
from fieldmon.io.writers.zipped import zipped_folder
from fieldmon.plot.projection import goes_round, turned_to

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fieldmon.io.writers.day_file import HandoffPlan

G = TypeVar("G", Point, LineString)

_WGS84 = "EPSG:4326"
_MOST_BYTES = 254  # of text in a cell of a shapefile's table
# what is read in the list of findings, and what is written
_CHOICES = (
    ("found infested", "yes"),
    ("looked clean", "no"),
    ("could not inspect", "skipped"),
    ("plant is gone", "gone"),
)
_SHOWN = {
    "yes": ("found infested", qml.Symbol("marker", qml.RED, 2.6, "diamond")),
    "no": ("looked clean", qml.Symbol("marker", qml.BLUE, 1.8)),
    "skipped": ("could not inspect", qml.Symbol("marker", qml.GREY, 2.0, "cross2")),
    "gone": ("plant is gone", qml.Symbol("marker", qml.GREY, 2.0, "cross2")),
    "": ("to inspect", qml.Symbol("marker", qml.YELLOW, 2.2)),
}
_NOT_FILLED_IN = {"fid", "plant", "arrive_s", "inspect_s", "chance", "detects"}


def route_gpkg(plan: HandoffPlan) -> bytes:
    """Return a day as GeoPackage with the layers ``stops`` and ``route``, in WGS 84.

    In QGIS and QField stops carry their order, and findings are chosen from a list. ``found``,
    ``count``, ``who``, ``notes`` and ``time`` of the stops are empty, to be filled in.
    """

    def write(folder: Path) -> Path:
        path = folder / "route.gpkg"
        stops = _stops(plan)
        stops["time"] = pd.Series([pd.NaT] * len(stops), dtype="datetime64[ms]")
        _write(stops, path, "GPKG", layer="stops", geometry_type="Point")
        _write(_line(plan), path, "GPKG", layer="route", geometry_type="LineString")
        _add_styles(path, stops.columns)
        return path

    return _made(lambda folder: write(folder).read_bytes())


def route_shapefile(plan: HandoffPlan) -> bytes:
    """Return a day as a zip with the shapefiles ``stops`` and ``route``, in WGS 84.

    By the format's limits: names of columns are ASCII of ten characters at most, text is UTF-8 (as
    the ``.cpg`` says) of 254 bytes at most, and times are text, since its tables know but days.
    """

    def write(folder: Path) -> bytes:
        for name, frame, kind in (
            ("stops", _stops(plan), "Point"),
            ("route", _line(plan), "LineString"),
        ):
            path = folder / f"{name}.shp"
            _write(frame, path, "ESRI Shapefile", encoding="UTF-8", geometry_type=kind)
        return zipped_folder(folder)

    return _made(write)


def _add_styles(path: Path, columns: Iterable[str]) -> None:
    """Let QGIS show stops by what was found, with their order, and offer what to fill in."""
    with closing(sqlite3.connect(path)) as db:
        db.execute(qml.STYLES_TABLE)
        db.execute(
            "INSERT OR IGNORE INTO gpkg_contents (table_name, data_type, identifier) "
            "VALUES ('layer_styles', 'attributes', 'layer_styles')"
        )
        drawn = qml.by_value("found", _SHOWN)
        renderer = drawn[drawn.index("<renderer-v2") : drawn.index("</qgis>")]
        hidden = "".join(qml.field(name, "Hidden") for name in columns if name in _NOT_FILLED_IN)
        form = (
            f"<fieldConfiguration>{hidden}{qml.choice_list('found', _CHOICES)}"
            f"{qml.numbered('count')}</fieldConfiguration>"
        )
        stops = qml.qml(renderer + qml.labelled('"stop"') + form, "Symbology|Labeling|Fields|Forms")
        stops = stops.replace("<qgis ", '<qgis labelsEnabled="1" ', 1)
        route = qml.single(qml.Symbol("line", qml.BLACK, 0.7))
        qml.add(db, {"stops": stops, "route": route})
        db.commit()


def _made(write: Callable[[Path], bytes]) -> bytes:
    """Return what is written in a folder of its own, which is then gone."""
    try:
        with working_folder() as folder:
            return write(Path(folder))
    except (OSError, pyogrio.errors.DataSourceError) as error:
        raise FileProblem(
            worded(
                "The route could not be made in the folder for temporary "
                "files ({error}). Make room there.",
                error=why_not_written(error),
            )
        ) from error


def _write(frame: gpd.GeoDataFrame, path: Path, driver: str, **more: Any) -> None:  # noqa: ANN401
    if driver == "GPKG" and not path.exists():
        more["VERSION"] = qml.GPKG_VERSION
    pyogrio.write_dataframe(frame, path, driver=driver, append=path.exists(), **more)


def _stops(plan: HandoffPlan) -> gpd.GeoDataFrame:
    stops = plan.stops
    columns: dict[str, pd.Series[Any]] = {
        name: pd.Series([getattr(stop, field) for stop in stops], dtype=kind)
        for name, field, kind in (
            ("stop", "order", "int32"),
            ("plant", "plant", "int32"),
            *((("block", "block", "int32"),) if plan.has_blocks else ()),
            *((("row", "row", "int32"),) if plan.in_rows else ()),
            *((("row_name", "row_name", "object"),) if plan.has_row_names else ()),
            ("number", "number", "int32"),
            *((("face", "face", "int32"),) if plan.has_faces else ()),
            ("arrive", "arrive", "object"),
            ("arrive_s", "arrive_s", "float64"),
            ("inspect_s", "inspect_s", "float64"),
            ("chance", "chance", "float64"),
            ("detects", "detects", "float64"),
        )
    }
    for name, kind in (("found", object), ("count", "Int32"), ("who", object), ("notes", object)):
        said = plan.notes.who if name == "who" else None
        columns[name] = pd.Series([said] * len(stops), dtype=kind)
    points = _in_one_piece(plan, [Point(stop.lon, stop.lat) for stop in stops])
    return gpd.GeoDataFrame(columns, geometry=points, crs=_WGS84)


def _line(plan: HandoffPlan) -> gpd.GeoDataFrame:
    there = len(plan.line_lonlat) > 1
    figures = summary(plan.route, plan.notes)
    row = {
        "plot": _cut(plan.notes.plot),
        "sampler": _cut(plan.notes.sampler),
        "start": plan.clock(0.0),
        "stops": figures["stops"],
        "seconds": figures["seconds"],
        "drive_m": figures["drive_m"],
        **({"bound": _cut(plan.bound)} if plan.bound else {}),
    }
    lines = _in_one_piece(plan, [LineString(plan.line_lonlat)] if there else [])
    columns = {name: pd.Series([value] * len(lines)) for name, value in row.items()}
    return gpd.GeoDataFrame(columns, geometry=lines, crs=_WGS84)


def _in_one_piece(plan: HandoffPlan, shapes: list[G]) -> list[G]:
    """Return what belongs to a day in one piece: across longitude 180, from 0 to 360."""
    across = len(plan.line_lonlat) > 0 and goes_round(plan.line_lonlat[:, 0])
    return [turned_to(shape, 180.0) for shape in shapes] if across else shapes


def _cut(text: str) -> str:
    """Return text of no more bytes than a shapefile's cell holds, no letter cut in two."""
    return plain_text(text).encode()[:_MOST_BYTES].decode("utf-8", "ignore")
