"""Drive: a day seen between the rows, as a simulated robot drives it or as it was driven."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.compute.digest import digest

from ..actions import choosing, driving, watching
from ..show import day, drive_play, field_map
from ..state import cached_simulations, widget_memory
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Choose a day, let it be driven or bring its file, and watch it."""
    st.caption(texts.DRIVE_INTRO)
    shown = f"{choices.key} {choices.revision} {choices.day} {choices.whose_day} {choices.robot}"
    shown = f"{shown} {choices.sampler} {choices.wishes} {choices.prior}"
    plan = choices.plan()
    scene = choices.wishes.applied_to(plan.scene)
    field_map.want(drive_play.content(choices, scene, None))
    source = widget_memory.show(
        st.segmented_control, texts.DRIVE_SOURCE, list(texts.DRIVE_SOURCES), key="drive_source",
        default="planned", required=True, format_func=texts.DRIVE_SOURCES.__getitem__,
    )  # fmt: skip
    if source == "planned":
        choosing.whose_day(choices)
        if not len(plan.route):
            day.say_of_day(choices, plan)
            return
        driven = driving.run(choices, scene, shown).day
    elif source == "live":
        watched = f"{choices.key} {choices.day}"
        if (live := watching.robots(watched, choices, scene)) is not None and live.running:
            field_map.want(drive_play.live_content(choices, live, f"{watched} {id(live)}"))
        return
    elif (brought := st.file_uploader(texts.DRIVE_FILE, type=["mcap", "csv"])) is None:
        return
    else:
        data = brought.getvalue()
        key = f"{shown} {digest(data)}"
        driven = cached_simulations.recorded_drive(key, data, choices.plot, scene)
        st.caption(texts.DRIVE_BELIEVED)
    if driven is not None:
        st.caption(texts.DRIVE_KEYS)
        field_map.want(drive_play.content(choices, scene, driven))
