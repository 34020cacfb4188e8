"""Beginning a season: from then on everything is kept."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import SettingError
from fieldmon.monitoring import KeptMessage, MonitoringSettings, Season
from fieldmon.monitoring.settings.belief_settings import BeliefSettings

from ..show import plot_place
from ..show.assumed import of_rows
from ..state import (
    assumptions,
    chosen_day,
    chosen_pest,
    drawn_plot,
    notices,
    plot_files,
    plot_source,
    seasons_folder,
    shared_plots,
    told_team,
    widget_memory,
    work_day,
)
from ..state.told_team import TeamChoice
from ..words import language, texts
from . import acting, assuming, editing_plot, telling_team

if TYPE_CHECKING:
    from fieldmon.infestation.earlier_season import EarlierSeason
    from fieldmon.plot.plot import Plot

    from ..state.choices import Choices

#: the box for what happens with a find
_FINDS = "begin_finds"
_FROM = "season begun from"
#: who works where nobody says that several do
_ALONE = TeamChoice(starts=chosen_day.STARTS)


def show(choices: Choices) -> None:
    """Offer to keep what is chosen as a season."""
    with st.container(border=True):
        st.markdown(f"### {texts.BEGIN_TITLE}")
        st.caption(texts.BEGIN_NOTE)
        if not assumptions.asked(choices):
            st.caption(plot_place.sentence(choices.plot))
        # outside the form: it counts for the button above, too, which begins at once
        assuming.finds_are(widget_memory.show, _FINDS, default=True)
        _form(choices)
        ask(choices, "form")


def ask(choices: Choices, place: str) -> None:
    """Ask whether the rows are right, with what they are in boxes; only where it was begun."""
    if assumptions.asked(choices) != place:
        return
    key, grid = choices.plot_key, choices.plot.grid
    with st.container(border=True, key="begin_asks"):
        st.markdown(of_rows(assumptions.of_rows(choices.plot), choices.units))
        st.markdown(plot_place.sentence(choices.plot))
        with st.container(horizontal=True):
            acting.at_press(texts.BEGIN_RIGHT, begin, choices, key="begin_right", at_once=False,
                            type="primary")  # fmt: skip
            st.button(texts.BEGIN_NOT_YET, key="begin_not_yet", on_click=assumptions.ask,
                      args=(choices, ""))  # fmt: skip
        editing_plot.spacings(key, {name: getattr(grid, name) for name in assumptions.SPACINGS})
        if grid.aisles_m is None:
            editing_plot.direction(key, grid.frame.bearing_deg % 180.0)
        if choices.plot.field.gate is None:
            st.button(texts.BEGIN_GATE, key="begin_gate", on_click=editing_plot.set_gate)


def begin_or_ask(choices: Choices, place: str) -> None:
    """Begin a season where people or files said how its rows run; else ask first."""
    if assumptions.are_rows_assumed(choices):
        _ask_if_named(choices, place)
    else:
        begin(choices)


@notices.reporting
def _ask_if_named(choices: Choices, place: str) -> str:
    """Ask whether the rows are right, unless the season cannot be called, or worked, so anyway."""
    seasons_folder.new_path(_named(choices))
    _who_works(choices)
    assumptions.ask(choices, place)
    return ""


def _form(choices: Choices) -> None:
    # no form of Streamlit's: what is typed in one counts only for its own button
    st.text_input(texts.SEASON_NAME, _proposed(choices), key=_name_box(choices))
    if kept := seasons_folder.names():
        st.selectbox(
            texts.EARLIER, [None, *kept], key="season_earlier", help=texts.EARLIER_HELP,
            format_func=lambda name: texts.NO_EARLIER if name is None else name,
        )  # fmt: skip
    if widget_memory.show(st.checkbox, texts.TEAM_BEGIN, key=_team_box(choices), default=False):
        st.caption(texts.TEAM_BEGIN_NOTE)
        telling_team.show(_team_box(choices), _ALONE, choices.robot)
    acting.at_press(texts.BEGIN, begin_or_ask, choices, "form", key="begin_form", at_once=False)


def _named(choices: Choices) -> str:
    return str(st.session_state.get(_name_box(choices), _proposed(choices))).strip()


def _proposed(choices: Choices) -> str:
    """Return what a season is called unless somebody says otherwise: a name that none has yet."""
    name = seasons_folder.plain_name(choices.plot.field.name, f" {choices.on.year}")
    return name if choices.season is not None else seasons_folder.free_name(name)


def _name_box(choices: Choices) -> str:
    """Return the key of the box of the name: another plot, or year, is proposed its own."""
    return f"season_name {_proposed(choices)}"


def _team_box(choices: Choices) -> str:
    """Return the key of the box whether several work: another plot has its own."""
    return f"begin_team {choices.plot_key}"


def _who_works(choices: Choices) -> TeamChoice:
    """Return who is to work; raise `SettingError` where the team that is told cannot be so."""
    box = _team_box(choices)
    several = widget_memory.value(box, False)
    return told_team.draft(box, _ALONE, choices.robot).told() if several else _ALONE


def _earlier() -> EarlierSeason | None:
    """Return what the season chosen for it learnt; None: none was."""
    chosen = st.session_state.get("season_earlier")
    return None if chosen is None else Season(seasons_folder.path_of(chosen)).as_earlier()


@notices.reporting
def begin(choices: Choices) -> str:
    """Keep what is chosen as a season from now on."""
    name, work = _named(choices), _who_works(choices)
    settings = MonitoringSettings(
        choices.on, work.starts, choices.robot, choices.sampler, prior=choices.prior,
        belief=BeliefSettings(treated=widget_memory.value(_FINDS, True), earlier=_earlier()),
        pest=chosen_pest.pest(), weather=chosen_pest.met(choices) if chosen_pest.pest() else None,
        language=language.for_seasons(), team=work.team, teamwork=work.teamwork,
    )  # fmt: skip
    said = [one.message for one in choices.messages]
    messages = [KeptMessage("import", str(m.severity), m.feature, m.sentence) for m in said]
    path = seasons_folder.new_path(name)
    plot = _as_answered(choices.plot) if assumptions.asked(choices) else choices.plot
    Season.create(path, plot, choices.records, settings, messages, choices.risk)
    assumptions.ask(choices, "")
    told_team.drop(_team_box(choices))
    st.session_state[f"{_FROM} {path}"] = plot_source.chosen()
    plot_source.open_season(name)
    if choices.on != choices.clock.today():
        work_day.choose(name, choices.on)  # what is shown stays what it was
    more = (*chosen_day.messages_on_records(choices), *shared_plots.of_one_plot([name]))
    begun = texts.BEGUN.format(name=texts.isolated(name), path=path)
    return "\n- ".join([begun, *map(language.in_words, more)])


def _as_answered(plot: Plot) -> Plot:
    """Return a plot of which rows and gate were asked about: they are assumed no more."""
    (gate,) = plot.grid.frame.lonlat(plot.aisles.gate_m).tolist()
    return replace(plot, field=replace(plot.field, gate=tuple(gate)), assumed=())


def another(choices: Choices) -> None:
    """Offer to begin another season of the plot, laid otherwise, while nothing is recorded."""
    if choices.open_season.batches():
        return
    st.markdown(texts.ANOTHER_NOTE)
    st.button(texts.ANOTHER, key="begin_another", on_click=_open_files, args=(choices,))


@notices.reporting
def _open_files(choices: Choices) -> str:
    begun_from = st.session_state.get(f"{_FROM} {choices.open_season.path}")
    nothing = plot_files.of_session() is None
    if begun_from is None and not nothing:
        raise SettingError(texts.ANOTHER_ELSEWHERE)
    if begun_from is None:  # opened by its address: what it was begun from is not here
        drawn_plot.bring(choices.plot)
    plot_source.open_season(begun_from or plot_source.FILES)
    return texts.ANOTHER_BARE if begun_from is None else ""
