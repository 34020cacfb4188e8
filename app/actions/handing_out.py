"""Handing a day's route out: to a phone by a code to scan, and as a file."""

from __future__ import annotations

import io
import zipfile
from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.io.writers import FORMATS, HandoffPlan
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.monitoring.days import day_ahead, kept_wishes
from fieldmon.monitoring.phones import scouts

from ..show import qr_code
from ..state import chosen_day, morning_steps, notices, phone_address, wishes
from ..words import language, texts
from . import inviting

if TYPE_CHECKING:
    from fieldmon.io.writers.handoff import HandoffFormat
    from fieldmon.planning.plan import DayPlan

    from ..state.choices import Choices


def show(choices: Choices, plan: DayPlan) -> None:
    """Show both ways: a season's day by a code for each person, a plan by its address."""
    if choices.season is not None:
        inviting.show(choices)
    else:
        _show_address()
    st.markdown(texts.SEND_FILE)
    starts = chosen_day.starts(choices, plan)
    notes = RouteNotes(choices.plot.field.name, choices.sampler, starts, choices.whose_day,
                       language=language.for_reports(language.current()))  # fmt: skip
    _files(choices, HandoffPlan(chosen_day.with_bound(choices, plan).route, notes))


def give_out(choices: Choices) -> None:
    """Keep the day's route with the season as the one given out: stops are counted along it.

    Kept is also what was picked to be inspected too, or not: whoever is out goes by it.
    """
    season, (wished, anew) = choices.open_season, choices.wished
    kept_wishes.keep_wishes(season, choices.on, choices.besides)
    wishes.forget(choices.laid, choices.day)
    day_ahead.planned(season, choices.on, wishes=wished, keep=True, anew=anew)


@notices.reporting
def _taken(choices: Choices) -> str:
    """Note that a route is taken along as a file."""
    if choices.season is not None:
        give_out(choices)
    morning_steps.note(choices, morning_steps.SEND)
    return ""


def is_out(choices: Choices) -> bool:
    """Return whether a phone has the day without more: by a person's code, or by the address."""
    if choices.season is None:
        return phone_address.address().reachable
    return bool(scouts.scouts_of(choices.season))


def _show_address() -> None:
    where = phone_address.address()
    if where.reachable:
        st.markdown(texts.SEND_SCAN)
        st.html(qr_code.image(where.url, texts.SEND_ALT))
        st.code(where.url, language=None, wrap_lines=True)
    else:
        st.info(texts.SEND_ALONE)


def _files(choices: Choices, plan: HandoffPlan) -> None:
    """Offer the route in the formats of robots, phones and paper."""
    names = list(FORMATS)
    name = st.selectbox(texts.FORMAT, names, names.index("gpx"), key="format", filter_mode=None,
                        label_visibility="collapsed",
                        format_func=lambda one: f"{_reader(one)}: {one}")  # fmt: skip
    chosen = FORMATS[name]
    ending = f".{name}.zip" if chosen.several else chosen.endings[0]
    called = choices.file_name("route", choices.whose_day or "")
    st.download_button(
        texts.DOWNLOAD_AS.format(reader=_reader(name)), partial(made, chosen, plan),
        f"{called}{ending}", key="download_format", type="primary",
        on_click=_taken, args=(choices,),
    )  # fmt: skip


def _reader(name: str) -> str:
    """Return who reads a format."""
    return language.in_words(FORMATS[name].reader)


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
