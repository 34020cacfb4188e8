"""Letting people record from a phone: a code for each, shown once, and taking it back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.monitoring.days.scouts_out import scouts_out
from fieldmon.monitoring.phones import scouts
from fieldmon.planning.members import person_key
from fieldmon.plot.named_rows import rows_meant

from ..show import qr_code, who_is_out
from ..state import morning_steps, notices, phone_address, scout_page
from ..words import language, texts

if TYPE_CHECKING:
    from fieldmon.monitoring import Season

    from ..state.choices import Choices

_SHOWN = "code shown"


def let_in(choices: Choices, name: str, rows: tuple[int, int] | None = None) -> str:
    """Make a person's key and return the address that opens the page with it: for a QR code.

    An earlier key of that name ends at once. Raise `SettingError` if there is no such part of the
    plot, or no name.
    """
    key = scouts.let_in(choices.open_season, name, rows)
    day = "" if choices.is_today else choices.day
    season = choices.open_season.path.stem
    return scout_page.invitation(phone_address.base().url, season, key, day, language.current())


def show_below(choices: Choices) -> None:
    """Show who is out; the codes folded, where they are not the first thing wanted."""
    _show_out(choices)
    # open at the code, which is shown once
    with st.expander(texts.INVITE, expanded=_SHOWN in st.session_state):
        _show_codes(choices)


def show(choices: Choices) -> None:
    """Show who may record from a phone, and make codes."""
    _show_codes(choices)
    _show_out(choices)


def _show_codes(choices: Choices) -> None:
    notices.show()  # in a window of its own nothing else would
    _show_code()  # above what made it: below it nobody would see it without scrolling
    st.markdown(texts.INVITE_NOTE)
    if not phone_address.base().works_offline:
        st.info(texts.INVITE_LOCAL)
    with st.form("invite", border=False):
        if choices.team:
            st.selectbox(texts.INVITE_NAME, choices.team, None, key="invite_name",
                         placeholder=texts.INVITE_NAME, accept_new_options=True)  # fmt: skip
        else:
            st.text_input(texts.INVITE_NAME, key="invite_name")
        left, right = st.columns(2)
        ends = _ends(choices.open_season)
        if choices.plot.grid.row_names:
            left.text_input(texts.INVITE_FIRST, key="invite_first")
            right.text_input(texts.INVITE_LAST, key="invite_last")
        else:
            left.number_input(texts.INVITE_FIRST, *ends, None, key="invite_first")
            right.number_input(texts.INVITE_LAST, *ends, None, key="invite_last")
        st.caption(texts.INVITE_RULES_TEAM if choices.team else texts.INVITE_RULES)
        st.form_submit_button(texts.INVITE_BUTTON, on_click=_invite, args=(choices,))


def _ends(season: Season) -> tuple[int, int]:
    """Return the first and the last row of a season's plot."""
    return int(season.plant_numbers.line.min()), int(season.plant_numbers.line.max())


def _show_out(choices: Choices) -> None:
    """Show a line for each who is out, with its cautions, and what ends a code."""
    lines = who_is_out.lines(choices)
    if not lines:
        return
    st.markdown(f"### {texts.OUT}")
    for line in lines:
        with st.container(key=f"out_{line.name}", gap=None):
            with st.container(horizontal=True, vertical_alignment="center"):
                st.markdown(f"**{line.title}**", width="stretch")
                if line.has_code:
                    st.button(texts.TAKE_BACK, key=f"take back {line.name}", type="tertiary",
                              on_click=_withdraw_key, args=(choices, line.name))  # fmt: skip
            st.caption(line.said)
            for caution in line.cautions:
                st.markdown(f":material/warning: {caution}")


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
    name = (state["invite_name"] or "").strip()
    typed = (state["invite_first"], state["invite_last"])
    first, last = (None if one in {None, ""} else f"{one}" for one in typed)
    whole = first is None and last is None
    rows = rows_meant(choices.plot.grid, first, last)
    before = {person_key(one.name) for one in scouts.scouts_of(choices.open_season)}
    state[_SHOWN] = name, let_in(choices, name, None if whole else rows)
    morning_steps.note(choices, morning_steps.SEND)
    return _what_follows(choices, name, had_code=person_key(name) in before)


def _what_follows(choices: Choices, name: str, *, had_code: bool) -> str:
    """Return what a new code means for others and for the earlier one; empty: nothing."""
    said = texts.isolated(name)
    others = ", ".join(
        texts.isolated(other)
        for one in scouts_out(choices.open_season, choices.on)
        if person_key(one.name) == person_key(name)
        for other in one.shares
    )  # fmt: skip
    beside = choices.open_season.settings.team and choices.open_season.settings.named(name) is None
    sentences = [
        texts.INVITE_ENDED.format(name=said) if had_code else "",
        texts.INVITE_SHARED.format(name=said, others=others) if others else "",
        texts.INVITE_BESIDE.format(name=said) if beside else "",
    ]
    return " ".join(one for one in sentences if one)


@notices.reporting
def _withdraw_key(choices: Choices, name: str) -> str:
    scouts.withdraw_key(choices.open_season, name)
    st.session_state.pop(_SHOWN, None)
    return texts.TAKEN_BACK.format(name=texts.isolated(name))
