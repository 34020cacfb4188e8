"""What is assumed, said beside the figures that rest on it, and changed there."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.monitoring.estimates.told_anew import telling_anew

from ..show.assumed import of_who_inspects, sentence
from ..state import assumptions, notices, widget_memory
from ..words import texts
from ..words.language import in_words
from . import editing_plot

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Say what the figures above rest on, with the way to say otherwise."""
    assumed = assumptions.of(choices)
    st.caption(sentence(assumed, choices.units) or texts.ASSUMED_NOTHING)
    with st.popover(texts.ASSUMED_ALL):
        if more := of_who_inspects(assumed, choices.units):
            st.caption(more)
        if choices.season is None:
            _boxes(choices)
        else:
            _boxes_of_season(choices)


def finds_are(show: Callable[..., object], key: str, **begins: object) -> None:
    """Show the box for what happens with a find: treated at once, or only flagged."""
    show(
        st.radio, texts.FINDS_ARE, list(texts.FINDS_TREATED), key=key, horizontal=True,
        format_func=texts.FINDS_TREATED.get, help=texts.FINDS_ARE_HELP, **begins,
    )  # fmt: skip


def _boxes(choices: Choices) -> None:
    if choices.plot.field.plants is None and not assumptions.asked(choices):
        editing_plot.spacings(choices.plot_key)
    usual = f"{100 * PriorSettings().background_chance:g}"
    widget_memory.show(
        st.number_input, texts.BACKGROUND, 0.0, 100.0, step=0.5, key=assumptions.BACKGROUND,
        placeholder=usual, help=texts.BACKGROUND_HELP,
    )  # fmt: skip
    st.caption(texts.ASSUMED_ROBOT)


def _boxes_of_season(choices: Choices) -> None:
    settings = choices.open_season.settings
    with st.form("assumed_form", border=False):
        st.caption(texts.ASSUMED_LAID)
        # side by side: a low window shows all of it at once
        left, right = st.columns(2)
        usual = 100 * settings.prior.background_chance
        with left:
            widget_memory.anew(st.number_input, texts.BACKGROUND, 0.0, 100.0, usual, 0.5,
                               key="season_background", help=texts.BACKGROUND_HELP)  # fmt: skip
        # a pest says itself how it spreads
        if settings.pest is None:
            usual = 100 * settings.belief.spread.rate_per_day
            with right:
                widget_memory.anew(st.number_input, texts.SPREAD, 0.0, 100.0, usual, 0.5,
                                   key="season_spread", help=texts.SPREAD_HELP)  # fmt: skip
        with st.container(horizontal=True, vertical_alignment="bottom"):
            finds_are(widget_memory.anew, "season_finds", index=0 if settings.belief.treated else 1)
            st.form_submit_button(texts.ASSUMED_USE, on_click=_change, args=(choices,))


@notices.reporting
def _change(choices: Choices) -> str:
    """Let a season believe otherwise, from its first morning on."""
    settings, state = choices.open_season.settings, st.session_state
    prior = replace(settings.prior, background_chance=state["season_background"] / 100)
    belief = replace(settings.belief, treated=state["season_finds"])
    if settings.pest is None:
        rate = state["season_spread"] / 100
        belief = replace(belief, spread=replace(belief.spread, rate_per_day=rate))
    new, said = replace(settings, prior=prior, belief=belief), [texts.ASSUMED_CHANGED]
    with telling_anew(choices.open_season, settings, new, said.append):
        choices.open_season.change(new, settings)
    return " ".join(map(in_words, said))
