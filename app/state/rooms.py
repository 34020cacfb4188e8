"""The rooms of the app, their parts, and which part of each is shown."""

from __future__ import annotations

from dataclasses import dataclass

import streamlit as st

from . import widget_memory


@dataclass(frozen=True)
class Room:
    """A room: its icon, and its parts, each a module of `views`; the first is shown first."""

    icon: str
    parts: tuple[str, ...]


#: by their addresses, in the order in which they stand at the top
ROOMS = {
    "plots": Room("grid_view", ("plots",)),
    "today": Room("route", ("today", "scout", "record", "decide")),
    "season": Room("calendar_month", ("season", "field", "report")),
    "ahead": Room("balance", ("compare", "simulate", "drive")),
    "plot": Room("polyline", ("plot",)),
}


#: the word in the address that names a part: a reload, and who goes back, are where they were
KEY = "part"
_TURN, _WRITTEN = "turn to", "part in address"


def take_from_address(name: str) -> None:
    """Show the part of a room that the address names; what was chosen just now comes first."""
    said, parts = st.query_params.get(KEY), ROOMS[name].parts
    room, shown = st.session_state.get(_WRITTEN, ("", ""))
    if room != name:
        if said in parts:
            open_part(said)
    elif st.session_state.get(key(name), shown) == shown:
        part = said if said in parts else parts[0]
        if part != shown:
            open_part(part)


def keep_in_address(name: str, part: str) -> None:
    """Let a reload lead back to the part that is shown; the first one of a room needs no word."""
    st.session_state[_WRITTEN] = name, part
    if part == ROOMS[name].parts[0]:
        st.query_params.pop(KEY, None)
    elif st.query_params.get(KEY) != part:
        st.query_params[KEY] = part


def turn_to(name: str) -> None:
    """Let a room be turned to in the next run (for callbacks, in which no page can be turned)."""
    st.session_state[_TURN] = name


def turn_to_part(part: str) -> None:
    """Let the room of a part be turned to in the next run, and show that part there."""
    turn_to(room_of(part))
    open_part(part)


def turned_to() -> str | None:
    """Return the room that is to be turned to, once."""
    name: str | None = st.session_state.pop(_TURN, None)
    return name


def room_of(part: str) -> str:
    """Return the room that a part is in."""
    return next(name for name, room in ROOMS.items() if part in room.parts)


def shown_part(name: str) -> str:
    """Return which part of a room is shown, before its box is."""
    parts = ROOMS[name].parts
    part: str = widget_memory.value(key(name), parts[0])
    return part if part in parts else parts[0]


def key(name: str) -> str:
    """Return the key of the box that says which part of a room is shown."""
    return f"part {name}"


def open_part(part: str) -> None:
    """Let a part be shown from the next run on (for callbacks)."""
    st.session_state[key(room_of(part))] = part
