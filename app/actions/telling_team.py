"""Telling who works as a team: a row of boxes each, and the team's table as a file."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.io.readers.team import team_of_table
from fieldmon.io.sandbox import limits
from fieldmon.io.writers.team import team_csv
from fieldmon.monitoring.settings.settings_words import besides_in_words
from fieldmon.planning.stated_team import stated_team, team_stated

from ..state import told_team, widget_memory
from ..state.chosen_units import units
from ..state.told_team import ROBOT, SCOUT
from ..words import texts
from ..words.language import in_words, of_error

if TYPE_CHECKING:
    from datetime import time

    from fieldmon.plot.robot import Robot

    from ..state.told_team import MemberRow, TeamChoice, TeamDraft

_PROBLEM = "team table problem "
# more rows than these take a page too long
_MOST_ROWS = 20
_TABLE, _TABLE_BYTES = "team.csv", limits.MB


def show(place: str, now: TeamChoice, robot: Robot) -> TeamChoice | None:
    """Show the boxes of a team that counts `now`, or is to be of `robot`; return what they say.

    None where that cannot be, or another window changed who works since it was begun: they say it.
    """
    draft = told_team.draft(place, now, robot)
    is_late = draft.seen != now
    # whatever is said among the rows, what stands below them is in its place, and stays open
    with st.container():
        told = _rows(place, draft, now, is_late=is_late)
    with st.expander(texts.TEAM_MORE):
        _together(draft)
        _table(place, draft, told)
    return None if is_late else told


def _rows(place: str, draft: TeamDraft, now: TeamChoice, *, is_late: bool) -> TeamChoice | None:
    """Show the rows; return what they say, None where that cannot be."""
    if is_late:
        st.warning(texts.TEAM_LATE)
        st.button(texts.TEAM_NOW, key="team_now", on_click=told_team.drop, args=(place,))
        st.button(texts.TEAM_GO_ON, key="team_go_on", on_click=told_team.go_on, args=(place, now))
    if len(draft.rows) > _MOST_ROWS:
        st.caption(texts.TEAM_MANY.format(n=len(draft.rows)))
    else:
        for row in draft.rows:
            _row(place, row, is_alone=len(draft.rows) == 1)
        with st.container(horizontal=True):
            for who, label in ((ROBOT, texts.TEAM_ADD_ROBOT), (SCOUT, texts.TEAM_ADD_SCOUT)):
                st.button(label, key=f"team_add_{who}", icon=":material/add:",
                          on_click=told_team.add, args=(place, who))  # fmt: skip
    return _told(draft)


def _told(draft: TeamDraft) -> TeamChoice | None:
    """Return what the boxes say; None where that cannot be, which is said below them."""
    try:
        return draft.told()
    except FieldmonError as error:
        st.error(of_error(error))
        return None


def _row(place: str, row: MemberRow, *, is_alone: bool) -> None:
    show = widget_memory.show
    with st.container(border=True, key=f"team_row_{row.number}"):
        with st.container(horizontal=True, vertical_alignment="bottom"):
            show(st.text_input, texts.TEAM_NAME, key=row.key("name"), default=row.first("name"),
                 label_visibility="collapsed", placeholder=texts.TEAM_NAME)  # fmt: skip
            if not is_alone:
                name = texts.isolated(row.said("name"))
                st.button(texts.TEAM_TAKE_OUT.format(name=name), key=row.key("out"),
                          icon=":material/close:", type="tertiary", on_click=told_team.take_out,
                          args=(place, row.number))  # fmt: skip
        show(st.segmented_control, texts.WHO, [ROBOT, SCOUT], key=row.key("who"),
             default=row.first("who"), required=True, label_visibility="collapsed",
             format_func={ROBOT: texts.ROBOT, SCOUT: texts.SCOUT}.get,
             on_change=told_team.turn_kind, args=(row,))  # fmt: skip
        hours, look, start = st.columns(3)
        with hours:
            show(st.number_input, texts.TEAM_HOURS, 0.0, 24.0, step=0.5, key=row.key("hours"),
                 default=row.first("hours"))  # fmt: skip
        with look:
            show(st.number_input, texts.TEAM_SECONDS, 0.0, 86_400.0, step=5.0, key=row.key("look"),
                 default=row.first("look"), help=texts.INSPECTION_S)  # fmt: skip
        with start:
            show(st.time_input, texts.TEAM_START, key=row.key("start"), default=row.first("start"))
        with suppress(FieldmonError):  # said below all rows
            st.caption(in_words(besides_in_words(row.told())))


def _together(draft: TeamDraft) -> None:
    """Show the boxes of how all work together."""
    most = {"contact": (1440.0, 5.0), "least_gain": (1e9, 0.1)}
    unit = texts.UNITS[units().length]
    for box, (last, step) in most.items():
        widget_memory.show(
            st.number_input, texts.TEAM_TOGETHER[box], 0.0, last, step=step, key=draft.key(box),
            default=draft.first(box), help=texts.TEAM_TOGETHER_HELP[box],
        )  # fmt: skip
    widget_memory.show(
        st.number_input, texts.TEAM_TOGETHER["passing"].format(unit=unit),
        *units().limits(0.0, 1000.0), step=0.5, key=draft.key("passing"),
        default=draft.first("passing"), help=texts.TEAM_TOGETHER_HELP["passing"],
    )  # fmt: skip


def _table(place: str, draft: TeamDraft, told: TeamChoice | None) -> None:
    """Show the team as a table, to be taken and brought."""
    st.caption(texts.TEAM_TABLE_NOTE)
    if told is not None:
        try:
            content = team_csv(stated_team(told.team, told.starts))
        except FieldmonError as error:
            st.caption(of_error(error))
        else:
            st.download_button(texts.TEAM_TABLE_OUT, content, _TABLE, "text/csv",
                               key="team_table_out", on_click="ignore")  # fmt: skip
    # another team, another box: it is empty again
    box = f"team_table {draft.rows[0].number}"
    st.file_uploader(texts.TEAM_TABLE_IN, type=["csv"], key=box, on_change=_bring,
                     args=(place, draft.begun.starts, box))  # fmt: skip
    if problem := st.session_state.get(_PROBLEM + place):
        st.error(problem)


def _bring(place: str, usual: time, box: str) -> None:
    """Let the rows be those of a table that was brought, or say why they are not."""
    st.session_state.pop(_PROBLEM + place, None)
    if (brought := st.session_state.get(box)) is None:
        return
    try:
        limits.check("bytes", brought.size, _TABLE_BYTES, brought.name)
        stated = team_of_table(brought.getvalue(), brought.name)
        told_team.bring(place, *team_stated(stated, usual))
    except FieldmonError as error:
        st.session_state[_PROBLEM + place] = of_error(error)
