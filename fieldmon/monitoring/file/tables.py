"""What a season's file holds, as values: into the tables and out of them again, bit for bit."""

from __future__ import annotations

import json
import math
import zlib
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from shapely import LineString, MultiLineString, MultiPolygon, Point

from fieldmon.compute.arrays import offsets
from fieldmon.compute.digest import digest
from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.infestation.records import Records
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import blob, geometry, insert, point_blobs, touch, unpacked
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.grid import PlantGrid, plant_numbers
from fieldmon.plot.local_clock import utc_text
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_course import row_corners
from fieldmon.plot.travel import Aisles

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.io.import_report import ImportMessage

_FRAME, _IN_ROWS = "frame", "in_rows"
_SPACINGS = ("row_spacing_m", "plant_spacing_m")
_ASSUMED = ("row_spacing_m", "plant_spacing_m")
_BEARING, _NOTHING = "row_bearing_deg", np.empty(0)
_STATED = ("row_bearing_deg", "row_spacing_m", "plant_spacing_m")
# what all arrays of a season may unpack to: those of a million plants take a third of it
_MOST_BYTES = 1 << 30
_NAMES = ("plant_rows", "plant_blocks", "plant_names")
_OF_PLOT = (
    "SELECT name, dtype, shape, data FROM arrays ORDER BY fid",
    "SELECT geom, name FROM plots ORDER BY fid",
    "SELECT kind, geom FROM places ORDER BY fid",
)
# the plot that was read last, by a name for what it was read from
_LAST_READ: dict[str, Plot] = {}


@dataclass(frozen=True)
class KeptMessage:
    """An import's message as the season's file keeps it, with the file that it was about.

    Parameters
    ----------
    source
        Name of the file.
    severity, feature, sentence
        As the message has them.
    remedy
        Setting that would have answered it; None where there was nothing to choose.
    """

    source: str
    severity: str
    feature: str | None
    sentence: str
    remedy: str | None = None

    @classmethod
    def of(cls, source: str, message: ImportMessage) -> KeptMessage:
        """Return a message about a file as it is kept."""
        remedy = None if message.remedy is None else message.remedy.setting
        return cls(source, message.severity.value, message.feature, message.sentence, remedy)


def write_array(db: sqlite3.Connection, name: str, values: NDArray[Any]) -> None:
    """Keep an array, compressed."""
    data = zlib.compress(np.ascontiguousarray(values).tobytes(), 1)
    row = (name, values.dtype.str, json.dumps(values.shape), data)
    insert(db, schema.ARRAYS, [row])


def read_arrays(db: sqlite3.Connection, like: str = "%") -> dict[str, NDArray[Any]]:
    """Return the arrays kept whose names are like an SQL pattern, by name."""
    arrays, left = {}, _MOST_BYTES
    wanted = "SELECT name, dtype, shape, data FROM arrays WHERE name LIKE ?"
    for name, dtype, shape, data in db.execute(wanted, (like,)):
        kind, sizes = np.dtype(dtype), json.loads(shape)
        flat = unpacked(data, min(kind.itemsize * math.prod(sizes), left))
        left -= len(flat)
        arrays[name] = np.frombuffer(flat, kind).reshape(sizes)
    return arrays


def write_plot(db: sqlite3.Connection, plot: Plot) -> None:
    """Keep a plot: its layers for people, its arrays so that it comes back exactly as it is."""
    _write_field(db, plot)
    _write_grid(db, plot.grid)
    _write_plant_layers(db, plot.grid)


def _write_field(db: sqlite3.Connection, plot: Plot) -> None:
    field, grid = plot.field, plot.grid
    area_ha = grid.frame.geometry_m(field.boundary).area / 1e4
    insert(db, schema.PLOTS, [(blob(field.boundary), field.name, round(area_ha, 4), len(grid))])
    places: list[tuple[bytes, str]] = [
        (blob(geom), kind)
        for kind, geom in (
            ("no-go", field.no_go),
            ("path", field.paths),
            ("row line", field.row_lines),
        )
        if not geom.is_empty
    ]
    if field.gate is not None:
        places.append((blob(Point(field.gate)), "gate"))
    places += [(blob(block.area), "block") for block in field.blocks]
    insert(db, schema.PLACES, places)
    if field.plants is not None:
        write_array(db, "measured_lonlat", field.plants)
    for name in _NAMES:
        if (names := getattr(field, name)) is not None:
            write_array(db, name, names)
    if field.blocks:
        _write_blocks(db, field.blocks)
    stated = [np.nan if (v := getattr(field, name)) is None else v for name in _STATED]
    write_array(db, "stated", np.array(stated, np.float64))
    if plot.headland_m is not None:
        write_array(db, "headland", np.array([plot.headland_m], np.float64))
    taken = {one.setting: one.value for one in plot.assumed}
    assumed = [taken.get(name, np.nan) for name in _ASSUMED]
    write_array(db, "assumed", np.array(assumed, np.float64))
    if _BEARING in taken:
        write_array(db, "assumed_bearing", np.array([taken[_BEARING]], np.float64))
    for table in (schema.PLOTS, schema.PLACES):
        touch(db, table.name, field.boundary.bounds)


def _write_blocks(db: sqlite3.Connection, blocks: tuple[Block, ...]) -> None:
    """Keep what is said of each block, in order."""
    areas = [shapely.to_wkb(block.area) for block in blocks]
    write_array(db, "blocks.name", np.array([block.name for block in blocks], np.str_))
    write_array(db, "blocks.wkb_start", offsets(np.array([len(area) for area in areas])))
    write_array(db, "blocks.wkb", np.frombuffer(b"".join(areas), np.uint8))
    stated = [[getattr(block, name) for name in _STATED] for block in blocks]
    write_array(db, "blocks.stated", np.array(stated, np.float64))


def _blocks(arrays: dict[str, NDArray[Any]]) -> tuple[Block, ...]:
    """Return the blocks kept; a file of an earlier version has none."""
    if "blocks.name" not in arrays:
        return ()
    wkb, start = arrays["blocks.wkb"].tobytes(), arrays["blocks.wkb_start"].tolist()
    areas: list[Any] = [shapely.from_wkb(wkb[a:b]) for a, b in pairwise(start)]
    stated = [
        [None if np.isnan(value) else value for value in row]
        for row in arrays["blocks.stated"].tolist()
    ]
    names = arrays["blocks.name"].tolist()
    return tuple(
        Block(name, area, *row) for name, area, row in zip(names, areas, stated, strict=True)
    )


def _write_grid(db: sqlite3.Connection, grid: PlantGrid) -> None:
    for each in fields(grid):
        value = getattr(grid, each.name)
        if isinstance(value, np.ndarray):
            write_array(db, f"grid.{each.name}", value)
    if not grid.in_rows:
        write_array(db, f"grid.{_IN_ROWS}", np.array([0], np.uint8))
    frame = grid.frame
    write_array(db, f"grid.{_FRAME}", np.array([frame.lon, frame.lat, frame.bearing_deg]))
    write_array(db, "grid.spacings", np.array([getattr(grid, name) for name in _SPACINGS]))
    if grid.half_canopy_m is not None:
        write_array(db, "grid.half_canopy", np.array([grid.half_canopy_m]))
    area = np.frombuffer(shapely.to_wkb(grid.drivable_m), np.uint8)
    write_array(db, "grid.drivable_wkb", area)
    if grid.beyond_m is not None:
        beyond = np.frombuffer(shapely.to_wkb(grid.beyond_m), np.uint8)
        write_array(db, "grid.beyond_wkb", beyond)


def _write_plant_layers(db: sqlite3.Connection, grid: PlantGrid) -> None:
    lonlat, numbered = grid.lonlat(), plant_numbers(grid)
    numbers, counts = grid.row_line_number[grid.unbroken], np.diff(grid.unbroken_start)
    lines = zip(row_corners(grid), numbers, counts, strict=True)
    rows = [
        (blob(LineString(grid.frame.lonlat(corners))), int(line), int(n))
        for corners, line, n in lines
    ]
    insert(db, schema.ROWS, rows)
    plants = zip(
        point_blobs(lonlat),
        range(len(grid)),
        numbered.line.tolist(),
        numbered.number.tolist(),
        strict=True,
    )
    insert(db, schema.PLANTS, list(plants))
    bounds = (*lonlat.min(axis=0).tolist(), *lonlat.max(axis=0).tolist())
    for table in (schema.ROWS, schema.PLANTS, schema.CHANCE):
        touch(db, table.name, bounds)


def read_plot(db: sqlite3.Connection) -> Plot:
    """Return the plot, exactly as it was written; its ways are found again.

    Of seasons of one plot that are read one after the other all have the first one's: whoever reads
    a season and its copy, or a season again, waits for its ways once.
    """
    name = _content_of_plot(db)
    plot = _LAST_READ.get(name)
    if plot is None:
        plot = _read_plot(db)
        _LAST_READ.clear()  # those of 100 000 plants fill the memory
        _LAST_READ[name] = plot
    return plot


def _content_of_plot(db: sqlite3.Connection) -> str:
    """Return a name for all from which the plot is read."""
    parts = [value for wanted in _OF_PLOT for row in db.execute(wanted) for value in row]
    known = [len(value) if isinstance(value, bytes) else value for value in parts]
    return digest(known, *(value for value in parts if isinstance(value, bytes)))


def _read_plot(db: sqlite3.Connection) -> Plot:
    arrays = read_arrays(db)
    try:
        grid, field = _grid(arrays), _field(db, arrays)
    except (KeyError, TypeError, ValueError) as error:
        raise FileProblem(
            worded(
                "The season's plants must be in its file, but not all that says where they stand "
                "can be read. Save what can be saved with: fieldmon salvage. If it was saved so, "
                "begin a new season with fieldmon init, and record the layer inspections into it."
            )
        ) from error
    gate = None if field.gate is None else grid.frame.xy_m(field.gate)[0]
    gate_xy_m = None if gate is None else (float(gate[0]), float(gate[1]))
    # a file of an earlier version does not say
    taken = arrays.get("assumed", np.full(len(_ASSUMED), np.nan)).tolist()
    assumed = [Assumed(*one) for one in zip(_ASSUMED, taken, strict=True) if not np.isnan(one[1])]
    assumed += [Assumed(_BEARING, one) for one in arrays.get("assumed_bearing", _NOTHING).tolist()]
    aisles = Aisles(grid, gate_xy_m, grid.frame.geometry_m(field.no_go))  # found when asked for
    # nor of headlands
    headland_m = next(iter(arrays.get("headland", _NOTHING).tolist()), None)
    return Plot(field, aisles, tuple(assumed), headland_m=headland_m)


def _grid(arrays: dict[str, NDArray[Any]]) -> PlantGrid:
    values: dict[str, Any] = {
        name.removeprefix("grid."): array
        for name, array in arrays.items()
        if name.startswith("grid.")
    }
    lon, lat, bearing_deg = values.pop(_FRAME).tolist()
    spacings = dict(zip(_SPACINGS, values.pop("spacings").tolist(), strict=True))
    # a file of an earlier version does not say: all plants stood in rows then
    in_rows = _IN_ROWS not in values
    values.pop(_IN_ROWS, None)
    area: Any = shapely.from_wkb(values.pop("drivable_wkb").tobytes())
    if "beyond_wkb" in values:
        values["beyond_m"] = shapely.from_wkb(values.pop("beyond_wkb").tobytes())
    if "half_canopy" in values:
        values["half_canopy_m"] = float(values.pop("half_canopy")[0])
    return PlantGrid(
        frame=Frame(lon, lat, bearing_deg),
        drivable_m=area,
        in_rows=in_rows,
        **spacings,
        **values,
    )


def _field(db: sqlite3.Connection, arrays: dict[str, NDArray[Any]]) -> Field:
    boundary, name = db.execute("SELECT geom, name FROM plots").fetchone()
    places = {kind: geometry(geom) for kind, geom in db.execute("SELECT kind, geom FROM places")}
    gate = places.get("gate")
    values = zip(_STATED, arrays["stated"].tolist(), strict=True)
    stated: dict[str, Any] = {name: None if np.isnan(value) else value for name, value in values}
    measured = arrays.get("measured_lonlat")
    return Field(
        name,
        geometry(boundary),
        no_go=places.get("no-go", MultiPolygon()),
        gate=None if gate is None else (gate.x, gate.y),
        paths=places.get("path", MultiLineString()),
        plants=None if measured is None else measured.copy(),
        row_lines=places.get("row line", MultiLineString()),
        blocks=_blocks(arrays),
        in_rows=f"grid.{_IN_ROWS}" not in arrays,
        plant_rows=arrays.get("plant_rows"),
        plant_blocks=arrays.get("plant_blocks"),
        plant_names=arrays.get("plant_names"),
        **stated,
    )


def write_records(db: sqlite3.Connection, records: Records) -> None:
    """Keep pest records from before the season."""
    rows = zip(
        point_blobs(records.lonlat),
        records.present.tolist(),
        _dates(records.day),
        *(_known(column) for column in (records.count, records.accuracy_m)),
        records.species.tolist(),
        records.stage.tolist(),
        _known(records.leaves_sampled),
        strict=True,
    )
    insert(db, schema.RECORDS, list(rows))
    placed = records.lonlat[~np.isnan(records.lonlat).any(axis=1)]
    if len(placed):
        low, high = placed.min(axis=0).tolist(), placed.max(axis=0).tolist()
        touch(db, schema.RECORDS.name, (*low, *high))


def read_records(db: sqlite3.Connection) -> Records:
    """Return the pest records from before the season."""
    names = ", ".join(schema.RECORDS.names)
    rows = db.execute(f"SELECT {names} FROM observations ORDER BY fid").fetchall()  # noqa: S608 - names of ours
    if not rows:
        return Records.none()
    geom, present, day, count, accuracy, species, stage, leaves = zip(*rows, strict=True)
    lonlat = np.full((len(geom), 2), np.nan)  # the point of no position is empty
    placed, which = shapely.get_coordinates([geometry(one) for one in geom], return_index=True)
    lonlat[which] = placed
    return Records(
        lonlat,
        np.array(present, np.int8),
        np.array([np.datetime64(d or "NaT", "D") for d in day]),
        count=_floats(count),
        accuracy_m=_floats(accuracy),
        species=np.array(species, np.str_),
        stage=np.array(stage, np.str_),
        leaves_sampled=_floats(leaves),
    )


def write_messages(db: sqlite3.Connection, messages: Iterable[KeptMessage]) -> None:
    """Keep what imports had to say."""
    now = utc_text()
    rows = [(m.source, m.severity, m.feature, m.sentence, m.remedy, now) for m in messages]
    insert(db, schema.IMPORTS, rows)


def read_messages(db: sqlite3.Connection) -> tuple[KeptMessage, ...]:
    """Return what imports had to say."""
    wanted = "source, severity, feature, sentence, remedy"
    rows = db.execute(f"SELECT {wanted} FROM import_findings ORDER BY fid")  # noqa: S608 - as above
    return tuple(KeptMessage(*row) for row in rows)


def _dates(days: NDArray[np.datetime64]) -> list[str | None]:
    return [None if np.isnat(day) else str(day) for day in days]


def _known(values: NDArray[np.float64]) -> list[float | None]:
    return [None if np.isnan(value) else value for value in values.tolist()]


def _floats(values: Iterable[float | None]) -> NDArray[np.float64]:
    return np.array([np.nan if value is None else value for value in values], np.float64)
