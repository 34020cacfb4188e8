"""What the first page shows before anything is planned: the outline, where the map will be.

Little is imported here: all else loads while the browser does (see `preload`).
"""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.errors import FieldmonError

from ..show.map_room import height_px, room_px
from ..show.maps import deck
from ..show.places import Places
from ..state import browser, plot_source, sample_estate
from ..words import texts
from . import preload

if TYPE_CHECKING:
    from collections.abc import Callable

    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.plot.field import Field


def places() -> Places:
    """Return the places of a page; the sample estate is outlined where nothing can be planned yet.

    The browser loads what draws maps only when it is sent one, and meanwhile the day is planned.
    """
    above, heading, figures, picture = st.empty(), *(st.container() for _ in range(3))
    if preload.start().ready.is_set():
        return Places(above, heading, figures, picture, picture)
    # where an outline gives way to the map; later there is none, or the map would lose its zoom
    made = Places(above, heading, figures, picture, picture.empty())
    if plot_source.chosen() == texts.SAMPLE:
        with suppress(FieldmonError):  # it is said where the plot is wanted
            _outline(made.chart, sample_estate.plots()[0])
    return made


def waiting(places: Places | None = None) -> Callable[[Field | None], None]:
    """Return what waits until plants can be laid, and shows a plot's outline meanwhile.

    It says how far compiling is, once an installation.
    """
    above = st.empty() if places is None else places.above

    def wait(field: Field | None) -> None:
        ready = preload.start().ready
        if field is not None and places is not None and not ready.is_set():
            _outline(places.chart, field)
        while not ready.wait(0.5):
            if FIRST_USE.compiled:
                above.info(texts.COMPILING.format(n=FIRST_USE.compiled))
        above.empty()

    return wait


def _outline(chart: DeltaGenerator, field: Field) -> None:
    """Show a plot on which no plants are laid yet."""
    chart.pydeck_chart(
        deck.outline(field, room_px(), dark=browser.is_dark()), key="outline",
        height=height_px(), alt=texts.OUTLINE_ALT.format(name=field.name),
    )  # fmt: skip
