"""A QGIS project inside a season's file: today's route, inspections to fill in.

QGIS and QField list it with the file and open it with one tap, without a network. It is XML in a
zip, in hexadecimal, as QGIS itself keeps projects in GeoPackages (``qgsgeopackageprojectstorage``).
It names the file that it is in: a copy by fieldmon gets its own, one made by other programs with
the next recording.
"""

from __future__ import annotations

import io
import math
import re
import zipfile
import zlib
from functools import lru_cache
from html import escape, unescape
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.io.parse.result_words import GONE
from fieldmon.io.writers.qml import choice_list, field, numbered, option
from fieldmon.io.writers.zipped import zipped
from fieldmon.monitoring.file.qgis_styles import ASKED_STYLES, PHOTO_STYLES, STYLES, routes_of

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Iterable

PROJECT = "fieldmon"
_TABLE = (
    "CREATE TABLE IF NOT EXISTS qgis_projects (name TEXT PRIMARY KEY, metadata BLOB, content BLOB)"
)
_MOST_DAYS = 14
_MOST_BYTES = 20_000_000  # of a project that somebody brings with a season
_LAST_DAY = '(SELECT max("date") FROM "routes")'
_SHAPES = {"POINT": "Point", "LINESTRING": "Line", "MULTIPOLYGON": "Polygon"}
_RESULTS = (
    ("found infested", "found"),
    ("looked clean", "clean"),
    ("could not inspect", "skipped"),
    ("plant is gone", GONE),
)
_HIDDEN = (
    *("fid", "plant", "line", "number", "day", "time"),
    *("batch", "digest", "undone", "detects"),
)
_WKT = {
    4326: 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
    'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]]',
    3857: 'PROJCS["WGS 84 / Pseudo-Mercator",GEOGCS["WGS 84",DATUM["WGS_1984",'
    'SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
    'UNIT["degree",0.0174532925199433]],PROJECTION["Mercator_1SP"],'
    'PARAMETER["central_meridian",0],PARAMETER["scale_factor",1],PARAMETER["false_easting",0],'
    'PARAMETER["false_northing",0],UNIT["metre",1],AUTHORITY["EPSG","3857"]]',
}


class Shown(NamedTuple):
    """A layer of the project.

    Parameters
    ----------
    table, title
        Where it is from, and what it is called.
    only
        SQL of the rows that are shown; "": all.
    on
        Whether it is drawn when the project is opened.
    edited
        Whether people may add to it.
    """

    table: str
    title: str
    only: str = ""
    on: bool = True
    edited: bool = False

    @property
    def id(self) -> str:
        """Return its name in the project: of more than ten letters, or QGIS makes its own."""
        return "fieldmon_" + re.sub(r"\W+", "_", f"{self.table} {self.title}".lower())


_FINDINGS = (
    Shown("inspections", "Findings", '"undone" = 0', edited=True),
    Shown("photo_places", "Photos"),
    Shown("photos_asked", "Photos asked for", '"ended" IS NULL'),
)
_PLOT = (
    Shown("hot_spots", "Hot spots"),
    Shown("treatments", "Treatments", '"undone" = 0', on=False),
    Shown("chance", "Chance of infestation"),
    Shown("rows", "Rows", on=False),
    Shown("plots", "Plot"),
)


def keep(
    db: sqlite3.Connection, file: str, gone: Callable[[int], Iterable[str]] = lambda _: ()
) -> None:
    """Keep the project of a file of this name, unless it is there as it should be.

    `gone` says whose routes of a day nobody goes by any more.
    """
    days = db.execute(
        "SELECT date, day FROM routes GROUP BY date ORDER BY date DESC LIMIT ?", (_MOST_DAYS + 1,)
    ).fetchall()
    last = [_last_routes(f"'{on}'" if k else _LAST_DAY, gone(day))
            for k, (on, day) in enumerate(days)] or [_last_routes(_LAST_DAY, ())]  # fmt: skip
    today = (
        *_FINDINGS,
        Shown("stops", "Stops today", f'"route" IN {last[0]}'),
        Shown("routes", "Route today", f'"fid" IN {last[0]}'),
    )
    earlier = tuple(
        Shown("routes", f"Route {on}", f'"fid" IN {of}', on=False)
        for (on, _), of in zip(days[1:], last[1:], strict=False)
    )
    box = db.execute(
        "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'plots'"
    ).fetchone()
    if box is None or None in box:
        # of a damaged file: there is no plot to look at
        return
    shapes = dict(db.execute("SELECT table_name, geometry_type_name FROM gpkg_geometry_columns"))
    team = [who for (who,) in db.execute("SELECT DISTINCT who FROM routes ORDER BY who")]
    styles = STYLES | PHOTO_STYLES | ASKED_STYLES
    if len(team) > 1:
        styles["routes"] = routes_of(team)
    content = _packed(_project(file, (today, earlier), (shapes, styles), box))
    db.execute(_TABLE)
    held = db.execute("SELECT content FROM qgis_projects WHERE name = ?", (PROJECT,)).fetchone()
    if held is None or held[0] != content:
        told = '{"last_modified_time": "2026-01-01T00:00:00", "last_modified_user": "fieldmon"}'
        db.execute("INSERT OR REPLACE INTO qgis_projects VALUES (?, ?, ?)",
                   (PROJECT, told, content))  # fmt: skip


def rename(db: sqlite3.Connection, file: str) -> None:
    """Let the project, if there is one, name the file that its season is called from now on."""
    there = "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'qgis_projects'"
    if db.execute(there).fetchone() is None:  # of a version that kept none
        return
    held = db.execute("SELECT content FROM qgis_projects WHERE name = ?", (PROJECT,)).fetchone()
    project = None if held is None else _unpacked(held[0])
    own = None if project is None else re.search(r'\./([^|<>"]*)\|layername=plots\b', project)
    if project is None or own is None or own[1] == escape(file):  # or somebody's own project
        return
    project = project.replace(f"./{own[1]}|layername=", f"./{escape(file)}|layername=")
    before, after = (escape(Path(name).stem) for name in (unescape(own[1]), file))
    for named in ('projectname="{}"', "<title>{}</title>"):
        project = project.replace(named.format(before), named.format(after))
    db.execute("UPDATE qgis_projects SET content = ? WHERE name = ?", (_packed(project), PROJECT))


def _last_routes(day: str, gone: Iterable[str]) -> str:
    """Return SQL of the last route of each who has one on a day, but of those gone."""
    names = ", ".join("'" + who.replace("'", "''") + "'" for who in sorted(gone))
    but = f' AND "who" NOT IN ({names})' if names else ""
    return f'(SELECT max("fid") FROM "routes" WHERE "date" = {day}{but} GROUP BY "who")'  # noqa: S608 - quoted


@lru_cache(maxsize=4)  # mostly it is what it was
def _packed(project: str) -> str:
    return zipped({f"{PROJECT}.qgs": project.encode()}).hex()


def _unpacked(content: object) -> str | None:
    """Return a project; None: it is not packed as one, or too large for one."""
    try:
        packed = content.decode() if isinstance(content, bytes) else str(content)
        with zipfile.ZipFile(io.BytesIO(bytes.fromhex(packed))) as archive:
            (inner,) = (one for one in archive.infolist() if one.filename.endswith(".qgs"))
            if inner.file_size > _MOST_BYTES:
                return None
            return archive.read(inner).decode()
    except (ValueError, OSError, RuntimeError, zipfile.BadZipFile, zlib.error):
        return None


def _project(
    file: str,
    days: tuple[tuple[Shown, ...], ...],
    drawn_as: tuple[dict[str, str], dict[str, str]],
    box: tuple[float, ...],
) -> str:
    today, earlier = days
    shapes, styles = drawn_as
    title = escape(Path(file).stem)
    layers = [*today, *earlier, *_PLOT]
    tree = (
        _group("Today", today)
        + (_group("Earlier days", earlier, on=False) if earlier else "")
        + _group("Plot", _PLOT)
    )
    view = _mercator(box)
    extent = "".join(
        f' {name}="{value}"' for name, value in zip(("xmin", "ymin", "xmax", "ymax"), view,
                                                      strict=True)
    )  # fmt: skip
    drawn = "".join(_layer(file, one, shapes[one.table], styles[one.table]) for one in layers)
    return (
        "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>"
        f'<qgis version="3.22.0" projectname="{title}"><title>{title}</title>'
        f"<projectCrs>{_system(3857)}</projectCrs><layer-tree-group>{tree}</layer-tree-group>"
        f'<mapcanvas name="theMapCanvas"><units>meters</units><extent>'
        + "".join(f"<{n}>{v}</{n}>" for n, v in zip(("xmin", "ymin", "xmax", "ymax"), view,
                                                     strict=True))
        + f"</extent><destinationsrs>{_system(3857)}</destinationsrs></mapcanvas>"
        f"<ProjectViewSettings><DefaultViewExtent{extent}>{_system(3857)}</DefaultViewExtent>"
        f"</ProjectViewSettings><projectlayers>{drawn}</projectlayers>{_themes(today, earlier)}"
        '<properties><SpatialRefSys><ProjectionsEnabled type="int">1</ProjectionsEnabled>'
        '</SpatialRefSys>'
        # else QGIS measures on the web map's plane, a third too much at 30 degrees
        '<Measure><Ellipsoid type="QString">EPSG:7030</Ellipsoid></Measure>'
        '<Paths><Absolute type="bool">false</Absolute></Paths></properties></qgis>'
    )  # fmt: skip


def _group(name: str, layers: Iterable[Shown], *, on: bool = True) -> str:
    inner = "".join(
        f'<layer-tree-layer id="{one.id}" name="{escape(one.title)}" providerKey="ogr" '
        f'checked="{_checked(one.on)}" expanded="0" source=""/>'
        for one in layers
    )
    return (
        f'<layer-tree-group name="{name}" checked="{_checked(on)}" expanded="{int(on)}">{inner}'
        "</layer-tree-group>"
    )


def _checked(on: bool) -> str:  # noqa: FBT001 - one flag
    return "Qt::Checked" if on else "Qt::Unchecked"


def _layer(file: str, one: Shown, shape: str, style: str) -> str:
    source = f"./{file}|layername={one.table}" + (f"|subset={one.only}" if one.only else "")
    parts = r"<mapTip>.*</mapTip>|<renderer-v2.*</renderer-v2>|<labeling.*</labeling>"
    drawn = "".join(re.findall(parts, style, re.DOTALL))
    return (
        f'<maplayer type="vector" geometry="{_SHAPES[shape]}" readOnly="{int(not one.edited)}" '
        f'labelsEnabled="{int("<labeling" in style)}">'
        f"<id>{one.id}</id><datasource>{escape(source)}</datasource>"
        f"<layername>{escape(one.title)}</layername><srs>{_system(4326)}</srs>"
        f'<provider encoding="UTF-8">ogr</provider>{_form() if one.edited else ""}'
        f"{drawn}</maplayer>"
    )


def _themes(today: tuple[Shown, ...], earlier: tuple[Shown, ...]) -> str:
    """Return the theme for print: no chance map, whose colours a printer drowns the route in."""
    printed = [one for one in (*today, *_PLOT) if one.on and one.table != "chance"]
    everything = [one for one in (*today, *_PLOT) if one.on]
    presets = (("Print", printed), ("Screen", everything), ("All routes", [*everything, *earlier]))
    inner = "".join(
        f'<visibility-preset name="{name}" has-expanded-info="0">'
        + "".join(f'<layer id="{one.id}" visible="1" style="default"/>' for one in layers)
        + "</visibility-preset>"
        for name, layers in presets
    )
    return f"<visibility-presets>{inner}</visibility-presets>"


def _form() -> str:
    """Return what people fill in of an inspection: a choice list, today's date, a count."""
    day = option("display_format", "yyyy-MM-dd") + option("field_format", "yyyy-MM-dd")
    return (
        "<fieldConfiguration>"
        + "".join(field(name, "Hidden") for name in _HIDDEN)
        + choice_list("result", _RESULTS)
        + field("date", "DateTime", f"{day}{option('calendar_popup', 'true', 'bool')}")
        + numbered("count")
        + "</fieldConfiguration><defaults>"
        '<default field="date" expression="to_date(now())" applyOnUpdate="0"/>'
        '<default field="undone" expression="0" applyOnUpdate="0"/></defaults><constraints>'
        '<constraint field="result" constraints="1" notnull_strength="1" unique_strength="0" '
        'exp_strength="0"/></constraints>'
    )


def _system(code: int) -> str:
    return (
        f'<spatialrefsys nativeFormat="Wkt"><wkt>{escape(_WKT[code])}</wkt><srid>{code}</srid>'
        f"<authid>EPSG:{code}</authid><geographicflag>{str(code == 4326).lower()}</geographicflag>"
        "</spatialrefsys>"
    )


def _mercator(box: tuple[float, ...]) -> tuple[float, float, float, float]:
    """Return a box of degrees in metres of web maps (EPSG 3857: spherical Mercator)."""
    radius = 6378137.0
    west, east = (math.radians(box[k]) * radius for k in (0, 2))
    south, north = (
        radius * math.log(math.tan(math.pi / 4 + math.radians(box[k]) / 2)) for k in (1, 3)
    )
    return west, south, east, north
