"""A simulated season on the plot, day by day, sampler beside sampler."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.samplers import COMPARED
from fieldmon.simulation.worker import LaidPlot

from ..actions import comparing
from ..show import charts, field_map, simulated_day
from ..state import cached_simulations, chosen_day, chosen_pest
from ..words import texts
from ..words.language import number
from ..words.strategies import sampler_name

if TYPE_CHECKING:
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.season import SimulatedDay

    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Simulate, and show any day of any sampler on the map."""
    st.caption(texts.SEASON_INTRO)
    pest = chosen_pest.in_weather(choices)
    numbers = comparing.season(choices, pest)
    n_days, *_, every = numbers
    seed = st.number_input(texts.SEED, 0, 10_000, 1, help=texts.SEED_HELP, key="seed")
    names = _names(choices)
    key = f"{choices.key}{choices.revision}{choices.day}{chosen_pest.key(pest)}"
    laid = LaidPlot(choices.plot, chosen_day.chance(choices), pest)
    seasons = {
        name: cached_simulations.simulated_season(
            key, name, (*numbers, int(seed)), choices.robot, laid
        )
        for name in names
    }
    name = st.segmented_control(
        texts.SHOW_SAMPLER, names, default=choices.sampler, required=True,
        format_func=sampler_name, key=f"season_sampler {names}",
    )  # fmt: skip
    day = st.slider(texts.SHOW_DAY, 1, n_days, min(5, n_days), key="season_day")
    truth = st.toggle(texts.SHOW_TRUTH, key="truth")
    days, metrics = seasons[name]
    field_map.want(simulated_day.content(choices, days, day - 1, truth=truth))
    if every > 1:
        st.caption(simulated_day.visit(metrics, day, every))
    _figures(days[day - 1])
    _charts({of: met for of, (_, met) in seasons.items()}, name, day)


def _charts(metrics: dict[str, SeasonMetrics], name: str, day: int) -> None:
    detected, found = (texts.DAY_AXIS, texts.DETECTION_AXIS), (texts.DAY_AXIS, texts.FOUND_AXIS)
    named = {sampler_name(of): met for of, met in metrics.items()}
    st.altair_chart(charts.detection(named, day, detected, [*metrics]), alt=texts.DETECTION_AXIS)
    st.altair_chart(charts.found(metrics[name], found), alt=texts.FOUND_AXIS)


def _names(choices: Choices) -> list[str]:
    usual = dict.fromkeys([choices.sampler, *COMPARED])
    chosen = st.multiselect(texts.COMPARED, list(texts.SAMPLERS), list(usual), key="compared",
                            max_selections=6, format_func=sampler_name)  # fmt: skip
    return list(dict.fromkeys([choices.sampler, *chosen]))


def _figures(day: SimulatedDay) -> None:
    found, visited = (
        texts.IN_PERCENT.format(value=number(pct, ".0f"))
        for pct in (day.detection_pct, day.visited_pct)
    )
    with st.container(horizontal=True):
        st.metric(texts.FOUND_SO_FAR, found, width="content")
        st.metric(texts.FOUND_TODAY, day.found, width="content")
        st.metric(texts.LEFT, day.left, width="content")
        st.metric(texts.VISITED_TODAY, visited, width="content")
