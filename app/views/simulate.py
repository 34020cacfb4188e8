"""A simulated season on the plot, day by day, sampler beside sampler."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from app import cached, charts, maps, panels, texts, verdicts, ways
from fieldmon.infestation.hotspots import hot_spots
from fieldmon.planning.route import route_of
from fieldmon.samplers import COMPARED
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from app.choices import Choices
    from fieldmon.simulation.season import SimulatedDay


def show(choices: Choices) -> None:
    """Simulate, and show any day of any sampler on the map."""
    st.subheader(f"{choices.name}: {texts.SIMULATE}")
    st.caption(texts.SEASON_INTRO)
    *columns, last = st.columns(4)
    numbers = ways.season(columns)
    seed = last.number_input(texts.SEED, 0, 10_000, 1, help=texts.SEED_HELP, key="seed")
    names = _names(choices)
    chance, key = panels.chance_of(choices), f"{choices.key}{choices.revision}{choices.day}"
    seasons = {
        name: cached.season(key, name, (*numbers, int(seed)), choices.robot, choices.plot, chance)
        for name in names
    }
    left, right = st.columns([2, 3])
    with right:
        name = st.segmented_control(
            texts.SHOW_SAMPLER, names, default=choices.sampler, required=True,
            format_func=verdicts.short, key=f"season_sampler {names}",
        )  # fmt: skip
        number = st.slider(texts.SHOW_DAY, 1, numbers[0], min(5, numbers[0]), key="season_day")
        _map(choices, seasons[name][0], number - 1)
    with left:
        figures = {verdicts.short(name): value[1] for name, value in seasons.items()}
        axes = texts.DAY_AXIS, texts.DETECTION_AXIS
        st.altair_chart(charts.detection(figures, number, axes), alt=texts.DETECTION_AXIS)
        _figures(seasons[name][0][number - 1])
        st.altair_chart(charts.found(seasons[name][1], (texts.DAY_AXIS, texts.FOUND_AXIS)),
                        alt=texts.FOUND_AXIS)  # fmt: skip


def _names(choices: Choices) -> list[str]:
    usual = dict.fromkeys([choices.sampler, *COMPARED])
    chosen = st.multiselect(texts.COMPARED, list(texts.SAMPLERS), list(usual), key="compared",
                            max_selections=6, format_func=verdicts.short)  # fmt: skip
    return list(dict.fromkeys([choices.sampler, *chosen]))


def _figures(day: SimulatedDay) -> None:
    with st.container(horizontal=True):
        st.metric(texts.FOUND_SO_FAR, f"{day.detection_pct:.0f} %", width="content")
        st.metric(texts.FOUND_TODAY, day.found, width="content")
        st.metric(texts.LEFT, day.left, width="content")
        st.metric(texts.VISITED_TODAY, f"{day.visited_pct:.0f} %", width="content")


def _map(choices: Choices, season: list[SimulatedDay], number: int) -> None:
    grid, day = choices.plot.grid, season[number]
    state = ways.seen_by(season, number)
    scene = Scene(
        aisles=choices.plot.aisles, robot=choices.robot, chance=day.chance,
        last_inspected=np.full(len(grid), NEVER, np.int32), seconds_left=choices.robot.day_s,
    )  # fmt: skip
    layers = [
        maps.plants(grid, maps.by_state(state), partial(panels.state_notes, state)),
        *maps.finds(grid, state),
        *maps.route(route_of(scene, day.work), numbers=False, dark=choices.dark),
    ]
    spots = maps.hot(grid, hot_spots(grid, state), dark=choices.dark)
    layers = maps.with_hot(layers, spots)
    signs = [texts.LEGEND_ROUTE, texts.LEGEND_HOT]
    if st.toggle(texts.SHOW_TRUTH, key="truth"):
        signs.append(texts.LEGEND_TRUTH)
        left = day.infested.copy()
        left[day.work.plant[day.work.found]] = False
        layers += maps.truth(grid, left, dark=choices.dark)
    panels.draw(choices, layers, "season_map")
    st.markdown(maps.state_legend(texts.LEGEND_STATES), unsafe_allow_html=True)
    panels.captions(signs)
