"""What is left of a day for somebody who leaves now: the route given out, or one of their rows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.monitoring.changes import logged_days
from fieldmon.monitoring.days import kept_routes, kept_wishes
from fieldmon.monitoring.phones.photos_asked import photos_asked_in
from fieldmon.monitoring.phones.scouts import inside, scouts_in
from fieldmon.monitoring.settings.shift_work import BEGINS_OTHERWISE_S, ScoutCrew
from fieldmon.monitoring.treating.closures import closed_plants
from fieldmon.planning.members import person_key
from fieldmon.planning.plan import DayPlan
from fieldmon.planning.route import route_of
from fieldmon.planning.wishes import Wishes
from fieldmon.planning.workday import Workday
from fieldmon.plot.local_clock import grid_clock, local_clock
from fieldmon.plot.travel import GATE, driven_s

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.monitoring.days.kept_routes import KeptRoute
    from fieldmon.monitoring.days.kept_wishes import KeptWishes
    from fieldmon.monitoring.phones.photos_asked import AskedPhoto
    from fieldmon.monitoring.phones.scouts import Scout
    from fieldmon.monitoring.season.season_file import Season
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantNumbers
    from fieldmon.samplers.base import Scene

    Plants = NDArray[np.int32]

MIDNIGHT = time()
_NO_PLANTS: Plants = np.empty(0, np.int32)


@dataclass(frozen=True)
class WorkPart:
    """Whose part of a day's work it is.

    Parameters
    ----------
    rows
        First and last row, from 1; None: the whole plot, or what the team's plan gives.
    name
        Of whoever works: one of the season's team or not; empty: nobody in particular.
    """

    rows: tuple[int, int] | None = None
    name: str = ""


WHOLE = WorkPart()


class WorkHours(NamedTuple):
    """Somebody's hours on a day.

    Parameters
    ----------
    begins_s
        The second of the day at which work began, or will, see `Season.work`.
    run
        Whether they run by the clock now: it is today, and it is known when work began.
    left_s
        What is left of them: now where they run, else where the last inspection left them.
    """

    begins_s: float
    run: bool
    left_s: float


@dataclass(frozen=True, eq=False)
class DayAhead:
    """What a season's file says of a day's routes and of who is to work, read at one moment.

    Parameters
    ----------
    plant_numbers
        Row and number of every plant.
    aisle
        ``(n,)`` from which aisle each is inspected.
    settings
        What is chosen.
    scouts
        Who has a code.
    last, plants
        The route kept last of each who has one, and its plants ``(k,)``, by `person_key`.
    asked
        The photos that are asked for.
    wished
        What is wanted of the day besides.
    """

    plant_numbers: PlantNumbers
    aisle: NDArray[np.integer]
    settings: MonitoringSettings
    scouts: tuple[Scout, ...]
    last: dict[str, KeptRoute]
    plants: dict[str, Plants]
    asked: tuple[AskedPhoto, ...]
    wished: KeptWishes = kept_wishes.NO_WISHES

    @classmethod
    def of(cls, season: Season, on: date) -> DayAhead:
        """Return it of the day `on`."""
        with season.reading() as now:
            settings = now.settings
            last = kept_routes.kept_last(now.db, settings.day(on))
            plants = {who: kept_routes.plants(now.db, kept) for who, kept in last.items()}
            people, asked = scouts_in(now.db), photos_asked_in(now.db)
            wished = kept_wishes.kept_in(now.db, on, len(season.plant_numbers.line))
        grid = season.plot.grid
        aisle = grid.corridor[grid.row]
        return cls(season.plant_numbers, aisle, settings, people, last, plants, asked, wished)

    def kept(self, who: str = "") -> Plants:
        """Return the plants of somebody's route; nobody named: of the first of the team."""
        named = self.settings.at_work(who)
        return self.plants.get(person_key(who if named is None else named.name), _NO_PLANTS)

    def member(self, part: WorkPart) -> TeamMember | None:
        """Return the one of the team whose part it is, or None."""
        return self.settings.named(part.name)

    def rows(self, part: WorkPart) -> tuple[int, int] | None:
        """Return the rows of a part; None: the plot, or what the team's plan gives one of it."""
        return None if self.member(part) is not None else part.rows

    def crew(self, part: WorkPart) -> tuple[str, ...]:
        """Return who shares a part's plants: all who have a code for these rows, beside the team.

        They have aisles of their own, as a team has. Whose part it is comes last without a code.
        """
        rows = self._lines(part.rows)
        names = {
            person_key(one.name): one.name
            for one in self.scouts
            if self._lines(one.rows) == rows and self.settings.named(one.name) is None
        }
        names.setdefault(person_key(part.name), part.name)
        return tuple(names.values())

    def others(self, part: WorkPart) -> tuple[str, ...]:
        """Return who else shares a part's plants."""
        return tuple(one for one in self.crew(part) if person_key(one) != person_key(part.name))

    def kept_as(self, part: WorkPart) -> str:
        """Return by which name a part's route is kept; empty: it is the season's own."""
        member = self.member(part)
        return self.works_as(part) if member is None else member.name

    def plan_of(self, part: WorkPart) -> int | None:
        """Return the number of the route kept last of a part as a plan; None: none is kept."""
        kept = self.last.get(person_key(self.kept_as(part)))
        return None if kept is None else kept.plan

    def mark(self, part: WorkPart) -> str:
        """Return the digest of the route kept last of a part; empty: none is kept."""
        kept = self.last.get(person_key(self.kept_as(part)))
        return "" if kept is None else kept.digest

    def is_seasons(self, part: WorkPart) -> bool:
        """Return whether a part's day is the season's own: that of who works alone on the plot.

        What anybody inspected is then part of its work.
        """
        if part.rows is not None or self.settings.team:
            return False
        return not part.name or not self.others(part)

    def works_as(self, part: WorkPart) -> str:
        """Return by whose inspections a part's hours are counted; empty: everybody's."""
        return "" if self.is_seasons(part) else part.name

    def route(self, part: WorkPart) -> Plants:
        """Return the plants of the route kept of a part, wherever they lie."""
        return self.kept(self.kept_as(part))

    def given(self, part: WorkPart) -> Plants:
        """Return the plants of the route kept of a part that are in it."""
        kept = self.route(part)
        return kept[self.own(part)[kept]]

    def has_route(self, part: WorkPart) -> bool:
        """Return whether somebody can have a route: beside the team rows are needed for it."""
        is_beside = bool(self.settings.team and part.name) and self.member(part) is None
        return not is_beside or part.rows is not None

    def own(self, part: WorkPart) -> NDArray[np.bool_]:
        """Return ``(n,)`` which plants are somebody's to inspect; none where no route can be."""
        if not self.has_route(part):
            return np.zeros(len(self.plant_numbers.line), np.bool_)
        return inside(self.plant_numbers, self.rows(part))

    def in_own_aisles(self, part: WorkPart) -> NDArray[np.bool_]:
        """Return ``(n,)`` which of somebody's plants are in no aisle that others' routes lead to.

        Theirs are those of the team, and of whoever shares the rows. What one's own route leads to
        stays one's own.
        """
        mine, member = self.own(part), self.member(part)
        team = [one.name for one in self.settings.team if one is not member]
        names = self.others(part) if member is None else team
        theirs = np.concatenate([_NO_PLANTS, *(self.kept(one) for one in names)])
        mine &= ~np.isin(self.aisle, self.aisle[theirs])
        mine[self.given(part)] = True
        return mine

    def is_others(self, part: WorkPart, left: Plants) -> bool:
        """Return whether a route was made for other rows, or others who share them have of it."""
        if self.member(part) is not None:
            return False
        if not self.own(part)[left].all():
            return True
        return any(np.isin(left, self.kept(one)).any() for one in self.others(part))

    def asked_of(self, part: WorkPart) -> tuple[AskedPhoto, ...]:
        """Return the photos asked for that are somebody's to take: none is taken by two.

        Those in a part's rows; of several who share them those on one's own route, and the first
        one's where they are on nobody's.
        """
        mine, team = self.own(part), [one.name for one in self.settings.team]
        mine[list(self.wished.wishes.unwanted)] = False
        names = self.crew(part) if self.member(part) is None else team
        if part.name and len(names) > 1:
            if person_key(part.name) != person_key(names[0]):
                mine &= np.isin(np.arange(len(mine)), self.kept(part.name))
            for one in names:
                if person_key(one) != person_key(part.name):
                    mine[self.kept(one)] = False
        return tuple(one for one in self.asked if mine[one.plant])

    def wishes(self, part: WorkPart) -> Wishes:
        """Return what is wanted of a part, the plants to be photographed among it."""
        mine, of_day = self.own(part), self.wished.wishes
        wanted = {*of_day.wanted, *(one.plant for one in self.asked)} - {*of_day.unwanted}
        return Wishes(tuple(sorted(k for k in wanted if mine[k])), of_day.unwanted)

    def is_unlike_wishes(self, part: WorkPart, left: Plants, done: Plants) -> bool:
        """Return whether what is `left` of a part's route is not as it is wished.

        It leads to what is not wanted, or what is wanted came after it and is on nobody's way.
        """
        if np.isin(left, self.wished.wishes.unwanted).any():
            return True
        kept = self.last.get(person_key(self.kept_as(part)))
        if self.member(part) is not None or kept is None or kept.number > self.wished.since:
            return False
        mine = self.own(part)
        wanted = [plant for plant in self.wished.wishes.wanted if mine[plant]]
        ways = [self.route(part), *(self.kept(one) for one in self.others(part)), done]
        return not np.isin(wanted, np.concatenate(ways)).all()

    def _lines(self, rows: tuple[int, int] | None) -> tuple[int, int]:
        return rows or (int(self.plant_numbers.line.min()), int(self.plant_numbers.line.max()))


def plan_ahead(
    season: Season, on: date, part: WorkPart = WHOLE, *, wishes: Wishes | None = None,
    keep: bool = False, anew: bool = False,
) -> DayPlan:  # fmt: skip
    """Return what is left of the season's own day, or of that of one of its team, as of now.

    App, command, report and phone ask here: they say the same route and the same hours. It is
    what `planned` says, `by_the_clock`.
    """
    plan = planned(season, on, part, wishes=wishes, keep=keep, anew=anew)
    return by_the_clock(season, on, part, plan)


def planned(
    season: Season, on: date, part: WorkPart = WHOLE, *, wishes: Wishes | None = None,
    keep: bool = False, anew: bool = False,
) -> DayPlan:  # fmt: skip
    """Return what is left of a day after the last inspection, planned with all that is known.

    As long as nothing was found or changed since its route was given out, it is what is left of
    that one, unless it is to be planned `anew`. `keep`: whether it is kept as given out.
    """
    ahead = DayAhead.of(season, on)
    if not anew and ahead.is_seasons(part):
        given = _given_last(season, on, ahead, ahead.wished.wishes if wishes is None else wishes)
        if given is not None:
            return given
    who = None if ahead.member(part) is None else part.name
    return season.plan(on, keep=keep, wishes=wishes, who=who)


def by_the_clock(season: Season, on: date, part: WorkPart, plan: DayPlan) -> DayPlan:
    """Return a plan as of now where its hours run: what no longer fits them is left out at its end.

    Where they do not run, it is the same.
    """
    hours = work_hours(season, on, part)
    if not hours.run:
        return plan
    scene = replace(plan.scene, seconds_left=min(hours.left_s, plan.scene.seconds_left))
    fit, notes = _fitting(scene, plan.route.plant, scene.seconds_left), plan.route.notes
    if len(fit.route) == len(plan.route):
        fit = replace(plan, scene=scene)
    if notes is None:
        return fit
    notes = replace(notes, start=kept_routes.begins(season.planned_by(on), fit, hours.begins_s))
    return replace(fit, route=replace(fit.route, notes=notes))


def _given_last(season: Season, on: date, ahead: DayAhead, wishes: Wishes) -> DayPlan | None:
    """Return what is left of the season's own route; None: there is none that holds still.

    None holds that leads to plants that are closed by now, or not where it is wished.
    """
    if not kept_routes.is_last(ahead.last):
        return None
    with season.store.reading() as db:
        if not logged_days.holds_still(db, on, ahead.last[""].digest):
            return None
    with season.entering_treated():
        scene = season.scene(on)
    plants = ahead.kept()
    left = plants[scene.are_open(plants)]
    closed = closed_plants(kept_routes.closed_to_kept(season, on), len(scene.chance))
    done = season.history.on(ahead.settings.day(on)).plant
    if not np.isin(wishes.wanted, np.append(plants, done)).all():
        return None
    if not len(left) or closed[left].any() or np.isin(wishes.unwanted, left).any():
        return None
    begins, work = ahead.last[""].begins, season.work(on)
    if len(work.inspections):  # a second more or less is no stop less
        given = _fitting(scene, left, scene.seconds_left + 1.0)
        begins = kept_routes.begins(season.planned_by(on), given, work.begun_s)
    else:
        given = through(scene, left)
    notes = RouteNotes(season.plot.field.name, ahead.settings.sampler, begins)
    return replace(given, route=replace(given.route, notes=notes))


def route_ahead(season: Season, on: date, part: WorkPart = WHOLE) -> Route:
    """Return what is left of a day's route for whoever leaves now; it is kept as given out.

    Who works alone on the plot has the season's own, see `plan_ahead`. Somebody of the team has a
    route of their own, and so has whoever has rows, or shares them, see `DayAhead.crew`: what is
    left of the one given out, from where that person inspected last, or from the gate. What no
    longer fits the hours that run is left out at its end. One that leads to plants that are closed
    is planned again.
    """
    ahead = DayAhead.of(season, on)
    if ahead.is_seasons(part):
        return plan_ahead(season, on, part, wishes=ahead.wishes(part), keep=True).route
    with season.entering_treated():
        scene = season.scene(on, who=ahead.works_as(part))
    to_kept = kept_routes.closed_to_kept(season, on, part.name, ahead.kept_as(part))
    closed = closed_plants(to_kept, len(scene.chance))
    kept = ahead.route(part)
    kept = kept[scene.are_open(kept)]
    left = kept[ahead.own(part)[kept]]
    is_others = bool(part.name) and ahead.is_others(part, kept)
    done = season.history.on(ahead.settings.day(on)).plant
    if not len(left) or closed[left].any() or is_others:
        return planned_again(season, on, part)
    if ahead.is_unlike_wishes(part, left, done):
        return planned_again(season, on, part)
    hours = work_hours(season, on, part)
    fits = _fitting(scene, left, hours.left_s) if hours.run else through(scene, left)
    return fits.route


def planned_again(
    season: Season, on: date, part: WorkPart = WHOLE, seconds_left: float | None = None
) -> Route:
    """Plan what is left of a day with all that is known now, by the plants to be photographed.

    It is kept as the route given out, unless it is a part of the plot and nobody's own.
    `seconds_left`: as told by whose part it is, no more than the season says; None: what
    `work_hours` says.
    """
    ahead = DayAhead.of(season, on)
    own, member = ahead.own(part), ahead.member(part)
    if part.rows is not None and member is None:
        for one in ahead.settings.team:
            own[ahead.kept(one.name)] = False
    wishes = ahead.wishes(part).never(tuple(np.flatnonzero(~own).tolist()))
    if part.name and member is None and not ahead.is_seasons(part):
        crew = ahead.crew(part)
        (me,) = {*crew} - {*ahead.others(part)}
        said = {} if seconds_left is None else {me: seconds_left}
        told = said | {
            one: work_hours(season, on, WorkPart(part.rows, one)).left_s
            for one in {*crew} - {*said}
        }
        named = (ahead.kept_as(part),) if len(crew) == 1 else None
        days = season.plan_each(on, wishes=wishes, crew=ScoutCrew(crew, told, named))
        return days[crew.index(me)].route
    who, hours = None if member is None else member.name, work_hours(season, on, part)
    left_s = hours.left_s if seconds_left is None else min(seconds_left, hours.left_s)
    is_told = hours.left_s - left_s > BEGINS_OTHERWISE_S  # a phone counts a little otherwise
    now = _time(season, on, left_s, member) if is_told or hours.run else None
    return season.plan(on, now, keep=ahead.rows(part) is None, wishes=wishes, who=who).route


def work_hours(season: Season, on: date, part: WorkPart = WHOLE) -> WorkHours:
    """Return somebody's hours on a day; those of who works alone are everybody's."""
    who = DayAhead.of(season, on).works_as(part)
    work, now = season.work(on, who), local_clock(season.plot.field).now()
    second = work.inspections.second
    run = now.date() == on and len(second) > 0 and bool(np.isfinite(second[0]))
    return WorkHours(work.begun_s, run, work.left_s(now.time() if run else None))


def _time(season: Season, on: date, seconds_left: float, member: TeamMember | None) -> time:
    """Return the local time at which so much of the working day is left."""
    robot, who = (season.settings.robot, "") if member is None else (member.robot, member.name)
    left_s = min(max(seconds_left, 0.0), robot.day_s)
    clock = grid_clock(season.plot.grid)
    now_s = clock.second_after(on, season.work(on, who).begun_s, robot.day_s - left_s)
    return (datetime.combine(on, MIDNIGHT) + timedelta(seconds=round(now_s))).time()


def _fitting(scene: Scene, plants: Plants, left_s: float) -> DayPlan:
    """Return a day of as many of the plants as fit with the way back."""
    plan, robot = through(scene, plants), scene.robot
    route = plan.route
    if route.end_s <= left_s:
        return plan
    back = [np.array([plant, GATE]) for plant in plants] if robot.returns else []
    back_s = np.array([driven_s(scene.aisles.travel, scene.clock, leg) for leg in back] or 0.0)
    fit = np.flatnonzero(route.leave_s + back_s <= left_s)
    return through(scene, plants[: fit[-1] + 1 if len(fit) else 0])


def through(scene: Scene, plants: Plants) -> DayPlan:
    """Return a day of plants in their order, from where the scene stands."""
    robot = scene.robot
    places = np.concatenate([[scene.at], plants, [GATE] if robot.returns else []]).astype(np.int64)
    legs = [places[k : k + 2] for k in range(len(places) - 1)]
    drive_s = np.array([driven_s(scene.aisles.travel, scene.clock, leg) for leg in legs])
    k = len(plants)
    arrive_s = np.cumsum(drive_s[:k] + robot.visit_s) - robot.visit_s
    work = Workday(
        plant=plants,
        arrive_s=arrive_s,
        found=np.zeros(k, np.bool_),
        stop_s=np.full(k, robot.visit_s),
        detects=np.full(k, robot.detects),
        end_s=float(arrive_s[-1] + robot.visit_s + drive_s[k:].sum()) if k else 0.0,
    )
    return DayPlan(scene, work, route_of(scene, work))
