"""A simulated season on the plot, day by day, sampler beside sampler."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from app import cached, charts, maps, panels, texts
from fieldmon.hotspots import hot_spots
from fieldmon.route import route_of
from fieldmon.samplers import NEVER, Scene

if TYPE_CHECKING:
    from app.choices import Choices
    from fieldmon.season import Day


def show(choices: Choices) -> None:
    """Simulate, and show any day of any sampler on the map."""
    st.subheader(f"{choices.name}: {texts.SIMULATE}")
    st.caption(texts.SEASON_INTRO)
    numbers, names = _numbers(), _names(choices)
    chance, key = panels.chance_of(choices), f"{choices.key}{choices.revision}{choices.day}"
    seasons = {
        name: cached.season(key, name, numbers, choices.robot, choices.plot, chance)
        for name in names
    }
    left, right = st.columns([2, 3])
    with right:
        name = st.segmented_control(
            texts.SHOW_SAMPLER, names, default=choices.sampler, key=f"season_sampler {names}"
        )
        name = name or choices.sampler
        number = st.slider(texts.SHOW_DAY, 1, numbers[0], min(5, numbers[0]), key="season_day")
        _map(choices, seasons[name][0], number - 1)
    with left:
        figures = {key: value[1] for key, value in seasons.items()}
        st.altair_chart(charts.detection(figures, number, (texts.DAY_AXIS, texts.DETECTION_AXIS)))
        _figures(seasons[name][0][number - 1])
        st.altair_chart(charts.found(figures[name], (texts.DAY_AXIS, texts.FOUND_AXIS)))


def _names(choices: Choices) -> list[str]:
    usual = dict.fromkeys([choices.sampler, "naive", "bouncy", "dynamic"])
    chosen = st.multiselect(
        texts.COMPARED, list(texts.SAMPLERS), list(usual), max_selections=6, key="compared",
        format_func=lambda name: texts.SAMPLERS[name].split(":")[0],
    )  # fmt: skip
    return list(dict.fromkeys([choices.sampler, *chosen]))


def _numbers() -> tuple[int, float, float, int]:
    columns = st.columns(4)
    n_days = columns[0].number_input(texts.DAYS, 2, 60, 25, key="n_days", persist_state="session")
    share = columns[1].number_input(
        texts.INFESTED, 0.1, 50.0, 2.0, 0.5, key="share", persist_state="session"
    )
    rate = columns[2].number_input(
        texts.SPREAD,
        0.0,
        100.0,
        10.0,
        5.0,
        help=texts.SPREAD_HELP,
        key="rate",
        persist_state="session",
    )
    seed = columns[3].number_input(
        texts.SEED, 0, 10_000, 1, help=texts.SEED_HELP, key="seed", persist_state="session"
    )
    return int(n_days), share / 100, rate / 100, int(seed)


def _figures(day: Day) -> None:
    with st.container(horizontal=True):
        st.metric(texts.FOUND_SO_FAR, f"{day.detection_pct:.0f} %", width="content")
        st.metric(texts.FOUND_TODAY, day.found, width="content")
        st.metric(texts.LEFT, day.left, width="content")
        st.metric(texts.VISITED_TODAY, f"{day.visited_pct:.0f} %", width="content")


def _map(choices: Choices, season: list[Day], number: int) -> None:
    grid, day = choices.plot.grid, season[number]
    state = np.where(day.last_inspected >= 0, 0, -1).astype(np.int8)
    for earlier in season[: number + 1]:
        state[earlier.work.plant[earlier.work.found]] = 1
    scene = Scene(
        aisles=choices.plot.aisles, robot=choices.robot, chance=day.chance,
        last_inspected=np.full(len(grid), NEVER, np.int32), seconds_left=choices.robot.day_s,
    )  # fmt: skip
    names = {1: texts.LEGEND_STATES["found"], 0: texts.LEGEND_STATES["clean"],
             -1: texts.LEGEND_STATES["never"]}  # fmt: skip
    layers = [
        maps.plants(grid, maps.by_state(state), [names[s] for s in state.tolist()]),
        *maps.finds(grid, state),
        *maps.route(route_of(scene, day.work), numbers=False),
        *maps.hot(grid, hot_spots(grid, state)),
    ]
    if st.toggle(texts.SHOW_TRUTH, key="truth"):
        left = day.infested.copy()
        left[day.work.plant[day.work.found]] = False
        layers += maps.truth(grid, left)
    panels.draw(choices, layers, "season_map")
    st.markdown(maps.state_legend(texts.LEGEND_STATES), unsafe_allow_html=True)
    panels.captions([texts.LEGEND_HOT, texts.LEGEND_TRUTH])
