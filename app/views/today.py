"""Today: what to do, in one sentence and on the map; who is to have it; what changed."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.compute.digest import digest

from ..actions import (
    asking_photos,
    assuming,
    beginning,
    bringing_files,
    choosing,
    morning_steps,
    picking,
    recording_here,
)
from ..show import cautions, day, map_layers, plant_history
from ..state import cached, chosen_day, wishes
from ..state.chosen_day import DayRoute
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.planning.plan import DayPlan

    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Plan the day and show it."""
    choosing.whose_day(choices)
    plan = choices.plan()
    with st.container(key="lead"):
        st.markdown(day.headline(choices, plan))
    work, figures = st.container(), st.container()
    with figures:  # they change with every choice: what takes longer is worked out after them
        if not day.is_over(choices, plan):
            day.route_figures(choices, plan)
        assuming.show(choices)
    with work:
        _work(choices, plan)
    if choices.season is None:
        beginning.show(choices)
    else:
        for title, said in ((texts.WHY, day.reasons(choices, plan)), day.changes(choices)):
            if said:
                st.markdown(f"### {title}")
                st.markdown("\n".join(f"- {sentence}" for sentence in said))
    if len(plan.route):
        with st.expander(texts.STOPS):
            route = plan.route
            planned = DayRoute(route, chosen_day.starts(choices, plan))
            stops = digest(route.plant, route.arrive_s, route.believed)
            key = f"table of stops {choices.key} {planned.begins} {stops}"
            table = cached.written(key, lambda: day.stops(choices, planned))
            st.dataframe(table, height=300)


def _work(choices: Choices, plan: DayPlan) -> None:
    """Show the morning's steps, and what is asked and recorded on the map."""
    bringing_files.show_doubts_of_plot(choices)
    day.say_of_day(choices, plan)
    day.say_otherwise(choices)
    cautions.show_today(choices, plan)
    beginning.ask(choices, "step")
    morning_steps.show(choices, plan)
    bringing_files.show_doubts_of_records(choices)
    content = map_layers.day_map(choices, above=picking.layers(choices))
    picked = wishes.picked(choices.laid)
    plant_history.want(choices, content, partial(picking.take, choices), picked=picked)
    picking.show(choices, plan)
    recording_here.show(choices)
    plant_history.show_chosen(choices)
    asking_photos.show(choices)
