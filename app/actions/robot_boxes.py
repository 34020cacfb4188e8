"""How wide the robot is, how it turns and which times are charged: boxes beside its hours."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.plot.robot import ROBOT_TIMES, USUAL_TIMES

from ..state import strategy_boxes
from ..state.chosen_units import units
from ..words import texts
from ..words.language import number

if TYPE_CHECKING:
    from fieldmon.plot.robot import Robot

#: times that a command has set, which no preset has
_OWN = "own"
_WIDTHS_M, _RADII_M = (0.1, 10.0), (0.1, 20.0)


def of_files(robot: Robot, place: str) -> Robot:
    """Show the boxes of a plot that no season keeps; return the robot that they say."""
    show = partial(strategy_boxes.show, place=place)
    unit = texts.UNITS[units().length]
    width = show(
        st.number_input, texts.ROBOT_WIDTH.format(unit=unit), *units().limits(*_WIDTHS_M),
        step=0.05, key="robot_width", counts=None, help=texts.ROBOT_WIDTH_HELP,
    )  # fmt: skip
    radius = show(
        st.number_input, texts.ROBOT_TURNS.format(unit=unit), *units().limits(*_RADII_M),
        step=0.1, key="robot_turns", counts=None, disabled=width is None,
        help=texts.ROBOT_TURNS_HELP,
    )  # fmt: skip
    times = show(
        st.selectbox, texts.ROBOT_TIMES_LABEL, list(ROBOT_TIMES), key="robot_times",
        counts=robot.times, filter_mode=None, format_func=lambda name: _times_name(robot, name),
        help=texts.ROBOT_TIMES_HELP,
    )  # fmt: skip
    return _with_size(robot.with_times(times or USUAL_TIMES), width, radius)


def of_season(robot: Robot, place: str, key: str) -> Robot:
    """Show the boxes of a season's robot; return the robot that they say."""
    show = partial(strategy_boxes.show, place=place)
    size = f"{robot.width_m} {robot.turning_radius_m}"
    now, key = units(), f"{key} {size} {robot.times} {units().length}"
    unit, was = texts.UNITS[now.length], (_shown(robot.width_m, _WIDTHS_M),
                                          _shown(robot.turning_radius_m, _RADII_M))  # fmt: skip
    width = show(
        st.number_input, texts.ROBOT_WIDTH.format(unit=unit), *now.limits(*_WIDTHS_M),
        counts=was[0], step=0.05, key=f"robot_width {key}", help=texts.ROBOT_WIDTH_HELP,
    )  # fmt: skip
    radius = show(
        st.number_input, texts.ROBOT_TURNS.format(unit=unit), *now.limits(*_RADII_M),
        counts=was[1], step=0.1, key=f"robot_turns {key}", disabled=width is None,
        help=texts.ROBOT_TURNS_HELP,
    )  # fmt: skip
    names = [*ROBOT_TIMES, *([_OWN] if robot.times is None else [])]
    times = strategy_boxes.show(
        st.selectbox, texts.ROBOT_TIMES_LABEL, names, place=place, counts=robot.times or _OWN,
        key=f"robot_times {key}", filter_mode=None, help=texts.ROBOT_TIMES_HELP,
        format_func=lambda name: _times_name(robot, name),
    )  # fmt: skip
    charged = robot if times == _OWN else robot.with_times(times)
    # what is shown is rounded: what nobody changed stays as it was
    return charged if (width, radius) == was else _with_size(charged, width, radius)


def _shown(metres: float | None, limits_m: tuple[float, float]) -> float | None:
    """Return a length as its box shows it."""
    if metres is None:
        return None
    low, high = units().limits(*limits_m)
    return min(max(units().shown(metres), low), high)


def _with_size(robot: Robot, width: float | None, radius: float | None) -> Robot:
    """Return a robot of another width and turning radius, as their boxes show them.

    A length that a command said stays, if it has a width.
    """
    if width is None:
        return replace(robot, width_m=None, length_m=None, turning_radius_m=None)
    turns_m = None if radius is None else units().in_metres(radius)
    return replace(robot, width_m=units().in_metres(width), turning_radius_m=turns_m)


def _times_name(robot: Robot, name: str) -> str:
    of = robot if name == _OWN else robot.with_times(name)
    return texts.ROBOT_TIMES_NAMES[name].format(
        row=number(of.row_change_s, "g"),
        turn=number(of.turn_180_s, "g"),
        stop=number(of.stop_s, "g"),
    )
