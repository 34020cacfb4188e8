"""Looking after a season's file: a backup of it, another name, and off the list."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import SettingError
from fieldmon.monitoring.phones import scouts

from ..state import notices, plot_source, seasons_folder, widget_memory, work_day
from ..words import texts
from . import acting

if TYPE_CHECKING:
    from ..state.choices import Choices

_ASKED = "season to remove"


def show(choices: Choices) -> None:
    """Show what can be done with the season's file."""
    with st.expander(texts.KEEPING):
        _backup(choices)
        _rename(choices)
        _remove(choices)


def _backup(choices: Choices) -> None:
    day = choices.on if choices.today is None else choices.today
    st.download_button(
        texts.BACKUP, partial(backed_up, choices), f"{choices.open_season.path.stem} {day}.gpkg",
        "application/geopackage+sqlite3", key="backup", icon=":material/download:",
        on_click="ignore", help=texts.BACKUP_HELP,
    )  # fmt: skip


def backed_up(choices: Choices) -> bytes:
    """Return the season's file as it is now, whoever works on it."""
    return seasons_folder.backup_of(choices.open_season.path)


def _rename(choices: Choices) -> None:
    name = choices.open_season.path.stem
    with st.container(horizontal=True, vertical_alignment="bottom"):
        widget_memory.show(st.text_input, texts.RENAME_TO, key=_box(choices), default=name)
        acting.at_press(texts.RENAME, _give_name, choices, key="rename")
    if scouts.scouts_of(choices.open_season):
        st.caption(texts.RENAME_CODES)


def _box(choices: Choices) -> str:
    """Return the key of the box of the name: another season has its own."""
    return f"rename {choices.open_season.path.stem}"


@notices.reporting
def _give_name(choices: Choices) -> str:
    name, new = choices.open_season.path.stem, str(widget_memory.value(_box(choices), "")).strip()
    if new == name:
        raise SettingError(texts.RENAME_UNSAID.format(name=texts.isolated(name)))
    seasons_folder.rename(name, new)
    _open(new, choices)
    return texts.RENAMED.format(name=texts.isolated(new))


def _remove(choices: Choices) -> None:
    """Ask before the season goes off the list."""
    name = choices.open_season.path.stem
    if st.session_state.get(_ASKED) != name:
        st.button(texts.REMOVE, key="remove", on_click=_ask, args=(name,))
        return
    aside = seasons_folder.folder() / seasons_folder.REMOVED
    st.warning(texts.REMOVE_ASKS.format(name=texts.isolated(name), folder=aside))
    with st.container(horizontal=True):
        acting.at_press(texts.REMOVE_YES, _set_aside, choices, key="remove_yes", type="primary")
        st.button(texts.REMOVE_NO, key="remove_no", on_click=_ask, args=("",))


def _ask(name: str) -> None:
    st.session_state[_ASKED] = name


@notices.reporting
def _set_aside(choices: Choices) -> str:
    name = choices.open_season.path.stem
    _ask("")
    path = seasons_folder.set_aside(name)
    _open(plot_source.SAMPLE)
    return texts.REMOVED.format(name=texts.isolated(name), path=path)


def _open(name: str, choices: Choices | None = None) -> None:
    """Open another source from the next run on, on the day of that which is open, if named."""
    if choices is not None and not choices.is_today:
        work_day.choose(name, choices.on)
    plot_source.open_season(name)
