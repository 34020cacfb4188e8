"""Scout mode: the next plant, three big buttons, each tap saved at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from app import maps, panels, scouting, texts

if TYPE_CHECKING:
    from app.choices import Choices

_BIG = """<style>
[class*="st-key-scout"] button {min-height:4.2rem;width:100%}
.st-key-scout_count button {min-height:0;width:auto}
[class*="st-key-scout"] button p {font-size:1.4rem;font-weight:600}
.st-key-scout_clean button {background:#146c43;color:#fff;border-color:#146c43}
.st-key-scout_found button {background:#b3171d;color:#fff;border-color:#b3171d}
</style>"""


def show(choices: Choices) -> None:
    """Lead from plant to plant."""
    if choices.project is None:
        st.markdown(texts.SCOUT_NEEDS)
        return
    st.html(_BIG)
    scouting.give_out(choices)
    scouting.ask_start(choices)
    today = choices.today()
    status = scouting.status(choices)
    if not len(today.route):
        st.markdown(texts.SCOUT_DONE.format(inspected=status.inspected_today,
                                            found=status.found_today))  # fmt: skip
        st.caption(texts.SCOUT_LONGER_NOTE)
        with st.container(key="scout_more"):
            st.button(texts.SCOUT_LONGER, key="scout_hour", on_click=scouting.longer,
                      args=(choices,))  # fmt: skip
        _undo(choices)
        return
    step = scouting.next_step(choices, today)
    st.markdown(f"## {step.arrow} {step.place}")
    st.markdown(f"**{step.way}**")
    st.caption(step.chance)
    with st.container(key="scout_buttons", horizontal=True):
        for key, label, result in (
            ("scout_clean", texts.CLEAN_BUTTON, scouting.CLEAN),
            ("scout_found", texts.FOUND_BUTTON, scouting.FOUND),
        ):
            st.button(label, key=key, width="stretch", on_click=scouting.tap,
                          args=(choices, step.plant, result))  # fmt: skip
    st.number_input(texts.COUNT_LABEL, 0, 100_000, None, key="scout_count")
    with st.container(key="scout_others"):
        st.button(texts.SKIP_BUTTON, key="scout_skip", width="stretch", on_click=scouting.tap,
                  args=(choices, step.plant, scouting.SKIPPED))  # fmt: skip
    _undo(choices)
    layers = [
        *panels.plant_layers(choices, "state"),
        *panels.route_layers(choices, today.route, numbers=False),
        maps.places([step.lonlat], "next", (255, 190, 0), texts.NEXT),
    ]
    panels.draw(choices, layers, "scout_map")
    st.markdown(maps.state_legend(texts.LEGEND_STATES), unsafe_allow_html=True)
    panels.captions([texts.LEGEND_ROUTE])


def _undo(choices: Choices) -> None:
    last = scouting.last_tap(choices)
    if last is not None:
        st.caption(scouting.last_said(choices))
        with st.container(key="scout_back"):
            st.button(texts.UNDO_BUTTON, key="scout_undo", width="stretch", icon=":material/undo:",
                      on_click=scouting.undo, args=(choices, last))  # fmt: skip
