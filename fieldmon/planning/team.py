"""A day for several robots and scouts: each aisle is one's own, and nobody meets in one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date, datetime, timedelta
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.array_arguments import chances_of
from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import counted, worded
from fieldmon.errors import SettingError
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.planning.bound_wording import bound_sentence, sound_bound
from fieldmon.planning.headlands import HeadOn, head_on
from fieldmon.planning.meetings import Meeting, meetings
from fieldmon.planning.members import must_differ, refuse_far_gates, refuse_too_wide
from fieldmon.planning.plan import DayPlan, starts_at
from fieldmon.planning.route import route_of
from fieldmon.planning.routes import best
from fieldmon.planning.sections import sections_of
from fieldmon.planning.team_bound import PRICES, MemberTask, team_bound
from fieldmon.planning.workday import Workday
from fieldmon.plot.travel import GATE, travel_s
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.compute.array_arguments import Column
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.route import Route
    from fieldmon.plot.plot import Plot

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# who must wait starts so much later than the other leaves
_PAUSE_S = 1.0
# and so much later where two would meet in a headland
_LATER_S = 20.0
# each route is looked for again so often in what the others leave, and so often where they meet
_ROUNDS, _TRIES = 2, 3
# who chose the plants, in files
_BEST_ROUTES = "best routes"


@checked
@dataclass(frozen=True, eq=False)
class TeamPlan:
    """A planned day of a team.

    Parameters
    ----------
    members
        Who works, in the order of `days`.
    days
        A day each; its seconds count from the member's own start.
    late_s
        ``(m,)`` seconds that each begins later than its start, so that nobody is met in an aisle.
    bound
        No routes of these members and hours can expect more finds together.
    passing_m
        Metres of headland that two need to pass each other; 0: they pass anywhere.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    >>> chance = fm.plan_day(plot, on="2026-11-18").chance
    >>> team = fm.plan_team(plot, chance, fm.team_of(2, fm.Robot(hours=0.5)))
    >>> ann, ben = team.routes
    >>> set(ann.plant.tolist()) & set(ben.plant.tolist())
    set()
    >>> team.sentence.startswith("3.5 finds expected; no routes of these hours can expect more th")
    True
    """

    members: tuple[TeamMember, ...]
    days: tuple[DayPlan, ...]
    late_s: Float
    bound: float
    passing_m: float = 0.0

    def __repr__(self) -> str:
        stops = sum(len(day.route) for day in self.days)
        return f"<TeamPlan: {counted(len(self.days), 'member')}, {counted(stops, 'stop')}>"

    @property
    def routes(self) -> tuple[Route, ...]:
        """Return the route of each member; `Route.to_file` writes who drives it and from when."""
        return tuple(day.route for day in self.days)

    @property
    def starts_s(self) -> Float:
        """Return when each begins, ``(m,)`` seconds after the team's day does."""
        return self.late_s + [member.starts_s for member in self.members]

    @property
    def expected_finds(self) -> float:
        """Return the infested plants that would be found, as believed."""
        return sum(day.route.expected_finds for day in self.days)

    @property
    def sentence(self) -> str:
        """Return for people what is expected, and what no other routes can exceed."""
        return bound_sentence(self.expected_finds, self.bound, routes="routes")

    def meetings(self) -> list[Meeting]:
        """Return where two are in one aisle at once: nowhere, if the plan is right."""
        return meetings(self.routes, self.starts_s)

    def head_on(self) -> list[HeadOn]:
        """Return where two meet head-on in a headland too narrow to pass: nowhere, likewise."""
        return head_on(self.routes, self.starts_s, self.passing_m)


@checked
def plan_team(
    plot: Plot,
    chance: Column,
    members: Sequence[TeamMember],
    *,
    on: str | date | datetime | np.datetime64 | None = None,
    passing_m: float = 0.0,
    progress: Callable[[int, int], None] | None = None,
) -> TeamPlan:
    """Plan a day of a team: no plant twice, and no two in one aisle at once.

    Routes are those of `fieldmon.planning.routes.best`: no find changes them. `Season.plan_each`
    plans what is left of a day for the team of a season, in which one's finds count for all.

    Parameters
    ----------
    plot
        Plants and the ways between them.
    chance
        ``(n,)`` believed chance of infestation, in 0..1, for instance `DayPlan.chance`.
    members
        Who works, robots and scouts: `team_of` returns several of one kind.
    on
        The day, or when work starts on it, as `plan_day` takes it: routes say when each begins.
    passing_m
        Metres of headland that two need to pass each other: where it is narrower nobody meets
        another head-on, but begins later. 0: they pass each other anywhere.
    progress
        Told how many routes were looked for and prices of plants tried for the bound, and of how
        many.

    Returns
    -------
    TeamPlan
        The days and routes of the members, in their order, and the bound.

    Raises
    ------
    SettingError
        If two members share a name, there are none, a gate is too far away, no route of any of
        them fits its hours, or `chance` does not fit the plants.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    >>> chance = fm.plan_day(plot, on="2026-11-18").chance
    >>> robot = fm.TeamMember("robot", fm.Robot(hours=1))
    >>> members = fm.TeamMember("Ann", fm.scout().with_hours(1)), robot
    >>> team = fm.plan_team(plot, chance, members, on="2026-11-18 05:30")
    >>> len(team.routes), team.meetings(), team.expected_finds <= team.bound
    (2, [], True)
    >>> [f"{route.notes.who} {route.notes.start:%H:%M}" for route in team.routes]
    ['Ann 05:30', 'robot 05:30']
    """
    must_differ([one.name for one in members])
    refuse_far_gates(members, plot.field)
    refuse_too_wide(members, plot)
    chance, begins = chances_of(chance, plot.n_plants), starts_at(on, plot)
    _must_be_a_width(passing_m)
    tasks = _tasks_of(plot, chance, members)
    search = _StopSearch(plot, tasks, progress or (lambda _done, _of: None))
    timed = max(
        (_kept_apart(tasks, days, passing_m) for days in search.ways_to_share()),
        key=lambda each: _expected(each.days),
    )
    if not _expected(timed.days):
        raise _nothing_in_reach(chance)
    starts_s = timed.late_s + [one.starts_s for one in members]
    days = tuple(
        _handed_out(
            day,
            chance,
            RouteNotes(
                plot.field.name,
                _BEST_ROUTES,
                begins + timedelta(seconds=round(float(s))),
                member.name,
            ),
        )
        for member, day, s in zip(members, timed.days, starts_s, strict=True)
    )
    held = _expected(days)
    most = sound_bound(held, team_bound(tasks, held, search.proving))
    search.proving(PRICES)  # it may have ended sooner
    return TeamPlan(tuple(members), days, timed.late_s, most, passing_m)


def _must_be_a_width(passing_m: float) -> None:
    if not 0.0 <= passing_m < np.inf:
        raise SettingError(
            worded(
                "Two must need 0 m or more to pass, but passing_m is {passing_m}.",
                passing_m=passing_m,
            )
        )


def _tasks_of(plot: Plot, chance: Float, members: Sequence[TeamMember]) -> list[MemberTask]:
    """Return what each member looks for: from its own gate, as well as it finds, and when."""
    return [
        MemberTask(
            plot.aisles if one.gate is None else plot.with_gate(one.gate).aisles,
            one.robot,
            chance * one.robot.detects,
            one.starts_s,
        )
        for one in members
    ]


def _nothing_in_reach(chance: Float) -> SettingError:
    """Return why no member's day holds anything: no chances, or no time."""
    if not chance.any():
        return SettingError(
            worded(
                "Some plant must have a chance of infestation above 0, but none has: there is "
                "nothing to look for. Give chances as of a chance map."
            )
        )
    return SettingError(
        worded(
            "The hours of some member must be long enough to reach a plant and come back, "
            "but none are. Give more hours."
        )
    )


def _handed_out(day: DayPlan, chance: Float, notes: RouteNotes) -> DayPlan:
    """Return a day with the chances as they were given, and with what its route says beside."""
    scene = replace(day.scene, chance=chance)
    return replace(day, scene=scene, route=replace(route_of(scene, day.work), notes=notes))


def _expected(days: Sequence[DayPlan]) -> float:
    return float(sum(day.route.expected_finds for day in days))


def bound_of_days(days: Sequence[DayPlan]) -> str:
    """Return for people what a team's days expect, and what no other routes can exceed.

    Empty where a day began already: bounds are of whole days from the gate.
    """
    whole = all(
        day.scene.at == GATE and day.scene.seconds_left == day.scene.robot.day_s for day in days
    )
    if not whole:
        return ""
    tasks = [_task_of(day.scene) for day in days]
    held = _expected(days)
    return bound_sentence(held, sound_bound(held, team_bound(tasks, held)), routes="routes")


def _task_of(scene: Scene) -> MemberTask:
    open_ = np.where(scene.last_inspected == scene.day, 0.0, scene.chance)
    return MemberTask(scene.aisles, scene.robot, open_ * scene.robot.detects)


class _StopSearch:
    """Looks for the stops of each of a team's tasks, given those of the others."""

    def __init__(
        self, plot: Plot, tasks: Sequence[MemberTask], progress: Callable[[int, int], None]
    ) -> None:
        self.plot, self.tasks, self.progress = plot, tasks, progress
        self.aisle = plot.grid.corridor[plot.grid.row]
        self.looked, self.expected = 0, len(tasks) * (3 + _ROUNDS)

    def look(self, k: int, free: NDArray[np.bool_], known: Int | None = None) -> Int:
        """Return the best stops of a task among the free plants, no worse than those known."""
        task, others = self.tasks[k], () if known is None else (known,)
        found = best(task.aisles, np.where(free, task.value, 0.0), task.robot, others=others)
        self.looked += 1
        self.progress(self.looked, max(self.expected, self.looked) + PRICES)
        return found.plant.astype(np.int64)

    def proving(self, prices: int) -> None:
        """Tell how far the bound is, which is looked for after all routes."""
        self.progress(self.looked + prices, self.looked + PRICES)

    def ways_to_share(self) -> list[list[DayPlan]]:
        """Return three ways to share the plot, a day of each task in each; any may be the best."""
        in_turn = self.in_turn()
        exclusive = self.aisle_by_aisle(in_turn)
        shared = self.apart(self.plant_by_plant(exclusive))
        return [self.turned(stops) for stops in (in_turn, exclusive, shared)]

    def in_turn(self) -> list[Int]:
        """Return stops for each task, the best in the aisles that those before it leave.

        The first has the plot to itself, and waits for nobody: a team finds no less than it alone.
        """
        free, found = np.ones(len(self.aisle), np.bool_), []
        for k in range(len(self.tasks)):
            found.append(self.look(k, free))
            free &= ~np.isin(self.aisle, self.aisle[found[-1]])
        return found

    def aisle_by_aisle(self, in_turn: Sequence[Int]) -> list[Int]:
        """Return stops for each task; each aisle is visited by one only.

        Aisles are given out in sections beside each other, too. From whichever is better each looks
        once more in what the others leave.
        """
        section = _sections(self.plot, self.tasks, in_turn)
        beside = [self.look(k, section == k) for k in range(len(self.tasks))]
        chosen = [*max(in_turn, beside, key=lambda each: _held(self.tasks, each))]
        for k in range(len(self.tasks)):
            others = [self.aisle[own] for own in (*chosen[:k], *chosen[k + 1 :])]
            taken = np.isin(self.aisle, np.concatenate([self.aisle[:0], *others]))
            chosen[k] = self._better(k, ~taken, chosen[k])
        return chosen

    def plant_by_plant(self, known: Sequence[Int]) -> list[Int]:
        """Return stops for each task, from those known; an aisle may be visited by several."""
        chosen = [*known]
        for _ in range(_ROUNDS if len(chosen) > 1 else 0):
            for k in range(len(chosen)):
                chosen[k] = self._better(k, self._untaken(chosen, k), chosen[k])
        return chosen

    def apart(self, known: Sequence[Int]) -> list[Int]:
        """Return stops of which few are where two would meet: the poorer looks elsewhere."""
        chosen, banned = [*known], [np.zeros(len(self.aisle), np.bool_) for _ in known]
        for _ in range(_TRIES * len(chosen)):
            days = self.turned(chosen)
            met = meetings([day.route for day in days], self._starts_s)
            if not met:
                break
            there = self.aisle == met[0].aisle
            k = min(met[0].who, key=lambda who: _of(self.tasks[who], chosen[who], there))
            banned[k] |= there
            free = self._untaken(chosen, k) & ~banned[k]
            chosen[k] = self.look(k, free, chosen[k][free[chosen[k]]])
        return chosen

    def turned(self, chosen: Sequence[Int]) -> list[DayPlan]:
        """Return a day of each task's stops, driven the way round on which fewer are met."""
        days: list[DayPlan] = []
        for task, stops in zip(self.tasks, chosen, strict=True):
            ways = [_day(task, stops)]
            if task.robot.returns and days:
                ways.append(_day(task, stops[::-1]))
            starts_s = self._starts_s[: len(days) + 1]
            days.append(min(ways, key=lambda day: _met_s([*days, day], starts_s)))
        return days

    @property
    def _starts_s(self) -> Float:
        return np.array([task.starts_s for task in self.tasks])

    def _better(self, k: int, free: NDArray[np.bool_], known: Int) -> Int:
        again = self.look(k, free, known)
        value = self.tasks[k].value
        return again if value[again].sum() > value[known].sum() else known

    def _untaken(self, chosen: Sequence[Int], k: int) -> NDArray[np.bool_]:
        free = np.ones(len(self.aisle), np.bool_)
        for j, own in enumerate(chosen):
            if j != k:
                free[own] = False
        return free


def _met_s(days: Sequence[DayPlan], starts_s: Float) -> float:
    met = meetings([day.route for day in days], starts_s)
    return sum(each.until_s - each.since_s for each in met)


def _of(task: MemberTask, stops: Int, there: NDArray[np.bool_]) -> float:
    """Return what a task's stops hold in an aisle."""
    return float(task.value[stops[there[stops]]].sum())


def _held(tasks: Sequence[MemberTask], stops: Sequence[Int]) -> float:
    return float(sum(task.value[own].sum() for task, own in zip(tasks, stops, strict=True)))


def _sections(plot: Plot, tasks: Sequence[MemberTask], known: Sequence[Int]) -> Int:
    """Return for each plant whose section it is in: aisles in order, with like work in each."""
    corridor = plot.grid.corridor[plot.grid.row]
    work = np.full(len(corridor), 1e-9)
    for task, own in zip(tasks, known, strict=True):
        work[own] += task.robot.visit_s
    shares = np.array([task.robot.day_s for task in tasks])
    return sections_of(plot.grid, np.bincount(corridor, work).astype(np.float64), shares)[corridor]


def _day(task: MemberTask, stops: Int) -> DayPlan:
    """Return a member's day: its work and route, in a scene whose chances are its own values."""
    robot, n = task.robot, len(task.value)
    believed = task.value / max(robot.detects, 1e-9)
    never = np.full(n, NEVER, np.int32)
    scene = Scene(task.aisles, robot, believed, never, seconds_left=robot.day_s)
    places = [GATE, *stops.tolist()]
    travel, clock = scene.aisles.travel, scene.clock
    way_s = np.array([travel_s(travel, clock, a, b) for a, b in pairwise(places)])
    visit_s = np.full(len(stops), robot.visit_s)
    leave_s = np.cumsum(way_s + visit_s)
    end_s = float(leave_s[-1]) if len(stops) else 0.0
    if robot.returns and len(stops):
        end_s += travel_s(travel, clock, places[-1], GATE)
    work = Workday(
        stops.astype(np.int32),
        leave_s - visit_s,
        np.zeros(len(stops), np.bool_),
        visit_s,
        np.full(len(stops), robot.detects),
        end_s,
    )
    return DayPlan(scene, work, route_of(scene, work))


class _DaysInTurn(NamedTuple):
    """Days, and the seconds ``(m,)`` that each begins later than its start."""

    days: list[DayPlan]
    late_s: Float


def _kept_apart(
    tasks: Sequence[MemberTask], days: Sequence[DayPlan], passing_m: float
) -> _DaysInTurn:
    """Let whoever would still meet another begin later, with fewer stops if need be."""
    kept, late_s = [*days], np.zeros(len(days))
    own_s = np.array([task.starts_s for task in tasks])
    while (wait := _first_wait(kept, own_s + late_s, passing_m)) is not None:
        k, seconds = wait
        late_s[k] += seconds
        kept[k] = _shortened(tasks[k], kept[k], tasks[k].robot.day_s - float(late_s[k]))
    return _DaysInTurn(kept, late_s)


def _first_wait(
    days: Sequence[DayPlan], starts_s: Float, passing_m: float
) -> tuple[int, float] | None:
    """Return who must begin later, and by how much; None: nobody meets another.

    Of two the later in the team waits: the first keeps its day.
    """
    driven = [day.route for day in days]
    if met := meetings(driven, starts_s):
        return max(met[0].who), met[0].until_s - met[0].since_s + _PAUSE_S
    if passing_m and (met_head_on := head_on(driven, starts_s, passing_m)):
        return max(met_head_on[0].who), _LATER_S
    return None


def _shortened(task: MemberTask, day: DayPlan, seconds: float) -> DayPlan:
    """Return a day without its poorest stops until it fits."""
    while len(day.work) and day.work.end_s > seconds:
        stops = day.work.plant.astype(np.int64)
        day = _day(task, np.delete(stops, int(np.argmin(task.value[stops]))))
    return day
