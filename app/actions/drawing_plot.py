"""A plot without a file: its place found, its corners tapped on the map, typed or walked to."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.plot.local_clock import LocalClock, clock_at

from ..show import drawn_map, field_map, plot_place
from ..show.map_view import MapAnswers
from ..state import browser, drawn_plot, notices, plot_source
from ..state.chosen_units import units
from ..words import texts
from ..words.language import listed, number, of_error
from . import bringing_files, laying_ground

if TYPE_CHECKING:
    from ..state.drawn_plot import DrawnCorners, FoundPlace
    from ..state.plot_edits import Points

_TYPED, _READ, _LONGITUDE_FIRST = "outline_typed", "place read", "longitude first"


def offer() -> None:
    """Offer it beside the boxes for files, for those who have none."""
    st.caption(texts.OUTLINE_OR)
    st.button(texts.OUTLINE_BEGIN, key="outline_begin", icon=":material/draw:",
              on_click=drawn_plot.begin)  # fmt: skip
    bringing_files.show()


def offer_again() -> None:
    """Offer a plot that was drawn to be corrected, and as a file to be kept."""
    data = drawn_plot.to_download()
    if plot_source.chosen() == plot_source.FILES and data is not None:
        with st.container(horizontal=True):
            st.button(texts.OUTLINE_CORRECT, key="outline_correct", icon=":material/draw:",
                      on_click=drawn_plot.correct)  # fmt: skip
            st.download_button(texts.OUTLINE_DOWNLOAD, data, "plot.geojson",
                               "application/geo+json", on_click="ignore")  # fmt: skip


def show() -> bool:
    """Show what is drawn so far, and the ways to set more corners; return whether a plot is drawn.

    The map takes taps.
    """
    if not drawn_plot.is_open():
        return False
    drawn = drawn_plot.so_far()
    st.markdown(texts.OUTLINE)
    st.caption(texts.OUTLINE_NOTE)
    _place()
    st.caption(texts.OUTLINE_STANDING)
    with st.expander(texts.WEB_MAP):
        st.caption(texts.OUTLINE_NO_MAP)
        today = (LocalClock() if drawn.at is None else clock_at(*drawn.at)).today()
        laying_ground.web_map(None, today, units())
    _so_far(drawn.corners)
    n = len(drawn_plot.distinct(drawn.corners))
    with st.container(horizontal=True):
        st.button(texts.OUTLINE_USE, key="outline_use", type="primary", on_click=_use,
                  disabled=n < drawn_plot.LEAST)  # fmt: skip
        st.button(texts.OUTLINE_LEAVE, key="outline_leave", on_click=drawn_plot.leave)
    if n < drawn_plot.LEAST:
        st.caption(texts.OUTLINE_LEAST.format(n=n))
    content = drawn_map.content(drawn, units(), dark=browser.is_dark())
    field_map.want(content, MapAnswers(drawn=_drawn))
    return True


# -- positions


def _place() -> None:
    # a form, whose first button Enter presses
    with st.form("outline_place", border=False):
        st.text_input(texts.OUTLINE_PLACE, key=_TYPED, placeholder="31.5012, 34.9034",
                      help=texts.OUTLINE_PLACE_HELP)  # fmt: skip
        with st.container(horizontal=True):
            st.form_submit_button(texts.OUTLINE_GO, key="outline_go", on_click=_go)
            st.form_submit_button(texts.OUTLINE_ADD, key="outline_add", on_click=_add)
    found: FoundPlace | None = st.session_state.get(_READ)
    if found is None:
        return
    at = found.lonlat
    lon, lat = (number(one, ".8g") for one in at)
    st.caption(texts.OUTLINE_READ.format(lat=lat, lon=lon, where=plot_place.at(*at)))
    if not found.is_certain and abs(at[0]) <= 90 and drawn_plot.so_far().at == at:
        st.button(texts.OUTLINE_TURN, key="outline_turn", icon=":material/swap_horiz:",
                  on_click=_exchange, args=(found,))  # fmt: skip


def _go() -> None:
    """Let the map show the place that is typed."""
    if (at := _read()) is not None:
        drawn_plot.keep(replace(drawn_plot.so_far(), at=at))


def _add() -> None:
    """Set a corner at the position that is typed."""
    if (at := _read()) is not None:
        drawn = drawn_plot.so_far()
        _keep(replace(drawn, corners=(*drawn.corners, at), at=drawn.at or at))
        st.session_state[_TYPED] = ""


def _read() -> tuple[float, float] | None:
    """Return the position that is typed; None, and a sentence why, where it is none."""
    typed, is_turned = st.session_state.get(_TYPED) or "", st.session_state.get(_LONGITUDE_FIRST)
    try:
        found = drawn_plot.place_of(typed, longitude_first=bool(is_turned))
    except FieldmonError as error:
        notices.keep("error", of_error(error))
        return None
    st.session_state[_READ] = found
    return found.lonlat


def _exchange(found: FoundPlace) -> None:
    """Read the place the other way round, and what is typed from now on."""
    lat, lon = found.lonlat
    turned = drawn_plot.FoundPlace((lon, lat), is_certain=False)
    st.session_state[_READ] = turned
    st.session_state[_LONGITUDE_FIRST] = not st.session_state.get(_LONGITUDE_FIRST)
    drawn_plot.keep(replace(drawn_plot.so_far(), at=turned.lonlat))


# -- corners


def _so_far(corners: Points) -> None:
    """Say the area and the edges: what the map shows, for those who do not see it."""
    if not corners:
        return
    now = units()
    st.markdown(f"**{drawn_map.said(corners, now)}**")
    lengths = [now.metres(length_m) for length_m in drawn_plot.edges_m(corners).tolist()]
    if lengths:
        st.caption(texts.OUTLINE_EDGES.format(edges=listed(lengths)))


def _keep(drawn: DrawnCorners) -> None:
    """Keep corners that were not set on the map."""
    drawn_plot.keep(drawn)
    drawn_plot.drawn_anew()


def _drawn(kind: str, points: Points) -> None:
    """Keep what was drawn on the map so far; use it when it is done; go to where one is."""
    name, _, what = kind.rpartition(" ")
    drawn = drawn_plot.so_far()
    if what == "here":
        drawn_plot.keep(replace(drawn, at=points[0]))
        return
    name = name if what == "done" else kind
    if name != f"outline {drawn_plot.turn()}":
        return  # drawn before what was typed since
    drawn_plot.keep(replace(drawn, corners=points))
    if what == "done":
        _use()


def _use() -> None:
    try:
        drawn_plot.use(units())
    except FieldmonError as error:
        notices.keep("error", of_error(error))
