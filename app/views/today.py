"""Today: the chance map, the route, the figures to decide by, and what changed."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from app import keeping, maps, panels, remembered, texts
from fieldmon.io.writers import HandoffPlan
from fieldmon.io.writers.geojson import RouteNotes, route_geojson

if TYPE_CHECKING:
    from app.choices import Choices
    from app.early import Places
    from fieldmon.planning.plan import DayPlan


def show(choices: Choices, places: Places) -> None:
    """Plan the day and show it."""
    today = choices.today()
    places.heading.subheader(f"{choices.name} · {choices.units.day(choices.day)}")
    with places.figures:  # one place above the map, however much is said there
        panels.route_figures(choices, today)
        panels.said_of_day(choices, today)
    shown = remembered.show(
        st.pills, texts.LAYERS, list(texts.LAYER_NAMES), key="layers",
        default=["plants", "route", "numbers", "hot"],
        format_func=texts.LAYER_NAMES.__getitem__, selection_mode="multi",
    )  # fmt: skip
    with places.picture:
        panels.draw(choices, _layers(choices, today, shown), "map", chart=places.chart)
    _hand_out(choices, today)
    st.markdown(f"**{texts.LEGEND_CHANCE}**{maps.chance_legend()}", unsafe_allow_html=True)
    panels.signs(shown)
    if choices.project is None:
        keeping.begin(choices)
    else:
        for title, said in ((texts.WHY, panels.reasons(choices, today)),
                            (texts.CHANGED, panels.changes(choices))):  # fmt: skip
            if said:
                st.markdown(f"**{title}**")
                st.markdown("\n".join(f"- {sentence}" for sentence in said))
    if len(today.route):
        with st.expander(texts.STOPS):
            st.dataframe(panels.stops(choices, today), height=300)


def _layers(choices: Choices, today: DayPlan, shown: list[str]) -> list:
    layers = panels.plant_layers(choices, "chance") if "plants" in shown else []
    if "route" in shown:
        layers = layers + panels.route_layers(choices, today.route, numbers="numbers" in shown)
    return panels.with_marks(choices, layers, shown)


def _hand_out(choices: Choices, today: DayPlan) -> None:
    if not len(today.route):
        return
    notes = RouteNotes(choices.plot.field.name, choices.sampler, panels.starts(choices, today))
    with st.container(horizontal=True):
        made = partial(route_geojson, today.route, notes)
        st.download_button(
            texts.DOWNLOAD, made, f"route_{choices.day}.geojson",
            "application/geo+json", type="primary", on_click="ignore",
        )  # fmt: skip
        with st.popover(texts.OTHER_FORMATS):
            panels.other_formats(choices, HandoffPlan(today.route, notes))
        if choices.project is not None:
            if st.button(texts.GIVE_OUT, help=texts.GIVE_OUT_HELP, key="give_out"):
                choices.project.plan(choices.on)
                st.toast(texts.GIVEN_OUT.format(day=choices.units.day(choices.day)))
            with st.container(key="start_scouting", width="content"):
                st.page_link(st.session_state["scout_page"], label=texts.START_SCOUTING,
                         icon=":material/eco:")  # fmt: skip
