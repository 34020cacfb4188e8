"""Compare: which sampler, how many hours, how long at a plant, on this very plot."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.simulation.worker import LaidPlot

from ..actions import background_work, changing_strategy, comparing
from ..show import charts, field_map, map_layers, verdicts
from ..state import cached_simulations, chosen_day, chosen_pest
from ..state.comparison import WatchedComparison, curve, gains, outcomes
from ..words import texts
from ..words.language import of_error

if TYPE_CHECKING:
    from ..state.choices import Choices

_MOST = 12
# how often is looked for results
_EVERY_S = 1.0


def show(choices: Choices) -> None:
    """Choose what to compare, and watch the results come."""
    field_map.want(map_layers.day_map(choices))
    pest = chosen_pest.in_weather(choices)
    st.caption(texts.COMPARE_INTRO + ("" if pest else f" {texts.COMPARE_ASSUMED}"))
    settings = comparing.settings(choices, pest)
    if not 1 <= len(settings.strategies) <= _MOST:
        st.warning(texts.TOO_MANY.format(most=_MOST, n=len(settings.strategies)))
        return
    key = f"{choices.key} {choices.revision} {choices.day} {chosen_pest.key(pest)}"
    laid = LaidPlot(choices.plot, chosen_day.chance(choices), pest)
    running = cached_simulations.comparison(key, settings, choices.robot, laid)
    label = texts.GO_ON if 0 < running.done < running.total else texts.RUN
    over = running.done == running.total
    at_work = background_work.buttons(running, label, key="run", over=over)
    st.fragment(_watch, run_every=_EVERY_S if at_work else None)(choices, running, at_work=at_work)


def _watch(choices: Choices, running: WatchedComparison, *, at_work: bool) -> None:
    if at_work and not running.running:
        st.rerun()  # the buttons must know
    _results(choices, running)


def _results(choices: Choices, running: WatchedComparison) -> None:
    if running.problem is not None:
        st.error(of_error(running.problem))
        return
    background_work.show_progress(running)
    seasons = running.seasons()
    ranked = outcomes(seasons)
    if not ranked:
        return
    for said in (verdicts.sentence(ranked), *map(verdicts.robots_sentence, gains(seasons))):
        st.markdown(said)
    if running.running and isnan(ranked[0].loss.low):
        return  # the sentence is there at once; curves and table come with their first interval
    curves = {verdicts.name(one): curve(walked) for one, walked in seasons.items()}
    axes, samplers = (texts.DAY_AXIS, texts.DETECTION_AXIS), [one.sampler for one in seasons]
    every = running.settings.visit_every
    st.altair_chart(charts.bands(curves, axes, samplers, every), alt=texts.DETECTION_AXIS)
    # two tables of words that wrap: of one wide one the last columns were out of sight
    for table in verdicts.tables(ranked, daily=every == 1):
        st.table(table, hide_index=True, border="horizontal")
    alone = [o.strategy for o in ranked if o.strategy.robots == 1]
    if not alone:
        return
    with st.container(horizontal=True, vertical_alignment="bottom"):
        box = f"use_strategy {running.settings.strategies}"
        st.selectbox(texts.STRATEGY, alone, format_func=verdicts.name, width=340, key=box)
        use = changing_strategy.use
        st.button(texts.USE_THIS, key="use_this", on_click=use, args=(choices, box))
