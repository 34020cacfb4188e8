"""The map on which a plot is drawn: where to begin, a grid to measure by, and what is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from babel.core import get_global
from pydeck import Layer

from fieldmon.plot.local_clock import zone_outline
from fieldmon.plot.projection import Frame

from ..state import browser, cached, drawn_plot
from ..words import texts
from . import answers_map, ground
from .map_view import Drawable, MapContent, Switch
from .maps import legends

if TYPE_CHECKING:
    from ..state.drawn_plot import DrawnCorners
    from ..state.plot_edits import Points
    from ..words.units import UnitsInLanguage
    from .maps.legends import LegendPart

# lines of the grid each way from its middle; how far apart they are, about, near and far
_LINES, _GRID_M = 25, (10.0, 100.0)
_GRID, _FAR_GRID = "grid", "grid-far"
# so much is seen about a place that was found, and about corners
_ABOUT_M, _BESIDE_M = 200.0, 30.0
_WORLD = (-150.0, -50.0, 170.0, 70.0)
# as exact as the outline of a time zone needs to be, to begin at it
_ROUGH_DEG = 0.05


def content(drawn: DrawnCorners, units: UnitsInLanguage, *, dark: bool) -> MapContent:
    """Return the map of what is drawn so far."""
    below = ground.of_world(None)
    middle = drawn.at or (drawn.corners[0] if drawn.corners else None)
    layers = _zones(dark=dark) if middle is None else _grid(middle, units, dark=dark)
    switches = (Switch("grid", texts.MAP_LAYERS["grid"], (_GRID, _FAR_GRID), not below.layers),)
    n = len(drawn.corners)
    return MapContent(
        place=f"drawing {drawn.at} {drawn_plot.turn()}",
        bounds=bounds(drawn), alt=texts.OUTLINE_ON_MAP.format(n=n), layers=layers,
        switches=switches if middle else (),
        legend=_legend(units, is_placed=middle is not None),
        draw=Drawable("outline", f"outline {drawn_plot.turn()}", said(drawn.corners, units),
                      points=drawn.corners, lengths=units.lengths_written()),
        ground=below,
    )  # fmt: skip


def said(corners: Points, units: UnitsInLanguage) -> str:
    """Return in a few words what is drawn so far."""
    if not corners:
        return texts.OUTLINE_HINT
    n, area_m2 = len(corners), drawn_plot.drawn_area_m2(corners)
    if n > 2 and (met := drawn_plot.crossing(corners)) is not None:
        return texts.OUTLINE_CROSSES.format(n=n, one=met[0] + 1, other=met[1] + 1)
    if not area_m2:
        return texts.MAP_WORDS["corners"].format(n=n)
    return texts.OUTLINE_SAID.format(n=n, area=units.square(area_m2))


def bounds(drawn: DrawnCorners) -> list[float]:
    """Return what is in view: the place that was found and what is drawn, else one's own country.

    Where that is, the time zone of the device says, without asking anybody.
    """
    parts = []
    if drawn.at is not None:
        parts.append(_about(drawn.at, _ABOUT_M))
    parts += [_about(corner, _BESIDE_M) for corner in drawn.corners]
    if not parts:
        return _own_country()
    low, high = np.min(parts, axis=0)[:2], np.max(parts, axis=0)[2:]
    return [*low.tolist(), *high.tolist()]


def _about(at: tuple[float, float], reach_m: float) -> list[float]:
    corners = Frame(*at).lonlat(np.array([[-reach_m, -reach_m], [reach_m, reach_m]]))
    return [float(one) for one in corners.ravel()]


def _own_country() -> list[float]:
    named = browser.zone()
    # browsers go on using names of old: Asia/Calcutta
    zone = get_global("zone_aliases").get(named, named)
    outline = zone_outline(zone, _ROUGH_DEG)
    is_nowhere = outline.is_empty or zone.startswith("Etc/")
    return list(_WORLD if is_nowhere else outline.bounds)


def _zones(*, dark: bool) -> list[Layer]:
    edges = np.array(_own_country())
    key = f"zones {edges.tolist()} {dark}"
    return cached.layers(key, lambda: answers_map.ground_of(edges, dark=dark))


def _steps(units: UnitsInLanguage) -> list[tuple[float, str]]:
    """Return how far lines of the grid are apart, near and far: in metres and as text."""
    return [min(units.lengths(), key=lambda one: abs(one[0] - about)) for about in _GRID_M]


def _grid(middle: tuple[float, float], units: UnitsInLanguage, *, dark: bool) -> list[Layer]:
    """Return lines around a place: every 10 m where a plot may be, every 100 m farther out."""
    made = zip((_GRID, _FAR_GRID), _steps(units), strict=True)
    lines = {name: _lines(Frame(*middle), step_m) for name, (step_m, _) in made}
    colour = [*answers_map.GROUND, 110 if dark else 90]
    return [
        Layer("PathLayer", lines[name], id=name, get_path="path", get_color=colour,
              get_width=0.05, width_min_pixels=width)
        for name, width in ((_GRID, 0.6), (_FAR_GRID, 1.6))
    ]  # fmt: skip


def _lines(frame: Frame, step_m: float) -> list[dict[str, list[list[float]]]]:
    end = _LINES * step_m
    return [
        {"path": np.round(frame.lonlat(np.array(ends)), 7).tolist()}
        for k in np.arange(-_LINES, _LINES + 1) * step_m
        for ends in ([[k, -end], [k, end]], [[-end, k], [end, k]])
    ]


def _legend(units: UnitsInLanguage, *, is_placed: bool) -> list[LegendPart]:
    words = texts.LEGEND_ZONE
    if is_placed:
        (_, near), (_, far) = _steps(units)
        words = texts.LEGEND_GRID.format(near=near, far=far)
    item = ("line", answers_map.GROUND, words)
    return [legends.part("", [item], "grid" if is_placed else "")]
