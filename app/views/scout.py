"""Scout mode: the next plant, three big buttons, each tap saved at once."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED

from ..actions import choosing, inviting, recording, scouting
from ..show import field_map, map_layers
from ..show.maps import marks
from ..show.next_stop import next_stop
from ..state import chosen_day
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices

# the buttons are as large as thumbs in gloves
_STYLE = Path(__file__).with_name("scout.css")


def show(choices: Choices) -> None:
    """Lead from plant to plant."""
    if choices.season is None:
        field_map.want(map_layers.day_map(choices, first="state"))
        st.markdown(texts.SCOUT_NEEDS)
        return
    st.html(_STYLE)
    with st.container():  # empty or not: buttons that move are there twice for a moment
        scouting.ask_start(choices)
        recording.ask_about_contradictions(choices)
    choosing.whose_day(choices)
    plan, progress = choices.plan(), chosen_day.progress(choices)
    if not len(plan.route):
        field_map.want(map_layers.day_map(choices, first="state"))
        with scouting.drawn():
            st.markdown(texts.SCOUT_DONE.format(inspected=progress.inspected_today,
                                                found=progress.found_today))  # fmt: skip
        if scouting.can_be_longer(choices):
            st.caption(texts.SCOUT_LONGER_NOTE)
            with st.container(key="scout_more"):
                st.button(texts.SCOUT_LONGER, key="scout_hour", on_click=scouting.longer,
                          args=(choices,))  # fmt: skip
        _undo(choices)
        inviting.show_below(choices)
        return
    stop = next_stop(plan, chosen_day.n_done(choices), choices.units)
    st.markdown(f"## {stop.arrow} {stop.place}")
    with scouting.drawn():
        st.markdown(f"**{stop.direction}**")
    with st.container(key="scout_buttons", horizontal=True):
        for key, label, result in (
            ("scout_found", texts.FOUND_BUTTON, FOUND),
            ("scout_clean", texts.CLEAN_BUTTON, CLEAN),
        ):
            st.button(label, key=key, width="stretch", on_click=scouting.tap,
                      args=(choices, stop.plant, result, scouting.taps()))  # fmt: skip
    st.caption(stop.chance)
    st.number_input(texts.COUNT_LABEL, 0, 100_000, None, key="scout_count")
    with st.container(key="scout_others"):
        st.button(texts.SKIP_BUTTON, key="scout_skip", width="stretch", on_click=scouting.tap,
                  args=(choices, stop.plant, SKIPPED, scouting.taps()))  # fmt: skip
    _undo(choices)
    here = marks.places([stop.lonlat], "next", (255, 190, 0), texts.NEXT)
    field_map.want(map_layers.day_map(choices, above=[here], first="state"))
    inviting.show_below(choices)


def _undo(choices: Choices) -> None:
    if (last := scouting.last_tap(choices)) is not None:
        batch, said = last
        st.caption(said)
        with st.container(key="scout_back"):
            st.button(texts.UNDO_BUTTON, key="scout_undo", width="stretch", icon=":material/undo:",
                      on_click=scouting.undo, args=(choices, batch, scouting.taps()))  # fmt: skip
