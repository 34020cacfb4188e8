"""The panel's boxes: which plot or season, which day, who inspects; one frozen value out."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.io.import_report import ImportMessage, Severity
from fieldmon.plot import robot as robots
from fieldmon.samplers import USUAL

from ..state import (
    cached,
    chosen_units,
    plot_files,
    plot_source,
    row_settings,
    sample_estate,
    seasons_folder,
    widget_memory,
)
from ..state.brought_files import FileMessage
from ..state.choices import Choices, Chosen
from ..words import texts
from ..words.strategies import sampler_does
from ..words.units import AREAS_M2, DATES, LENGTHS
from . import changing

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import date

    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.monitoring import KeptMessage
    from fieldmon.plot.field import Field
    from fieldmon.plot.robot import Robot

    from ..state.brought_files import File

    #: waits until plants can be laid, while a plot's outline may be shown
    Wait = Callable[[Field | None], None]

_DAY = "day {source}"


def choose(head: DeltaGenerator, foot: DeltaGenerator, wait: Wait) -> Chosen:
    """Show where and when in the head, who works and how numbers are written in the foot.

    Returns the choices, or the problem that keeps from them.
    """
    with head:
        source = _source()
        try:
            if source in (texts.SAMPLE, texts.UPLOAD):
                return Chosen(_from_files(source, wait, foot))
            wait(None)
            return Chosen(_from_season(source, foot))
        except FieldmonError as error:
            return Chosen(problem=error)
        finally:
            with foot:
                _units()


def _source() -> str:
    options = [texts.SAMPLE, texts.UPLOAD, *seasons_folder.names()]
    plot_source.begin_from_address()
    if widget_memory.value(plot_source.KEY) not in options:
        st.session_state[plot_source.KEY] = texts.SAMPLE
    chosen = widget_memory.show(
        st.selectbox, texts.PLOT_FROM, options, key=plot_source.KEY, filter_mode=None,
        label_visibility="collapsed",
    )  # fmt: skip
    plot_source.keep_in_address(chosen)
    return chosen


# -- a season


def _from_season(name: str, foot: DeltaGenerator) -> Choices:
    season = cached.season(seasons_folder.path_of(name))
    settings, key, units = season.settings, str(season.path), chosen_units.units()
    day = widget_memory.show(
        st.date_input, texts.DATE, min_value=settings.begins, key=_DAY.format(source=name),
        default=season.last_date(), format=units.date_format, label_visibility="collapsed",
    )  # fmt: skip
    said = tuple(FileMessage(key, _message(kept)) for kept in cached.import_messages(key, season))
    choices = Choices(
        key, season.plot, season.observations, said, settings.robot, settings.sampler, str(day),
        units, season, key,
    )  # fmt: skip
    with foot:
        changing.show(name, season)
    return choices


def _message(kept: KeptMessage) -> ImportMessage:
    """Return what an import said when the season began; its remedy is gone: plants are laid."""
    return ImportMessage(Severity(kept.severity), kept.sentence, kept.feature)


# -- files: the sample estate's, or those brought


def _from_files(source: str, wait: Wait, foot: DeltaGenerator) -> Choices | None:
    if source == texts.SAMPLE:
        files = plot_files.of_sample()
    elif (files := plot_files.of_session()) is None:
        return None
    which, when = st.columns([3, 2])
    with which:
        outline = plot_files.outline(files, _which)
    wait(outline.field)
    made = plot_files.prepared(files, outline)
    with when:
        day = _day(source)
    with foot:
        robot, sampler = _work()
    return Choices(
        made.key, made.plot, made.records, made.messages, robot, sampler, day,
        chosen_units.units(), None, outline.key, made.risk,
    )  # fmt: skip


def _today() -> date:
    return datetime.now().astimezone().date()


def _which(file: File, names: list[str]) -> int:
    number = widget_memory.show(
        st.selectbox, texts.WHICH_PLOT, range(len(names)), format_func=names.__getitem__,
        key=plot_source.feature_key(file.key), default=0, label_visibility="collapsed",
    )  # fmt: skip
    return number or 0


def _day(source: str) -> str:
    first = sample_estate.LAST_DAY if source == texts.SAMPLE else _today()
    day = widget_memory.show(
        st.date_input, texts.DATE, key=_DAY.format(source=source), default=first,
        format=chosen_units.units().date_format, label_visibility="collapsed",
    )  # fmt: skip
    return str(day)


def _work() -> tuple[Robot, str]:
    with st.expander(texts.WHO):
        who = widget_memory.show(
            st.segmented_control, texts.WHO, [texts.ROBOT, texts.SCOUT], key="who",
            default=texts.ROBOT, required=True, label_visibility="collapsed",
        )  # fmt: skip
        base = robots.scout() if who == texts.SCOUT else robots.Robot()
        hours = widget_memory.show(st.slider, texts.HOURS, 0.5, 16.0, step=0.5,
                                   key=f"hours {who}", default=base.hours)  # fmt: skip
        inspection_s = widget_memory.show(
            st.slider, texts.INSPECTION_S, 20, 60, step=5, key=f"inspection_s {who}",
            default=int(base.look_s),
        )  # fmt: skip
        sampler = widget_memory.show(
            st.selectbox, texts.SAMPLER, list(texts.SAMPLERS), key="sampler",
            default=USUAL, **changing.NAMED,
        )  # fmt: skip
        st.caption(sampler_does(sampler))
    return replace(base, hours=float(hours), look_s=float(inspection_s)), sampler


# -- units


def _units() -> None:
    with st.expander(texts.DISPLAY):
        for key, label, options in zip(
            chosen_units.KEYS, (texts.LENGTH, texts.AREA, texts.DATE_LIKE),
            (LENGTHS, AREAS_M2, DATES), strict=True,
        ):  # fmt: skip
            widget_memory.show(
                st.selectbox, label, list(options), key=key, default=next(iter(options)),
                filter_mode=None, on_change=row_settings.carry_over, args=(chosen_units.units(),),
            )  # fmt: skip
