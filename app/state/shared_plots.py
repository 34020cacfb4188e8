"""One day's plan of all plots that are due: who goes where, when, and what is found as expected."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import count
from typing import TYPE_CHECKING

from fieldmon.compute.digest import digest
from fieldmon.errors import FieldmonError
from fieldmon.monitoring.days import estate_day
from fieldmon.monitoring.days.estate_day import EstatePlot
from fieldmon.monitoring.days.estate_routes import (
    EstateRoute,
    NamedPlot,
    PlotLeftOut,
    too_far,
    walked,
)
from fieldmon.monitoring.merging import other_seasons
from fieldmon.monitoring.merging.other_seasons import SeasonGround
from fieldmon.monitoring.treating.closures import closed_plants
from fieldmon.planning.members import TeamMember
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.robot import Robot, scout
from fieldmon.samplers import USUAL_SAMPLER, sampler

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

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.days.estate_day import EstateTurn
    from fieldmon.planning.plan import DayPlan

    from .estate import PlotState

    #: told how many plots are ready, and of how many
    Progress = Callable[[int, int], object]


@dataclass(frozen=True)
class EstateCrew:
    """Who shares the plots, and how long going from one plot to the next takes."""

    robots: int = 1
    robot_hours: float = 12.0
    scouts: int = 0
    scout_hours: float = 8.0
    move_min: float = 15.0

    def members(self, kind: Robot | None = None) -> tuple[TeamMember, ...]:
        """Return who works, robots first; they are of a `kind`, or None: of the usual ones."""
        usual = {False: Robot(), True: scout()} | ({} if kind is None else {kind.on_foot: kind})
        robot = replace(usual[False], hours=self.robot_hours)
        walker = replace(usual[True], hours=self.scout_hours)
        return (
            *(TeamMember(texts.ROBOT_NAMED.format(n=k + 1), robot) for k in range(self.robots)),
            *(TeamMember(texts.SCOUT_NAMED.format(n=k + 1), walker) for k in range(self.scouts)),
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class PlannedTurn(EstateRoute):
    """A plot of the day's plan: its state, and the number of who works there."""

    state: PlotState
    number: int


@dataclass(frozen=True, eq=False)
class SharedPlots:
    """The plan: its turns, plots to which nobody goes, and plots that cannot be planned.

    And what is left off as people may not be there yet, who has no plot, of how many, whether the
    plots have robots of several kinds, so that the usual one is taken, who works in plots with
    teams of their own, which are not asked, and ways from plot to plot that are too far for their
    minutes.
    """

    turns: tuple[PlannedTurn, ...]
    left_out: tuple[PlotLeftOut, ...] = ()
    problems: tuple[PlotLeftOut, ...] = ()
    closed: tuple[str, ...] = ()
    free: tuple[str, ...] = ()
    n_members: int = 0
    several_kinds: bool = False
    teams: tuple[tuple[str, tuple[str, ...]], ...] = ()
    too_far: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class _Ready:
    """A plot that can be planned, and who decides there; `key` stands for all of it."""

    plot: PlotState
    key: str
    sampler: str
    known: EstatePlot

    def named(self) -> NamedPlot:
        """Return it as it is called here."""
        units = chosen_units.units().in_sentences(self.known.on)
        return NamedPlot(self.plot.name, self.sampler, self.known, units)


def usual_crew(plots: Iterable[PlotState]) -> EstateCrew:
    """Return who works where nobody is told: one of those, with the hours, of all seasons.

    Where they work with both, or there is none, it is a robot; where they have several hours, those
    of `EstateCrew`.
    """
    robots: list[Robot] = []
    for one in plots:
        if one.number is None:
            with suppress(FieldmonError):  # the plan says of it what is wrong
                season = cached.season(seasons_folder.path_of(one.source))
                robots += estate_day.robots_of(season)
    hours = {one.hours for one in robots}
    if robots and all(one.on_foot for one in robots):
        usual = EstateCrew(robots=0, scouts=1)
        return replace(usual, scout_hours=hours.pop()) if len(hours) == 1 else usual
    if len(hours) == 1 and not any(one.on_foot for one in robots):
        return EstateCrew(robot_hours=hours.pop())
    return EstateCrew()


def due(plots: Iterable[PlotState], *, every: bool = False) -> list[PlotState]:
    """Return the plots to be planned: of those that have begun the due ones, or `every` one."""
    some = [one for one in plots if one.waits is None]
    return some if every else [some[k] for k in estate_day.due([one.days_since for one in some])]


def not_due(plots: Iterable[PlotState], wanted: Iterable[PlotState]) -> list[PlotLeftOut]:
    """Return the plots that are not among those `wanted`, and why."""
    planned = {id(one) for one in wanted}
    return [
        PlotLeftOut(one.name, in_words(one.waits or estate_day.not_due(one.days_since or 0)))
        for one in plots
        if id(one) not in planned
    ]


def of_one_plot(names: Iterable[str]) -> tuple[Worded, ...]:
    """Return a sentence on each plot of several seasons here, if one of these is among them."""
    seasons, wanted, own = [], {*names}, []
    for name in seasons_folder.names() if wanted else ():
        with suppress(FieldmonError):  # what cannot be opened is said where it is to be
            season = cached.season(seasons_folder.path_of(name))
            seasons.append(season)
            own += [season] if name in wanted else []
    grounds = [SeasonGround.of(one) for one in own]
    among = [one for one in seasons if any(map(SeasonGround.of(one).is_that_of, grounds))]
    return other_seasons.of_one_plot(among, texts.isolated)


def planned(plots: list[PlotState], crew: EstateCrew, progress: Progress) -> SharedPlots:
    """Return the plan of these plots for a crew."""
    ready, problems = [], []
    for k, plot in enumerate(plots):
        progress(k, 2 * len(plots))
        try:
            ready.append(_ready(plot))
        except FieldmonError as error:
            problems.append(PlotLeftOut(plot.name, of_error(error)))
    known = [one.known for one in ready]
    seasons = [one.season for one in known if one.season is not None]
    # plots of files have the usual robot
    kind = estate_day.one_robot(seasons) if len(seasons) == len(known) else None
    members = crew.members(kind)
    shared = estate_day.share_estate(known, members, STARTS, 60.0 * crew.move_min)
    done = count(len(plots))

    def plan(turn: EstateTurn) -> DayPlan:
        progress(next(done), 2 * len(plots))
        return _plan(ready[turn.plot], turn)

    made = walked(shared, [one.named() for one in ready], members, plan, in_words)
    return SharedPlots(
        tuple(
            PlannedTurn(**vars(route), state=ready[turn.plot].plot, number=turn.who)
            for turn, route in made.turns
        ),
        made.left_out,
        tuple(problems),
        tuple(
            f"{texts.isolated(one.plot.name)}: {sentence}"
            for one, sentences in zip(ready, made.closed, strict=True)
            for sentence in sentences
        ),
        made.free,
        len(members),
        several_kinds=kind is None and bool(seasons),
        teams=tuple(
            (one.plot.name, tuple(member.name for member in one.known.season.settings.team))
            for one in ready
            if one.known.season is not None and one.known.season.settings.team
        ),
        too_far=tuple(
            in_words(one)
            for one in too_far(
                [route for _, route in made.turns], 60.0 * crew.move_min, chosen_units.units()
            )
        ),
    )


def _plan(ready: _Ready, turn: EstateTurn) -> DayPlan:
    closed = closed_plants(turn.closed, len(turn.scene.chance))
    key = f"{ready.key} {digest(closed)}" if closed.any() else ready.key
    return cached.turn_plan(key, turn.scene.robot, turn)


def _ready(plot: PlotState) -> _Ready:
    return _of_season(plot) if plot.number is None else _of_files(plot, plot.number)


def _of_season(plot: PlotState) -> _Ready:
    season = cached.season(seasons_folder.path_of(plot.source))
    settings = season.settings
    on = local_clock(season.plot.field).today()
    now = cached.revision_on(season, on)
    key = f"{season.key} {now} {on}"
    known = cached.estate_plot(season.key, now, str(on), season)
    return _Ready(plot, key, settings.sampler, known)


def _of_files(plot: PlotState, number: int) -> _Ready:
    is_sample = plot.source == plot_source.SAMPLE
    files = plot_files.of_sample() if is_sample else plot_files.brought()
    outline = plot_files.outline(files, lambda _file, _fields: number)
    made = plot_files.prepared(files, outline)
    on = sample_estate.LAST_DAY if is_sample else local_clock(made.plot.field).today()
    settings = PlanSettings(Robot(hours=1), sampler(USUAL_SAMPLER), assumptions.prior())
    known = made.records, made.risk
    chance = cached.chance_map(made.key, str(on), settings.prior, made.plot, known)
    scene = plan_from(made.plot, chance, settings).scene
    key = f"{made.key} {on} {settings.prior}"
    return _Ready(plot, key, USUAL_SAMPLER, EstatePlot(on, scene, settings.sampler))
