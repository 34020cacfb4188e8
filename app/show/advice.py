"""What a season advises: in one sentence, in figures, zone by zone, and on the map."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np
import pandas as pd
import shapely
import streamlit as st
from pydeck import Layer

from fieldmon.compute.digest import digest
from fieldmon.compute.wording import chance_figure, share_figure
from fieldmon.io.spray_rate import litres_figure
from fieldmon.plot.grid import plant_numbers, row_ends

from ..state import assumptions, cached
from ..words import texts
from ..words.language import about, in_words
from . import map_layers
from .map_view import Switch
from .maps import colours, legends

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.monitoring.advice.advice import Advice
    from fieldmon.plot.grid import PlantGrid

    from ..state.choices import Choices
    from .map_view import MapContent
    from .maps.labels import Label

# more numbers than these have no room beside each other
_MOST_NUMBERS = 200
# more zones than these are scrolled
_MOST_ZONES, _TABLE_PX = 10, 420
# who decides asks where to spray, not where to drive
_OF_ROUTE = frozenset({"casing", "route", "arrows"})


def headline(choices: Choices, advice: Advice) -> None:
    """Answer the daily question in one sentence, and say what the answer rests on."""
    with st.container(key="lead"):
        st.markdown(f"**{in_words(advice.headline(choices.units.of_library))}**")
    for k, sentence in enumerate(advice.reasons(choices.units.in_sentences(choices.on))):
        st.markdown(_starred(choices, in_words(sentence)) if k == 0 else in_words(sentence))


def _starred(choices: Choices, figure: str) -> str:
    """Return words with a star if what they say rests on what is assumed."""
    return f"{figure}\N{NO-BREAK SPACE}*" if assumptions.of(choices) else figure


def figures(choices: Choices, advice: Advice, product: str) -> None:
    """Show what treating the zones comes to."""
    if not len(advice.zones):
        st.markdown(in_words(advice.zones.sentence()))
        return
    for sentence in advice.though():
        st.markdown(in_words(sentence))
    zones, units = advice.zones, choices.units
    share = in_words(share_figure(zones.m2 / zones.plot_m2))
    inside, outside, enough = (
        _starred(choices, one)
        for one in (texts.DECIDE_INSIDE, texts.DECIDE_OUTSIDE, texts.DECIDE_ENOUGH)
    )
    with st.container(horizontal=True):
        st.metric(texts.DECIDE_AREA, f"{units.square(zones.m2)} ({share})", width="content")
        liquid = texts.DECIDE_LITRES.format(value=in_words(litres_figure(advice.litres)))
        st.metric(product or texts.DECIDE_LIQUID, liquid, width="content")
        st.metric(inside, about(zones.inside), width="content")
        st.metric(outside, about(zones.outside), width="content")
        if not advice.is_whole:
            st.metric(
                texts.DECIDE_SAVING,
                in_words(advice.saved),
                width="content",
                help=texts.DECIDE_SAVING_HELP.format(lost=in_words(advice.lost)),
            )
        st.metric(enough, in_words(chance_figure(advice.said.enough, drawn=True)), width="content",
                  help=texts.DECIDE_ENOUGH_HELP)  # fmt: skip


def zones(advice: Advice) -> None:
    """Show each zone with its own verdict and how often such a verdict is wrong."""
    if not len(advice.zones):
        return
    with st.expander(texts.DECIDE_ZONES.format(n=len(advice.zones))):
        # words that wrap: beside the map, a grid cut off its last columns
        st.table(table(advice), hide_index=True, border="horizontal", height=_height(advice))
        st.caption(texts.DECIDE_WRONG_HELP)


def _height(advice: Advice) -> int | Literal["content"]:
    return _TABLE_PX if len(advice.zones) > _MOST_ZONES else "content"


def table(advice: Advice) -> pd.DataFrame:
    """Return a row a zone."""
    numbered, zone = plant_numbers(advice.grid), advice.zones.zone
    mine = [np.flatnonzero(zone == k) for k in range(len(advice.zones))]
    said = advice.said.zones
    return pd.DataFrame(
        {
            texts.DECIDE_ZONE: [k + 1 for k in range(len(mine))],
            texts.DECIDE_ROWS: [_rows(advice.grid, numbered.line[plants]) for plants in mine],
            texts.DECIDE_PLANTS: [_span(numbered.number[plants]) for plants in mine],
            texts.DECIDE_INFESTED: [in_words(share_figure(one.share)) for one in said],
            texts.DECIDE_ITSELF: [texts.DECIDE_VERDICTS[one.verdict] for one in said],
            texts.DECIDE_WRONG: [in_words(chance_figure(one.wrong, drawn=True)) for one in said],
        }
    )


def _rows(grid: PlantGrid, line: NDArray[np.int64]) -> str:
    low, high = row_ends(grid, line)
    return low if low == high else f"{low}-{high}"


def _span(numbers: NDArray[np.int64]) -> str:
    low, high = int(numbers.min()), int(numbers.max())
    return f"{low}" if low == high else f"{low}-{high}"


def zone_map(choices: Choices, advice: Advice) -> MapContent:
    """Return the map of the chosen day with the zones on it, each with its number."""
    day = map_layers.day_map(choices, off=("records", "route", "hot"))
    places = [one for one in day.labels if one["k"] not in {"stop", "leg"}]
    below = [layer for layer in day.layers if layer.id not in _OF_ROUTE]
    content = replace(day, labels=places, layers=below, play=None)
    # by what is drawn: results may have come since the advice was worked out
    drawn = digest(advice.zones.zone, [(one.share, one.verdict) for one in advice.said.zones])
    key = f"zones {choices.key} {choices.dark} {advice.asked} {drawn}"
    layers = cached.layers(key, partial(_layers, advice, dark=choices.dark))
    if not layers:
        return content
    own = Switch("zones", texts.DECIDE_ON_MAP, tuple(layer.id for layer in layers))
    numbers = Switch("numbers", texts.DECIDE_NUMBERS, ())
    others = [one for one in content.switches if one.key not in {"numbers", "route"}]
    edge = colours.ZONE_IN_DARK if choices.dark else colours.ZONE
    sign = legends.part("", [("outline", edge, texts.DECIDE_ON_MAP)], "zones")
    labels = [*_numbers(advice), *places]
    return replace(
        content, layers=[*content.layers, *layers], switches=(own, numbers, *others),
        legend=[*content.legend, sign], labels=labels,
    )  # fmt: skip


def _layers(advice: Advice, *, dark: bool) -> list[Layer]:
    """Return the zones: their tint, and their outlines."""
    edge = list(colours.ZONE_IN_DARK if dark else colours.ZONE)
    rows = []
    for k, area in enumerate(advice.outlines):
        said = advice.said.zones[k]
        verdict = texts.DECIDE_VERDICTS[said.verdict]
        text = texts.DECIDE_TIP.format(zone=k + 1, share=said.share, verdict=verdict)
        rows += [
            {"p": np.round(shapely.get_coordinates(part.exterior), 7).tolist(), "t": text}
            for part in shapely.get_parts(area)
        ]
    if not rows:
        return []
    return [
        Layer("PolygonLayer", rows, id="zones", get_polygon="p", get_fill_color=[*edge, 40],
              stroked=False),
        Layer("PathLayer", rows, id="zones-edge", get_path="p", get_color=edge,
              width_min_pixels=3, get_width=0.4),
    ]  # fmt: skip


def _numbers(advice: Advice) -> list[Label]:
    """Return each zone's number in its middle."""
    inner = [area.representative_point() for area in advice.outlines[:_MOST_NUMBERS]]
    return [
        {"p": [round(point.x, 7), round(point.y, 7)], "t": f"{k}", "k": "zone"}
        for k, point in enumerate(inner, start=1)
    ]
