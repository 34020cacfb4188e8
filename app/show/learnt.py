"""What the inspections of a season tell of the insects: how far they jump, how many arrive."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from ..state import chosen_day
from ..words import texts
from ..words.language import about, number

if TYPE_CHECKING:
    from ..state.choices import Choices

# a chance below this is said to be 0 %: how far insects would jump is then of no use
_SAID = 0.005


def show(choices: Choices) -> None:
    """Show each estimate with its interval, or that finds are traced to neighbours only."""
    st.markdown(f"**{texts.LEARNT_TITLE}**")
    estimates = chosen_day.learnt(choices)
    if not estimates:
        st.caption(texts.NOT_LEARNT)
    jump = next((one.value for one in estimates if one.name == "jumps beyond neighbours"), 1.0)
    lines = []
    for one in estimates:
        if one.name == "length of jumps" and jump < _SAID:
            continue
        said = partial(number, form=".0%") if one.is_share else about
        figures = {name: said(getattr(one, name)) for name in ("value", "low", "high")}
        lines.append(f"- {texts.LEARNT[one.name].format(**figures)}")
    if lines:
        st.markdown("\n".join(lines))
