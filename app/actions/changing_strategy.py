"""Changing a strategy: in the season that is open, or in the boxes of the sidebar."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from functools import partial
from typing import TYPE_CHECKING, Any

import streamlit as st

from fieldmon.monitoring.changes.earlier_settings import before_change
from fieldmon.monitoring.estimates.told_anew import telling_anew
from fieldmon.monitoring.settings.settings_words import changed, taken_back
from fieldmon.plot.robot import Robot, scout

from ..state import notices, strategy_boxes, told_team
from ..state.told_team import TeamChoice
from ..words import texts
from ..words.language import in_words, listed
from ..words.strategies import sampler_does, sampler_name, strategy_name
from . import acting, robot_boxes, telling_team

if TYPE_CHECKING:
    from contextlib import AbstractContextManager
    from datetime import date

    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.monitoring import MonitoringSettings

    from ..state.choices import Choices
    from ..state.comparison import Strategy

_UNUSED = "settings not in use yet"
#: who may inspect, whatever they are called in a language; a team only in a season
ROBOT, SCOUT, TEAM = "Robot", "Scout on foot", "Team"
WHO = (ROBOT, SCOUT)


def who_name(who: str) -> str:
    """Return what one who inspects is called."""
    return {SCOUT: texts.SCOUT, TEAM: texts.TEAM}.get(who, texts.ROBOT)


def named() -> dict[str, Any]:
    """Return how a box names samplers: it is too narrow for more than that."""
    help_ = "\n".join(f"- {is_}" for is_ in texts.SAMPLERS.values())
    return {"format_func": sampler_name, "help": help_}


@dataclass(frozen=True)
class Work:
    """Where the boxes stand: who works in the foot; the hours with the day, or else there too."""

    foot: DeltaGenerator
    day: DeltaGenerator | None = None

    def hours(self) -> DeltaGenerator:
        """Return where the hours stand, to be used within the boxes of who works."""
        where = st if self.day is None else self.day
        return where.container(key="hours" if self.day is None else "hours_of_day")


def in_hours() -> str:
    """Return how a slider writes hours."""
    return texts.IN_HOURS.format(hours="%g")


def show(name: str, choices: Choices, work: Work, by: MonitoringSettings) -> None:
    """Show who works in the season of this name, and change it on demand.

    A day that goes `by` what counted then says so instead: a change is for days to come.
    """
    season = choices.open_season
    st.session_state[_UNUSED] = False
    with work.foot, st.expander(texts.WHO, expanded=work.day is not None):
        settings = season.settings
        if by != settings:
            st.caption(_earlier(by, choices.on))
            _offer_as_now(choices)
            return
        with strategy_boxes.all_of(choices.key):
            wanted, hours = _wanted(name, choices, work)
        if wanted is None:  # what is said of a team cannot be used, and says why
            st.session_state[_UNUSED] = True
            wanted = settings
        others = replace(wanted, robot=wanted.robot.with_hours(settings.robot.hours))
        # what was changed with the day is used there
        with hours if others == settings else nullcontext():
            if wanted != settings:
                st.session_state[_UNUSED] = True
                st.caption(texts.CHANGE_NOTE)
                acting.at_press(texts.CHANGE, _change, choices, wanted, settings,
                                key="change_setup", at_once=False, type="primary")  # fmt: skip
        _offer_undo(choices)


def is_unused() -> bool:
    """Return whether boxes say what the season does not go by yet: its plan is none of theirs."""
    unused: bool = st.session_state.get(_UNUSED, False)
    return unused


def _offer_as_now(choices: Choices) -> None:
    """Offer to plan a day that was missed by what counts now."""
    now = choices.open_season.settings
    if _is_recorded(choices):
        return
    strategy = strategy_name(now.sampler, now.robot.hours, now.robot.look_s)
    if now.team:
        strategy = listed(texts.isolated(one.name) for one in now.team)
    acting.at_press(texts.PLAN_AS_NOW.format(strategy=strategy), _as_now, choices,
                    key="plan_as_now")  # fmt: skip


def _is_recorded(choices: Choices) -> bool:
    season = choices.open_season
    return len(season.history.on(season.settings.day(choices.on))) > 0


@notices.reporting
def _as_now(choices: Choices) -> str:
    return _planned_as_now(choices)


def _planned_as_now(choices: Choices) -> str:
    """Plan a day that was missed by what counts now: it goes on by the plan that is kept of it."""
    with choices.open_season.as_now(choices.on):
        choices.open_season.plan(choices.on, wishes=choices.wishes)
    return texts.CHANGED_LATE.format(day=choices.units.said_day(choices.on))


def _earlier(by: MonitoringSettings, on: date) -> str:
    """Return by what an earlier day goes, of each who worked."""
    if not by.team:
        was = strategy_name(by.sampler, by.robot.hours, by.robot.look_s)
        return texts.EARLIER_SETTINGS.format(strategy=was, starts=f"{by.starts:%H:%M}")
    begins = datetime.combine(on, by.starts)
    each = [
        texts.EARLIER_MEMBER.format(
            name=texts.isolated(one.name),
            strategy=strategy_name(by.sampler, one.robot.hours, one.robot.look_s),
            starts=f"{begins + timedelta(seconds=one.starts_s):%H:%M}",
        )
        for one in by.team
    ]
    return "\n- ".join([f"{texts.EARLIER_TEAM}\n", *each])


def _with_team(name: str, choices: Choices) -> MonitoringSettings | None:
    """Show the boxes of a team; return the settings that they say, if they can be so."""
    settings = choices.open_season.settings
    now = TeamChoice(settings.team, settings.starts, settings.teamwork)
    told = telling_team.show(choices.key, now, settings.robot)
    wanted = _with_sampler(choices, settings, f"{name} {settings.sampler}")
    return None if told is None else replace(wanted, **told._asdict())


def _with_sampler(choices: Choices, settings: MonitoringSettings, key: str) -> MonitoringSettings:
    """Show the box of the sampler; return the settings with the one that is chosen."""
    sampler = strategy_boxes.show(
        st.selectbox, texts.SAMPLER, list(texts.SAMPLERS), place=choices.key,
        key=f"sampler {key}", counts=settings.sampler, **named(),
    )  # fmt: skip
    wanted = settings if sampler == settings.sampler else settings.with_sampler(sampler)
    st.caption(sampler_does(sampler, wanted.sampler_settings.get("every")))
    return wanted


def _wanted(
    name: str, choices: Choices, work: Work
) -> tuple[MonitoringSettings | None, AbstractContextManager[object]]:
    """Show the boxes; return the settings that they say, and where the hours stand.

    No settings: a team that is told cannot be so.
    """
    settings = choices.open_season.settings
    robot = settings.robot
    key = f"{name} {robot.hours} {robot.look_s} {settings.sampler} {robot.speed_m_s}"
    alone = SCOUT if robot.on_foot else ROBOT
    was = TEAM if settings.team else alone
    show = partial(strategy_boxes.show, place=choices.key)
    who = show(st.segmented_control, texts.WHO, [*WHO, TEAM], key=f"who {key} {was}", counts=was,
               required=True, format_func=who_name, label_visibility="collapsed")  # fmt: skip
    if who == TEAM:
        return _with_team(name, choices), nullcontext()
    settings = replace(settings, team=())
    if who != alone:
        robot = (scout() if who == SCOUT else Robot()).with_hours(robot.hours)
        key = f"{key} {who}"
    # a command, or "one hour more", may have set what is beyond the usual; a program whole numbers
    usual_h, usual_s = float(robot.hours), float(robot.look_s)
    place = work.hours()
    with place:
        hours = show(st.slider, texts.HOURS, min(0.5, usual_h), max(16.0, usual_h), step=0.5,
                     format=in_hours(), key=f"hours {key}", counts=usual_h)  # fmt: skip
    inspection_s = show(
        st.slider, texts.INSPECTION_S, min(20.0, usual_s), max(60.0, usual_s), step=5.0,
        format="%g", key=f"inspection_s {key}", counts=usual_s,
    )  # fmt: skip
    if who != SCOUT:
        robot = robot_boxes.of_season(robot, choices.key, key)
    wanted = _with_sampler(choices, settings, key)
    robot = replace(robot, hours=float(hours), look_s=float(inspection_s))
    return replace(wanted, robot=robot), place


def _offer_undo(choices: Choices) -> None:
    before = before_change(choices.open_season)
    if before is None:
        return
    what = in_words(changed(choices.open_season.settings, before))
    if what:  # on the button a team of many is too long for a phone
        st.caption(texts.LAST_CHANGE.format(what=what))
    label = texts.UNDO_CHANGE if what else texts.UNDO_NO_CHANGE
    st.button(label, key="undo_change", icon=":material/undo:", on_click=_undo, args=(choices,))


@notices.reporting
def _change(choices: Choices, wanted: MonitoringSettings, settings: MonitoringSettings) -> str:
    season = choices.open_season
    season.change(wanted, settings)
    told_team.drop(choices.key)
    if season.planned_by(choices.on) == season.settings:
        return ""
    if not _is_recorded(choices):
        return _planned_as_now(choices)
    return texts.CHANGED_LATER.format(day=choices.units.said_day(choices.on))


@notices.reporting
def _undo(choices: Choices) -> str:
    """Take the last change back, and say what it was and what that makes of days past."""
    season, said = choices.open_season, list[str]()
    settings = season.settings
    with telling_anew(season, settings, before_change(season) or settings, said.append):
        said.append(taken_back(settings, season.undo_change()))
    told_team.drop(choices.key)
    return " ".join(map(in_words, said))


@notices.reporting
def use(choices: Choices, box: str) -> str:
    """Work by the strategy that the box of this key holds from now on (for callbacks)."""
    strategy: Strategy = st.session_state[box]
    sampler, hours, inspection_s = strategy.sampler, strategy.hours, strategy.inspection_s
    if choices.season is not None:
        settings = choices.season.settings
        if settings.team:  # each has hours of its own
            choices.season.change(settings.with_sampler(sampler), settings)
            return texts.NOW_USED.format(name=sampler_name(sampler))
        robot = replace(settings.robot, hours=hours, look_s=inspection_s)
        wanted = replace(settings.with_sampler(sampler), robot=robot)
        choices.season.change(wanted, settings)
    else:
        who = st.session_state.get("who", ROBOT)
        st.session_state["sampler"] = sampler
        st.session_state[f"hours {who}"] = hours
        st.session_state[f"inspection_s {who}"] = int(inspection_s)
    return texts.NOW_USED.format(name=strategy_name(sampler, hours, inspection_s))
