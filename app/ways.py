"""Widgets that say what is simulated: ways of working, and the season they meet."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from . import texts
from .comparing import Arm, Asked

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.season import Day

    from .choices import Choices


def short(name: str) -> str:
    """Return a sampler's name without its description."""
    return texts.SAMPLERS[name].split(":")[0]


def asked(choices: Choices) -> Asked:
    """Show what can be compared; return what is asked for."""
    left, middle, right = st.columns([2, 1, 1])
    samplers = left.multiselect(
        texts.ARM_SAMPLERS, list(texts.SAMPLERS), ["dynamic", "naive", "bouncy"], key="arms",
        format_func=short, persist_state="session",
    )  # fmt: skip
    own_hours, own_look = float(choices.robot.hours), int(choices.robot.look_s)
    hours = middle.multiselect(
        texts.ARM_HOURS, sorted({2.0, 4.0, 6.0, 8.0, 10.0, 12.0, own_hours}), [own_hours],
        key=f"arm_hours {own_hours}",
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
    keep = {"persist_state": "session"}
    n_days = columns[0].number_input(texts.DAYS, 2, 60, 25, key="n_days", **keep)
    share = columns[1].number_input(texts.INFESTED, 0.1, 50.0, 2.0, 0.5, key="share", **keep)
    rate = columns[2].number_input(
        texts.SPREAD, 0.0, 100.0, 10.0, 5.0, help=texts.SPREAD_HELP, key="rate", **keep
    )
    return int(n_days), share / 100, rate / 100


def seen_by(walk: list[Day], number: int) -> NDArray[np.int8]:
    """Return ``(n,)`` found (1), clean (0) or never inspected (-1) after a simulated day."""
    state = np.where(walk[number].last_inspected >= 0, 0, -1).astype(np.int8)
    for day in walk[: number + 1]:
        state[day.work.plant[day.work.found]] = 1
    return state
