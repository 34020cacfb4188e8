"""Today: the chance map, the route, the figures to decide by, and what changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..actions import assuming, beginning, handing_out
from ..show import day, field_map, map_layers
from ..show.maps import legends
from ..state import chosen_day, widget_memory
from ..state.chosen_day import DayRoute
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.planning.plan import DayPlan

    from ..show.places import Places
    from ..state.choices import Choices


def show(choices: Choices, places: Places) -> None:
    """Plan the day and show it."""
    plan = choices.plan()
    places.heading.subheader(f"{choices.name} · {choices.units.day(choices.day)}")
    with places.figures:  # one place above the map, however much is said there
        day.route_figures(choices, plan)
        assuming.show(choices)
        day.said_of_day(choices, plan)
    shown = widget_memory.show(
        st.pills, texts.LAYERS, list(texts.LAYER_NAMES), key="layers",
        default=["plants", "route", "numbers", "hot"],
        format_func=texts.LAYER_NAMES.__getitem__, selection_mode="multi",
    )  # fmt: skip
    with places.picture:
        field_map.draw(choices, _layers(choices, plan, shown), "map", chart=places.chart)
    handing_out.show(choices, plan)
    legend = legends.chance_legend(dark=choices.dark)
    st.markdown(f"**{texts.LEGEND_CHANCE}**{legend}", unsafe_allow_html=True)
    field_map.signs(shown)
    if choices.season is None:
        beginning.show(choices)
    else:
        for title, said in ((texts.WHY, day.reasons(choices, plan)),
                            (texts.CHANGED, day.changes(choices))):  # fmt: skip
            if said:
                st.markdown(f"**{title}**")
                st.markdown("\n".join(f"- {sentence}" for sentence in said))
    if len(plan.route):
        with st.expander(texts.STOPS):
            planned = DayRoute(plan.route, chosen_day.starts(choices, plan))
            st.dataframe(day.stops(choices, planned), height=300)


def _layers(choices: Choices, plan: DayPlan, shown: list[str]) -> list:
    layers = map_layers.plants(choices, "chance") if "plants" in shown else []
    if "route" in shown:
        layers = layers + map_layers.route(choices, plan.route, numbers="numbers" in shown)
    return map_layers.with_marks(choices, layers, shown)
