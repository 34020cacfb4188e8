"""Widgets that say what is simulated: ways of working, and the season they meet."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from . import remembered, texts
from .comparing import Arm, Asked
from .verdicts import short

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.simulation.season import SimulatedDay

    from .choices import Choices


def asked(choices: Choices) -> Asked:
    """Show what can be compared; return what is asked for."""
    left, middle, right = st.columns([2, 1, 1])
    samplers = remembered.show(
        left.multiselect, texts.ARM_SAMPLERS, list(texts.SAMPLERS), key="arms",
        default=["adaptive", "dynamic", "naive"], format_func=short,
    )  # fmt: skip
    own_hours, own_look = float(choices.robot.hours), int(choices.robot.look_s)
    hours = middle.multiselect(
        texts.ARM_HOURS, sorted({2.0, 4.0, 6.0, 8.0, 10.0, 12.0, own_hours}), [own_hours],
        key=f"arm_hours {own_hours}", format_func="{:g}".format,
    )  # fmt: skip
    looks = right.multiselect(
        texts.ARM_LOOKS, sorted({20, 25, 30, 35, 40, 45, own_look}), [own_look],
        key=f"arm_looks {own_look}",
    )  # fmt: skip
    arms = tuple(Arm(s, float(h), float(k)) for s, h, k in product(samplers, hours, looks))
    first, *others = st.columns(4)
    seeds = first.number_input(texts.SEEDS, 1, 500, 20, help=texts.SEEDS_HELP, key="seeds")
    return Asked(arms, *season(others), int(seeds))


def season(columns: list) -> tuple[int, float, float]:
    """Show what a simulated season is like: days, share infested at the start, spread a night."""
    show, (first, second, third) = remembered.show, columns
    n_days = show(first.number_input, texts.DAYS, 2, 60, key="n_days", default=25)
    share = show(second.number_input, texts.INFESTED, 0.1, 50.0, step=0.5, key="share", default=2.0)
    rate = show(third.number_input, texts.SPREAD, 0.0, 100.0, step=5.0, key="rate", default=10.0,
                help=texts.SPREAD_HELP)  # fmt: skip
    return int(n_days), share / 100, rate / 100


def seen_by(walk: list[SimulatedDay], number: int) -> NDArray[np.int8]:
    """Return ``(n,)`` found (1), clean (0) or never inspected (-1) after a simulated day."""
    state = np.where(walk[number].last_inspected >= 0, 0, -1).astype(np.int8)
    for day in walk[: number + 1]:
        state[day.work.plant[day.work.found]] = 1
    return state
