"""The panel's boxes: which plot or season, which day, who inspects; one frozen value out."""

from __future__ import annotations

from dataclasses import replace
from datetime import date, timedelta
from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError, FileProblem
from fieldmon.io.import_report import ImportMessage, Severity
from fieldmon.io.parse.geometry import area_m2
from fieldmon.monitoring.settings.settings import MOST_DAYS
from fieldmon.pests.pest import seen_by_pest
from fieldmon.plot import robot as robots
from fieldmon.plot.local_clock import local_clock
from fieldmon.samplers import USUAL_SAMPLER

from ..state import (
    assumptions,
    browser,
    cached,
    chosen_language,
    chosen_pest,
    chosen_units,
    kept_files,
    notices,
    plot_files,
    plot_source,
    sample_estate,
    season_held,
    seasons_folder,
    strategy_boxes,
    unit_boxes,
    widget_memory,
    work_day,
)
from ..state.brought_files import FileMessage
from ..state.choices import WHOSE_DAY, Choices, Chosen
from ..state.work_day import Calendar
from ..words import language, texts
from ..words.strategies import sampler_does
from ..words.units import AREAS_M2, DATES, LENGTHS, hours
from . import changing_strategy, robot_boxes
from .changing_strategy import Work

if TYPE_CHECKING:
    from collections.abc import Callable

    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.monitoring import KeptMessage
    from fieldmon.plot.field import Field
    from fieldmon.plot.local_clock import LocalClock
    from fieldmon.plot.robot import Robot

    from ..state.brought_files import File
    from ..words.units import UnitsInLanguage

    #: waits until plants can be laid, while a plot's outline may be shown
    Wait = Callable[[Field | None], None]

# where boxes of who works stand that no season keeps
_OF_FILES = "files"
# in the box names look alike that begin with the same letters, so many
_CUT_ALIKE = 14
_MOST_MEASURED = 500
# where something can be recorded
_RECORDING = frozenset({"today", "scout", "record", "decide"})


def choose(
    head: DeltaGenerator, foot: DeltaGenerator, wait: Wait, day: DeltaGenerator | None = None
) -> Chosen:
    """Show where and when in the head, who works in the foot, how long today with the `day`.

    Without a `day` the hours stand with who works. On a phone they fold with where and when.
    Returns the choices, or the problem that keeps from them.
    """
    names = seasons_folder.names()
    if not browser.is_phone():
        return _chosen(head, Work(foot, day), wait, names)
    with head.container(key="where_and_when", horizontal=True, vertical_alignment="center"):
        name = _of_files().get(plot_source.chosen()) or texts.isolated(plot_source.chosen())
        boxes, line = st.popover(name), st.empty()
    chosen = _chosen(boxes, Work(foot, None if day is None else boxes), wait, names)
    if chosen.choices is not None:
        line.markdown(_where_and_when(chosen.choices))
    return chosen


def _where_and_when(choices: Choices) -> str:
    """Return the plot and the day in a line: on a phone it stands for the boxes, which fold."""
    day = choices.units.said_day(choices.day, choices.today)
    said = [day, hours(_who_works(choices).hours)]
    return language.listed(said if choices.season is not None else [f"**{choices.name}**", *said])


def _who_works(choices: Choices) -> Robot:
    """Return whose hours the day shown has: a team's robot of the season's own works nowhere."""
    if choices.season is None or choices.whose_day is None:
        return choices.robot
    return choices.season.planned_by(choices.on).member(choices.whose_day).robot


def _chosen(head: DeltaGenerator, work: Work, wait: Wait, names: list[str]) -> Chosen:
    with head:
        source = _source(_options(names))
        try:
            if source in (plot_source.SAMPLE, plot_source.FILES):
                return Chosen(_from_files(source, wait, work))
            wait(None)
            if source not in names:  # it may be back at the next run
                raise FileProblem(notices.gone(source))
            notices.found()
            return Chosen(_from_season(source, work))
        except FieldmonError as error:
            return Chosen(problem=error)


def _options(names: list[str]) -> list[str]:
    """Return where a plot may come from; the season that is asked for, also while it is gone."""
    options = [plot_source.SAMPLE, plot_source.FILES, *names]
    plot_source.begin_from_address()
    named = widget_memory.value(plot_source.KEY)
    if not named:
        st.session_state[plot_source.KEY] = plot_source.SAMPLE
    return options if not named or named in options else [*options, named]


def _source(options: list[str]) -> str:
    chosen: str = widget_memory.show(
        st.selectbox, texts.PLOT_FROM, options, key=plot_source.KEY, filter_mode=None,
        label_visibility="collapsed", format_func=_source_name,
    )  # fmt: skip
    plot_source.keep_in_address(chosen)
    return chosen


def _source_name(source: str) -> str:
    """Return what a source is called: a season by its own name."""
    return _of_files().get(source, source)


def _of_files() -> dict[str, str]:
    return {plot_source.SAMPLE: texts.SAMPLE, plot_source.FILES: texts.UPLOAD}


# the box would keep showing a day that it refuses, and the page another: it takes all
_ANY_DAY = date(1900, 1, 1), date(2999, 12, 31)

# -- a season


def _from_season(name: str, work: Work) -> Choices:
    kept_files.sync()
    with work.foot:  # the boxes above are folded on a phone
        season_held.wait(seasons_folder.path_of(name))
    season = cached.season(seasons_folder.path_of(name))
    settings, key, units = season.settings, season.key, chosen_units.units()
    clock = local_clock(season.plot.field)
    last = settings.begins + timedelta(days=MOST_DAYS)
    calendar = Calendar(clock.today(), settings.begins, last)
    day = _day(name, calendar, clock)
    said = tuple(FileMessage(key, _message(kept)) for kept in cached.import_messages(key, season))
    by = season.planned_by(day)
    choices = Choices(
        key, season.plot, season.records, said, by.robot, by.sampler, str(day),
        units, season, key, today=calendar.today, prior=settings.prior,
    )  # fmt: skip
    changing_strategy.show(name, choices, work, by)
    return choices


def _message(kept: KeptMessage) -> ImportMessage:
    """Return what an import said when the season began; its remedy is gone: plants are laid."""
    return ImportMessage(Severity(kept.severity), kept.sentence, kept.feature)


# -- files: the sample estate's, or those brought


def _from_files(source: str, wait: Wait, work: Work) -> Choices | None:
    kept_files.sync()
    if source == plot_source.SAMPLE:
        day = sample_estate.LAST_DAY
        said = f"{chosen_units.units().said_day(day)} {day.year}"
        st.caption(texts.SAMPLE_NOTE.format(day=said))
        files = plot_files.of_sample()
    elif (brought := plot_files.of_session()) is None:
        return None
    else:
        files = brought
    which, when = st.columns([3, 2])
    with which:
        outline = plot_files.outline(files, _which)
    wait(outline.field)
    made = plot_files.prepared(files, outline)
    clock = local_clock(made.plot.field)
    today = sample_estate.LAST_DAY if source == plot_source.SAMPLE else clock.today()
    with when:
        day = _day(source, Calendar(today), clock)
    robot, sampler = _work(work)
    pest, prior = chosen_pest.pest(), chosen_pest.prior(assumptions.prior(), made.plot, today, day)
    return Choices(
        made.key, made.plot, made.records, made.messages,
        seen_by_pest(robot, pest), sampler, str(day),
        chosen_units.units(), None, outline.key, made.risk, today, made.left_out, prior,
    )  # fmt: skip


# -- the day


def _day(source: str, calendar: Calendar, clock: LocalClock) -> date:
    """Show the box for the day: today on the plot, unless another was chosen on purpose."""
    work_day.begin_from_address(source)
    key = work_day.BOX.format(source=source)
    day = st.session_state[key] = work_day.of(source, calendar)
    zone = clock.zone or texts.ZONE_OF_MACHINE
    first, last = _ANY_DAY if calendar.first else (None, None)
    st.date_input(
        texts.DATE, day, first, last, key=key,
        format=chosen_units.units().date_format, help=texts.DATE_HELP.format(zone=zone),
        label_visibility="collapsed",
        on_change=_choose_day, args=(source, key, calendar),
    )  # fmt: skip
    work_day.keep_in_address(day, calendar.today)
    return day


def _choose_day(source: str, key: str, calendar: Calendar) -> None:
    day = st.session_state[key]
    if day is not None and (near := calendar.within(day)) != day:
        said = {"first": calendar.first, "last": calendar.last, "day": day}
        written = {name: chosen_units.units().day(one) for name, one in said.items() if one}
        notices.keep("warning", texts.DAY_OUTSIDE.format(**written))
        day = near
    if day is None or day == calendar.today:
        work_day.back_to_today(source)
    else:
        work_day.choose(source, day)


def whose_day(choices: Choices) -> None:
    """Let one of the day's team be chosen, whose day is shown and who signs where it is worked."""
    if len(team := choices.team_that_day) > 1:
        if widget_memory.value(WHOSE_DAY, team[0]) not in team:  # taken out, or of another season
            widget_memory.put(WHOSE_DAY, team[0])
        widget_memory.show(
            st.segmented_control, texts.WHOSE_DAY, list(team), key=WHOSE_DAY,
            default=team[0], required=True,
        )  # fmt: skip
    elif team:
        st.caption(f"{texts.WHOSE_DAY}: {texts.isolated(team[0])}")


def mark_day(choices: Choices, page: str) -> None:
    """Say above a page that its day is not today, with the way back."""
    if choices.is_today:
        return
    today = choices.today or choices.on
    day, now = (choices.units.said_day(on, today) for on in (choices.day, today))
    # below each other: beside the sentence there is no room for the button's words
    said = [texts.OTHER_DAY.format(day=day, today=now)]
    if page in _RECORDING:
        said.append(texts.OTHER_DAY_RECORDED.format(day=day))
    st.warning(" ".join(said))
    st.button(texts.BACK_TO_TODAY, key="back_to_today",
              on_click=work_day.back_to_today, args=(plot_source.chosen(),))  # fmt: skip


def _which(file: File, fields: tuple[Field, ...]) -> int:
    labels = _labels(fields, chosen_units.units())
    number = widget_memory.show(
        st.selectbox, texts.WHICH_PLOT, range(len(labels)), format_func=labels.__getitem__,
        key=plot_source.feature_key(file.key), default=0, label_visibility="collapsed",
    )  # fmt: skip
    return number or 0


def _labels(fields: tuple[Field, ...], units: UnitsInLanguage) -> list[str]:
    """Return what plots are called in the box: by number and area where names would be cut alike.

    Many of them go without their areas, which take time.
    """
    names = [field.name for field in fields]
    if len({name[:_CUT_ALIKE] for name in names}) == len(names):
        return names
    few = len(fields) <= _MOST_MEASURED
    areas = [[units.square(area_m2(field.boundary))] if few else [] for field in fields]
    return [
        " · ".join([f"{k}", *area, texts.isolated(name)])
        for k, (name, area) in enumerate(zip(names, areas, strict=True), 1)
    ]


def _work(work: Work) -> tuple[Robot, str]:
    show = partial(strategy_boxes.show, place=_OF_FILES)
    with work.foot, st.expander(texts.WHO, expanded=work.day is not None):
        who = show(
            st.segmented_control, texts.WHO, list(changing_strategy.WHO), key="who",
            counts=changing_strategy.ROBOT, required=True, label_visibility="collapsed",
            format_func=changing_strategy.who_name, on_change=_keep_hours,
        )  # fmt: skip
        base = robots.scout() if who == changing_strategy.SCOUT else robots.Robot()
        with work.hours():
            day_h = show(
                st.slider, texts.HOURS, 0.5, 16.0, step=0.5, key=f"hours {who}",
                counts=base.hours, format=changing_strategy.in_hours(),
            )  # fmt: skip
        inspection_s = show(
            st.slider, texts.INSPECTION_S, 20, 60, step=5, key=f"inspection_s {who}",
            counts=int(base.look_s),
        )  # fmt: skip
        if who != changing_strategy.SCOUT:
            base = robot_boxes.of_files(base, _OF_FILES)
        sampler = strategy_boxes.show(
            st.selectbox, texts.SAMPLER, list(texts.SAMPLERS), place=_OF_FILES, key="sampler",
            counts=USUAL_SAMPLER, **changing_strategy.named(),
        )  # fmt: skip
        st.caption(sampler_does(sampler))
        st.caption(texts.TEAM_IN_SEASON)
    return replace(base, hours=float(day_h), look_s=float(inspection_s)), sampler


def _keep_hours() -> None:
    """Let a working day be as long as it was, whoever is to inspect now (for callbacks)."""
    who = widget_memory.value("who")
    before = changing_strategy.ROBOT if who == changing_strategy.SCOUT else changing_strategy.SCOUT
    if (hours_h := widget_memory.value(f"hours {before}")) is not None:
        widget_memory.put(f"hours {who}", hours_h)


# -- language and units


def choose_display() -> None:
    """Show how words and numbers are written.

    What was chosen is known before, see `chosen_units.units`: so a page shows it below all else.
    """
    with st.expander(texts.DISPLAY):
        spoken = language.current()
        names = language.LANGUAGES | {c: n for c, n in language.DRAFTS.items() if c == spoken}
        code = widget_memory.show(
            st.selectbox, texts.LANGUAGE, list(names), key=chosen_language.KEY, default=spoken,
            filter_mode=None, format_func=names.get, on_change=chosen_language.carry_over,
            args=(spoken,),
        )  # fmt: skip
        chosen_language.keep_in_address(code)
        if code != language.ENGLISH:
            st.caption(texts.DRAFT if code in language.DRAFTS else texts.MACHINE_MADE)
        now = chosen_units.units()
        options = [*LENGTHS], [*AREAS_M2], [*DATES]
        labels = texts.LENGTH, texts.AREA, texts.DATE_LIKE
        for key, label, names_of in zip(chosen_units.KEYS, labels, options, strict=True):
            widget_memory.show(
                st.selectbox, label, names_of, key=key, default=getattr(now, key),
                filter_mode=None, format_func=_unit_name, on_change=unit_boxes.carry_over,
                args=(now,),
            )  # fmt: skip


def _unit_name(unit: str) -> str:
    """Return what a unit is called; dates are shown as they are."""
    return texts.UNITS.get(unit, unit)
