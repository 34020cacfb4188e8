"""What scout mode does; all of it is in the season's file, nothing in the page."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring.settings.settings import seconds

from ..show import recorded_batches
from ..state import chosen_day, notices
from ..words import texts
from ..words.language import number
from . import handing_out, recording_results, undoing

if TYPE_CHECKING:
    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.monitoring import Batch, MonitoringSettings
    from fieldmon.planning.members import TeamMember

    from ..state.choices import Choices

SOURCE = "scout mode"
_TAPS = "scout taps"


def _second(choices: Choices) -> float:
    """Return the second of the day of a tap; NaN on another day than today: nobody said when."""
    now = choices.clock.now()
    return seconds(now.time()) if now.date() == choices.on else np.nan


@notices.reporting
def _tap(choices: Choices, plant: int, result: int) -> str:
    count = st.session_state.get("scout_count")
    counted = float(count) if result == FOUND and count is not None else np.nan
    second, (kept, note) = _second(choices), recording_results.as_kept(result)
    results = Inspections.of(
        np.array([plant]), np.array([kept]), np.datetime64(choices.day),
        second=np.array([second]), count=np.array([counted]), notes=np.array([note], object),
    )  # fmt: skip
    if not len(chosen_day.given_out(choices)):  # from the first tap on it is the day's route
        handing_out.give_out(choices)
    recording_results.recorded(choices, results, SOURCE, who=choices.whose_day or "")
    return ""


def taps() -> int:
    """Return how many taps were answered so far: by this the browser knows what a tap is of."""
    n: int = st.session_state.setdefault(_TAPS, 0)
    return n


def drawn() -> DeltaGenerator:
    """Return what says how many taps what stands above it was drawn after: see `taps.js`."""
    return st.container(key=f"scout_after_{taps()}")


def tap(choices: Choices, plant: int, result: int, after: int) -> None:
    """Record a tap at once; a second one of what was drawn after as many taps says nothing."""
    if after != taps():
        return
    st.session_state[_TAPS] += 1
    _tap(choices, plant, result)
    st.session_state["scout_count"] = None


def undo(choices: Choices, batch: Batch, after: int) -> None:
    """Take a tap back; a second press of the same button takes no other one back."""
    if after != taps():
        return
    st.session_state[_TAPS] += 1
    undoing.undo(choices, batch, choices.whose_day or "")


def last_tap(choices: Choices) -> tuple[Batch, str] | None:
    """Return the batch of this person's last tap of the day that counts, and what it said."""
    who, season = choices.whose_day or "", choices.open_season
    taps = (b for b in season.batches() if (b.source, b.who, b.undone) == (SOURCE, who, False))
    last = next(taps, None)
    if last is None:
        return None
    tapped = season.contents([last.number]).get(last.number)
    if tapped is None or (tapped.n, tapped.first) != (1, str(choices.on)):
        return None
    return last, recorded_batches.last(choices, tapped)


def offer_undo(choices: Choices) -> None:
    """Show what this person tapped last, and a button that takes it back."""
    if (last := last_tap(choices)) is None:
        return
    batch, said = last
    st.caption(said)
    with st.container(key="scout_back"):
        st.button(texts.UNDO_BUTTON, key="scout_undo", width="stretch", icon=":material/undo:",
                  on_click=undo, args=(choices, batch, taps()))  # fmt: skip


def can_be_longer(choices: Choices) -> bool:
    """Return whether the day shown would go by other hours: one that is past would not."""
    return not choices.open_season.work(choices.on).is_earlier


@notices.reporting
def longer(choices: Choices) -> str:
    """Make the working day an hour longer than it is, and than the work has taken so far.

    Of a team it is the day of the one chosen.
    """
    settings = choices.open_season.settings
    who = choices.whose_day
    work = choices.open_season.work(choices.on, who or "")
    # who worked on is hours beyond the end
    gone_s = np.nanmax(np.append(work.inspections.second, 0.0)) - work.begun_s
    robot = settings.robot if who is None else settings.member(who).robot
    hours = max(robot.hours, np.ceil(gone_s / 1800.0) / 2) + 1.0
    robot = replace(robot, hours=float(min(hours, 24.0)))
    changed = replace(settings, robot=robot)
    if who is not None:
        changed = _with_member(settings, replace(settings.member(who), robot=robot))
    choices.open_season.change(changed, settings)
    return _now_used(choices, texts.IN_HOURS.format(hours=number(robot.hours, "g")))


def ask_start(choices: Choices) -> None:
    """Where the work begins later than planned, offer to begin now."""
    now, starts = choices.clock.now(), chosen_day.work_begins(choices)
    begun = len(choices.open_season.work(choices.on, choices.whose_day or "").inspections)
    late = now.date() == choices.on and now > starts
    if not begun and late:
        said = texts.SCOUT_START.format(start=f"{starts:%H:%M}", now=f"{now:%H:%M}")
        with st.container(key="begin_later", horizontal=True, vertical_alignment="center"):
            st.markdown(said, width="stretch")
            st.button(texts.SCOUT_NOW, key="begin_now", on_click=_begin_now, args=(choices,))


@notices.reporting
def _begin_now(choices: Choices) -> str:
    settings = choices.open_season.settings
    starts = choices.clock.now().replace(second=0).time()
    changed = replace(settings, starts=starts)
    if (who := choices.whose_day) is not None:  # the others begin as before
        late_s = seconds(starts) - seconds(settings.starts)
        changed = _with_member(settings, replace(settings.member(who), starts_s=late_s))
    choices.open_season.change(changed, settings)
    return _now_used(choices, f"{starts:%H:%M}")


def _with_member(settings: MonitoringSettings, member: TeamMember) -> MonitoringSettings:
    """Return settings in which one of the team works otherwise."""
    team = tuple(member if one.name == member.name else one for one in settings.team)
    return replace(settings, team=team)


def _now_used(choices: Choices, what: str) -> str:
    """Return what is in use now, and for whom of a team."""
    name = what if choices.whose_day is None else f"{texts.isolated(choices.whose_day)} · {what}"
    return texts.NOW_USED.format(name=name)
