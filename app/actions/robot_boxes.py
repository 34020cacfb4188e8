"""How wide the robot is, and which times are charged: boxes beside its hours."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.plot.robot import ROBOT_TIMES, USUAL_TIMES

from ..state import widget_memory
from ..state.chosen_units import units
from ..words import texts
from ..words.language import number

if TYPE_CHECKING:
    from fieldmon.plot.robot import Robot

#: times that a command has set, which no preset has
_OWN = "own"


def of_files(robot: Robot) -> Robot:
    """Show the boxes of a plot that no season keeps; return the robot that they say."""
    unit = texts.UNITS[units().length]
    shown = widget_memory.show(
        st.number_input, texts.ROBOT_WIDTH.format(unit=unit), *units().limits(0.1, 10.0),
        step=0.05, key="robot_width", help=texts.ROBOT_WIDTH_HELP,
    )  # fmt: skip
    times = widget_memory.show(
        st.selectbox, texts.ROBOT_TIMES_LABEL, list(ROBOT_TIMES), key="robot_times",
        default=robot.times, filter_mode=None, format_func=lambda name: _times_name(robot, name),
        help=texts.ROBOT_TIMES_HELP,
    )  # fmt: skip
    return _with_width(robot.with_times(times or USUAL_TIMES), shown)


def of_season(robot: Robot, key: str) -> Robot:
    """Show the boxes of a season's robot; return the robot that they say."""
    now, key = units(), f"{key} {robot.width_m} {robot.times} {units().length}"
    width_m, limits = robot.width_m, units().limits(0.1, 10.0)
    was = None if width_m is None else min(max(now.shown(width_m), limits[0]), limits[1])
    unit = texts.UNITS[now.length]
    shown = widget_memory.anew(
        st.number_input, texts.ROBOT_WIDTH.format(unit=unit), *limits, value=was, step=0.05,
        key=f"robot_width {key}", help=texts.ROBOT_WIDTH_HELP,
    )  # fmt: skip
    names = [*ROBOT_TIMES, *([_OWN] if robot.times is None else [])]
    times = st.selectbox(texts.ROBOT_TIMES_LABEL, names, names.index(robot.times or _OWN),
                         key=f"robot_times {key}", filter_mode=None, help=texts.ROBOT_TIMES_HELP,
                         format_func=lambda name: _times_name(robot, name))  # fmt: skip
    charged = robot if times == _OWN else robot.with_times(times)
    # what is shown is rounded: what nobody changed stays as it was
    return charged if shown == was else _with_width(charged, shown)


def _with_width(robot: Robot, shown: float | None) -> Robot:
    """Return a robot of another width; a length that a command said stays, if it has a width."""
    width_m = None if shown is None else units().in_metres(shown)
    return replace(robot, width_m=width_m, length_m=None if width_m is None else robot.length_m)


def _times_name(robot: Robot, name: str) -> str:
    of = robot if name == _OWN else robot.with_times(name)
    return texts.ROBOT_TIMES_NAMES[name].format(
        row=number(of.row_change_s, "g"),
        turn=number(of.turn_180_s, "g"),
        stop=number(of.stop_s, "g"),
    )
