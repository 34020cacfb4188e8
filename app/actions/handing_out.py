"""Handing a day's route out: as a download in any format, and as the route a season keeps."""

from __future__ import annotations

import io
import zipfile
from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.io.writers import FORMATS, HandoffPlan
from fieldmon.io.writers.geojson import RouteNotes, route_geojson

from ..state import chosen_day, rooms
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.io.writers.handoff import HandoffFormat
    from fieldmon.planning.plan import DayPlan

    from ..state.choices import Choices


def show(choices: Choices, plan: DayPlan) -> None:
    """Show the buttons, if there is a route."""
    if not len(plan.route):
        return
    starts = chosen_day.starts(choices, plan)
    notes = RouteNotes(choices.plot.field.name, choices.sampler, starts, choices.who)
    with st.container(horizontal=True):
        st.download_button(
            texts.DOWNLOAD, partial(route_geojson, plan.route, notes),
            f"route_{choices.day}.geojson", "application/geo+json", type="primary",
            on_click="ignore",
        )  # fmt: skip
        with st.popover(texts.OTHER_FORMATS):
            _other_formats(choices, HandoffPlan(plan.route, notes))
        if choices.season is not None:
            _give_out(choices)


def _other_formats(choices: Choices, plan: HandoffPlan) -> None:
    """Offer the route in the formats of robots, phones and paper."""
    name = st.selectbox(texts.FORMAT, list(FORMATS), key="format", filter_mode=None,
                        format_func=lambda one: f"{one}: {_reader(one)}")  # fmt: skip
    chosen = FORMATS[name]
    ending = f".{name}.zip" if chosen.several else chosen.endings[0]
    st.download_button(
        texts.DOWNLOAD_AS.format(reader=_reader(name)), partial(made, chosen, plan),
        f"route_{choices.day}{ending}", key="download_format", on_click="ignore",
    )  # fmt: skip


def _reader(name: str) -> str:
    """Return who reads a format."""
    return texts.READERS.get(name, FORMATS[name].reader)


def made(chosen: HandoffFormat, plan: HandoffPlan) -> bytes:
    """Return a day in a format, several files as one zip; made when somebody wants it."""
    files = chosen.make(plan)
    if not chosen.several:
        return next(iter(files.values()))
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for ending, data in files.items():
            archive.writestr(f"route{ending}", data)
    return packed.getvalue()


def _give_out(choices: Choices) -> None:
    if st.button(texts.GIVE_OUT, help=texts.GIVE_OUT_HELP, key="give_out"):
        choices.season.plan(choices.on, wishes=choices.wishes)
        st.toast(texts.GIVEN_OUT.format(day=choices.units.day(choices.day)))
    with st.container(key="start_scouting", width="content"):
        st.button(texts.START_SCOUTING, key="begin_scouting", icon=":material/eco:",
                  on_click=_open_scouting)  # fmt: skip


def _open_scouting() -> None:
    rooms.open_part("scout")
