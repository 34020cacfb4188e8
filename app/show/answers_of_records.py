"""Where records would lie by each answer to a question about them, around the plot, on one map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from pydeck import Layer

from fieldmon.infestation.observations import PRESENT

from ..words import texts
from . import answers_map
from .map_view import MapContent
from .maps import colours, deck, legends

if TYPE_CHECKING:
    from fieldmon.infestation.observations import Observations
    from fieldmon.plot.plot import Plot

    from ..state.tried_answers import TriedAnswer

#: the layer in which a tapped answer is looked up
PLACES = answers_map.PLACES
# drawn of each answer: more say no more of where they lie
_MOST = 400
_RING_PX = 4
# as near as this, answers lead to the same places
_SAME_DEG = 1e-7


def content(tried: tuple[TriedAnswer, ...], plot: Plot, *, dark: bool) -> MapContent | None:
    """Return the map of the answers that lead somewhere; None if none does."""
    seen = [k for k, one in enumerate(tried) if one.records is not None]
    if not seen:
        return None
    at = [np.median(tried[k].records.lonlat, axis=0) for k in seen]  # type: ignore[union-attr]
    some = [_some(tried[k].records) for k in seen]
    spots = np.concatenate([*some, shapely.get_coordinates(plot.field.boundary)])
    bounds = np.concatenate([spots.min(axis=0), spots.max(axis=0)])
    ground = answers_map.ground_of(bounds, dark=dark)
    same = _same_places(tried, seen)
    around = deck.outline(plot.field, "boundary", colours.AMONG_ANSWERS)
    made = [*ground, around, *_points(tried, seen)]
    if not same:
        made.append(_places(tried, seen, at))
    items = [("line", answers_map.GROUND, texts.LEGEND_ZONE)] if ground else []
    rings = [("ring", answers_map.colour(k), f"{k + 1} · {tried[k].said}") for k in seen]
    numbers = [] if same else [
        answers_map.label(k, place.round(7).tolist())
        for k, place in zip(seen, at, strict=True)
    ]  # fmt: skip
    said = texts.ANSWERS_OF_RECORDS_ALT.format(name=plot.field.name, n=len(seen))
    return MapContent(
        f"answers {[one.answer for one in tried]}", answers_map.with_room(bounds).tolist(),
        said, made, labels=numbers,
        legend=[legends.part("", [*items, *rings])],
    )  # fmt: skip


def tapped(tried: tuple[TriedAnswer, ...], layer: str, index: int) -> str | None:
    """Return the answer whose place was tapped."""
    seen = [one.answer for one in tried if one.records is not None]
    return seen[index] if layer == PLACES and 0 <= index < len(seen) else None


def _some(records: Observations | None) -> np.ndarray:
    """Return the places of records, or of some of very many, spread evenly over the file."""
    if records is None:
        return np.empty((0, 2))
    n = len(records)
    places: np.ndarray = records.lonlat[np.linspace(0, n - 1, min(n, _MOST)).astype(int)]
    return places


def _same_places(tried: tuple[TriedAnswer, ...], seen: list[int]) -> bool:
    """Return whether the answers differ in finds only."""
    first, *others = (_some(tried[k].records) for k in seen)
    return bool(others) and all(
        len(one) == len(first) and np.allclose(one, first, rtol=0, atol=_SAME_DEG) for one in others
    )


def _points(tried: tuple[TriedAnswer, ...], seen: list[int]) -> list[Layer]:
    """Return each answer's records: a dot each, and a ring round finds, wider by the answer."""
    made = []
    for number, k in enumerate(seen):
        records = tried[k].records
        if records is None:
            continue
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


def _places(tried: tuple[TriedAnswer, ...], seen: list[int], at: list[np.ndarray]) -> Layer:
    """Return a dot in the middle of each answer's records, to be tapped."""
    rows = [
        {"p": place.round(7).tolist(), "c": list(answers_map.colour(k)),
         "t": answers_map.said(tried, k)}
        for k, place in zip(seen, at, strict=True)
    ]  # fmt: skip
    return Layer("ScatterplotLayer", rows, id=PLACES, get_position="p", get_fill_color="c",
                 radius_min_pixels=12, get_radius=1, stroked=True, get_line_color="c",
                 line_width_min_pixels=3)  # fmt: skip
