"""A plot that is drawn: its corners so far, kept as files are, and the file that they make."""

from __future__ import annotations

import json
import re
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING
from urllib.parse import unquote

import numpy as np
import shapely
import streamlit as st
from shapely import LineString, Polygon

from fieldmon.errors import SettingError
from fieldmon.io.options import Upload
from fieldmon.io.parse.degrees import positions_in_cells
from fieldmon.io.parse.geometry import LARGEST_M2, SMALLEST_M2, area_m2, steps_m
from fieldmon.plot.planting import Planting

from ..words import language, texts
from . import brought_files, plot_edits, plot_files, plot_source, row_settings, widget_memory
from .brought_files import BLOCKS, DRAWN, PLANTS, PLOT, ROWS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray
    from shapely.geometry.base import BaseGeometry

    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot

    from ..words.units import UnitsInLanguage
    from .plot_edits import Points

#: what the corners so far are kept as
CORNERS = "corners"
# both faces of a row stand in one place
_TWINS_M = 0.05
#: corners that a plot has
LEAST = 3
# a plot as wide as this is a slip of a finger, or two plots
_WIDEST_M = LARGEST_M2**0.5
_OPEN, _TURN = "draws a plot", "plot drawn anew"
_PLANTS_FILE, _ROWS_FILE, _BLOCKS_FILE = "plants.geojson", "rows.geojson", "blocks.geojson"
_NUMBER = r"(-?\d{1,3}(?:\.\d+)?)"
_PAIR = rf"(?:loc:)?{_NUMBER}[,~\s+]+{_NUMBER}"
# how maps on the internet write a position into an address, latitude first: a pin before the view
_IN_LINKS = (
    rf"!3d{_NUMBER}!4d{_NUMBER}",
    rf"[?&]mlat={_NUMBER}&mlon={_NUMBER}",
    rf"[?&](?:q|query|ll|coordinate|center|destination|daddr|viewpoint|cp)={_PAIR}",
    rf"[@/]{_NUMBER},[\s+]*{_NUMBER}",
    rf"#(?:map=)?[\d.]+/{_NUMBER}/{_NUMBER}",
    rf"^geo:{_NUMBER},{_NUMBER}",
)
_LONGITUDE_FIRST = re.compile(r"//[^/]*\byandex\.")


@dataclass(frozen=True)
class DrawnCorners:
    """What is drawn so far.

    Parameters
    ----------
    corners
        Lon/lat, in order.
    at
        The place that was found, lon/lat; None while none was.
    """

    corners: Points = ()
    at: tuple[float, float] | None = None


@dataclass(frozen=True)
class FoundPlace:
    """A position that was typed, lon/lat, and whether its order was sure."""

    lonlat: tuple[float, float]
    is_certain: bool


# -- the corners so far


def is_open() -> bool:
    """Return whether a plot is being drawn; corners without a plot are drawn on after a reload."""
    if plot_source.chosen() != plot_source.FILES:
        return False
    brought = brought_files.brought()
    return bool(st.session_state.get(_OPEN, CORNERS in brought and PLOT not in brought))


def begin() -> None:
    """Draw a plot, or go on with what was begun (for callbacks)."""
    st.session_state[_OPEN] = True


def correct() -> None:
    """Draw on at the plot that was drawn (for callbacks)."""
    keep(DrawnCorners(corners_of_plot()))
    drawn_anew()
    begin()


def leave() -> None:
    """Draw no more; what was begun waits, what was to be corrected stays as it was."""
    st.session_state[_OPEN] = False
    if corners_of_plot():
        brought_files.take_out(CORNERS)


def so_far() -> DrawnCorners:
    """Return what is drawn so far."""
    file = brought_files.brought().get(CORNERS)
    if file is None or not isinstance(file.source, Upload):
        return DrawnCorners()
    said = json.loads(file.source.data)
    return DrawnCorners(
        tuple((lon, lat) for lon, lat in said["corners"]), said["at"] and (*said["at"],)
    )


def keep(made: DrawnCorners) -> None:
    """Keep what is drawn so far, as files are kept, to the centimetre: a reload finds it."""
    data = json.dumps({"corners": _rounded(made.corners), "at": made.at}).encode()
    brought_files.keep_uploads(CORNERS, (Upload("corners.json", data),))


def turn() -> int:
    """Return what changes when corners were set elsewhere than on the map."""
    count: int = st.session_state.get(_TURN, 0)
    return count


def drawn_anew() -> None:
    """Let the map show the corners that are kept, whatever it held."""
    st.session_state[_TURN] = turn() + 1


# -- the plot they make


def use(units: UnitsInLanguage) -> None:
    """Let the plot be what is drawn, as if it had come in a file; raise `SettingError` if none."""
    corners = checked(so_far().corners, units)
    data = data_of_plot()
    before = None if data is None else brought_files.brought()[PLOT]
    name = texts.OUTLINE_NAME if data is None else _read(data)[1]
    brought_files.keep_uploads(PLOT, (Upload(DRAWN, geojson(corners, name)),))
    if before is not None:
        _carry(before.key, brought_files.brought()[PLOT].key)
    brought_files.take_out(CORNERS)
    st.session_state[_OPEN] = False


def bring(plot: Plot) -> None:
    """Let the plot be this one, as if it had come in files, with all that its rows were laid by.

    How wide its headlands are is not known of a season that an earlier version began.
    """
    field = plot.field
    brought_files.keep_uploads(PLOT, (Upload(DRAWN, _outline(field)),))
    _bring_plants_or_rows(field)
    _bring_blocks(field)
    key = plot_files.outline(plot_files.brought(), lambda *_: 0).key
    plot_files.draw(key, _drawn_on(field))
    row_settings.say(key, _said_of_rows(plot))


def _outline(field: Field) -> bytes:
    """Return the boundary of a plot as a GeoJSON file, as `geojson` makes it where it can."""
    parts = shapely.get_parts(field.boundary)
    if len(parts) == 1 and not parts[0].interiors:
        return geojson(tuple(parts[0].exterior.coords)[:-1], field.name)
    shape = shapely.geometry.mapping(field.boundary)
    feature = {"type": "Feature", "properties": {"name": field.name}, "geometry": shape}
    return json.dumps(feature, ensure_ascii=False).encode()


def _bring_plants_or_rows(field: Field) -> None:
    """Bring the measured plants of a plot and what they are called; else the rows drawn on it."""
    if (plants := field.plants) is not None:
        called = {"block": field.plant_blocks, "row": field.plant_rows, "plant": field.plant_names}
        columns = {kind: names.tolist() for kind, names in called.items() if names is not None}
        said = [{kind: names[k] for kind, names in columns.items()} for k in range(len(plants))]
        data = _features(shapely.points(plants.tolist()), said)
        brought_files.keep_uploads(PLANTS, (Upload(_PLANTS_FILE, data),))
    elif len(lines := shapely.get_parts(field.row_lines)):
        data = _features(lines, [{}] * len(lines))
        brought_files.keep_uploads(ROWS, (Upload(_ROWS_FILE, data),))


def _bring_blocks(field: Field) -> None:
    if field.blocks:
        stated = [{"name": one.name, "bearing": one.row_bearing_deg,
                   "row_spacing": one.row_spacing_m, "plant_spacing": one.plant_spacing_m}
                  for one in field.blocks]  # fmt: skip
        data = _features([block.area for block in field.blocks], stated)
        brought_files.keep_uploads(BLOCKS, (Upload(_BLOCKS_FILE, data),))


def _drawn_on(field: Field) -> tuple[plot_edits.Edit, ...]:
    """Return the gate, paths and no-go areas of a plot as if they had been drawn on it."""
    gate = [] if field.gate is None else [plot_edits.Edit(plot_edits.GATE, (field.gate,))]
    no_go = (area.exterior for area in shapely.get_parts(field.no_go))
    return (
        *gate,
        *(plot_edits.Edit(plot_edits.PATH, tuple(line.coords))
          for line in shapely.get_parts(field.paths)),
        *(plot_edits.Edit(plot_edits.NO_GO, tuple(ring.coords)) for ring in no_go),
    )  # fmt: skip


def _said_of_rows(plot: Plot) -> dict[str, float | bool]:
    """Return how a plot's rows were laid, as far as neither its files say it nor it was assumed."""
    field, grid = plot.field, plot.grid
    said: dict[str, float | bool] = {"both_faces": grid.has_faces}
    if grid.half_canopy_m is not None:
        said["half_canopy"] = grid.half_canopy_m
    if plot.headland_m not in {None, Planting().headland_m}:
        said["headland"] = plot.headland_m
    if field.plants is not None:
        return said | {"no_rows": not field.in_rows}
    assumed = {one.setting for one in plot.assumed}
    for name in ("row_spacing", "plant_spacing"):
        known = {getattr(one, f"{name}_m") for one in field.blocks}
        if f"{name}_m" not in assumed and (not known or None in known):
            # the rest is stated by its blocks; what is measured is within a centimetre
            said[name] = round(_laid_m(plot, f"{name}_m"), 2)
    if field.row_lines.is_empty and not field.blocks:
        said["row_bearing"] = grid.frame.bearing_deg % 360.0
    return said


def _laid_m(plot: Plot, name: str) -> float:
    """Return a spacing of the rows laid, of those in blocks that do not state it themselves."""
    field, grid = plot.field, plot.grid
    usual: float = getattr(grid, name)
    if not field.blocks:
        return usual
    unstated = [one.area for one in field.blocks if getattr(one, name) is None]
    lon, lat = grid.lonlat().T
    inside = shapely.contains_xy(shapely.union_all(unstated), lon, lat)
    rows = [grid.xy_m[one] for one in np.split(np.arange(len(grid)), grid.row_start[1:-1])
            if inside[one].all() and len(one) > 1]  # fmt: skip
    if name == "plant_spacing_m":
        apart = [np.hypot(*np.diff(row, axis=0).T) for row in rows]
    else:
        lines = [LineString(row) for row in rows]
        apart = [shapely.distance(shapely.points(row[len(row) // 2]), line)
                 for row, line in zip(rows, lines[1:], strict=False)]  # fmt: skip
    steps = np.concatenate([np.ravel(one) for one in apart]) if apart else np.zeros(0)
    steps = steps[steps > _TWINS_M]
    return float(np.median(steps)) if len(steps) else usual


def _features(shapes: Iterable[BaseGeometry], columns: Sequence[Mapping[str, object]]) -> bytes:
    """Return shapes with their columns as a GeoJSON file."""
    features = [
        {"type": "Feature", "properties": said, "geometry": shapely.geometry.mapping(shape)}
        for shape, said in zip(shapes, columns, strict=True)
    ]
    whole = {"type": "FeatureCollection", "features": features}
    return json.dumps(whole, ensure_ascii=False).encode()


def _carry(old: str, new: str) -> None:
    """Let what was said and drawn of the plot hold for the corrected one, too."""
    for key, value in list(st.session_state.items()):
        if str(key).startswith(("edits ", "answers ")) and old in str(key):
            st.session_state[str(key).replace(old, new)] = value
    widget_memory.carry(old, new)


def geojson(corners: Points, name: str) -> bytes:
    """Return a plot as a GeoJSON file, its corners in their order."""
    ring = _rounded(corners)
    shape = {"type": "Polygon", "coordinates": [[[*at] for at in (*ring, *ring[:1])]]}
    feature = {"type": "Feature", "properties": {"name": name}, "geometry": shape}
    return json.dumps(feature, ensure_ascii=False).encode()


def _rounded(corners: Points) -> Points:
    """Return corners to the centimetre, as files have them."""
    return tuple((round(lon, 7), round(lat, 7)) for lon, lat in corners)


def to_download() -> bytes | None:
    """Return the drawn plot's file for other programs: left of its outline lies the plot.

    Its first corner is the first one that was set.
    """
    data = data_of_plot()
    if data is None:
        return None
    corners, name = _read(data)
    ring = shapely.orient_polygons(Polygon(corners), exterior_cw=False).exterior
    return geojson(tuple((lon, lat) for lon, lat in ring.coords[:-1]), name)


def data_of_plot() -> bytes | None:
    """Return the plot's file if it was drawn here, or is as it would be; else None."""
    file = brought_files.brought().get(PLOT)
    if file is None or not isinstance(file.source, Upload):
        return None
    data = file.source.data
    with suppress(ValueError, KeyError, TypeError):  # any other file
        return data if geojson(*_read(data)) == data else None
    return None


def corners_of_plot() -> Points:
    """Return the corners of the plot if it was drawn here; none otherwise."""
    data = data_of_plot()
    return () if data is None else _read(data)[0]


def _read(data: bytes) -> tuple[Points, str]:
    """Return corners and name from a file as `geojson` makes it."""
    feature = json.loads(data)
    (ring,) = feature["geometry"]["coordinates"]
    return tuple((float(lon), float(lat)) for lon, lat in ring[:-1]), feature["properties"]["name"]


def distinct(corners: Points) -> Points:
    """Return corners, none twice in a row."""
    made = tuple(at for k, at in enumerate(corners) if not k or at != corners[k - 1])
    while len(made) > 1 and made[-1] == made[0]:
        made = made[:-1]
    return made


def checked(corners: Points, units: UnitsInLanguage) -> Points:
    """Return corners that can be a plot, none twice in a row; else raise `SettingError`."""
    made = distinct(corners)
    if len(made) < LEAST:
        raise SettingError(texts.OUTLINE_LEAST.format(n=len(made)))
    if (wide_m := _wide_m(made)) > _WIDEST_M:
        most, wide = units.metres(_WIDEST_M), units.metres(wide_m)
        raise SettingError(texts.OUTLINE_WIDE.format(most=most, wide=wide))
    if (met := crossing(made)) is not None:
        one, other = met
        raise SettingError(texts.OUTLINE_CROSSED.format(one=one + 1, other=other + 1))
    if area_m2(Polygon(made)) < SMALLEST_M2:
        raise SettingError(texts.OUTLINE_SMALL.format(n=len(made)))
    return made


def edges_m(corners: Points) -> NDArray[np.float64]:
    """Return how long the edges are, the last one back to the first corner."""
    closed = [*corners, *corners[:1]] if len(corners) > 2 else corners
    return steps_m(np.reshape(closed, (-1, 2)).astype(np.float64))


def drawn_area_m2(corners: Points) -> float:
    """Return the area that corners enclose; 0 while they enclose none, or cross."""
    if len(corners) < 3 or crossing(corners) is not None:
        return 0.0
    return area_m2(Polygon(corners))


def _wide_m(corners: Points) -> float:
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    return float(steps_m(np.stack([low, high]))[0])


def crossing(corners: Points) -> tuple[int, int] | None:
    """Return two edges that meet where they should not, each by the corner it begins at."""
    n = len(corners)
    edges = [LineString([at, corners[(k + 1) % n]]) for k, at in enumerate(corners)]
    for one, other in combinations(range(n), 2):
        if other - one in (1, n - 1):
            meets = edges[one].intersection(edges[other]).length > 0  # folded back on itself
        else:
            meets = edges[one].intersects(edges[other])
        if meets:
            return one, other
    return None


# -- positions as people have them


def place_of(text: str, *, longitude_first: bool = False) -> FoundPlace:
    """Return the position that is typed, or that a link to a map holds.

    `longitude_first` is how a pair is read of which nothing says so; a link is not opened.
    """
    text = text.strip()
    if "://" in text or text.startswith(("geo:", "www.")):
        found = _of_link(unquote(text))
    else:
        found = _typed(text, longitude_first=longitude_first)
    lon, lat = found.lonlat
    if not (abs(lon) <= 180 and abs(lat) <= 90):
        raise SettingError(texts.OUTLINE_RANGE.format(text=text[:80]))
    return found


def _of_link(link: str) -> FoundPlace:
    for pattern in _IN_LINKS:
        if found := re.search(pattern, link):
            lat, lon = (float(number) for number in found.groups())
            is_turned = _LONGITUDE_FIRST.search(link) is not None
            return FoundPlace((lat, lon) if is_turned else (lon, lat), is_certain=True)
    raise SettingError(texts.OUTLINE_LINK.format(text=link[:80]))


def _typed(text: str, *, longitude_first: bool) -> FoundPlace:
    cell = text
    if language.separators()[0] == "," and "." not in text:
        cell = text.replace(",", ".")
    read = positions_in_cells([cell.strip("()[] ")])
    lon, lat = read.values[0].tolist()
    if not np.isfinite([lon, lat]).all():
        raise SettingError(texts.OUTLINE_WRITTEN.format(text=text[:80]))
    found = FoundPlace((lon, lat), read.is_certain)
    if longitude_first and not found.is_certain:
        found = replace(found, lonlat=(lat, lon))
    return found
