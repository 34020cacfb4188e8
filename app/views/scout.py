"""Scout mode: the next plant, the big buttons, each tap saved at once."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED

from ..actions import choosing, contradicting, inviting, scouting
from ..show import field_map, map_layers
from ..show.maps import marks
from ..show.next_stop import NextStop, next_stop
from ..show.recorded_batches import GONE
from ..state import chosen_day
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices

_STYLE = Path(__file__).with_name("scout.css")  # buttons as large as thumbs in gloves


def show(choices: Choices) -> None:
    """Lead from plant to plant."""
    if choices.season is None:
        field_map.want(map_layers.day_map(choices, first="state"))
        st.markdown(texts.SCOUT_NEEDS)
        return
    st.html(_STYLE)
    with st.container():  # empty or not: buttons that move are there twice for a moment
        scouting.ask_start(choices)
        contradicting.ask_about_contradictions(choices)
    choosing.whose_day(choices)
    plan, above = choices.plan(), []
    if len(plan.route):
        stop = next_stop(plan, chosen_day.n_done(choices), choices.units)
        above = [marks.places([stop.lonlat], "next", (255, 190, 0), texts.NEXT)]
        _lead(choices, stop)
    else:
        _say_done(choices)
    scouting.offer_undo(choices)
    field_map.want(map_layers.day_map(choices, above=above, first="state"))
    inviting.show_below(choices)


def _lead(choices: Choices, stop: NextStop) -> None:
    tap = partial(scouting.tap, choices, stop.plant, after=scouting.taps())
    st.markdown(f"## {stop.arrow} {stop.place}")
    with scouting.drawn():
        st.markdown(f"**{stop.direction}**")
    with st.container(key="scout_buttons", horizontal=True):
        st.button(texts.FOUND_BUTTON, "scout_found", width="stretch", on_click=tap, args=(FOUND,))
        st.button(texts.CLEAN_BUTTON, "scout_clean", width="stretch", on_click=tap, args=(CLEAN,))
    st.caption(stop.chance)
    st.number_input(texts.COUNT_LABEL, 0, 100_000, None, key="scout_count")
    with st.container(key="scout_others"):
        st.button(texts.SKIP_BUTTON, "scout_skip", width="stretch", on_click=tap, args=(SKIPPED,))
        st.button(texts.GONE_BUTTON, "scout_gone", on_click=tap, args=(GONE,))


def _say_done(choices: Choices) -> None:
    now = chosen_day.progress(choices)
    with scouting.drawn():
        done = {"inspected": now.inspected_today, "found": now.found_today}
        day = choices.units.said_day(choices.on, choices.today)
        said = texts.SCOUT_DONE if choices.is_today else texts.SCOUT_DONE_OF
        st.markdown(said.format(day=day, **done))
    if scouting.can_be_longer(choices):
        st.caption(texts.SCOUT_LONGER_NOTE)
        with st.container(key="scout_more"):
            st.button(texts.SCOUT_LONGER, "scout_hour", on_click=scouting.longer, args=(choices,))
