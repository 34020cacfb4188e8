"""Boxes that say what is simulated: strategies, and the season they meet."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import streamlit as st

from ..show import pest_figures
from ..state import chosen_day, widget_memory
from ..state.comparison import ComparisonSettings, Strategy
from ..words import texts
from ..words.language import listed
from ..words.strategies import sampler_name

MOST_ROBOTS = 5
# so many days of visits are named
_SOME = 6

if TYPE_CHECKING:
    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather

    from ..state.choices import Choices


def settings(choices: Choices, pest: PestInWeather | None = None) -> ComparisonSettings:
    """Show what can be compared; return what is asked for."""
    samplers = widget_memory.show(
        st.multiselect, texts.STRATEGY_SAMPLERS, list(texts.SAMPLERS), key="strategy_samplers",
        default=["adaptive", "dynamic", "naive"], format_func=sampler_name,
    )  # fmt: skip
    left, middle, right = st.columns(3)
    own_hours, own_s = float(choices.robot.hours), int(choices.robot.look_s)
    hours = middle.multiselect(
        texts.STRATEGY_HOURS, sorted({2.0, 4.0, 6.0, 8.0, 10.0, 12.0, own_hours}), [own_hours],
        key=f"strategy_hours {own_hours}", format_func="{:g}".format,
    )  # fmt: skip
    seconds = right.multiselect(
        texts.STRATEGY_INSPECTION_S, sorted({20, 25, 30, 35, 40, 45, own_s}), [own_s],
        key=f"strategy_inspection_s {own_s}",
    )  # fmt: skip
    robots = widget_memory.show(
        left.multiselect, texts.STRATEGY_ROBOTS, list(range(1, MOST_ROBOTS + 1)),
        key="strategy_robots", default=[1], help=texts.STRATEGY_ROBOTS_HELP,
    )  # fmt: skip
    strategies = tuple(
        Strategy(name, float(h), float(s), k)
        for name, h, s, k in product(samplers, hours, seconds, sorted(robots))
    )
    first, *others = _columns(4 if pest is not None else 5)
    seeds = first.number_input(texts.SEEDS, 1, 500, 20, help=texts.SEEDS_HELP, key="seeds")
    return ComparisonSettings(strategies, *_season(choices, others, pest), int(seeds))


def season(choices: Choices, pest: PestInWeather | None = None) -> tuple[int, float, float, int]:
    """Show what a simulated season is like; return what `settings` has of it."""
    return _season(choices, _columns(3 if pest is not None else 4), pest)


def _columns(number: int) -> list[DeltaGenerator]:
    return st.columns(number, vertical_alignment="bottom")


def _season(
    choices: Choices, columns: list[DeltaGenerator], pest: PestInWeather | None
) -> tuple[int, float, float, int]:
    """Show what a simulated season is like.

    Days, share infested at the start, spread a night, days from one visit to the next. The share
    and the spread begin as an open season believes. Where a pest is known, its nights are told
    instead of asked for.
    """
    show, (first, apart, second, *third) = widget_memory.show, columns
    own_share, own_rate = chosen_day.believed(choices)
    if choices.season is not None:
        said = texts.AS_BELIEVED if pest is None else texts.START_AS_BELIEVED
        st.caption(said.format(day=choices.units.said_day(choices.day)))
    n_days = int(show(first.number_input, texts.DAYS, 2, 60, key="n_days", default=25))
    every = int(show(apart.number_input, texts.VISIT_EVERY, 1, 30, key="visit_every", default=1,
                     help=texts.VISIT_EVERY_HELP))  # fmt: skip
    _say_visits(n_days, every)
    share = show(second.number_input, texts.INFESTED, 0.1, 50.0, step=0.5,
                 key=f"share {own_share:g}", default=own_share)  # fmt: skip
    if pest is not None:
        st.caption(texts.NIGHTS_OF_PEST.format(pest=pest_figures.title(pest.pest)))
        return n_days, share / 100, 0.0, every
    rate = show(third[0].number_input, texts.SPREAD, 0.0, 100.0, step=0.5, key=f"rate {own_rate:g}",
                default=own_rate, help=texts.SPREAD_HELP)  # fmt: skip
    return n_days, share / 100, rate / 100, every


def _say_visits(n_days: int, visit_every: int) -> None:
    """Say on which days somebody comes, if not on all."""
    if visit_every == 1:
        return
    days = [f"{day}" for day in range(1, n_days + 1, visit_every)]
    few = days if len(days) <= _SOME else [*days[: _SOME - 2], "…", days[-1]]
    st.caption(texts.VISITS_ON.format(visits=len(days), days=n_days, on=listed(few)))
