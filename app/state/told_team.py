"""Who is to work as a team, as it is being told: in boxes, a row a member, and not used yet."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import date, datetime, time, timedelta
from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

import streamlit as st

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.monitoring.settings.settings import (
    MonitoringSettings,
    as_json,
    from_json,
    seconds,
)
from fieldmon.planning.members import TeamMember, Teamwork, must_differ, person_key
from fieldmon.planning.stated_team import usual_kind

from ..words import texts
from . import widget_memory
from .chosen_units import units

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from fieldmon.plot.robot import Robot

ROBOT, SCOUT = "robot", "scout"
_MADE, _DRAFT = "team rows made", "team told "
# the boxes of a row, and those of how all work together
_BOXES, _TOGETHER = ("name", "who", "hours", "look", "start"), ("contact", "least_gain", "passing")
_DAY_S, _MIN_S = 24 * 3600.0, 60.0


class TeamChoice(NamedTuple):
    """Who works, when the first of them starts (local time), and how they work together.

    An empty team: one works.
    """

    team: tuple[TeamMember, ...] = ()
    starts: time = time(6)
    teamwork: Teamwork = Teamwork()


@dataclass(frozen=True)
class MemberRow:
    """A row of boxes: its number, and who stood in it at first; they start at so many seconds."""

    number: int
    member: TeamMember
    starts_s: float

    def key(self, box: str) -> str:
        """Return the key of a box."""
        return f"team_{box} {self.number}"

    def first(self, box: str) -> Any:  # noqa: ANN401 - whatever the widget holds
        """Return what stood in a box at first."""
        member = self.member
        return {
            "name": member.name, "who": SCOUT if member.robot.on_foot else ROBOT,
            "hours": float(member.robot.hours), "look": float(member.robot.look_s),
            "start": _clock(self.starts_s).replace(second=0, microsecond=0),
        }[box]  # fmt: skip

    def said(self, box: str) -> Any:  # noqa: ANN401 - whatever the widget holds
        """Return what a box says; one that was emptied, what stood in it at first."""
        said = widget_memory.value(self.key(box), self.first(box))
        return self.first(box) if said is None else said

    def starts(self) -> float:
        """Return the seconds of the day at which whoever it is starts."""
        start: time = self.said("start")
        return self.starts_s if start == self.first("start") else seconds(start)

    def worker(self) -> Robot:
        """Return the robot or scout that the row says; raise `SettingError` for no such one."""
        was, who = self.member.robot, self.said("who")
        kind = was if was.on_foot == (who == SCOUT) else usual_kind(who)
        return replace(kind, hours=self.said("hours"), look_s=self.said("look"))

    def told(self) -> TeamMember:
        """Return who the row says; they start as it began. Raise `SettingError` for no such one."""
        name = self.said("name").strip()
        try:
            robot = self.worker()
        except SettingError as error:
            if not name:
                raise
            named = worded("{name}: {problem}", name=name, problem=error.args[0])
            raise SettingError(named) from None
        return replace(self.member, name=name, robot=robot)


@dataclass(frozen=True)
class TeamDraft:
    """What is being told: the rows, and what counted when it was begun.

    Parameters
    ----------
    number
        Of the boxes of how all work together.
    seen
        What counted.
    begun
        What the rows said at first.
    rows
        One a member.
    plain
        What was begun with the first of them starting when the team does.
    """

    number: int
    seen: TeamChoice
    begun: TeamChoice
    rows: tuple[MemberRow, ...]
    plain: TeamChoice

    def key(self, box: str) -> str:
        """Return the key of a box of how all work together."""
        return f"team_{box} {self.number}"

    def first(self, box: str) -> float:
        """Return what stood in a box of how all work together at first, as it is shown."""
        teamwork = self.begun.teamwork
        return {
            "contact": teamwork.contact_s / _MIN_S,
            "least_gain": teamwork.least_gain,
            "passing": units().shown(teamwork.passing_m),
        }[box]

    def told(self) -> TeamChoice:
        """Return what the boxes say; raise `SettingError` where that cannot be."""
        members = [row.told() for row in self.rows]
        must_differ([one.name for one in members])
        made = _choice(members, [row.starts() for row in self.rows], self._teamwork())
        return self.begun if made == self.plain else made

    def is_told(self) -> bool:
        """Return whether anything was said in the boxes since they were begun."""
        try:
            return self.told() != self.begun
        except SettingError:
            return True

    def _teamwork(self) -> Teamwork:
        shown = {box: self.first(box) for box in _TOGETHER}
        said = {box: widget_memory.value(self.key(box), one) for box, one in shown.items()}
        # what is shown is rounded: what nobody changed stays as it was
        in_units: dict[str, tuple[str, Callable[[float], float]]] = {
            "contact": ("contact_s", lambda shown: _MIN_S * shown),
            "least_gain": ("least_gain", float),
            "passing": ("passing_m", units().in_metres),
        }
        changed: dict[str, Any] = {in_units[box][0]: in_units[box][1](one)
                   for box, one in said.items() if one not in (None, shown[box])}  # fmt: skip
        return replace(self.begun.teamwork, **changed)


def draft(place: str, now: TeamChoice, robot: Robot) -> TeamDraft:
    """Return what is being told in a place; if nothing is, begin with what counts now.

    Where one works, `robot`, that is two of its kind.
    """
    kept: TeamDraft | None = st.session_state.get(_DRAFT + place)
    if kept is None or (kept.seen != now and not kept.is_told()):
        kept = _begun(now, now if now.team else now._replace(team=_two(robot)))
        _keep(place, kept)
    return kept


def drop(place: str) -> None:
    """Let the boxes begin anew with what counts (for callbacks)."""
    st.session_state.pop(_DRAFT + place, None)


def go_on(place: str, now: TeamChoice) -> None:
    """Let what was told stand, though what counts is another by now (for callbacks)."""
    _keep(place, replace(_kept(place), seen=now))


def bring(place: str, team: Iterable[TeamMember], starts: time) -> None:
    """Let the rows be of another team, as of a table (for callbacks)."""
    _keep(place, replace(_kept(place), rows=_rows(team, starts)))


def add(place: str, who: str) -> None:
    """Add a robot or a scout: like the last of that kind, if there is one (for callbacks)."""
    before = _kept(place)
    robot = usual_kind(who)
    for row in before.rows:
        with suppress(SettingError):  # what is wrong with it is said below all rows
            robot = row.worker() if row.said("who") == who else robot
    names = {person_key(row.said("name")) for row in before.rows}
    called = texts.SCOUT_NAMED if who == SCOUT else texts.ROBOT_NAMED
    name = next(name for k in count(1) if person_key(name := called.format(n=k)) not in names)
    starts_s = min((row.starts() for row in before.rows), default=0.0)
    row = MemberRow(_next(), TeamMember(name, robot), starts_s)
    _keep(place, replace(before, rows=(*before.rows, row)))


def take_out(place: str, number: int) -> None:
    """Take the member of a row out (for callbacks)."""
    before = _kept(place)
    rows = tuple(row for row in before.rows if row.number != number)
    _keep(place, replace(before, rows=rows))


def turn_kind(row: MemberRow) -> None:
    """Let whoever is of another kind now look as long as that kind does (for callbacks)."""
    widget_memory.put(row.key("look"), float(usual_kind(row.said("who")).look_s))


def said() -> dict[str, Any]:
    """Return what is being told and not used yet, by its place, as JSON can hold it."""
    drafts = {str(key): st.session_state[key] for key in st.session_state
              if str(key).startswith(_DRAFT)}  # fmt: skip
    return {key: _written(one) for key, one in drafts.items() if one.is_told()}


def take(said: dict[str, Any]) -> None:
    """Go on telling what was being told before a reload, as `said` returned it."""
    for key, told in said.items():
        st.session_state[key] = draft = _read(told)
        numbers = [draft.number, *(row.number for row in draft.rows)]
        st.session_state[_MADE] = max([st.session_state.get(_MADE, 0), *(k + 1 for k in numbers)])
        for box, value in told["boxes"].items():
            is_start = box.startswith("team_start ")
            widget_memory.put(box, time.fromisoformat(value) if is_start else value)


def _written(draft: TeamDraft) -> dict[str, Any]:
    rows = [(row.number, _settings(TeamChoice((row.member,))), row.starts_s) for row in draft.rows]
    keys = [*map(draft.key, _TOGETHER), *(row.key(box) for row in draft.rows for box in _BOXES)]
    said = {key: widget_memory.value(key) for key in keys}
    return {
        "number": draft.number, "rows": rows,
        "seen": _settings(draft.seen), "begun": _settings(draft.begun),
        "boxes": {key: f"{one}" if isinstance(one, time) else one
                  for key, one in said.items() if one is not None},
    }  # fmt: skip


def _read(told: dict[str, Any]) -> TeamDraft:
    begun = _of_settings(told["begun"])
    rows = tuple(MemberRow(number, _of_settings(one).team[0], starts_s)
                 for number, one, starts_s in told["rows"])  # fmt: skip
    return TeamDraft(told["number"], _of_settings(told["seen"]), begun, rows, _plain(begun))


def _settings(choice: TeamChoice) -> dict[str, str]:
    """Return a team as a season's file has it."""
    return as_json(MonitoringSettings(begins=date.min, **choice._asdict()))


def _of_settings(kept: dict[str, str]) -> TeamChoice:
    settings = from_json(kept)
    return TeamChoice(settings.team, settings.starts, settings.teamwork)


def _begun(seen: TeamChoice, choice: TeamChoice) -> TeamDraft:
    rows = _rows(choice.team, choice.starts)
    return TeamDraft(_next(), seen, choice, rows, _plain(choice))


def _plain(choice: TeamChoice) -> TeamChoice:
    """Return a team whose first member starts when the team does."""
    starts_s = [seconds(choice.starts) + one.starts_s for one in choice.team]
    return _choice(choice.team, starts_s, choice.teamwork)


def _rows(team: Iterable[TeamMember], starts: time) -> tuple[MemberRow, ...]:
    return tuple(MemberRow(_next(), one, seconds(starts) + one.starts_s) for one in team)


def _choice(
    members: Iterable[TeamMember], starts_s: Sequence[float], teamwork: Teamwork
) -> TeamChoice:
    """Return a team whose members start at so many seconds of the day, the first with the team."""
    first_s = min(starts_s)
    each = zip(members, starts_s, strict=True)
    team = tuple(replace(one, starts_s=at_s - first_s) for one, at_s in each)
    return TeamChoice(team, _clock(first_s), teamwork)


def _two(robot: Robot) -> tuple[TeamMember, ...]:
    called = texts.SCOUT_NAMED if robot.on_foot else texts.ROBOT_NAMED
    return tuple(TeamMember(called.format(n=k), robot) for k in (1, 2))


def _clock(seconds: float) -> time:
    """Return the time of the day at so many seconds since midnight, on whichever day."""
    return (datetime.min + timedelta(seconds=seconds % _DAY_S)).time()  # noqa: DTZ901 - local time


def _kept(place: str) -> TeamDraft:
    kept: TeamDraft = st.session_state[_DRAFT + place]
    return kept


def _keep(place: str, told: TeamDraft) -> None:
    st.session_state[_DRAFT + place] = told


def _next() -> int:
    made: int = st.session_state.get(_MADE, 0)
    st.session_state[_MADE] = made + 1
    return made
