"""A study that runs while its page waits: progress, and a button that stops it."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np
import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.studies.thesis.chapter5.sites import Site

from ..words import texts
from ..words.language import of_error

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..state.choices import Choices

    Progress = Callable[[int, int], None]

T = TypeVar("T")


def run(name: str, make: Callable[[Progress], T]) -> T | None:
    """Return what a study makes; None if it was refused, which is said.

    Any click ends the script where it next shows progress, and so the study: hence the button.
    """
    place = st.empty()
    with place.container():
        bar = st.progress(0.0)
        st.button(texts.STOP, key=f"{name}_stop")
    st.session_state[f"{name} at work"] = True

    def progress(done: int, total: int) -> None:
        bar.progress(done / max(total, 1), texts.STUDY_PROGRESS.format(done=done, total=total))

    made = None
    try:
        made = make(progress)
    except FieldmonError as error:
        st.error(of_error(error))
    # not reached where the script was ended
    st.session_state[f"{name} at work"] = False
    place.empty()
    return made


def say_stopped(name: str) -> None:
    """Say that the study was stopped, if it was."""
    if st.session_state.pop(f"{name} at work", False):
        st.info(texts.STUDY_STOPPED)


def site_of(choices: Choices) -> Site:
    """Return the chosen plot as a site of the study; where it has records, they seed the start."""
    plot = choices.plot
    if not len(choices.records):
        return Site(plot.field.name, plot.aisles, plot.field)
    day = np.datetime64(choices.day, "D")
    chance = prior_chance(plot.grid, plot.field, choices.records, day, choices.prior)
    return Site(plot.field.name, plot.aisles, plot.field, chance)
