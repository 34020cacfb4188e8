"""What the first page shows before anything is planned: the outline, where the map will be.

Little is imported here: all else loads while the browser does (see `warming`).
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.io import read

from . import maps, remembered, texts, warming

if TYPE_CHECKING:
    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.plot.field import Field

SAMPLE = Path(__file__).resolve().parents[1] / "sample_data"
PLOTS = "paran_estate.zip"
#: names the box that says whose plot it is; also the word in the address
WHERE = "season"


@dataclass(frozen=True, eq=False)
class Places:
    """Where the parts of a page go, made before there is anything to put there.

    Parameters
    ----------
    above
        What there is to wait for.
    heading, figures
        What stands over the map.
    picture
        The map, and what belongs to it.
    chart
        The map itself, in there.
    """

    above: DeltaGenerator
    heading: DeltaGenerator
    figures: DeltaGenerator
    picture: DeltaGenerator
    chart: DeltaGenerator


def places() -> Places:
    """Return the places of a page; the sample estate is outlined where nothing can be planned yet.

    The browser loads what draws maps only when it is sent one, and meanwhile the day is planned.
    """
    above, heading, figures, picture = st.empty(), *(st.container() for _ in range(3))
    if warming.start().ready.is_set():
        return Places(above, heading, figures, picture, picture)
    # where an outline gives way to the map; later there is none, or the map would lose its zoom
    made = Places(above, heading, figures, picture, picture.empty())
    if remembered.value(WHERE, texts.SAMPLE) == texts.SAMPLE:
        with suppress(FieldmonError):  # it is said where the plot is wanted
            outline(made.chart, sample()[0])
    return made


@cache
def sample() -> tuple[Field, ...]:
    """Return the plots of the sample estate."""
    return read.read_plots(SAMPLE / PLOTS).value


def outline(chart: DeltaGenerator, field: Field) -> None:
    """Show a plot on which no plants are laid yet."""
    chart.pydeck_chart(
        maps.outline(field, room_px(), dark=is_dark()), key="outline",
        height=map_px(), alt=texts.OUTLINE_ALT.format(name=field.name),
    )  # fmt: skip


def is_phone() -> bool:
    """Return whether the page is shown on a phone, by what its browser says."""
    return "Mobi" in (st.context.headers.get("User-Agent") or "")


def is_dark() -> bool:
    """Return whether the page is dark."""
    return st.context.theme.get("type") == "dark"


def room_px() -> tuple[int, int]:
    """Return the room that a map over the whole page has on this device."""
    return maps.PHONE_PX if is_phone() else maps.PAGE_PX


def map_px() -> int:
    """Return the height of a map: half a phone's screen, more on a laptop."""
    return 400 if is_phone() else 520
