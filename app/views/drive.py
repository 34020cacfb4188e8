"""Drive: a day seen between the rows, as a simulated robot drives it or as it was driven."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.drive.simulated import CHARGED, MUJOCO, MadeUp
from fieldmon.samplers import sampler

from ..actions import background
from ..show import drive_play, field_map
from ..state import cached, widget_memory
from ..words import texts
from ..words.language import of_error

if TYPE_CHECKING:
    from fieldmon.samplers.base import Scene

    from ..state.choices import Choices
    from ..state.driving import DriveRun


def show(choices: Choices) -> None:
    """Choose a day, let it be driven or bring its file, and watch it."""
    st.caption(texts.DRIVE_INTRO)
    scene = choices.wishes.told(choices.plan().scene)
    field_map.want(drive_play.content(choices, scene, None))
    source = widget_memory.show(
        st.segmented_control, texts.DRIVE_SOURCE, list(texts.DRIVE_SOURCES), key="drive_source",
        default="planned", required=True, format_func=texts.DRIVE_SOURCES.__getitem__,
    )  # fmt: skip
    shown = f"{choices.key} {choices.revision} {choices.day} {choices.who} {choices.robot}"
    shown = f"{shown} {choices.sampler} {choices.wishes} {choices.prior}"
    if source == "planned":
        run = _run(choices, scene, shown)
        st.fragment(_progress, run_every=0.5 if run.running else None)(run, at_work=run.running)
        day = run.day
    elif (brought := st.file_uploader(texts.DRIVE_FILE, type=["mcap", "csv"])) is None:
        return
    else:
        data = brought.getvalue()
        key = f"{shown} {cached.digest(data)}"
        day = cached.recorded_drive(key, data, choices.plot, scene)
        st.caption(texts.DRIVE_BELIEVED)
    if day is not None:
        st.caption(texts.DRIVE_KEYS)
        field_map.want(drive_play.content(choices, scene, day))


def _run(choices: Choices, scene: Scene, key: str) -> DriveRun:
    kinds = [CHARGED, *([MUJOCO] if find_spec("mujoco") else [])]
    kind = widget_memory.show(
        st.segmented_control, texts.DRIVE_ROBOT, kinds, key="drive_robot", default=CHARGED,
        required=True, format_func=texts.DRIVE_ROBOTS.__getitem__,
    )  # fmt: skip
    share = widget_memory.show(
        st.number_input, texts.DRIVE_SHARE, 0.1, 50.0, step=0.5, key="drive_share", default=2.0
    )
    st.caption(texts.DRIVE_MADE_UP)
    made_up = MadeUp(share / 100)
    run = cached.drive_run(key, kind, made_up, choices.plot, scene, sampler(choices.sampler))
    background.buttons(run, texts.DRIVE_RUN, key="drive_run", over=run.day is not None)
    return run


def _progress(run: DriveRun, *, at_work: bool) -> None:
    if at_work and not run.running:
        st.rerun()  # the map must know
    if run.problem is not None:
        st.error(of_error(run.problem))
    if run.running:
        st.progress(run.share, texts.DRIVE_PROGRESS.format(share=round(100 * run.share)))
    if run.said:
        st.warning(run.said)
