"""A day of a season driven by a team: one batch, and a find by one is planned for by all."""

from __future__ import annotations

import threading
from contextlib import nullcontext
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.drive.aisle_keeper import AisleKeeper
from fieldmon.drive.day_clock import second_now
from fieldmon.drive.season_day import (
    REPLAN_AFTER_S,
    as_inspection,
    begun_batch,
    left_of_plan,
)
from fieldmon.errors import SettingError
from fieldmon.monitoring.estimates.asked_day import AskedDay, PlantToInspect, plant_to_inspect
from fieldmon.monitoring.file.connections import kept_open
from fieldmon.monitoring.phones.scouts import codes_on
from fieldmon.monitoring.season.season_inspections import recorded
from fieldmon.plot.local_clock import grid_clock
from fieldmon.plot.travel import GATE, travel_s

if TYPE_CHECKING:
    from contextlib import AbstractContextManager
    from datetime import date

    from fieldmon.monitoring.season.season_file import Season
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.plan import DayPlan
    from fieldmon.plot.travel import Aisles


class _Stands(NamedTuple):
    """Where one of a team stands, and how many seconds of its day are gone."""

    at: int
    gone_s: float


class TeamSeason:
    """A day of a season that several drive; each has a `MemberDay` to ask and tell.

    May be asked from several threads. Whatever is told is in the file before the next is asked.

    Parameters
    ----------
    season, on
        The season, which has a team, and the day.
    source
        What the batch is called.

    Raises
    ------
    SettingError
        If the season has no team.
    """

    def __init__(self, season: Season, on: date, source: str = "robots") -> None:
        self.settings = season.planned_by(on)
        self.team = self.settings.team
        if not self.team:
            raise SettingError("A day of several robots needs a season with a team (--robots).")
        #: who of the team drives: people walk their own routes
        self.robots = robots_of(self.team)
        self.season, self.on = season, on
        self.keeper = AisleKeeper()
        self.lock = threading.RLock()
        self.source = f"{source} {on}"
        #: plans that it went by, the one it began or went on with included
        self.replanned = 0
        #: how often somebody stopped it: nobody is given another plant
        self.stops = 0
        #: plants that somebody has set out for
        self.errands: dict[str, int] = {}
        grid = season.plot.grid
        self.aisle = grid.corridor[grid.row]
        today = season.history.inspections.on(on)
        self.done: set[int] = set(today.plant.tolist())
        #: whether it goes on with what is left of the plans given out last
        self.goes_on = self.batch is not None and self._go_on()
        if self.goes_on:
            self.replanned = 1
        else:
            self.plan()

    @property
    def batch(self) -> int | None:
        """The batch of the day, as it is numbered now: merging may change that; None: none yet."""
        return begun_batch(self.season, self.source)

    def __repr__(self) -> str:
        """Say which day of which season, and of how many."""
        return f"<TeamSeason {self.on} of {self.season.path.name}: {len(self.team)} members>"

    def member(self, name: str) -> MemberDay:
        """Return the day of one of the team."""
        return MemberDay(self, self.settings.member(name))

    @kept_open()
    def plan(self) -> None:
        """Plan the rest of the day for all, each from where it was told of last; keep the plans."""
        with self.lock:
            with self._entering():
                days = self.season.plan_each(self.on)
            self.days = dict(zip((one.name for one in self.team), days, strict=True))
            self.replanned += 1

    def _entering(self) -> AbstractContextManager[None]:
        """Let a team of robots enter where people may not be yet; nobody of it has a code."""
        codes = any(self.settings.named(name) for name in codes_on(self.season, self.on))
        is_people = codes or len(self.robots) < len(self.team)
        return nullcontext() if is_people else self.season.entering_treated()

    def _go_on(self) -> bool:
        """Take what is left of the plans given out last; tell whether all fit and any is left."""
        with self._entering():
            left = {one.name: left_of_plan(self.season, self.on, one.name) for one in self.team}
        self.days = {name: today for name, today in left.items() if today is not None}
        return len(self.days) == len(left) and any(len(one.route) for one in self.days.values())


def robots_of(team: tuple[TeamMember, ...]) -> tuple[TeamMember, ...]:
    """Return who of a team drives; raise `SettingError` if nobody does."""
    robots = tuple(one for one in team if not one.robot.on_foot)
    if not robots:
        names = ", ".join(one.name for one in team)
        raise SettingError(f"A day is driven by robots, but the team has none: {names}.")
    return robots


class MemberDay(AskedDay):
    """The day of one of a team, asked for the next plant and told what was seen there."""

    late_s = REPLAN_AFTER_S

    def __init__(self, team: TeamSeason, member: TeamMember) -> None:
        self._team, self._member = team, member
        scene = team.days[member.name].scene
        self.aisles: Aisles = scene.aisles
        self._stands = _Stands(scene.at, member.robot.day_s - scene.seconds_left)
        super().__init__(self._stands.gone_s)
        #: the second of the day at which its work began, from which seconds count here
        self.begun_s = team.season.work(team.on, member.name).begun_s

    def now_s(self) -> tuple[float, str]:
        """Return what `second_now` does, of its robot."""
        return second_now(self._team.season, self._team.on, self._member.name)

    def begin_at(self, now_s: float) -> None:
        """Begin now, or go on, seconds since the day's midnight: results count from then."""
        season, on = self._team.season, self._team.on
        if not len(season.work(on, self._member.name).inspections):
            self.begun_s = now_s
            return
        gone_s = grid_clock(season.plot.grid).seconds_between(on, self.begun_s, now_s)
        if gone_s > self.gone_s + REPLAN_AFTER_S:
            self._stands = self._stands._replace(gone_s=gone_s)
            self._clock_s = gone_s

    @property
    def on(self) -> date:
        """The day."""
        return self._team.on

    @property
    def left_s(self) -> float:
        """Seconds of its hours that are left."""
        return max(0.0, self._member.robot.day_s - self.gone_s)

    def __repr__(self) -> str:
        """Say whose day it is."""
        return f"<MemberDay of {self._member.name}: {self._team!r}>"

    @property
    def at(self) -> int:
        """Where it stands: a plant, or -1 for the gate."""
        return self._stands.at

    @property
    def gone_s(self) -> float:
        """Seconds of its day that are gone."""
        return self._stands.gone_s

    def ask(self) -> PlantToInspect | None:
        """Return the plant to inspect next; None where its hours allow no other.

        Never one that another has set out for, nor one in an aisle where another stays for today.
        """
        team, name = self._team, self._member.name
        with team.lock:
            if team.stops:
                return None
            if self._asked is None and (left := self._left()):
                team.errands[name] = left[0]
                self._asked = self._stop(left[0])
            return self._asked

    def ahead(self, n: int) -> list[int]:
        """Return up to n plants that follow the one asked for if nothing is found."""
        with self._team.lock:
            return [plant for plant in self._left() if plant != self._errand][:n]

    @kept_open()
    def tell(self, found: bool | None, at_s: float | None = None) -> None:  # noqa: FBT001 - a result
        """Record what was seen at the plant that was asked for, and when; see `SeasonDay.tell`."""
        with self._team.lock:
            self._tell(found, at_s)

    def _take(self, stop: PlantToInspect, found: bool | None, now_s: float) -> None:  # noqa: FBT001
        team = self._team
        clock = grid_clock(team.season.plot.grid)
        at_s = clock.second_after(team.on, self.begun_s, now_s)
        one = as_inspection(stop.plant, found, (team.on, at_s), self._member.name)
        recorded(team.season, one, team.source, into=team.batch)

    def _go_on(self, stop: PlantToInspect, found: bool | None, *, is_late: bool) -> None:  # noqa: FBT001
        team = self._team
        self._stands = _Stands(stop.plant, self._clock_s)
        team.errands.pop(self._member.name, None)
        team.done.add(stop.plant)
        if found or found is None or is_late:
            team.plan()

    def leave(self) -> None:
        """Go to no plant any more: what it set out for is free for others."""
        super().leave()
        with self._team.lock:
            self._team.errands.pop(self._member.name, None)

    @property
    def _errand(self) -> int:
        return self._team.errands.get(self._member.name, GATE)

    @property
    def _today(self) -> DayPlan:
        return self._team.days[self._member.name]

    def _left(self) -> list[int]:
        """Return the plants of its route that are still its to inspect, as its hours allow."""
        team, name = self._team, self._member.name
        taken = team.done | {plant for who, plant in team.errands.items() if who != name}
        free = [
            plant
            for plant in self._today.route.plant.tolist()
            if plant not in taken and not team.keeper.blocked(name, [int(team.aisle[plant])])
        ]
        while free and not self._fits(free[0]):
            del free[0]
        return free

    def _fits(self, plant: int) -> bool:
        scene = self._today.scene
        robot, travel, clock = scene.robot, self.aisles.travel, scene.clock
        home_s = travel_s(travel, clock, plant, GATE) if robot.returns else 0.0
        return self._arrive_s(plant) + robot.visit_s + home_s <= robot.day_s

    def _arrive_s(self, plant: int) -> float:
        clock = self._today.scene.clock
        return self.gone_s + float(travel_s(self.aisles.travel, clock, self.at, plant))

    def _stop(self, plant: int) -> PlantToInspect:
        route = self._today.route
        k = int(np.flatnonzero(route.plant == plant)[0])
        long = float(route.leave_s[k] - route.arrive_s[k]), float(route.detects[k])
        grid = self._team.season.plot.grid
        return plant_to_inspect(grid, plant, self._arrive_s(plant), *long)
