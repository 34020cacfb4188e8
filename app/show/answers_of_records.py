"""Where records would lie by each answer to a question about them, around the plot, on one map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from pydeck import Layer

from fieldmon.infestation.records import PRESENT

from ..words import texts
from . import answers_map
from .map_view import MapContent
from .maps import colours, deck, legends

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.records import Records
    from fieldmon.plot.plot import Plot

    from ..state.tried_answers import TriedAnswer

    Floats = NDArray[np.float64]

#: the layer in which a tapped answer is looked up
PLACES = answers_map.PLACES
# drawn of each answer: more say no more of where they lie
_MOST = 400
_RING_PX = 4
# as near as this, answers lead to the same places
_SAME_DEG = 1e-7


def content(tried: tuple[TriedAnswer, ...], plot: Plot, *, dark: bool) -> MapContent | None:
    """Return the map of the answers that lead somewhere; None if none does."""
    found = {k: one.records for k, one in enumerate(tried) if one.records is not None}
    if not found:
        return None
    some = [_some(records) for records in found.values()]
    spots = np.concatenate([*some, shapely.get_coordinates(plot.field.boundary)])
    bounds = np.concatenate([spots.min(axis=0), spots.max(axis=0)])
    ground = answers_map.ground_of(bounds, dark=dark)
    middles = {} if _are_same(some) else {k: _middle(records) for k, records in found.items()}
    around = deck.outline(plot.field, "boundary", colours.AMONG_ANSWERS)
    layers = [*ground, around, *_points(tried, found)]
    if middles:
        layers.append(_places(tried, middles))
    items = [("line", answers_map.GROUND, texts.LEGEND_ZONE)] if ground else []
    rings = [("ring", answers_map.colour(k), f"{k + 1} · {tried[k].said}") for k in found]
    said = texts.ANSWERS_OF_RECORDS_ALT.format(name=plot.field.name, n=len(found))
    return MapContent(
        f"answers {[one.answer for one in tried]}", answers_map.with_room(bounds).tolist(),
        said, layers, labels=[answers_map.label(k, place) for k, place in middles.items()],
        legend=[legends.part("", [*items, *rings])],
    )  # fmt: skip


def tapped(tried: tuple[TriedAnswer, ...], layer: str, index: int) -> str | None:
    """Return the answer whose place was tapped."""
    seen = [one.answer for one in tried if one.records is not None]
    return seen[index] if layer == PLACES and 0 <= index < len(seen) else None


def _some(records: Records) -> Floats:
    """Return the places of records, or of some of very many, spread evenly over the file."""
    n = len(records)
    places: Floats = records.lonlat[np.linspace(0, n - 1, min(n, _MOST)).astype(int)]
    return places


def _middle(records: Records) -> list[float]:
    place: list[float] = np.median(records.lonlat, axis=0).round(7).tolist()
    return place


def _are_same(places: list[Floats]) -> bool:
    """Return whether several answers lead to the same places: they differ in finds only."""
    first, *others = places
    return bool(others) and all(
        len(one) == len(first) and np.allclose(one, first, rtol=0, atol=_SAME_DEG) for one in others
    )


def _points(tried: tuple[TriedAnswer, ...], found: dict[int, Records]) -> list[Layer]:
    """Return each answer's records: a dot each, and a ring round finds, wider by the answer."""
    made = []
    for number, (k, records) in enumerate(found.items()):
        colour = list(answers_map.colour(k))
        finds = records.take(records.present == PRESENT)
        said = f"{k + 1} · {tried[k].said}"
        dots = [{"p": place, "t": said} for place in _some(records).round(7).tolist()]
        rings = [{"p": place, "t": said} for place in _some(finds).round(7).tolist()]
        made += [
            Layer("ScatterplotLayer", dots, id=f"answer-dots-{k}", get_position="p",
                  get_fill_color=colour, radius_min_pixels=2, get_radius=0.5),
            Layer("ScatterplotLayer", rings, id=f"answer-finds-{k}", get_position="p",
                  filled=False, stroked=True, get_line_color=colour, get_radius=0.8,
                  radius_min_pixels=_RING_PX + 3 * number, line_width_min_pixels=2),
        ]  # fmt: skip
    return made


def _places(tried: tuple[TriedAnswer, ...], middles: dict[int, list[float]]) -> Layer:
    """Return a dot in the middle of each answer's records, to be tapped."""
    rows = [
        {"p": place, "c": list(answers_map.colour(k)),
         "t": answers_map.said(tried, k)}
        for k, place in middles.items()
    ]  # fmt: skip
    return Layer("ScatterplotLayer", rows, id=PLACES, get_position="p", get_fill_color="c",
                 radius_min_pixels=12, get_radius=1, stroked=True, get_line_color="c",
                 line_width_min_pixels=3)  # fmt: skip
