"""The plot drawn for paper: plants by chance, finds, hot spots, route, rows, scale, north."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.infestation.hotspots import outlines_m
from fieldmon.infestation.records import PRESENT
from fieldmon.plot.grid import before_rows
from fieldmon.reports import colours, words
from fieldmon.reports.drawing import (
    Areas,
    Bitmap,
    Discs,
    Drawing,
    Lettering,
    Part,
    Segments,
    Strokes,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.compute.units import Units
    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.reports.content import Size
    from fieldmon.reports.drawing import Colour

    Floats = NDArray[np.float64]

#: of more plants, a picture instead of lines
MOST_LINES = 20_000
_MARGIN_MM, _FOOT_MM = 5.0, 8.0
_DOTS_PER_MM = 10.0
# between the margins of A4
_PAGE_MM = 186.0
# a map turned from the north must gain so much size by it
_TURNED_GAINS = 1.25
# plants this far apart on paper stand alone; closer ones of one colour run together
_ALONE_MM = 1.2
# more zones would hide each other
_MOST_NUMBERS = 60
_THREE_DIGITS = 100
_LEGEND_MM = 8.0
_ARROWS_MM, _MOST_STOPS = 24.0, 400


@dataclass(frozen=True, eq=False)
class PlotMap:
    """What a map on paper shows.

    Parameters
    ----------
    grid
        The plants.
    chance, state
        ``(n,)`` chance of infestation, and found (1), clean (0) or never inspected (-1).
    spots
        Where finds cluster.
    gate_m
        ``(2,)`` where days begin.
    units
        Of the scale bar.
    route
        The way that is shown; None: none.
    by_state
        Whether plants are coloured by what was found there instead of by chance.
    zones_m
        Areas to be sprayed, metres of the plot.
    recorded
        ``(n,)`` other finds, known from records of before the season; None: none.
    passed
        ``(n,)`` plants that could not be inspected, or are gone; None: none.
    """

    grid: PlantGrid
    chance: Floats
    state: NDArray[np.int8]
    spots: HotSpots
    gate_m: Floats
    units: Units
    route: Route | None = None
    by_state: bool = False
    zones_m: tuple[MultiPolygon, ...] = ()
    recorded: NDArray[np.bool_] | None = None
    passed: NDArray[np.bool_] | None = None

    @property
    def rank(self) -> NDArray[np.intp]:
        """Class of each plant, ``(n,)``; of two in one place the higher is seen."""
        return self.state.astype(np.intp) + 1 if self.by_state else colours.ranks(self.chance)

    @property
    def palette(self) -> tuple[Colour, ...]:
        """Colour of each class."""
        return colours.STATES if self.by_state else colours.CHANCE

    def heights(self, least: float, most: float) -> tuple[float, float]:
        """Return the least and the most millimetres that the map is worth across a page."""
        placed = _fitted(self.grid, self.gate_m, (_PAGE_MM, most))
        needed = float(np.ptp(placed(_hull(self.grid, self.gate_m))[:, 1])) + _MARGIN_MM + _FOOT_MM
        return min(least, needed), min(most, needed)

    def draw(self, size: Size) -> Drawing:
        """Return the map on so much paper."""
        placed = _fitted(self.grid, self.gate_m, size)
        parts = [
            *_ground(self.grid, placed),
            *_plants(self, placed, size),
            *_hot(self, placed),
            *_sprayed(self, placed),
            *([] if self.route is None else _way(self.route, placed)),
            *_passed(self, placed),
            *_finds(self, placed),
            *_gate(self.gate_m, placed),
            *_row_numbers(self.grid, placed),
            *_hot_numbers(self, placed),
            *_scale(self.units, placed, size),
            *_north(self.grid, placed, size),
        ]
        return Drawing(*size, tuple(parts))


@dataclass(frozen=True, eq=False)
class _ToPaper:
    """From metres of the plot to millimetres of paper: turned, mirrored, scaled, moved."""

    turn: Floats
    scale: float
    corner: Floats

    def __call__(self, xy_m: Floats) -> Floats:
        placed: Floats = np.atleast_2d(xy_m) @ self.turn * self.scale + self.corner
        return placed


def _turn(angle: float) -> Floats:
    """Return what turns places by an angle and lets y run downwards."""
    return np.array([[np.cos(angle), -np.sin(angle)], [-np.sin(angle), -np.cos(angle)]])


def _northward(grid: PlantGrid) -> Floats:
    """Return the direction of true north in the plot's frame, ``(2,)``."""
    frame = grid.frame
    here = np.array([[frame.lon, frame.lat], [frame.lon, frame.lat + 1e-4]])
    step = np.diff(frame.xy_m(here), axis=0)[0]
    north: Floats = step / np.hypot(*step)
    return north


def _fitted(grid: PlantGrid, gate_m: Floats, size: Size) -> _ToPaper:
    """Return how the plot comes on paper: north up, unless it is much larger turned to its rows."""
    north = _northward(grid)
    upright = np.pi / 2 - np.arctan2(north[1], north[0])
    square = [0.0, np.pi / 2, np.pi, -np.pi / 2]
    # of two opposite ways, the one on which north is above
    along = [one for one in square if (north @ _turn(one))[1] < 1e-9][:2]
    hull = _hull(grid, gate_m)
    room = np.array(size) - [2 * _MARGIN_MM, _MARGIN_MM + _FOOT_MM]
    ways = []
    for angle in (upright, *along):
        flat = hull @ _turn(angle)
        low, span = flat.min(axis=0), np.maximum(np.ptp(flat, axis=0), 1.0)
        scale = float((room / span).min())
        corner = [_MARGIN_MM, _MARGIN_MM] + (room - span * scale) / 2 - low * scale
        ways.append(_ToPaper(_turn(angle), scale, corner))
    best = max(ways, key=lambda way: way.scale)
    return best if best.scale > _TURNED_GAINS * ways[0].scale else ways[0]


def _hull(grid: PlantGrid, gate_m: Floats) -> Floats:
    """Return places that hold all that a map shows between them."""
    corners: Floats = shapely.get_coordinates(grid.drivable_m)
    return np.concatenate([corners, gate_m[None], grid.xy_m[:1]])


def _ground(grid: PlantGrid, placed: _ToPaper) -> list[Part]:
    rings = shapely.get_rings(shapely.get_parts(grid.drivable_m))
    corners = tuple(placed(shapely.get_coordinates(ring)) for ring in rings)
    return [Areas(corners, fill=colours.GROUND, edge=colours.SOFT, width=0.3)]


def _plants(what: PlotMap, placed: _ToPaper, size: Size) -> list[Part]:
    """Return the plants by chance, likelier ones over others: lines, or a picture of very many."""
    if len(what.grid) > MOST_LINES:
        return [Bitmap(0.0, 0.0, *size, _picture(what, placed, size))]
    ends_m, of_rank = _runs(what.grid, what.rank, placed)
    ends = np.concatenate([placed(ends_m[:, :2]), placed(ends_m[:, 2:])], axis=1)
    width = _plant_width(what.grid, placed)
    return [
        Segments(ends[of_rank == one], what.palette[one], width)
        for one in np.unique(of_rank).tolist()
    ]


def _plant_width(grid: PlantGrid, placed: _ToPaper) -> float:
    return max(0.6 * grid.row_spacing_m * placed.scale, 0.15)


def _runs(
    grid: PlantGrid, rank: NDArray[np.intp], placed: _ToPaper
) -> tuple[Floats, NDArray[np.intp]]:
    """Return lines ``(k, 4)`` along the rows, metres, and their classes ``(k,)``.

    Each plant is one; side by side of one class they are one together, where dots would blur.
    """
    apart_m = grid.plant_spacing_m
    alone = apart_m * placed.scale >= _ALONE_MM
    half_m = (0.4 if alone else 0.5) * apart_m
    x, y = grid.xy_m.T
    new = np.ones(len(grid), bool)
    if not alone:
        same = (np.diff(grid.row) == 0) & (np.diff(rank) == 0)
        new[1:] = ~(same & (np.diff(x) < 1.6 * apart_m) & (np.abs(np.diff(y)) < apart_m / 4))
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(grid)) - 1
    return np.stack([x[first] - half_m, y[first], x[last] + half_m, y[last]], axis=1), rank[first]


def _picture(what: PlotMap, placed: _ToPaper, size: Size) -> bytes:
    """Return the plants as a PNG; the likeliest plant wins a dot."""
    from PIL import Image  # noqa: PLC0415 - only for very many plants

    grid, rank = what.grid, what.rank
    wide, high = (round(side * _DOTS_PER_MM) for side in size)
    top = np.zeros((high, wide), np.uint8)
    per_m = placed.scale * _DOTS_PER_MM
    steps = [
        np.linspace(-half, half, max(int(np.ceil(2 * half * per_m)) + 1, 2))
        for half in (0.5 * grid.plant_spacing_m, 0.3 * grid.row_spacing_m)
    ]
    for dx in steps[0].tolist():
        for dy in steps[1].tolist():
            at = (placed(grid.xy_m + np.array([dx, dy])) * _DOTS_PER_MM).astype(np.int64)
            column, row = at[:, 0].clip(0, wide - 1), at[:, 1].clip(0, high - 1)
            np.maximum.at(top, (row, column), (rank + 1).astype(np.uint8))
    palette = np.array([(0, 0, 0, 0), *((*one, 255) for one in what.palette)], np.uint8)
    file = io.BytesIO()
    Image.fromarray(palette[top]).save(file, "PNG", optimize=False)
    return file.getvalue()


def _hot(what: PlotMap, placed: _ToPaper) -> list[Part]:
    rings = tuple(
        placed(shapely.get_coordinates(shape.exterior))
        for shape in outlines_m(what.grid, what.spots)
    )
    lines = Strokes(rings, colours.PAPER, 1.3), Strokes(rings, colours.INK, 0.55)
    return [*lines] if rings else []


def _sprayed(what: PlotMap, placed: _ToPaper) -> list[Part]:
    """Return the outlines of the zones, each with its number in its middle."""
    rings = tuple(
        placed(shapely.get_coordinates(part.exterior))
        for area in what.zones_m
        for part in shapely.get_parts(area)
    )
    if not rings:
        return []
    parts: list[Part] = [
        Strokes(rings, colours.PAPER, 1.3),
        Strokes(rings, colours.INK, 0.7, dashed=True),
    ]
    for number, area in enumerate(what.zones_m[:_MOST_NUMBERS], start=1):
        ((x, y),) = placed(shapely.get_coordinates(area.representative_point())).tolist()
        parts += [
            Discs(np.array([[x, y]]), 2.0, fill=colours.PAPER, edge=colours.INK, width=0.3),
            Lettering(x, y, f"{number}", 7.5, colours.INK, "middle", bold=True),
        ]
    return parts


def _hot_numbers(what: PlotMap, placed: _ToPaper) -> list[Part]:
    """Return the number of each hot spot at the upper left of its outline, where it has room."""
    parts: list[Part] = []
    taken = np.empty((0, 3))
    for number, shape in enumerate(outlines_m(what.grid, what.spots), start=1):
        corners = placed(shapely.get_coordinates(shape.exterior))
        x, y = corners[np.argmin(corners.sum(axis=1))].tolist()
        radius = 2.0 if number < _THREE_DIGITS else 2.6
        # the surest has its number: one over another can neither be read
        if (np.hypot(taken[:, 0] - x, taken[:, 1] - y) < taken[:, 2] + radius).any():
            continue
        taken = np.vstack([taken, (x, y, radius)])
        parts += [
            Discs(np.array([[x, y]]), radius, fill=colours.INK, edge=colours.PAPER, width=0.3),
            Lettering(x, y, f"{number}", 7.5, colours.PAPER, "middle", bold=True),
        ]
    return parts


def _way(route: Route, placed: _ToPaper) -> list[Part]:
    """Return the route with its stops and arrows that show where it goes."""
    if len(route.line_m) < 2:
        return []
    line = placed(route.line_m)
    parts: list[Part] = [
        Strokes((line,), colours.PAPER, 0.95),
        Strokes((line,), colours.ROUTE, 0.45),
    ]
    if len(route) <= _MOST_STOPS:
        stops = placed(route.aisles.grid.xy_m[route.plant])
        parts.append(
            Discs(stops, 0.55, fill=colours.PAPER, edge=colours.ROUTE, width=0.25),
        )
    return [*parts, *_arrows(line)]


def _arrows(line: Floats) -> list[Part]:
    step = np.diff(line, axis=0)
    length = np.hypot(*step.T)
    way = np.append(0.0, np.cumsum(length))
    every = max(_ARROWS_MM, way[-1] / 60)
    at = np.arange(every / 2, way[-1], every)
    at = at[at < way[-1]]  # rounding may bring one more
    leg = np.searchsorted(way, at, side="right") - 1
    ahead = step[leg] / length[leg][:, None]
    place = line[leg] + ahead * (at - way[leg])[:, None]
    aside = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    tips = np.stack([place + 1.5 * ahead, place - ahead + aside, place - ahead - aside], axis=1)
    return [Areas((tip,), fill=colours.ROUTE, edge=colours.PAPER, width=0.2) for tip in tips]


def _sign_radius(what: PlotMap, placed: _ToPaper) -> float:
    return float(np.clip(0.35 * what.grid.row_spacing_m * placed.scale, 0.55, 1.3))


def _passed(what: PlotMap, placed: _ToPaper) -> list[Part]:
    """Return the plants that could not be inspected, or are gone, and were never found or clean."""
    if what.passed is None or not what.passed.any():
        return []
    places = placed(what.grid.xy_m[what.passed])
    return [_not_inspected(places, _sign_radius(what, placed))]


def _not_inspected(places: Floats, radius: float) -> Part:
    return Discs(places, radius, fill=colours.NOT_INSPECTED, edge=colours.PAPER, width=0.2)


def _finds(what: PlotMap, placed: _ToPaper) -> list[Part]:
    radius = _sign_radius(what, placed)
    parts: list[Part] = []
    if what.recorded is not None and what.recorded.any():
        parts.append(_recorded(placed(what.grid.xy_m[what.recorded]), radius))
    if (found := what.state == PRESENT).any():
        places = placed(what.grid.xy_m[found])
        parts += [
            Discs(places, radius + 0.25, fill=colours.PAPER),
            Discs(places, radius, fill=colours.FOUND, edge=colours.INK, width=0.2),
        ]
    return parts


def _recorded(places: Floats, radius: float) -> Part:
    """Return the sign of finds that only records tell of: hollow."""
    return Discs(places, radius, fill=colours.PAPER, edge=colours.FOUND, width=0.35)


def _gate(gate_m: Floats, placed: _ToPaper) -> list[Part]:
    place = placed(gate_m)
    return [
        Discs(place, 1.9, fill=colours.PAPER),
        Discs(place, 1.4, edge=colours.GATE, width=0.9),
    ]


def _row_numbers(grid: PlantGrid, placed: _ToPaper) -> list[Part]:
    """Return the numbers of the rows before their first plants, as many as have room."""
    if not grid.in_rows:
        return []
    lines, first = np.unique(grid.row_line, return_index=True)
    gap_mm = grid.row_spacing_m * placed.scale
    every = next(k for k in (1, 2, 5, 10, 20, 50, 100, 10**9) if k * gap_mm >= 3.2)
    before_m = before_rows(grid, first, 0.5 * grid.plant_spacing_m + 2.4 / placed.scale)
    return [
        Lettering(x, y, sign, 6.0, colours.SOFT, "middle")
        for line, sign, (x, y) in zip(
            lines.tolist(), grid.line_signs.values(), placed(before_m).tolist(), strict=True
        )
        if line == 0 or (line + 1) % every == 0
    ]


def _scale(units: Units, placed: _ToPaper, size: Size) -> list[Part]:
    """Return a bar of a round length in the lower left corner."""
    bar_m, text = units.bar_m((size[0] - 2 * _MARGIN_MM) / placed.scale / 4)
    y, end = size[1] - 2.5, 2.0 + bar_m * placed.scale
    bar = np.array([[2.0, y - 1.2], [2.0, y], [end, y], [end, y - 1.2]])
    return [Strokes((bar,), colours.INK, 0.4), Lettering(end + 1.5, y - 0.6, text, 7.0)]


def _north(grid: PlantGrid, placed: _ToPaper, size: Size) -> list[Part]:
    """Return an arrow to true north in the lower right corner."""
    ahead = _northward(grid) @ placed.turn
    aside = np.array([-ahead[1], ahead[0]])
    place = np.array([size[0] - 5.0, size[1] - 6.0])
    tip = [place + 4 * ahead, place - 2.2 * ahead + 1.7 * aside,
           place - 1.0 * ahead, place - 2.2 * ahead - 1.7 * aside]  # fmt: skip
    x, y = (place - 4.0 * ahead).tolist()
    return [
        Areas((np.array(tip),), fill=colours.INK),
        Lettering(x, y, words.NORTH, 7.0, anchor="middle", bold=True),
    ]


def legend(
    width: float,
    *,
    route: bool = False,
    by_state: bool = False,
    zones: bool = False,
    recorded: bool = False,
    passed: bool = False,
) -> Drawing:
    """Return what the signs of a map mean, on a strip of that width; `passed` has a second line."""
    y = 2.5
    x, parts = _states(y) if by_state else _chances(y)
    find = np.array([[x + 1.2, y]])
    parts += [Discs(find, 1.2, fill=colours.FOUND, edge=colours.INK),
              Lettering(x + 3.5, y, words.LEGEND_FOUND, 7.0)]  # fmt: skip
    x += 22.5
    if recorded:
        parts += [_recorded(np.array([[x + 1.2, y]]), 1.2),
                  Lettering(x + 3.5, y, words.LEGEND_RECORDED, 7.0)]  # fmt: skip
        x += 22.5
    ring = np.concatenate([_box(x, y, 3.5), _box(x, y, 3.5)[:1]])
    outlined = words.LEGEND_ZONES if zones else words.LEGEND_HOT
    parts += [Strokes((ring,), colours.INK, 0.5, dashed=zones),
              Lettering(x + 4.5, y, outlined, 7.0)]  # fmt: skip
    x += 24.0 if zones else 17.0
    parts += [Discs(np.array([[x + 1.4, y]]), 1.2, edge=colours.GATE, width=0.8),
              Lettering(x + 3.7, y, words.LEGEND_GATE, 7.0)]  # fmt: skip
    x += 12.0
    if route:
        parts += [Strokes((np.array([[x, y], [x + 6.0, y]]),), colours.ROUTE, 0.5),
                  *_arrows(np.array([[x - 9.2, y], [x + 16.0, y]])),
                  Lettering(x + 7.5, y, words.LEGEND_ROUTE_ONLY if recorded else words.LEGEND_ROUTE,
                            7.0)]  # fmt: skip
    if passed:
        y = _LEGEND_MM + 1.5
        parts += [_not_inspected(np.array([[1.2, y]]), 1.2),
                  Lettering(3.5, y, words.LEGEND_NOT_INSPECTED, 7.0)]  # fmt: skip
    return Drawing(width, legend_mm(passed=passed), tuple(parts))


def legend_mm(*, passed: bool = False) -> float:
    """Return how high a legend is, millimetres."""
    return _LEGEND_MM + 4.0 * passed


def _chances(y: float) -> tuple[float, list[Part]]:
    """Return the scale of chances, and where it ends."""
    parts: list[Part] = [Lettering(0.0, y, words.LEGEND_CHANCE, 7.0, colours.SOFT)]
    x = 37.0
    for colour, name in zip(colours.CHANCE, colours.chance_names(), strict=True):
        parts.append(Areas((_box(x, y, 7.0),), fill=colour))
        parts.append(Lettering(x + 3.5, y + 3.6, name, 6.0, colours.SOFT, "middle"))
        x += 7.0
    return x + 3.5, parts


def _states(y: float) -> tuple[float, list[Part]]:
    """Return what the colours of states mean, and where they end."""
    parts: list[Part] = []
    x = 0.0
    for colour, name in zip(colours.STATES[:2], words.LEGEND_STATES, strict=True):
        parts.append(Areas((_box(x, y, 8.0),), fill=colour))
        parts.append(Lettering(x + 9.5, y, name, 7.0))
        x += 40.0  # "nunca inspeccionada" is the longest
    return x, parts


def _box(x: float, y: float, wide: float) -> Floats:
    return np.array([[x, y - 1.5], [x + wide, y - 1.5], [x + wide, y + 1.5], [x, y + 1.5]])
