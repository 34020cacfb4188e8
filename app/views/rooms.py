"""A room in the panel: its parts side by side, the chosen one below."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..actions import news
from ..state import rooms, widget_memory
from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

    from ..state.choices import Choices


def show(name: str, choices: Choices, view: Callable[[str], ModuleType]) -> None:
    """Show the chosen part of a room; `view` returns a part's module."""
    parts = rooms.ROOMS[name].parts
    part = parts[0]
    if len(parts) > 1:
        part = widget_memory.show(
            st.segmented_control, texts.PARTS_OF, list(parts), key=rooms.key(name),
            default=parts[0], format_func=texts.PARTS.__getitem__, required=True,
            label_visibility="collapsed", width="stretch",
        )  # fmt: skip
    rooms.keep_in_address(name, part)
    with widget_memory.part(part):
        view(part).show(choices)
    news.watch(choices)
