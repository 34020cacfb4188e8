"""The records up to a day, chosen by a slider."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.infestation.records import ABSENT, PRESENT

from ..state import chosen_units
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.infestation.records import Records

    from ..state.choices import Choices

_SEEN = {"found": PRESENT, "clean": ABSENT}


def records_until(records: Records) -> tuple[Records, str]:
    """Show a slider over the days of the records; return those up to its day, and how many."""
    known = np.unique(records.day[~np.isnat(records.day)])
    shown = records
    if len(known) > 1:
        first, last = (day.item() for day in (known[0], known[-1]))
        until = st.slider(
            texts.RECORDS, first, last, last, key=f"until {first} {last}",
            format=chosen_units.units().date_format,
        )  # fmt: skip
        shown = records.take(np.isnat(records.day) | (records.day <= np.datetime64(until)))
    if not len(records):
        return records, ""
    counts = {name: int((shown.present == value).sum()) for name, value in _SEEN.items()}
    return shown, texts.RECORDS_SHOWN.format(shown=len(shown), all=len(records), **counts)


def say(choices: Choices, said: str) -> None:
    """Say which records are shown, and what is not known of them."""
    if not len(choices.records):
        st.caption(texts.RECORDS_NONE)
        return
    st.caption(said)
    if np.isnat(choices.records.day).any():
        st.caption(texts.UNDATED)
