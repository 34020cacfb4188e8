"""An item of the menu in the panel: its pages side by side, the chosen one below."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..actions import news
from ..state import menu, widget_memory
from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

    from ..state.choices import Choices


def show(name: str, choices: Choices, view: Callable[[str], ModuleType]) -> None:
    """Show the chosen page of an item; `view` returns a page's module."""
    pages = menu.MENU[name].pages
    page = pages[0]
    if len(pages) > 1:
        page = widget_memory.show(
            st.segmented_control, texts.PAGES_OF, list(pages), key=menu.key(name),
            default=pages[0], format_func=texts.PAGES.__getitem__, required=True,
            label_visibility="collapsed", width="stretch",
        )  # fmt: skip
    menu.keep_in_address(name, page)
    with widget_memory.page(page):
        view(page).show(choices)
    news.watch(choices)
