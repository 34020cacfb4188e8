"""`fieldmon share`: one day on the seasons that are due, for all who work. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import (
    assumed_in_words,
    tell_assumed_of_plots,
    tell_drafts,
)
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.options import MoveMinutes, StartTime, WorkDate
from fieldmon.cli.outputs import write_route
from fieldmon.cli.progress import progress
from fieldmon.cli.season_files import opened
from fieldmon.cli.team_files import members_of, tell_member
from fieldmon.cli.times import clock, day, day_on
from fieldmon.cli.worker_options import Robots, WorkerOptions
from fieldmon.compute.wording import counted
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from datetime import date, time

    from fieldmon.monitoring import Season
    from fieldmon.monitoring.days.estate_day import EstatePlot, EstateTurn
    from fieldmon.monitoring.days.estate_routes import EstateRoutes, NamedPlot, PlotLeftOut
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.plan import DayPlan

Seasons = Annotated[
    list[Path], typer.Argument(help="Season files, made by fieldmon init; a plot each.")
]
Folder = Annotated[
    Path | None,
    typer.Option(
        "--output", "-o", help="Folder of routes and plan.csv; without it day-YYYY-MM-DD."
    ),
]
Formats = Annotated[
    list[str] | None,
    typer.Option(
        "--format",
        help="Format of the routes, as often as wanted: geojson, gpx, csv, sheet, nav2 and so on.",
    ),
]
Also = Annotated[
    bool, typer.Option("--all", help="Also plots that were inspected less than three days ago.")
]


@dataclass(frozen=True)
class ShareOptions:
    """What `fieldmon share` is told."""

    seasons: Seasons
    output: Folder = None
    formats: Formats = None
    on: WorkDate = None
    start: StartTime = "06:00"
    robots: Robots = None
    move: MoveMinutes = 15.0
    not_due: Also = False
    worker: WorkerOptions = field(default_factory=WorkerOptions)


@with_options
def share(options: ShareOptions) -> None:
    """Share one day between the seasons that are due: who inspects which plot, when and where.

    A plot is due three days after it was inspected, and where it never was; where none is due, none
    is planned without --all. The plot with the most
    infested plants expected comes first; hours are shared by what is expected. A plot that would
    get less than a quarter of an hour waits. The seasons are not changed.

    Their robot works where nobody else is told, and the routes go into a new folder.

    Example: fieldmon share gate.gpkg hill.gpkg nursery.gpkg --robots 2 --hours 6 -o monday
    Example: fieldmon share *.gpkg --robots crew.csv --format geojson --format gpx
    """
    endings = _endings(options.formats or ["geojson"])
    seasons = opened(options.seasons)
    due, left_out = _due(seasons, day(options.on), every=options.not_due)
    for one in left_out:
        _tell_left_out(one)
    if not due:
        raise SettingError(
            "At least one season must have begun and be due, so inspected three days ago or never, "
            "but none is. Plan those seen since with --all, or another day with --date."
        )
    folder = options.output or Path(f"day-{min(plot.on for _, plot in due)}")
    _require_empty(folder)
    members, starts = _members(options, [season for season, _ in due])
    plots = [_named(season, plot) for season, plot in due]
    made = _planned(plots, members, starts, 60.0 * options.move)
    for one in made.left_out:
        _tell_left_out(one)
    made = replace(made, left_out=(*made.left_out, *left_out))
    if len(due) > 1:
        move = f"{options.move:g} minute{'' if options.move == 1 else 's'}"
        typer.echo(f"From plot to plot takes {move}, wherever they lie (--move).")
    tell_assumed_of_plots({_name(season): _assumed(season, members) for season, _ in due})
    if not made.turns:
        raise SettingError(
            "Somebody must be able to inspect a plot within the hours, but nobody is: the plots "
            "are closed, as said above, or the hours are too short."
        )
    _write(folder, plots, made, endings)


def _require_empty(folder: Path) -> None:
    """Refuse a folder that holds anything: an earlier day's routes may be filled in."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise SettingError(
            f"The routes must go into a new or empty folder, but {folder} holds something. Choose "
            "another one with --output, or move away what it holds."
        )


def _members(
    options: ShareOptions, seasons: Sequence[Season]
) -> tuple[tuple[TeamMember, ...], time]:
    """Return who works, and when the first of them starts: the seasons' robot, if not told."""
    from fieldmon.monitoring.days.estate_day import one_robot, robots_of

    worker, told = options.worker, options.robots or "1"
    robot = None if worker.scout or worker.rover else one_robot(seasons)
    if robot is not None:
        robot = worker.said_of(robot)
    elif told.isdecimal() and not (worker.scout or worker.rover):
        crews = "; ".join(f"{_name(season)}: {_crew(season)}" for season in seasons)
        raise SettingError(
            f"The seasons must work with one robot, but they have several ({crews}). Say who "
            "works: --scout, --rover, or a table with --robots."
        )
    hours = {one.hours for season in seasons for one in robots_of(season)}
    if told.isdecimal() and worker.hours is None and len(hours) > 1:
        listed = " and ".join(f"{one:g}" for one in sorted(hours))
        raise SettingError(
            f"The day must have one length, but the seasons have {listed} h. Say it with --hours."
        )
    members, starts = members_of(told, clock(options.start), worker, robot)
    if fixed := [one.name for one in members if one.gate is not None]:
        raise SettingError(
            "Who works on several plots must start at each plot's own gate, but the table tells "
            f"lon and lat of {', '.join(fixed)}. Leave them out."
        )
    return members, starts


def _crew(season: Season) -> str:
    """Return who works in a season, in a few words."""
    settings = season.settings
    one = "a scout" if settings.robot.on_foot else "a robot"
    return ", ".join(member.name for member in settings.team) or one


def _endings(formats: Sequence[str]) -> list[str]:
    """Return the endings of the formats that are named, by their names or endings."""
    from fieldmon.io.writers.handoff import FORMATS, format_of

    def ending(one: str) -> str:
        if one.lower() in FORMATS or not (bare := one.lower().strip(".")):
            return format_of(Path(), one).endings[0]
        known = {e.strip(".") for chosen in FORMATS.values() for e in chosen.endings}
        return f".{bare}" if bare in known else format_of(Path(), one).endings[0]

    return [*dict.fromkeys(map(ending, formats))]


def _name(season: Season) -> str:
    """Return what a season's plot is called: its file says it apart from others."""
    return season.path.stem


def _due(
    seasons: Sequence[Season], told: date | None, *, every: bool
) -> tuple[list[tuple[Season, EstatePlot]], list[PlotLeftOut]]:
    """Return the seasons that share the day, with their plots; and those that are left out."""
    from fieldmon.monitoring.days.estate_day import EstatePlot, days_since, due, not_begun, not_due
    from fieldmon.monitoring.days.estate_routes import PlotLeftOut

    begun, left_out = [], list[PlotLeftOut]()
    for season in seasons:
        tell_drafts(season.drafts)
        on = day_on(season.plot.field, told)
        if (why := not_begun(season.settings.begins, on)) is not None:
            left_out.append(PlotLeftOut(_name(season), why))
        else:
            begun.append((season, on))
    since = [days_since(season, on) for season, on in begun]
    wanted = range(len(begun)) if every else due(since)
    shared = []
    for k, (season, on) in enumerate(begun):
        if k in wanted:
            shared.append((season, EstatePlot.of(season, on)))
        else:
            left_out.append(PlotLeftOut(_name(season), not_due(since[k] or 0)))
    return shared, left_out


def _tell_left_out(one: PlotLeftOut) -> None:
    typer.echo(f"Left out: {one.plot} ({one.why}).")


def _assumed(season: Season, members: tuple[TeamMember, ...]) -> str:
    return assumed_in_words(season.assumed(replace(season.settings, team=members)))


def _named(season: Season, plot: EstatePlot) -> NamedPlot:
    from fieldmon.monitoring.days.estate_routes import NamedPlot

    return NamedPlot(_name(season), season.settings.sampler, plot)


def _planned(
    plots: Sequence[NamedPlot], members: Sequence[TeamMember], starts: time, move_s: float
) -> EstateRoutes:
    """Return what comes of the day; say the routes, what is left off, and who is free."""
    from fieldmon.monitoring.days.estate_day import share_estate
    from fieldmon.monitoring.days.estate_routes import too_far, walked

    shared = share_estate([one.known for one in plots], members, starts, move_s)
    with progress("Routes", len(shared.turns)) as bar:

        def plan(turn: EstateTurn) -> DayPlan:
            made = turn.plan()
            bar.update(1)
            return made

        made = walked(shared, plots, members, plan)
    for _, one in made.turns:
        tell_member(f"{one.plot}, {one.who}", one.begins, one.route)
    for plot, sentences in zip(plots, made.closed, strict=True):
        for sentence in sentences:
            typer.echo(f"seen: {plot.name}: {sentence}", err=True)
    for sentence in too_far([one for _, one in made.turns], move_s):
        typer.echo(f"seen: {sentence}", err=True)
    if made.free:
        typer.echo(f"Without a plot: {', '.join(made.free)}.")
    return made


def _write(
    folder: Path, plots: Sequence[NamedPlot], made: EstateRoutes, endings: Sequence[str]
) -> None:
    """Write the routes and their table."""
    from fieldmon.io.atomic_write import write_whole
    from fieldmon.monitoring.days.estate_routes import PLAN_TABLE, plan_table, stems

    folder.mkdir(parents=True, exist_ok=True)
    files, routes = {}, [one for _, one in made.turns]
    seasons = {plot.name: plot.known.season for plot in plots}
    kept = {name: season.settings.language for name, season in seasons.items() if season}
    for stem, one in stems(routes).items():
        route = replace(one.route, notes=one.notes)
        of = kept.get(one.plot, "")
        paths = [write_route(route, folder / f"{stem}{end}", of) for end in endings]
        written = [path for some in paths for path in some]
        files[" ".join(dict.fromkeys(path.name for path in written))] = one
    write_whole(folder / PLAN_TABLE, plan_table(files, made.left_out, made.free))
    plants = sum(one.plants for one in routes)
    typer.echo(
        f"{counted(len(routes), 'plot')}, {counted(plants, 'plant')}. Routes and {PLAN_TABLE} in "
        f"{folder}"
    )
