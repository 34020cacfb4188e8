"""A season that another program holds: who waits for it is told so, and for how long by now."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FileProblem
from fieldmon.monitoring import wait_until_free

from ..words import texts

if TYPE_CHECKING:
    from pathlib import Path

    from streamlit.delta_generator import DeltaGenerator


class SeasonHeld(FileProblem):
    """Another program holds a season longer than is waited for."""


def wait(path: Path, *, to_write: bool = False, patience_s: float | None = None) -> None:
    """Wait until a season can be read or written; raise `SeasonHeld` if that takes too long.

    `patience_s`: how long is too long; None: what is too long for any command.
    """
    places: list[DeltaGenerator] = []

    def tell(waited_s: float) -> None:
        if not places:
            places.append(st.empty())
        said = texts.HELD.format(name=texts.isolated(path.stem))
        counted = texts.HELD_FOR.format(n=int(waited_s))
        # who hears the page is told once that it waits, not every second
        places[0].html(
            f'<div class="held" role="status">{escape(said)} '
            f'<span aria-hidden="true">{escape(counted)}</span></div>'
        )

    try:
        is_free = wait_until_free(path, tell, to_write=to_write, patience_s=patience_s)
    finally:
        for place in places:
            place.empty()
    if not is_free:
        raise SeasonHeld(texts.HELD_STILL.format(name=texts.isolated(path.stem)))
