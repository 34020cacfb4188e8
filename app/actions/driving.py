"""Let a planned day be driven by a simulated robot."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.drive.simulated_robots import CHARGED, MUJOCO, MadeUp

from ..state import cached_simulations, chosen_day, widget_memory
from ..words import texts
from ..words.language import of_error
from ..words.units import hours
from . import background_work

if TYPE_CHECKING:
    from fieldmon.drive.trace import Trace
    from fieldmon.samplers.base import Scene

    from ..state.choices import Choices
    from ..state.driving import DriveRun


def run(choices: Choices, scene: Scene, key: str) -> DriveRun:
    """Ask who drives a planned day, and let it be driven; return it, done or to be."""
    kinds = [CHARGED, *([MUJOCO] if find_spec("mujoco") else [])]
    kind = widget_memory.show(
        st.segmented_control, texts.DRIVE_ROBOT, kinds, key="drive_robot", default=CHARGED,
        required=True, format_func=texts.DRIVE_ROBOTS.__getitem__,
    )  # fmt: skip
    believed, _ = chosen_day.believed(choices)
    share = widget_memory.show(
        st.number_input, texts.DRIVE_SHARE, 0.1, 50.0, step=0.5, key=f"drive_share {believed:g}",
        default=believed,
    )  # fmt: skip
    if choices.season is not None and share == believed:
        st.caption(texts.DRIVE_BELIEVES.format(day=choices.units.said_day(choices.day)))
    st.caption(texts.DRIVE_MADE_UP)
    made_up = MadeUp(share / 100)
    made = cached_simulations.drive_run(key, kind, made_up, choices.plot, scene, choices.decides)
    over = made.day is not None
    at_work = background_work.buttons(made, texts.DRIVE_RUN, key="drive_run", over=over)
    st.fragment(_progress, run_every=0.5 if at_work else None)(made, at_work=at_work)
    return made


def _progress(run: DriveRun, *, at_work: bool) -> None:
    if at_work and not run.running:
        st.rerun()  # the map must know
    if run.problem is not None:
        st.error(of_error(run.problem))
    if run.running:
        st.progress(run.share, texts.DRIVE_PROGRESS.format(share=round(100 * run.share)))
    if run.thrown_away:
        st.info(texts.DRIVE_STOPPED)
    if run.day is not None:
        st.markdown(_result(run.day.trace))
    if run.said:
        st.warning(run.said)


def _result(trace: Trace) -> str:
    """Return what came of a driven day."""
    found = sum(stop.found is True for stop in trace.stops)
    time = hours(trace.end_s / 3600)
    return texts.DRIVE_DONE.format(n=len(trace.stops), found=found, time=time)
