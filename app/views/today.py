"""Today: the chance map, the route, and the figures to decide by."""

from __future__ import annotations

from datetime import datetime, time
from typing import TYPE_CHECKING

import pandas as pd
import streamlit as st

from app import cached, maps, texts
from fieldmon.errors import FieldmonError
from fieldmon.geodata.routes import RouteNotes, route_geojson
from fieldmon.grid import row_label
from fieldmon.prior import usable

if TYPE_CHECKING:
    import pydeck as pdk

    from app.choices import Choices
    from fieldmon.monitor import Today

STARTS = time(6, 0)


def show(choices: Choices) -> None:
    """Plan the day and show it."""
    try:
        today = cached.today(
            choices.key, choices.day, choices.robot, choices.sampler, choices.plot, choices.records
        )
    except FieldmonError as error:
        st.error(str(error))
        return
    st.subheader(choices.plot.field.name)
    _figures(choices, today)
    if not len(today.route):
        st.warning(texts.NO_STOPS)
    shown = st.pills(
        texts.LAYERS, list(texts.LAYER_NAMES), format_func=texts.LAYER_NAMES.__getitem__,
        selection_mode="multi", default=["plants", "route", "numbers", "hot"], key="layers",
    )  # fmt: skip
    layers, bar_m = _layers(choices, today, shown)
    st.pydeck_chart(
        maps.deck(choices.plot.grid, layers, phone=choices.phone), height=choices.map_px, key="map"
    )
    st.markdown(f"**{texts.LEGEND_CHANCE}**{maps.chance_legend()}", unsafe_allow_html=True)
    notes = [texts.LEGEND_ROUTE, texts.LEGEND_HOT, texts.LEGEND_RECORDS]
    st.caption(" · ".join([*notes, texts.NORTH.format(m=bar_m)]))
    _download(choices, today)
    _findings(choices)


def _figures(choices: Choices, today: Today) -> None:
    route, n = today.route, len(choices.plot.grid)
    finds = route.expected_finds * choices.robot.detects
    with st.container(horizontal=True):
        st.metric(texts.PLANTS_TO_INSPECT, f"{len(route):,} / {n:,}", width="content")
        st.metric(texts.TIME, f"{route.end_s / 3600:.1f} h", width="content")
        st.metric(texts.DRIVE, f"{route.drive_m / 1000:.2f} km", width="content")
        st.metric(texts.FINDS, f"{finds:.1f}", help=texts.FINDS_HELP, width="content")


def _layers(choices: Choices, today: Today, shown: list[str]) -> tuple[list[pdk.Layer], int]:
    grid = choices.plot.grid
    layers = [maps.boundary(choices.plot.field)]
    if "plants" in shown:
        note = [f"{chance:.1%} chance" for chance in today.chance.tolist()]
        layers.append(maps.plants(grid, maps.by_chance(today.chance), note))
    if "route" in shown:
        layers += maps.route(today.route, numbers="numbers" in shown)
    if "hot" in shown:
        spots = cached.recorded_hot_spots(choices.key, choices.plot, choices.records)
        layers += maps.hot(grid, spots)
    if "records" in shown:
        layers += maps.records(choices.records)
    bar, bar_m = maps.scale(grid)
    return [*layers, *bar], bar_m


def _download(choices: Choices, today: Today) -> None:
    if not len(today.route):
        return
    start = datetime.combine(datetime.fromisoformat(choices.day), STARTS)
    notes = RouteNotes(choices.plot.field.name, choices.sampler, start)
    st.download_button(
        texts.DOWNLOAD, route_geojson(today.route, notes), f"route_{choices.day}.geojson",
        "application/geo+json", type="primary", on_click="ignore",
    )  # fmt: skip
    with st.expander(texts.STOPS):
        label = row_label(choices.plot.grid, today.route.plant)
        arrive = pd.Timestamp(start) + pd.to_timedelta(today.route.arrive_s.round(), unit="s")
        table = pd.DataFrame(
            {
                "arrive": arrive.strftime("%H:%M:%S"),
                "row": label.line,
                "plant": label.number,
                "chance %": (100 * today.route.chance).round(1),
            },
            index=pd.RangeIndex(1, len(today.route) + 1, name="stop"),
        )
        st.dataframe(table, height=300)


def _findings(choices: Choices) -> None:
    with st.expander(texts.FINDINGS):
        for finding in choices.findings:
            st.markdown(f"- **{finding.severity}**: {finding.sentence}")
        for remark in usable(choices.records, pd.Timestamp(choices.day).to_numpy()).remarks():
            st.markdown(f"- {remark}")
        if not choices.findings:
            st.markdown(texts.FINDINGS_NONE)
