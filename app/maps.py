"""Map layers of a plot. No Streamlit in here, and nothing that needs the internet."""

from __future__ import annotations

import base64
import io
import json
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import pydeck as pdk
import shapely
from PIL import Image
from pydeck.bindings.json_tools import default_serialize

from fieldmon.plot.grid import row_label

from . import texts

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.infestation.observations import Observations
    from fieldmon.planning.route import Route
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

    #: what is said of some plants, in words
    Notes = Callable[[NDArray[np.intp]], list[str]]

Colour = tuple[int, int, int]
Layer = pdk.Layer

# pale to dark, told apart without hue too
CHANCE_FROM = (0.0, 0.01, 0.02, 0.05, 0.10, 0.25, 0.50)
CHANCE_COLOURS: tuple[Colour, ...] = (
    *((255, 250, 220), (254, 227, 145), (254, 178, 76), (240, 120, 40), (210, 55, 30)),
    *((150, 10, 40), (70, 0, 30)),
)
FOUND: Colour = (213, 30, 30)
CLEAN: Colour = (90, 160, 230)
NEVER: Colour = (150, 150, 145)
TRUTH: Colour = (0, 0, 0)
TRUTH_IN_DARK: Colour = (255, 255, 255)
ROUTE: Colour = (20, 80, 200)
ROUTE_IN_DARK: Colour = (110, 220, 255)
GATE: Colour = (0, 140, 90)
HOT: Colour = (140, 40, 180)
HOT_IN_DARK: Colour = (205, 130, 255)
OUTLINE: Colour = (70, 80, 70)
OUTLINE_IN_DARK: Colour = (190, 200, 190)

# more plants than this travel as one picture
POINTS_AT_MOST = 20_000
_PICTURE_AT_MOST = 2048
_ARROWS = 40
_NUMBERS = 24
# how large a stop's number is, and how long the route on a small map
_NUMBER_PX, _ROUTE_PX = (30, 17), 300
#: room for a map, width and height: a whole page, most or half of it beside something else
PAGE_PX, MOST_PX, HALF_PX, PHONE_PX = (720, 480), (620, 480), (500, 480), (340, 380)
_TILE_PX = 512
# days since a plant was inspected: fresh is pale green, long ago is dark
AGE_FROM = (0, 1, 3, 7, 14)
AGE_COLOURS: tuple[Colour, ...] = (
    (217, 240, 163), (120, 198, 121), (49, 163, 84), (0, 104, 55), (0, 50, 30),
)  # fmt: skip
# after a layer's name: the same layer once more
RENAMED = "~"
_EMPTY = 30  # opacity of a plant that nobody looked at: an outline with next to nothing in it
# layers are not changed once made; their texts go when they do
_WRITTEN: WeakKeyDictionary[Layer, str] = WeakKeyDictionary()
# likewise for plots
_RASTERS: WeakKeyDictionary[PlantGrid, _Raster] = WeakKeyDictionary()


class Deck(pdk.Deck):
    """A deck whose JSON has no white space, and whose layers are written once each.

    Half the size and several times the speed; a layer that is shown again costs nothing.
    Layers in `renamed` have another id in the page: what was tapped on them is not selected there
    any more, and Streamlit no longer fades everything else.
    """

    renamed: frozenset[str] = frozenset()

    def to_json(self) -> str:
        """Return the deck as compact JSON."""
        layers, self.layers = self.layers, []
        try:
            frame = _json(self)
        finally:
            self.layers = layers
        texts = ",".join(self._named(layer) for layer in layers)
        return frame.replace('"layers":[]', f'"layers":[{texts}]', 1)

    def _named(self, layer: Layer) -> str:
        text, name = _layer_json(layer), json.dumps(layer.id)
        if layer.id not in self.renamed:
            return text
        return text.replace(f'"id":{name}', f'"id":{json.dumps(layer.id + RENAMED)}', 1)


def _layer_json(layer: Layer) -> str:
    text = _WRITTEN.get(layer)
    if text is None:
        text = _WRITTEN[layer] = _json(layer)
    return text


def _json(thing: object) -> str:
    return json.dumps(thing, sort_keys=True, default=default_serialize, separators=(",", ":"))


@dataclass(frozen=True)
class Shade:
    """A colour for every plant by its rank ``(n,)``; higher ranks win a pixel.

    ``table`` is ``(k, 4)`` uint8, a colour with its opacity for each rank.
    """

    table: NDArray[np.uint8]
    rank: NDArray[np.uint8]

    @classmethod
    def of(cls, colours: list[tuple[int, ...]], rank: NDArray[np.integer]) -> Shade:
        """Return the shade of these colours, a rank each; where no opacity is named, it is full."""
        table = np.array([(*c, 255) if len(c) == 3 else c for c in colours], np.uint8)
        return cls(table, rank.astype(np.uint8))


def by_chance(chance: NDArray[np.float64]) -> Shade:
    """Return plants shaded by their chance of infestation, in the legend's classes."""
    rank = np.searchsorted(CHANCE_FROM, chance, side="right") - 1
    return Shade.of([*CHANCE_COLOURS], rank)


def by_state(state: NDArray[np.int8]) -> Shade:
    """Return plants shaded as found (1), clean (0) or never inspected (-1: an empty ring)."""
    return Shade.of([(*NEVER, _EMPTY), CLEAN, FOUND], state + np.int8(1))


def by_age(days: NDArray[np.integer]) -> Shade:
    """Return plants shaded by the days since they were inspected; -1 (never): an empty ring."""
    rank = np.searchsorted(AGE_FROM, days, side="right")
    return Shade.of([(*NEVER, _EMPTY), *AGE_COLOURS], rank)


def plain(n: int) -> Shade:
    """Return n plants in one colour."""
    return Shade.of([(90, 150, 90)], np.zeros(n, np.uint8))


def unsaid(which: NDArray[np.intp]) -> list[str]:
    """Return nothing to say of each of these plants."""
    return [""] * len(which)


def deck(
    grid: PlantGrid, layers: list[Layer], room_px: tuple[int, int] = PAGE_PX
) -> Deck:  # fmt: skip
    """Return the map of a plot; its first view depends on the plot and the room for it alone."""
    return Deck(
        layers=layers,
        initial_view_state=view(
            grid.frame.lonlat(shapely.get_coordinates(grid.drivable_m)), room_px
        ),
        map_provider=None,
        tooltip={"html": "{t}", "style": {"fontSize": "13px"}},
    )


def outline(
    field: Field, room_px: tuple[int, int] = PAGE_PX, *, dark: bool = False
) -> Deck:  # fmt: skip
    """Return the map of a plot on which no plants are laid yet."""
    return Deck(
        layers=[boundary(field, dark=dark)],
        initial_view_state=view(shapely.get_coordinates(field.boundary), room_px),
        map_provider=None,
    )


def view(corners: NDArray[np.float64], room_px: tuple[int, int]) -> pdk.ViewState:
    """Return the view that holds corners ``(n, 2)`` lon/lat where there is so much room."""
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    low, high = (_mercator(lat) for lat in (south, north))
    room = [
        np.log2(360.0 * px * 0.85 / (_TILE_PX * span))
        for px, span in zip(room_px, (east - west, high - low), strict=True)
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


def boundary(field: Field, *, dark: bool = False) -> Layer:
    """Return the plot's outline, holes and no-go areas."""
    rings = [
        {"path": np.round(shapely.get_coordinates(ring), 7).tolist()}
        for area in (field.boundary, field.no_go)
        for ring in shapely.get_rings(shapely.get_parts(area))
    ]
    return Layer(
        "PathLayer",
        rings,
        id="boundary",
        get_path="path",
        get_color=list(OUTLINE_IN_DARK if dark else OUTLINE),
        get_width=0.5,
        width_min_pixels=1.5,
    )


def plants(
    grid: PlantGrid, shade: Shade, notes: Notes, part: NDArray[np.intp] | None = None
) -> Layer:
    """Return the plants: points with a note each, or one picture if there are very many.

    `part` names the plants to draw as points where the plot is too large to draw all.
    """
    if part is None and len(grid) > POINTS_AT_MOST:
        return _picture(grid, shade)
    which = np.arange(len(grid)) if part is None else part
    label = row_label(grid, which)
    columns = zip(
        np.round(grid.lonlat(which), 7).tolist(), shade.table[shade.rank[which]].tolist(),
        label.line.tolist(), label.number.tolist(), which.tolist(), notes(which), strict=True,
    )  # fmt: skip
    rows = [
        {
            "p": place,
            "c": colour,
            "i": plant,
            "t": texts.TIP_PLANT.format(row=line, plant=number, note=note),
        }
        for place, colour, line, number, plant, note in columns
    ]
    return Layer(
        "ScatterplotLayer",
        rows,
        id="plants" if part is None else "part",
        get_position="p",
        get_fill_color="c",
        get_radius=0.4 * min(grid.plant_spacing_m, grid.row_spacing_m),
        radius_min_pixels=1.5,
        stroked=True,
        get_line_color=[120, 110, 90, 140],
        line_width_min_pixels=0.5,
        get_line_width=0.05,
        pickable=True,
    )


def finds(grid: PlantGrid, state: NDArray[np.int8]) -> list[Layer]:
    """Return a dark ring with a pale rim round each find: told by shape, not by colour alone.

    Where finds stand close, the rings run together, but none covers a find.
    """
    here = np.round(grid.lonlat(np.flatnonzero(state == 1)), 7).tolist()
    least_m = min(grid.plant_spacing_m, grid.row_spacing_m)
    rings = [
        _ring(f"finds{k}", here, 0.55 * least_m, (colour, pixels))
        for k, (colour, pixels) in enumerate([((255, 255, 255), 4.5), ((20, 0, 0), 2.0)])
    ]
    dots = Layer(
        "ScatterplotLayer", [{"p": p} for p in here], id="found", get_position="p",
        get_fill_color=list(FOUND), get_radius=0.4 * least_m, radius_min_pixels=2,
    )  # fmt: skip
    return [*rings, dots]


def chosen(grid: PlantGrid, plant: int) -> list[Layer]:
    """Return a broad yellow ring with a dark rim round the plant whose history is shown."""
    here = np.round(grid.lonlat(np.array([plant])), 7).tolist()
    size = 0.9 * min(grid.plant_spacing_m, grid.row_spacing_m)
    return [
        _ring(f"chosen{k}", here, size, pen, 9.0)
        for k, pen in enumerate([((40, 30, 0), 6.5), ((255, 190, 0), 4.0)])
    ]


def _ring(
    name: str,
    places: list[list[float]],
    size_m: float,
    pen: tuple[Colour, float],
    least_px: float = 4.5,
) -> Layer:
    colour, pixels = pen
    return Layer(
        "ScatterplotLayer", [{"p": p} for p in places], id=name, get_position="p",
        get_radius=size_m, radius_min_pixels=least_px, filled=False, stroked=True,
        get_line_color=list(colour), line_width_min_pixels=pixels, get_line_width=0.05,
    )  # fmt: skip


class _Raster(NamedTuple):
    """A picture of a plot: its size, its corners lon/lat, and the pixel of each plant ``(n,)``."""

    tall: int
    wide: int
    corners: list[list[float]]
    pixel: NDArray[np.intp]


def _raster(grid: PlantGrid) -> _Raster:
    kept = _RASTERS.get(grid)
    if kept is not None:
        return kept
    low, high = grid.xy_m.min(axis=0), grid.xy_m.max(axis=0)
    step = np.array([grid.plant_spacing_m, grid.row_spacing_m])
    step = np.maximum(step, (high - low) / _PICTURE_AT_MOST)
    low, high = low - step / 2, high + step / 2
    wide, tall = np.ceil((high - low) / step).astype(int).tolist()
    column, line = np.floor((grid.xy_m - low) / step).astype(np.intp).T
    right, top = low + step * [wide, tall]
    corners = [[low[0], low[1]], [low[0], top], [right, top], [right, low[1]]]
    lonlat = grid.frame.lonlat(corners).tolist()
    _RASTERS[grid] = _Raster(tall, wide, lonlat, (tall - 1 - line) * wide + column)
    return _RASTERS[grid]


def _picture(grid: PlantGrid, shade: Shade) -> Layer:
    """Return the plants as one picture, the most important plant of each pixel on top."""
    raster = _raster(grid)
    # one number a pixel, looked up in a table of colours; 0 is the ground between plants
    pixels = np.zeros(raster.tall * raster.wide, np.uint8)
    np.maximum.at(pixels, raster.pixel, shade.rank + np.uint8(1))
    image = Image.fromarray(pixels.reshape(raster.tall, raster.wide))
    image.putpalette(bytes(3) + shade.table[:, :3].tobytes())
    file = io.BytesIO()
    # rows are runs of one colour: looked for as such, they pack as well as at the highest level
    opacity = bytes(1) + shade.table[:, 3].tobytes()
    image.save(file, "PNG", transparency=opacity, compress_type=zlib.Z_RLE)
    uri = "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()
    return Layer(
        "BitmapLayer",
        None,
        id="plants",
        image=pdk.types.String(uri),
        bounds=raster.corners,
        texture_parameters={"magFilter": "nearest", "minFilter": "nearest"},
    )


def route(the_route: Route, *, numbers: bool = True, dark: bool = False) -> list[Layer]:
    """Return the driven line with arrows in its direction, the gate, and stop numbers."""
    if not len(the_route):
        return []
    colour = list(ROUTE_IN_DARK if dark else ROUTE)
    line = np.round(the_route.line_lonlat(), 7).tolist()
    gate = the_route.aisles.grid.frame.lonlat(the_route.aisles.gate_m)[0].tolist()
    layers = [
        Layer(
            "PathLayer", [{"path": line}], id="route", get_path="path", get_color=[*colour, 190],
            get_width=0.5, width_min_pixels=1.5,
        ),
        Layer(
            "PolygonLayer", _arrows(the_route), id="arrows", get_polygon="p",
            get_fill_color=colour, stroked=False,
        ),
        Layer(
            "ScatterplotLayer", [{"p": gate, "t": texts.TIP_GATE}], id="gate",
            get_position="p", get_radius=3, radius_min_pixels=7, filled=False, stroked=True,
            get_line_color=list(GATE), line_width_min_pixels=3, pickable=True,
        ),
    ]  # fmt: skip
    return [*layers, *_numbers(the_route)] if numbers else layers


def _numbers(the_route: Route) -> list[Layer]:
    n = len(the_route)
    every = max(1, int(np.ceil(n / _NUMBERS)))
    lonlat = the_route.stops_lonlat()
    span = np.ptp(lonlat, axis=0)
    # as wide and as high as a number where the whole route is in view, in degrees
    flat = np.cos(np.radians(lonlat[0, 1]))
    room = max(span[0] * flat, span[1]) / _ROUTE_PX * np.array(_NUMBER_PX) / [flat, 1.0]
    shown: list[int] = []
    for k in (0, n - 1, *range(every, n - 1, every)):
        if k not in shown and not (np.abs(lonlat[shown] - lonlat[k]) < room).all(axis=1).any():
            shown.append(k)
    here = np.round(lonlat[shown], 7).tolist()
    rows = [{"p": p, "n": str(k + 1)} for p, k in zip(here, shown, strict=True)]
    return [
        Layer(
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


def hot(grid: PlantGrid, spots: HotSpots, *, dark: bool = False) -> list[Layer]:
    """Return the hot spots, if there are any: their tint, and their outlines."""
    if not len(spots):
        return []
    rows = []
    margin_m = 0.75 * max(grid.row_spacing_m, grid.plant_spacing_m)
    inside = np.flatnonzero(spots.of_plant >= 0)
    for k in range(len(spots)):
        own = shapely.multipoints(grid.xy_m[inside[spots.of_plant[inside] == k]])
        shape = grid.frame.geometry_lonlat(shapely.buffer(shapely.convex_hull(own), margin_m))
        corners = np.round(shapely.get_coordinates(shape.exterior), 7).tolist()
        text = texts.TIP_HOT.format(found=spots.found[k], inspected=spots.inspected[k])
        rows.append({"p": corners, "t": text})
    colour = HOT_IN_DARK if dark else HOT
    return [
        Layer("PolygonLayer", rows, id="hot", get_polygon="p", get_fill_color=[*colour, 20],
              stroked=False, pickable=True),
        Layer("PathLayer", rows, id="hot-edge", get_path="p", get_color=list(colour),
              width_min_pixels=3, get_width=0.4),
    ]  # fmt: skip


def with_hot(layers: list[Layer], spots: list[Layer]) -> list[Layer]:
    """Return the layers with hot spots outlined, their tint under plants that can be tapped."""
    points = [k for k, layer in enumerate(layers) if layer.type == "ScatterplotLayer"]
    under = min([*points, len(layers)])
    return [*layers[:under], *spots[:1], *layers[under:], *spots[1:]]


def paths(field: Field) -> list[Layer]:
    """Return the paths along which insects come in."""
    rows = [
        {"path": np.round(shapely.get_coordinates(line), 7).tolist(), "t": texts.TIP_PATH}
        for line in shapely.get_parts(field.paths)
    ]
    return [
        Layer("PathLayer", rows, id="paths", get_path="path", get_color=[150, 110, 60, 160],
              get_width=1.0, width_min_pixels=2)
    ]  # fmt: skip


def records(observations: Observations, *, dark: bool = False) -> list[Layer]:
    """Return the records: filled where pests were seen, empty where not."""
    colour = HOT_IN_DARK if dark else HOT
    rows = [
        {
            "p": place,
            "c": [*colour, 220 if seen == 1 else 0],
            "t": texts.TIP_RECORD.format(day=day, result=texts.TIP_SEEN.get(seen, "?")),
        }
        for place, seen, day in zip(
            np.round(observations.lonlat, 7).tolist(),
            observations.present.tolist(),
            observations.day.astype(str).tolist(),
            strict=True,
        )
    ]
    return [
        Layer(
            "ScatterplotLayer", rows, id="records", get_position="p", get_fill_color="c",
            get_radius=1.2, radius_min_pixels=3, stroked=True, get_line_color=[*colour, 170],
            line_width_min_pixels=1, pickable=True,
        )
    ]  # fmt: skip


def truth(grid: PlantGrid, infested: NDArray[np.bool_], *, dark: bool = False) -> list[Layer]:
    """Return dots on plants that are infested, as only a simulation can know."""
    here = np.round(grid.lonlat(np.flatnonzero(infested)), 7).tolist()
    return [
        Layer(
            "ScatterplotLayer", [{"p": p, "t": texts.TIP_INFESTED} for p in here], id="truth",
            get_position="p", get_fill_color=list(TRUTH_IN_DARK if dark else TRUTH),
            get_radius=0.5, radius_min_pixels=2,
        )
    ]  # fmt: skip


def playback(the_route: Route, second: float, *, dark: bool = False) -> list[Layer]:
    """Return the line driven up to a second of the day, the stops made, and the robot."""
    if not len(the_route):
        return []
    line, at_s = the_route.line_lonlat(), the_route.line_s
    gone = int(np.searchsorted(at_s, second, side="right"))
    here = [float(np.interp(second, at_s, line[:, axis])) for axis in (0, 1)]
    path = [*np.round(line[:gone], 7).tolist(), here]
    done = the_route.leave_s <= second
    colour = ROUTE_IN_DARK if dark else ROUTE
    stops = np.round(the_route.stops_lonlat()[done], 7).tolist()
    return [
        Layer(
            "PathLayer", [{"path": path}], id="trail", get_path="path",
            get_color=[*colour, 230], get_width=0.6, width_min_pixels=2.5,
        ),
        Layer(
            "ScatterplotLayer", [{"p": p} for p in stops], id="stops", get_position="p",
            get_fill_color=[*colour, 150], get_radius=0.5, radius_min_pixels=2,
        ),
        Layer(
            "ScatterplotLayer", [{"p": here, "t": texts.TIP_HERE}], id="robot", get_position="p",
            get_fill_color=[255, 210, 0], get_radius=1.5, radius_min_pixels=8, stroked=True,
            get_line_color=[0, 0, 0], line_width_min_pixels=3, pickable=True,
        ),
    ]  # fmt: skip


def places(lonlat: list[list[float]], name: str, colour: Colour, note: str) -> Layer:
    """Return large rings about some positions: where one stands, what was tapped."""
    rows = [{"p": p, "t": note} for p in lonlat]
    return Layer(
        "ScatterplotLayer", rows, id=name, get_position="p", get_radius=1.5, radius_min_pixels=11,
        filled=True, get_fill_color=[*colour, 60], stroked=True, get_line_color=list(colour),
        line_width_min_pixels=4, pickable=True,
    )  # fmt: skip


def drawing(points: tuple[tuple[float, float], ...]) -> list[Layer]:
    """Return what is being drawn: its corners so far, joined."""
    here = [list(point) for point in points]
    return [
        Layer(
            "PathLayer", [{"path": here}] if len(here) > 1 else [], id="drawing", get_path="path",
            get_color=list(GATE), width_min_pixels=3, get_width=0.4,
        ),
        places(here, "corners", GATE, texts.TIP_CORNER),
    ]  # fmt: skip


def backdrop(uri: str, corners: list[list[float]]) -> Layer:
    """Return a picture of the ground; corners from lower left over upper left, lon/lat."""
    return Layer(
        "BitmapLayer", None, id="backdrop", image=pdk.types.String(uri), bounds=corners,
        opacity=0.8,
    )  # fmt: skip


def legend(items: list[tuple[Colour, str]], *, signs: tuple[str, ...] = ()) -> str:
    """Return signs with their meaning, as HTML: squares, or ``"ring"``, ``"dot"``, ``"find"``."""
    kinds = signs or ("square",) * len(items)
    parts = "".join(
        f'<span style="white-space:nowrap;margin-right:14px">{_sign(kind, colour)}{text}</span>'
        for kind, (colour, text) in zip(kinds, items, strict=True)
    )
    return f'<div style="line-height:1.9">{parts}</div>'


def _sign(kind: str, colour: Colour) -> str:
    shapes = {
        "square": f'<rect x="1" y="1" width="14" height="14" fill="rgb{colour}" stroke="#777"/>',
        "dot": f'<circle cx="8" cy="8" r="5" fill="rgb{colour}" stroke="#777"/>',
        "ring": f'<circle cx="8" cy="8" r="5" fill="none" stroke="rgb{colour}" stroke-width="2"/>',
        "find": f'<circle cx="8" cy="8" r="6.5" fill="#fff" stroke="#140000" stroke-width="2"/>'
        f'<circle cx="8" cy="8" r="4" fill="rgb{colour}"/>',
        "line": f'<rect x="0" y="6" width="16" height="4" fill="rgb{colour}"/>',
        "outline": f'<rect x="2" y="2" width="12" height="12" rx="4" fill="none" '
        f'stroke="rgb{colour}" stroke-width="3"/>',
    }
    return (
        '<svg width="16" height="16" aria-hidden="true" '
        f'style="vertical-align:-3px;margin-right:5px">{shapes[kind]}</svg>'
    )


def state_legend(names: dict[str, str]) -> str:
    """Return the legend of the three states."""
    items = [(FOUND, names["found"]), (CLEAN, names["clean"]), (NEVER, names["never"])]
    return legend(items, signs=("find", "dot", "ring"))


def age_legend(never: str, days: str) -> str:
    """Return the legend of the days since the last inspection."""
    tops = [*AGE_FROM[1:], None]
    names = [
        days.format(n=f"{low}-{top - 1}" if top and top - 1 > low else f"{low}" if top
                    else f"{low}+")
        for low, top in zip(AGE_FROM, tops, strict=True)
    ]  # fmt: skip
    items = [*zip(AGE_COLOURS, names, strict=True), (NEVER, never)]
    return legend(items, signs=("square",) * len(names) + ("ring",))


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
