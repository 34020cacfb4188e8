"""Beside a map: a scale bar and a north arrow that follow its zoom, and clicks as positions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import streamlit as st

from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Callable

    import pydeck as pdk

    from ..words.units import Units

    #: takes positions in the order in which they were clicked on, lon/lat
    Clicked = Callable[[tuple[tuple[float, float], ...]], None]

_HTML = """<div class="scale-bar" role="img">
<svg class="north" viewBox="0 0 14 20" aria-hidden="true" fill="currentColor">
<path d="M7 0l6 19l-6 -4l-6 4z"/></svg>
<div class="scale"><div class="bar"></div><div class="text"></div></div></div>"""
_CROSSHAIR = "<style>.stDeckGlJsonChart canvas{cursor:crosshair!important}</style>"
_HERE = Path(__file__).parent
_bar = st.components.v2.component(
    "fieldmon_scale_bar", html=_HTML, js=(_HERE / "scale_bar.js").read_text(encoding="utf-8"),
    css=(_HERE / "scale_bar.css").read_text(encoding="utf-8"),
)  # fmt: skip


def show(name: str, view: pdk.ViewState, units: Units, clicked: Clicked | None = None) -> None:
    """Show scale and north of the map just shown; `clicked` hears of each click on it once."""
    key = f"scale bar {name}"

    def heard() -> None:
        if clicked is not None and (new := new_points(key)):
            clicked(new)

    if clicked is not None:
        st.html(_CROSSHAIR)
    _bar(
        key=key,
        data={
            "view": {"zoom": view.zoom, "latitude": view.latitude, "bearing": 0},
            "lengths": units.lengths(),
            "first": texts.SCALE_FIRST,
            "alt": texts.SCALE_ALT,
            "draws": clicked is not None,
        },
        on_points_change=heard,
    )


def new_points(key: str) -> tuple[tuple[float, float], ...]:
    """Return the positions clicked on that were not heard of before."""
    points = st.session_state[key].get("points") or []
    last = st.session_state.get(f"{key} heard", 0)
    st.session_state[f"{key} heard"] = max([last, *(point[0] for point in points)])
    return tuple((float(lon), float(lat)) for at, lon, lat in points if at > last)
