"""`fieldmon share`: one day on the seasons that are due, for all who work. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import (
    assumed_in_words,
    tell_assumed_of_plots,
    tell_clock_change,
    tell_drafts,
)
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.options import MoveMinutes, Robots, StartTime, WorkDate, WorkerOptions
from fieldmon.cli.season_files import opened
from fieldmon.cli.team_files import members_of, tell_member
from fieldmon.cli.times import clock, day, day_on
from fieldmon.cli.waiting import progress
from fieldmon.compute.wording import counted
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from datetime import date, time

    from fieldmon.monitoring import Season
    from fieldmon.monitoring.estate_day import EstatePlot
    from fieldmon.monitoring.estate_routes import EstateRoute
    from fieldmon.planning.members import TeamMember

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
    typer.Option("--format", help="Format of the routes, as often as wanted: geojson, gpx, nav2."),
]
Also = Annotated[
    bool, typer.Option("--all", help="Also plots that were inspected in the last three days.")
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

    A plot is due three days after it was inspected, and where it never was. The plot with the most
    infested plants expected comes first; hours are shared by what is expected. A plot that would
    get less than a quarter of an hour waits. The seasons are not changed.

    Example: fieldmon share gate.gpkg hill.gpkg nursery.gpkg --robots 2 --hours 6 -o monday
    Example: fieldmon share *.gpkg --robots crew.csv --format geojson --format gpx
    """
    members, starts = _members(options)
    endings = _endings(options.formats or ["geojson"])
    seasons = opened(options.seasons)
    plots = [*_due(seasons, day(options.on), every=options.not_due)]
    if not plots:
        raise SettingError(
            "At least one season must have begun and be due, but none has and is. Plan those seen "
            "in the last three days with --all, or another day with --date."
        )
    first = min(plot.on for plot in plots)
    _tell_clock_changes(plots, members, starts)
    routes = _planned(plots, members, starts, 60.0 * options.move)
    tell_assumed_of_plots({_name(plot): _assumed(plot, members) for plot in plots})
    if not routes:
        raise SettingError("Somebody must have time to inspect a plot, but nobody has.")
    _write(options.output or Path(f"day-{first}"), routes, endings)


def _members(options: ShareOptions) -> tuple[tuple[TeamMember, ...], time]:
    """Return who works, and when the first of them starts."""
    usual = clock(options.start)
    members, starts = members_of(options.robots or "1", usual, options.worker)
    if fixed := [one.name for one in members if one.gate is not None]:
        raise SettingError(
            "Who works on several plots must start at each plot's own gate, but the table tells "
            f"lon and lat of {', '.join(fixed)}. Leave them out."
        )
    return members, starts


def _endings(formats: Sequence[str]) -> list[str]:
    """Return the endings of the formats that are named."""
    from fieldmon.io.writers.handoff import format_of

    return [format_of(Path(), one).endings[0] for one in dict.fromkeys(formats)]


def _name(plot: EstatePlot) -> str:
    """Return what a plot is called: its season's file says it apart from others."""
    return "" if plot.season is None else plot.season.path.stem


def _due(seasons: Sequence[Season], told: date | None, *, every: bool) -> Iterator[EstatePlot]:
    """Yield the plots to share the day; say which are left out."""
    from fieldmon.monitoring.estate_day import EstatePlot, days_since, due

    begun = []
    for season in seasons:
        tell_drafts(season.drafts)
        on = day_on(season.plot.field, told)
        if on < season.settings.begins:
            typer.echo(
                f"seen: {season.path.stem} begins on {season.settings.begins} and is left out.",
                err=True,
            )
        else:
            begun.append((season, on))
    since = [days_since(season, on) for season, on in begun]
    wanted = range(len(begun)) if every else due(since)
    for k, (season, on) in enumerate(begun):
        if k in wanted:
            yield EstatePlot.of(season, on)
        else:
            days = since[k] or 0
            ago = f"{counted(days, 'day')} ago" if days else "today"
            typer.echo(f"{season.path.stem} was inspected {ago} and is not due.")


def _tell_clock_changes(
    plots: Sequence[EstatePlot], members: Sequence[TeamMember], starts: time
) -> None:
    """Print that clocks change in these hours, if so: once, as the plots of an estate lie near."""
    plot = plots[0]
    if plot.season is not None:
        hours = max(one.starts_s / 3600 + one.robot.hours for one in members)
        tell_clock_change(datetime.combine(plot.on, starts), hours, plot.season.plot.field)


def _assumed(plot: EstatePlot, members: tuple[TeamMember, ...]) -> str:
    if plot.season is None:
        return ""
    return assumed_in_words(plot.season.assumed(replace(plot.season.settings, team=members)))


def _planned(
    plots: Sequence[EstatePlot],
    members: Sequence[TeamMember],
    starts: time,
    move_s: float,
) -> list[EstateRoute]:
    """Return the routes in the order of who works; say what is left off, waits and is free."""
    from fieldmon.compute.units import Units
    from fieldmon.monitoring.closures import left_off_in_words
    from fieldmon.monitoring.estate_day import share_estate
    from fieldmon.monitoring.estate_routes import EstateRoute

    shared = share_estate(plots, members, starts, move_s)
    said = [
        () if one.season is None else
        left_off_in_words(closed, (one.scene.grid, one.season.label), Units())
        for one, closed in zip(plots, shared.closed, strict=True)
    ]  # fmt: skip
    routes, waiting = [], {*shared.waiting}
    with progress("Routes", len(shared.turns)) as bar:
        for turn in shared.turns:
            route, plot = turn.plan().route, plots[turn.plot]
            bar.update(1)
            if not len(route):
                waiting.add(turn.plot)
                continue
            sampler = "" if plot.season is None else plot.season.settings.sampler
            routes.append(
                EstateRoute(
                    _name(plot), members[turn.who].name, turn.begins, route, sampler,
                    [*map(str, said[turn.plot])],
                )
            )  # fmt: skip
    for one in routes:
        tell_member(f"{one.plot}, {one.who}", one.begins, one.route)
    for plot, sentences in zip(plots, said, strict=True):
        for sentence in sentences:
            typer.echo(f"seen: {_name(plot)}: {sentence}", err=True)
    if waiting:
        typer.echo(f"No time for {', '.join(_name(plots[k]) for k in sorted(waiting))}.")
    busy = {one.who for one in routes}
    if free := [one.name for one in members if one.name not in busy]:
        typer.echo(f"Without a plot: {', '.join(free)}.")
    return routes


def _write(folder: Path, routes: Sequence[EstateRoute], endings: Sequence[str]) -> None:
    """Write the routes and their table in place of those of an earlier run."""
    from fieldmon.io.atomic_write import write_whole
    from fieldmon.monitoring.estate_routes import TABLE, files_named, plan_table, stems

    folder.mkdir(parents=True, exist_ok=True)
    table = folder / TABLE
    if table.is_file():
        for file in files_named(table.read_bytes()):
            (folder / Path(file).name).unlink(missing_ok=True)
        table.unlink()
    files = {}
    for stem, one in stems(routes).items():
        route, names = (
            replace(one.route, notes=one.notes),
            [f"{stem}{ending}" for ending in endings],
        )
        made = [path for file in names for path in route.to_file(folder / file)]
        files[" ".join(path.name for path in made)] = one
    write_whole(table, plan_table(files))
    plants = sum(len(one.route) for one in routes)
    typer.echo(
        f"{counted(len(routes), 'plot')}, {counted(plants, 'plant')}. Routes and {TABLE} in "
        f"{folder}"
    )
