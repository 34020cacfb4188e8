"""Letting people record from a phone: a code for each, shown once, and taking it back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.monitoring import scouts

from ..show import qr_code
from ..state import morning, notices, phone, scout_page
from ..words import language, texts

if TYPE_CHECKING:
    from ..state.choices import Choices

_SHOWN = "code shown"


def let_in(choices: Choices, name: str, rows: tuple[int, int] | None = None) -> str:
    """Make a person's key and return the address that opens the page with it: for a QR code.

    An earlier key of that name ends at once. Raise `SettingError` if there is no such part of the
    plot, or no name.
    """
    key = scouts.let_in(choices.season, name, rows)
    day = "" if choices.is_today else choices.day
    season = choices.season.path.stem
    return scout_page.invitation(phone.base().url, season, key, day, language.current())


def show_folded(choices: Choices) -> None:
    """Show it where it is not the first thing wanted."""
    with st.expander(texts.INVITE):
        show(choices)


def show(choices: Choices) -> None:
    """Show who may record from a phone, and make codes."""
    notices.show()  # in a window of its own nothing else would
    st.markdown(texts.INVITE_NOTE)
    if not phone.base().works_offline:
        st.info(texts.INVITE_LOCAL)
    with st.form("invite", border=False):
        st.text_input(texts.INVITE_NAME, key="invite_name")
        left, right = st.columns(2)
        rows = int(choices.season.label.line.max())
        left.number_input(texts.INVITE_FIRST, 1, rows, None, key="invite_first")
        right.number_input(texts.INVITE_LAST, 1, rows, None, key="invite_last")
        st.form_submit_button(texts.INVITE_BUTTON, on_click=_invite, args=(choices,))
    _show_code()
    for scout in scouts.scouts_of(choices.season):
        name, ends = st.columns([3, 1], vertical_alignment="center")
        said = texts.isolated(scout.name)
        if scout.rows is not None:
            said = texts.INVITED.format(name=said, low=scout.rows[0], high=scout.rows[1])
        name.markdown(said)
        ends.button(texts.TAKE_BACK, key=f"take back {scout.name}", on_click=_take_back,
                    args=(choices, scout.name))  # fmt: skip


def _show_code() -> None:
    if _SHOWN not in st.session_state:
        return
    name, address = st.session_state[_SHOWN]
    st.markdown(f"**{texts.INVITE_CODE.format(name=texts.isolated(name))}**")
    st.html(qr_code.image(address, texts.INVITE_ALT))
    st.code(address, language=None, wrap_lines=True)


@notices.reporting
def _invite(choices: Choices) -> str:
    state = st.session_state
    name, first, last = state["invite_name"], state["invite_first"], state["invite_last"]
    whole = first is None and last is None
    lines = int(choices.season.label.line.max())
    rows = None if whole else (int(first or 1), int(last or lines))
    state[_SHOWN] = name.strip(), let_in(choices, name, rows)
    morning.note(choices, morning.SEND)
    return ""


@notices.reporting
def _take_back(choices: Choices, name: str) -> str:
    scouts.take_back(choices.season, name)
    st.session_state.pop(_SHOWN, None)
    return texts.TAKEN_BACK.format(name=texts.isolated(name))
