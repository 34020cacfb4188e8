"""What answers to an import's question lead to, side by side on one map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from pydeck import Layer

from fieldmon.plot.local_clock import zone_outline, zones_within

from ..words import texts
from . import plot_place
from .map_view import MapContent
from .maps import legends

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from ..state.tried_answers import TriedAnswer
    from .maps.colours import Colour
    from .maps.labels import Label

#: the layers in which a tapped answer is looked up
SHAPES, PLACES = "answer-shapes", "answer-places"
# Okabe & Ito's, for the colour-blind
_COLOURS: tuple[Colour, ...] = (
    (0, 114, 178), (213, 94, 0), (0, 158, 115), (204, 121, 167), (230, 159, 0), (86, 180, 233),
)  # fmt: skip
GROUND: Colour = (130, 140, 135)
# as far as this, outlines are too small to be told from dots
_FAR_DEG = 1.0
# what is shown about a place to see where on earth it is: west, south, east, north
_ABOUT_DEG = np.array([-6.0, -4.0, 6.0, 4.0])
# of a map, one side is no more than so many times as long as the other
_STRIP = 2.0
# outlines of countries, as exact as they are seen
_ROUGH_DEG = 0.05


def content(
    tried: tuple[TriedAnswer, ...], *, dark: bool, on_earth: bool = False
) -> MapContent | None:
    """Return the map of the answers that lead somewhere; None if none does.

    `on_earth`: the question is where on earth it is; if one answer alone leads to a place, that is
    shown from so far that one sees in which country.
    """
    shapes = [_outline(one) for one in tried]
    seen = [k for k, shape in enumerate(shapes) if not shape.is_empty]
    if not seen:
        return None
    bounds = np.array(shapely.total_bounds([shapes[k] for k in seen]))
    if on_earth and len(seen) == 1:
        bounds = np.tile(_middle(shapes[seen[0]]), 2) + _ABOUT_DEG
    ground = ground_of(bounds, dark=dark)
    bounds = with_room(bounds)
    labels = [label(k, _middle(shapes[k])) for k in seen]
    items = [("line", GROUND, texts.LEGEND_ZONE)] if ground else []
    return MapContent(
        f"answers {[one.answer for one in tried]}", bounds.tolist(),
        texts.ANSWERS_ALT.format(n=len(seen)), [*ground, *_answers(tried, shapes, seen)],
        legend=[legends.part("", items)] if items else [], labels=labels,
    )  # fmt: skip


def tapped(tried: tuple[TriedAnswer, ...], layer: str, index: int) -> str | None:
    """Return the answer that was tapped: its dot, or one of the outlines it leads to."""
    seen = [one for one in tried if one.plots]
    parts = [one.answer for one in seen for _ in range(len(_outline(one).geoms))]
    found = {PLACES: [one.answer for one in seen], SHAPES: parts}.get(layer, [])
    return found[index] if 0 <= index < len(found) else None


def label(number: int, place: list[float]) -> Label:
    """Return the number of an answer, counted from 0, as it stands on the map."""
    return {"p": place, "t": f"{number + 1}", "k": "leg", "tight": True}


def said(tried: tuple[TriedAnswer, ...], number: int) -> str:
    """Return what is said of an answer, by its number from 0, where one points at it."""
    return " · ".join([f"{number + 1}", tried[number].said, plot_place.of_zone(tried[number].zone)])


def colour(number: int) -> Colour:
    """Return the colour of an answer, by its number from 0."""
    return _COLOURS[number % len(_COLOURS)]


def _outline(one: TriedAnswer) -> MultiPolygon:
    parts = [shapely.get_parts(plot.boundary) for plot in one.plots]
    return shapely.MultiPolygon([*np.concatenate(parts)] if parts else [])


def _middle(shape: MultiPolygon) -> list[float]:
    place: list[float] = shapely.get_coordinates(shape.centroid)[0].round(7).tolist()
    return place


def _answers(
    tried: tuple[TriedAnswer, ...], shapes: list[MultiPolygon], seen: list[int]
) -> list[Layer]:
    """Return the outlines, one entry an answer, and a dot where each lies."""
    rows = [
        {
            "p": [
                np.round(shapely.get_coordinates(ring), 7).tolist()
                for ring in shapely.get_exterior_ring(shapely.get_parts(shapes[k]))
            ],
            "m": _middle(shapes[k]),
            "t": said(tried, k),
            "c": [*colour(k), 90],
            "l": list(colour(k)),
        }
        for k in seen
    ]
    flat = [{**row, "p": ring} for row in rows for ring in row["p"]]
    return [
        Layer("PolygonLayer", flat, id=SHAPES, get_polygon="p", get_fill_color="c",
              stroked=True, get_line_color="l", line_width_min_pixels=2),
        Layer("ScatterplotLayer", rows, id=PLACES, get_position="m", get_fill_color="c",
              radius_min_pixels=12, get_radius=1, stroked=True, get_line_color="l",
              line_width_min_pixels=3),
    ]  # fmt: skip


def ground_of(bounds: NDArray[np.float64], *, dark: bool) -> list[Layer]:
    """Return the time zones about, where answers lie far apart.

    Without a map, their borders show where on earth one is.
    """
    if (bounds[2:] - bounds[:2] <= _FAR_DEG).all():
        return []
    bounds = _as_a_map(with_room(bounds))
    west, south, east, north = bounds.clip([-180, -85, -180, -85], [180, 85, 180, 85]).tolist()
    view = shapely.box(*with_room(np.array([west, south, east, north])))
    rows = [
        {"p": np.round(shapely.get_coordinates(ring), 3).tolist(), "t": zone}
        for zone in zones_within((west, south, east, north))
        for ring in shapely.get_exterior_ring(
            shapely.get_parts(shapely.intersection(zone_outline(zone, _ROUGH_DEG), view))
        )
        if ring is not None
    ]
    return [
        Layer("PolygonLayer", rows, id="zones", get_polygon="p", stroked=True,
              get_fill_color=[40, 50, 50] if dark else [250, 250, 246],
              get_line_color=list(GROUND), line_width_min_pixels=1, get_line_width=1)
    ]  # fmt: skip


def _as_a_map(bounds: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the bounds made wide and high enough to be known on a map, no narrow strip."""
    sides = bounds[2:] - bounds[:2]
    missing = np.maximum(sides.max() / _STRIP - sides, 0.0) / 2.0
    return np.concatenate([bounds[:2] - missing, bounds[2:] + missing])


def with_room(bounds: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the bounds with some room about them."""
    room = 0.15 * np.maximum(bounds[2:] - bounds[:2], 1e-4)
    return np.concatenate([bounds[:2] - room, bounds[2:] + room])
