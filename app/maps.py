"""Map layers of a plot. No Streamlit in here, and nothing that needs the internet."""

from __future__ import annotations

import base64
import io
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pydeck as pdk
import shapely
from PIL import Image
from pydeck.bindings.json_tools import default_serialize

from fieldmon.grid import row_label

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.field import Field, Observations
    from fieldmon.grid import PlantGrid
    from fieldmon.hotspots import HotSpots
    from fieldmon.route import Route

Colour = tuple[int, int, int]

# pale to dark, told apart without hue too
CHANCE_FROM = (0.0, 0.01, 0.02, 0.05, 0.10, 0.25, 0.50)
CHANCE_COLOURS: tuple[Colour, ...] = (
    *((255, 250, 220), (254, 227, 145), (254, 178, 76), (240, 120, 40), (210, 55, 30)),
    *((150, 10, 40), (70, 0, 30)),
)
FOUND: Colour = (213, 30, 30)
CLEAN: Colour = (90, 160, 230)
NEVER: Colour = (205, 205, 198)
TRUTH: Colour = (0, 0, 0)
ROUTE: Colour = (20, 80, 200)
GATE: Colour = (0, 140, 90)
HOT: Colour = (140, 40, 180)
OUTLINE: Colour = (70, 80, 70)

# more plants than this travel as one picture
POINTS_AT_MOST = 20_000
_PICTURE_AT_MOST = 2048
_ARROWS = 40
_NUMBERS = 24
_VIEW_PX, _PHONE_PX = (720, 480), (340, 380)
_TILE_PX = 512


class Deck(pdk.Deck):
    """A deck whose JSON is written without white space: half the size, several times the speed."""

    def to_json(self) -> str:
        """Return the deck as compact JSON."""
        return json.dumps(self, sort_keys=True, default=default_serialize, separators=(",", ":"))


@dataclass(frozen=True)
class Shade:
    """A colour for every plant, ``(n, 3)`` uint8, and its rank: higher ranks win a pixel."""

    colour: NDArray[np.uint8]
    rank: NDArray[np.int64]


def by_chance(chance: NDArray[np.float64]) -> Shade:
    """Return plants shaded by their chance of infestation, in the legend's classes."""
    rank = np.searchsorted(CHANCE_FROM, chance, side="right") - 1
    return Shade(np.array(CHANCE_COLOURS, np.uint8)[rank], rank)


def by_state(state: NDArray[np.int8]) -> Shade:
    """Return plants shaded as found (1), clean (0) or never inspected (-1)."""
    rank = state.astype(np.int64) + 1
    return Shade(np.array([NEVER, CLEAN, FOUND], np.uint8)[rank], rank)


def deck(grid: PlantGrid, layers: list[pdk.Layer], *, phone: bool = False) -> Deck:
    """Return the map of a plot; its first view depends on the plot and the device alone."""
    return Deck(
        layers=layers,
        initial_view_state=view(grid, phone=phone),
        map_provider=None,
        tooltip={"html": "{t}", "style": {"fontSize": "13px"}},
    )


def view(grid: PlantGrid, *, phone: bool = False) -> pdk.ViewState:
    """Return the view that holds the whole plot on a laptop's map, or on a phone's."""
    corners = grid.frame.lonlat(shapely.get_coordinates(grid.drivable_m))
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    low, high = (_mercator(lat) for lat in (south, north))
    size_px = _PHONE_PX if phone else _VIEW_PX
    room = [
        np.log2(360.0 * px * 0.85 / (_TILE_PX * span))
        for px, span in zip(size_px, (east - west, high - low), strict=True)
        if span > 0
    ]
    return pdk.ViewState(
        longitude=float((west + east) / 2),
        latitude=float((south + north) / 2),
        zoom=float(min([*room, 21.0])),
        max_zoom=24,
        bearing=0,
        pitch=0,
    )


def boundary(field: Field) -> pdk.Layer:
    """Return the plot's outline, holes and no-go areas."""
    rings = [
        {"path": np.round(shapely.get_coordinates(ring), 7).tolist()}
        for area in (field.boundary, field.no_go)
        for ring in shapely.get_rings(shapely.get_parts(area))
    ]
    return pdk.Layer(
        "PathLayer",
        rings,
        id="boundary",
        get_path="path",
        get_color=list(OUTLINE),
        get_width=0.5,
        width_min_pixels=1.5,
    )


def plants(grid: PlantGrid, shade: Shade, note: list[str]) -> pdk.Layer:
    """Return the plants: points with a note each, or one picture if there are very many."""
    if len(grid) > POINTS_AT_MOST:
        return _picture(grid, shade)
    label = row_label(grid)
    places = np.round(grid.lonlat(), 7).tolist()
    columns = zip(
        places, shade.colour.tolist(), label.line.tolist(), label.number.tolist(), note, strict=True
    )
    rows = [
        {"p": place, "c": colour, "t": f"row {line}, plant {number}<br>{text}"}
        for place, colour, line, number, text in columns
    ]
    return pdk.Layer(
        "ScatterplotLayer",
        rows,
        id="plants",
        get_position="p",
        get_fill_color="c",
        get_radius=0.4 * min(grid.plant_spacing_m, grid.row_spacing_m),
        radius_min_pixels=1.5,
        stroked=True,
        get_line_color=[120, 110, 90, 120],
        line_width_min_pixels=0.5,
        get_line_width=0.05,
        pickable=True,
    )


def _picture(grid: PlantGrid, shade: Shade) -> pdk.Layer:
    """Return the plants as one picture, the most important plant of each pixel on top."""
    low, high = grid.xy_m.min(axis=0), grid.xy_m.max(axis=0)
    step = np.array([grid.plant_spacing_m, grid.row_spacing_m])
    step = np.maximum(step, (high - low) / _PICTURE_AT_MOST)
    low, high = low - step / 2, high + step / 2
    wide, tall = np.ceil((high - low) / step).astype(int)
    column, line = np.floor((grid.xy_m - low) / step).astype(int).T
    image = np.zeros((tall, wide, 4), np.uint8)
    order = np.argsort(shade.rank, kind="stable")
    image[tall - 1 - line[order], column[order], :3] = shade.colour[order]
    image[tall - 1 - line[order], column[order], 3] = 255
    file = io.BytesIO()
    Image.fromarray(image).save(file, "PNG")
    right, top = low + step * [wide, tall]
    corners = [[low[0], low[1]], [low[0], top], [right, top], [right, low[1]]]
    uri = "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()
    return pdk.Layer(
        "BitmapLayer",
        None,
        id="plants",
        image=pdk.types.String(uri),
        bounds=grid.frame.lonlat(corners).tolist(),
        texture_parameters={"magFilter": "nearest", "minFilter": "nearest"},
    )


def route(the_route: Route, *, numbers: bool = True) -> list[pdk.Layer]:
    """Return the driven line with arrows in its direction, the gate, and stop numbers."""
    if not len(the_route):
        return []
    colour = list(ROUTE)
    line = np.round(the_route.line_lonlat(), 7).tolist()
    gate = the_route.aisles.grid.frame.lonlat(the_route.aisles.gate_m)[0].tolist()
    layers = [
        pdk.Layer(
            "PathLayer", [{"path": line}], id="route", get_path="path", get_color=[*colour, 190],
            get_width=0.5, width_min_pixels=1.5,
        ),
        pdk.Layer(
            "PolygonLayer", _arrows(the_route), id="arrows", get_polygon="p",
            get_fill_color=colour, stroked=False,
        ),
        pdk.Layer(
            "ScatterplotLayer", [{"p": gate, "t": "gate: start and end"}], id="gate",
            get_position="p", get_radius=3, radius_min_pixels=7, filled=False, stroked=True,
            get_line_color=list(GATE), line_width_min_pixels=3, pickable=True,
        ),
    ]  # fmt: skip
    return [*layers, *_numbers(the_route)] if numbers else layers


def _numbers(the_route: Route) -> list[pdk.Layer]:
    n = len(the_route)
    every = max(1, int(np.ceil(n / _NUMBERS)))
    shown = np.unique(np.append(np.arange(0, n, every), n - 1))
    here = np.round(the_route.stops_lonlat()[shown], 7).tolist()
    rows = [{"p": p, "n": str(k + 1)} for p, k in zip(here, shown.tolist(), strict=True)]
    return [
        pdk.Layer(
            "TextLayer", rows, id="numbers", get_position="p", get_text="n", get_size=12,
            get_color=[10, 30, 90], background=True, get_background_color=[255, 255, 255, 220],
            background_padding=[3, 1],
        )
    ]  # fmt: skip


def _arrows(the_route: Route) -> list[dict[str, Any]]:
    """Return triangles at even distances along the line, pointing the way it is driven."""
    line = the_route.line_m
    step = np.diff(line, axis=0)
    length = np.hypot(*step.T)
    way = np.append(0.0, np.cumsum(length))
    at = (np.arange(_ARROWS) + 0.5) / _ARROWS * way[-1]
    leg = np.searchsorted(way, at, side="right") - 1
    ahead = step[leg] / length[leg][:, None]
    left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    tip = line[leg] + ahead * (at - way[leg])[:, None]
    size = np.clip(np.hypot(*np.ptp(line, axis=0)) / 90.0, 0.4, 6.0)
    corners = np.stack(
        [tip + ahead * size, tip - ahead * size + left * size * 0.7,
         tip - ahead * size - left * size * 0.7], axis=1
    )  # fmt: skip
    frame = the_route.aisles.grid.frame
    lonlat = np.round(frame.lonlat(corners.reshape(-1, 2)), 7).reshape(-1, 3, 2)
    return [{"p": corner} for corner in lonlat.tolist()]


def hot(grid: PlantGrid, spots: HotSpots) -> list[pdk.Layer]:
    """Return the outline of each hot spot's plants."""
    if not len(spots):
        return []
    rows = []
    margin_m = 0.75 * max(grid.row_spacing_m, grid.plant_spacing_m)
    for k in range(len(spots)):
        own = shapely.multipoints(grid.xy_m[spots.of_plant == k])
        shape = grid.frame.geometry_lonlat(shapely.buffer(shapely.convex_hull(own), margin_m))
        corners = np.round(shapely.get_coordinates(shape.exterior), 7).tolist()
        text = f"hot spot: {spots.found[k]} found of {spots.inspected[k]} inspected"
        rows.append({"p": corners, "t": text})
    return [
        pdk.Layer(
            "PolygonLayer", rows, id="hot", get_polygon="p", filled=True,
            get_fill_color=[*HOT, 20], stroked=True, get_line_color=list(HOT),
            line_width_min_pixels=3, get_line_width=0.4, pickable=True,
        )
    ]  # fmt: skip


def records(observations: Observations) -> list[pdk.Layer]:
    """Return the records: filled where pests were seen, empty where not."""
    rows = [
        {
            "p": place,
            "c": [*HOT, 220 if seen == 1 else 0],
            "t": f"record of {day}: {'found' if seen == 1 else 'nothing' if seen == 0 else '?'}",
        }
        for place, seen, day in zip(
            np.round(observations.lonlat, 7).tolist(),
            observations.present.tolist(),
            observations.day.astype(str).tolist(),
            strict=True,
        )
    ]
    return [
        pdk.Layer(
            "ScatterplotLayer", rows, id="records", get_position="p", get_fill_color="c",
            get_radius=1.2, radius_min_pixels=3, stroked=True, get_line_color=[*HOT, 170],
            line_width_min_pixels=1, pickable=True,
        )
    ]  # fmt: skip


def truth(grid: PlantGrid, infested: NDArray[np.bool_]) -> list[pdk.Layer]:
    """Return dots on plants that are infested, as only a simulation can know."""
    here = np.round(grid.lonlat(np.flatnonzero(infested)), 7).tolist()
    return [
        pdk.Layer(
            "ScatterplotLayer", [{"p": p, "t": "infested"} for p in here], id="truth",
            get_position="p", get_fill_color=list(TRUTH), get_radius=0.5, radius_min_pixels=2,
        )
    ]  # fmt: skip


def scale(grid: PlantGrid) -> tuple[list[pdk.Layer], int]:
    """Return a bar of a round number of metres under the plot, and that number."""
    corners = grid.frame.lonlat(shapely.get_coordinates(grid.drivable_m))
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    metres_deg = 111_320.0 * np.cos(np.deg2rad((south + north) / 2))
    wide_m = (east - west) * metres_deg
    bar_m = max(b for b in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if b <= max(wide_m / 4, 1))
    y = south - (north - south) * 0.04
    ends = [[float(west), float(y)], [float(west + bar_m / metres_deg), float(y)]]
    middle = [(ends[0][0] + ends[1][0]) / 2, ends[0][1]]
    layers = [
        pdk.Layer(
            "PathLayer", [{"path": ends}], id="scale", get_path="path", get_color=[40, 40, 40],
            get_width=0.1, width_min_pixels=4,
        ),
        pdk.Layer(
            "TextLayer", [{"p": middle, "n": f"{bar_m} m"}], id="scale-text", get_position="p",
            get_text="n", get_size=13, get_color=[40, 40, 40], get_alignment_baseline="'top'",
            get_pixel_offset=[0, 6],
        ),
    ]  # fmt: skip
    return layers, bar_m


def legend(items: list[tuple[Colour, str]]) -> str:
    """Return coloured squares with their meaning, as HTML."""
    squares = "".join(
        f'<span style="white-space:nowrap;margin-right:14px"><span aria-hidden="true" '
        f'style="display:inline-block;width:14px;height:14px;border:1px solid #777;'
        f'vertical-align:-2px;margin-right:5px;background:rgb{colour}"></span>{text}</span>'
        for colour, text in items
    )
    return f'<div style="line-height:1.9">{squares}</div>'


def chance_legend() -> str:
    """Return the legend of the chance classes."""
    tops = [*CHANCE_FROM[1:], None]
    names = [
        f"{low * 100:g}-{high * 100:g} %" if high else f"over {low * 100:g} %"
        for low, high in zip(CHANCE_FROM, tops, strict=True)
    ]
    return legend(list(zip(CHANCE_COLOURS, names, strict=True)))


def _mercator(lat: float) -> float:
    return float(np.rad2deg(np.log(np.tan(np.pi / 4 + np.deg2rad(lat) / 2))))
