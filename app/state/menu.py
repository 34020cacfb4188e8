"""The menu of the app: its items, their pages, and which page of each is shown."""

from __future__ import annotations

from dataclasses import dataclass

import streamlit as st

from . import widget_memory


@dataclass(frozen=True)
class MenuItem:
    """An item: its icon, and its pages, each a module of `views`; the first is shown first."""

    icon: str
    pages: tuple[str, ...]


#: by their addresses, in the order in which they stand at the top
MENU = {
    "plots": MenuItem("grid_view", ("plots",)),
    "today": MenuItem("route", ("today", "scout", "record", "decide")),
    "season": MenuItem("calendar_month", ("season", "field", "report")),
    "ahead": MenuItem("balance", ("compare", "simulate", "drive")),
    "plot": MenuItem("polyline", ("plot",)),
}


#: the word in the address that names a page, as bookmarks have it: a reload, and who goes back, are
#: where they were
KEY = "part"
_TURN, _WRITTEN = "turn to", "page in address"


def take_from_address(name: str) -> None:
    """Show the page of an item that the address names; what was chosen just now comes first."""
    said, pages = st.query_params.get(KEY), MENU[name].pages
    item, shown = st.session_state.get(_WRITTEN, ("", ""))
    if item != name:
        if said in pages:
            open_page(said)
    elif st.session_state.get(key(name), shown) == shown:
        page = said if said in pages else pages[0]
        if page != shown:
            open_page(page)


def keep_in_address(name: str, page: str) -> None:
    """Let a reload lead back to the page that is shown; the first one of an item needs no word."""
    st.session_state[_WRITTEN] = name, page
    if page == MENU[name].pages[0]:
        st.query_params.pop(KEY, None)
    elif st.query_params.get(KEY) != page:
        st.query_params[KEY] = page


def turn_to(name: str) -> None:
    """Let an item be turned to in the next run (for callbacks, in which no page can be turned)."""
    st.session_state[_TURN] = name


def turn_to_page(page: str) -> None:
    """Let the item of a page be turned to in the next run, and show that page there."""
    turn_to(item_of(page))
    open_page(page)


def turned_to() -> str | None:
    """Return the item that is to be turned to, once."""
    name: str | None = st.session_state.pop(_TURN, None)
    return name


def item_of(page: str) -> str:
    """Return the item that a page is in."""
    return next(name for name, item in MENU.items() if page in item.pages)


def shown_page(name: str) -> str:
    """Return which page of an item is shown, before its box is."""
    pages = MENU[name].pages
    page: str = widget_memory.value(key(name), pages[0])
    return page if page in pages else pages[0]


def key(name: str) -> str:
    """Return the key of the box that says which page of an item is shown."""
    return f"page {name}"


def open_page(page: str) -> None:
    """Let a page be shown from the next run on (for callbacks)."""
    st.session_state[key(item_of(page))] = page
