"""One day's plan of all plots that are due: who goes where, when, and what is found as expected."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.errors import FieldmonError
from fieldmon.monitoring.closures import any_closed, left_off_in_words, open_to_people
from fieldmon.planning.members import TeamMember
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.planning.shared_day import PlotNeed, share_day
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.robot import Robot, scout
from fieldmon.samplers import USUAL, sampler

from ..words import texts
from ..words.language import in_words, of_error
from . import (
    assumptions,
    cached,
    chosen_units,
    plot_files,
    plot_source,
    sample_estate,
    seasons_folder,
)
from .chosen_day import STARTS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from datetime import date

    from fieldmon.monitoring import Season
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.shared_day import PlotTurn
    from fieldmon.samplers.base import Sampler, Scene

    from .estate import PlotState

    #: told how many plots are ready, and of how many
    Progress = Callable[[int, int], None]

#: a plot is due so many days after it was seen
DUE_DAYS = 3


@dataclass(frozen=True)
class EstateCrew:
    """Who shares the plots, and how long going from one plot to the next takes."""

    robots: int = 1
    robot_hours: float = 12.0
    scouts: int = 0
    scout_hours: float = 8.0
    move_min: float = 15.0

    def members(self) -> tuple[TeamMember, ...]:
        """Return who works, robots first."""
        robot, walker = Robot(hours=self.robot_hours), replace(scout(), hours=self.scout_hours)
        return (
            *(TeamMember(texts.ROBOT_NAMED.format(n=k + 1), robot) for k in range(self.robots)),
            *(TeamMember(texts.SCOUT_NAMED.format(n=k + 1), walker) for k in range(self.scouts)),
        )


@dataclass(frozen=True, eq=False)
class PlannedTurn:
    """A plot of the day's plan: who works there and from when on, the route, and what is closed."""

    plot: PlotState
    who: str
    number: int
    begins: datetime
    plan: DayPlan
    sampler: str
    closed: tuple[str, ...] = ()
    is_shut: bool = False

    @property
    def ends(self) -> datetime:
        """Return when the route ends."""
        return self.begins + timedelta(seconds=float(self.plan.route.end_s))


@dataclass(frozen=True, eq=False)
class SharedPlots:
    """The plan: its turns, plots for which there is no time, and plots that cannot be planned.

    And what is left off as people may not be there yet.
    """

    turns: tuple[PlannedTurn, ...]
    waiting: tuple[PlotState, ...] = ()
    problems: tuple[str, ...] = ()
    closed: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class _Ready:
    """A plot that can be planned: what is believed of it on its day, and who decides there.

    `key` stands for all of it. Of a `season`, which tells what is closed to people.
    """

    plot: PlotState
    key: str
    on: date
    scene: Scene
    sampler: str
    decides: Sampler
    season: Season | None = None


def due(plots: Iterable[PlotState]) -> list[PlotState]:
    """Return the plots to be planned: those due; if none is, those not seen today."""
    some = [*plots]
    wanted = [one for one in some if one.days_since is None or one.days_since >= DUE_DAYS]
    return wanted or [one for one in some if one.days_since]


def planned(plots: list[PlotState], crew: EstateCrew, progress: Progress) -> SharedPlots:
    """Return the plan of these plots for a crew."""
    ready, problems = [], []
    for k, plot in enumerate(plots):
        progress(k, 2 * len(plots))
        try:
            ready.append(_ready(plot))
        except FieldmonError as error:
            problems.append(f"{texts.isolated(plot.name)}: {of_error(error)}")
    members = crew.members()
    needs = [PlotNeed(float(one.scene.chance.sum()), _whole_s(one.scene, members)) for one in ready]
    shared = share_day(needs, members, 60.0 * crew.move_min)
    turns = []
    for k, turn in enumerate(shared):
        progress(len(plots) + k, 2 * len(plots))
        turns.append(_planned(ready[turn.plot], turn, members[turn.who]))
    worked = [one for one in turns if len(one.plan.route)]
    served = {id(one.plot) for one in turns if len(one.plan.route) or one.is_shut}
    closed = [f"{texts.isolated(one.plot.name)}: {said}" for one in turns for said in one.closed]
    waiting = [one.plot for one in ready if id(one.plot) not in served]
    said = tuple(dict.fromkeys(closed))
    return SharedPlots(tuple(worked), tuple(waiting), tuple(problems), said)


def _planned(ready: _Ready, turn: PlotTurn, member: TeamMember) -> PlannedTurn:
    # to the second, so that the same turn is planned once
    robot = replace(member.robot, hours=max(round(turn.seconds), 1) / 3600)
    begins = datetime.combine(ready.on, STARTS) + timedelta(seconds=round(turn.starts_s))
    season, key, scene, said, shut = ready.season, ready.key, ready.scene, (), np.False_
    if season is not None:
        begins_s = (begins - datetime.combine(ready.on, time())).total_seconds()
        closed = season.closed_between(ready.on, begins_s, begins_s + robot.day_s)
        shut = any_closed(closed, len(scene.chance))
        key = f"{key} {digest(shut)}"
        scene = open_to_people(scene, closed)
        units = chosen_units.units().in_sentences(ready.on)
        said = tuple(map(in_words, left_off_in_words(closed, (scene.grid, season.label), units)))
    plan = cached.turn_plan(key, robot, scene, ready.decides)
    return PlannedTurn(
        ready.plot, member.name, turn.who, begins, plan, ready.sampler, said, bool(shut.all())
    )


def _whole_s(scene: Scene, members: Iterable[TeamMember]) -> float:
    """Return about how long it takes to inspect all plants, for the slowest."""
    grid = scene.grid
    lanes_m = float(np.ptp(grid.lane_x_m, axis=1).sum())
    return max(
        (
            len(grid) * one.robot.visit_s
            + lanes_m / one.robot.speed_m_s
            + grid.n_rows * one.robot.row_change_s
            for one in members
        ),
        default=0.0,
    )


def _ready(plot: PlotState) -> _Ready:
    return _of_files(plot) if plot.number is not None else _of_season(plot)


def _of_season(plot: PlotState) -> _Ready:
    season = cached.season(seasons_folder.path_of(plot.source))
    settings = season.settings
    on = max(local_clock(season.plot.field).today(), settings.begins)
    now = cached.revision_on(season, on)
    key = f"{season.key} {now} {on}"
    scene = cached.season_scene(season.key, now, str(on), season)
    return _Ready(plot, key, on, scene, settings.sampler, settings.decides(), season)


def _of_files(plot: PlotState) -> _Ready:
    is_sample = plot.source == plot_source.SAMPLE
    files = plot_files.of_sample() if is_sample else plot_files.of_session()
    outline = plot_files.outline(files, lambda _file, _fields: plot.number)
    made = plot_files.prepared(files, outline)
    on = sample_estate.LAST_DAY if is_sample else local_clock(made.plot.field).today()
    settings = PlanSettings(Robot(hours=1), sampler(USUAL), assumptions.prior())
    known = made.records, made.risk
    chance = cached.chance_map(made.key, str(on), settings.prior, made.plot, known)
    scene = plan_from(made.plot, chance, settings).scene
    key = f"{made.key} {on} {settings.prior}"
    return _Ready(plot, key, on, scene, USUAL, settings.sampler)
