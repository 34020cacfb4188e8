"""A season from the command line: plan, record, status, undo, treat. Heavy imports wait."""

from __future__ import annotations

import tempfile
from datetime import date, datetime, time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldmon.cli import rasters
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.readers.reported import FindingsOptions
    from fieldmon.io.writers.geojson import RouteNotes
    from fieldmon.monitoring import Remark, Season, Status
    from fieldmon.planning.route import Route

SeasonFile = Annotated[Path, typer.Argument(help="The season's file, made by fieldmon init.")]
On = Annotated[str | None, typer.Option("--date", help="The day, YYYY-MM-DD; today.")]
UndoChange = Annotated[
    bool, typer.Option("--change", help="Take back the last change of settings instead.")
]
ListBatches = Annotated[
    bool, typer.Option("--batches", help="List what was recorded, with numbers to undo.")
]
ListRows = Annotated[
    bool, typer.Option("--rows", help="List the days since each row was inspected.")
]
TakeDoubtful = Annotated[
    bool, typer.Option("--take-doubtful", help="Take doubtful positions at the nearest plant.")
]
FindingChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--finding-option",
        help="What the files leave open, as NAME=VALUE: zone=Asia/Jerusalem, accuracy_m=3, "
        "columns=count=Milben.",
    ),
]
# what a plan of a season may be told; all else was chosen when it began
_OF_A_PLAN = {"plot", "output", "on", "now", "chance_map"}


def register(app: typer.Typer) -> None:
    """Add the commands of a season."""
    for command in (record, status, undo, treat, change, salvage):
        app.command()(command)


def is_season(path: Path) -> bool:
    """Tell whether a file is a season of fieldmon."""
    from fieldmon.monitoring.transactions import is_season as asked  # noqa: PLC0415

    return asked(path)


def remarks(notes: Iterable[tuple[str, ImportMessage]]) -> list[Remark]:
    """Return what imports had to say, as the season's file keeps it."""
    from fieldmon.monitoring import Remark  # noqa: PLC0415

    return [
        Remark(
            Path(source).name,
            finding.severity.value,
            finding.feature,
            finding.sentence,
            None if finding.remedy is None else finding.remedy.setting,
        )
        for source, finding in notes
    ]


def hand_off(route: Route, notes: RouteNotes, outputs: list[Path] | None) -> None:
    """Write a route in every format asked for, and say where."""
    from fieldmon.io.writers import HandoffPlan, write_handoff  # noqa: PLC0415

    for output in outputs or [Path("route.geojson")]:
        for path in write_handoff(HandoffPlan(route, notes), output):
            typer.echo(f"Route written to {path}")


def plan_season(context: typer.Context, season: Path, outputs: list[Path] | None) -> None:
    """Plan a day of a season, keep the route in its file, and write it for whoever drives."""
    from fieldmon.io.writers.geojson import RouteNotes  # noqa: PLC0415
    from fieldmon.monitoring.routes import begins  # noqa: PLC0415

    told = {
        name
        for name in context.params
        if (source := context.get_parameter_source(name)) is not None
        and source.name == "COMMANDLINE"
    }
    if told - _OF_A_PLAN:
        flags = ", ".join(f"--{name.replace('_', '-')}" for name in sorted(told - _OF_A_PLAN))
        raise SettingError(
            f"A season keeps what was chosen when it began, but {flags} was given too. "
            "Leave it away, or choose otherwise for the days to come with: fieldmon change"
        )
    project = _open(season)
    on, now = _date(context.params["on"]), context.params["now"]
    today = project.plan(on, None if now is None else _time(now))
    route, setup = today.route, project.setup
    if not len(route):
        left_h = today.scene.seconds_left / 3600
        raise SettingError(
            "The working day must be long enough to reach another plant and come back, but "
            f"{left_h:.1f} h are left of {on}. Plan another day with --date."
        )
    notes = RouteNotes(project.plot.field.name, setup.sampler, begins(setup, today))
    seen = project.history.inspections.on(today.scene.day)
    done = f"{len(seen)} done, " if len(seen) else ""
    typer.echo(
        f"{on}: {done}{len(route)} of {len(project.plot.grid)} plants in "
        f"{route.end_s / 3600:.1f} h, {route.drive_m / 1000:.2f} km; about "
        f"{route.expected_finds:.1f} of them infested, about "
        f"{route.expected_found:.1f} of these would be found."
    )
    hand_off(route, notes, outputs)
    rasters.write_map(context.params["chance_map"], project.plot, today.chance)


def record(
    season: SeasonFile,
    files: Annotated[
        list[Path],
        typer.Argument(
            help="Findings: CSV, Excel, GeoJSON, GPX, GeoPackage... with plants or positions; "
            "or the route file given out, filled in."
        ),
    ],
    on: Annotated[
        str | None,
        typer.Option("--date", help="Day of findings whose file names none, YYYY-MM-DD."),
    ] = None,
    who: Annotated[str, typer.Option(help="Who inspected.")] = "",
    take_doubtful: TakeDoubtful = False,  # noqa: FBT002 - a flag
    finding_option: FindingChoices = None,
) -> None:
    """Record what was found; the same findings twice change nothing.

    Plants that are not in the files stay unknown. Positions are snapped to the nearest plant;
    doubtful ones are listed and left out, unless --take-doubtful is given.

    Example: fieldmon record season.gpkg route.csv --date 2026-04-06 --who Ann
    """
    from fieldmon.io.readers.inspections import read_findings  # noqa: PLC0415
    from fieldmon.io.readers.reported import FindingsOptions  # noqa: PLC0415
    from fieldmon.monitoring import counting_copy, results_from  # noqa: PLC0415

    project = _open(season)
    options = FindingsOptions(take_doubtful=take_doubtful)
    if on is not None:
        options = options.choose("day", str(_date(on)))
    options = _chosen(options, finding_option)
    # all are read before any is recorded: a file that cannot be used leaves nothing half-done
    with tempfile.TemporaryDirectory(prefix="fieldmon-") as folder:
        sources = [counting_copy(f, Path(folder)) if is_season(f) else f for f in files]
        heard = [read_findings(source, project.plot.grid, options) for source in sources]
    read = list(zip(files, heard, strict=True))
    for file, found in read:
        for finding in found.messages:
            typer.echo(f"{file.name}: {finding}", err=True)
    last = None
    for file, found in read:
        results = results_from(found.value)
        done = project.record(results, file.name, who)
        if len(results):
            last = max(last or results.day.max(), results.day.max())
        batch = "" if done.batch is None else f" (batch {done.batch})"
        typer.echo(f"{file.name}: {done.new} new, {done.known} known already{batch}")
    if last is not None:
        typer.echo("\n".join(_lines(project, project.status(last.item()))))


def status(
    season: SeasonFile,
    on: On = None,
    batches: ListBatches = False,  # noqa: FBT002 - a flag
    rows: ListRows = False,  # noqa: FBT002 - a flag
) -> None:
    """Show where a season stands: found, expected still out there, rows not seen for long.

    Example: fieldmon status season.gpkg
    """
    project = _open(season)
    now = project.status(project.last_date() if on is None else _date(on))
    typer.echo("\n".join(_lines(project, now)))
    if rows:
        _show_rows(project, now)
    if batches:
        for batch in project.batches():
            undone = "  (undone)" if batch.undone else ""
            who = f" by {batch.who}" if batch.who else ""
            typer.echo(
                f"{batch.number:5d}  {batch.at[:16]}  {batch.rows:5d} {batch.kind}{who}  "
                f"{batch.source}{undone}"
            )
    for sentence in project.verify():
        typer.echo(f"doubtful: {sentence}", err=True)


def _lines(project: Season, now: Status) -> Iterable[str]:
    ahead = now.estimate
    yield f"{project.plot.field.name}, {now.on} (day {now.day + 1} of the season)"
    yield f"  inspected today        {now.inspected_today:6d}, {now.found_today} found infested"
    yield (
        f"  inspected so far       {now.inspected:6d} of {now.plants} plants "
        f"({100 * now.inspected / now.plants:.0f} %), {now.found} found infested"
    )
    yield (
        f"  expected still there   {ahead.expected:6.1f} ({ahead.low} to {ahead.high} with a "
        "chance of 90 %)"
    )
    yield f"  found of all           {now.detection_pct:6.1f} %, as believed"
    yield f"  chance it is clean     {100 * ahead.chance_clean:6.1f} %"
    spots = now.hot_spots
    yield f"  hot spots              {len(spots):6d}" + "".join(
        f"; {spots.found[h]} finds where {spots.expected[h]:.1f} were expected"
        for h in range(min(len(spots), 3))
    )


def _show_rows(project: Season, now: Status) -> None:
    import numpy as np  # noqa: PLC0415

    lines = project.plot.grid.row_line + 1
    for line in np.unique(lines):
        days = now.days_since[lines == line]
        known = days[~np.isnan(days)]
        said = f"{known.min():.0f} days ago" if len(known) else "never"
        typer.echo(f"  row {line:4d}  {said}")


def undo(
    season: SeasonFile,
    batch: Annotated[
        int | None, typer.Option(help="Number of a batch, see fieldmon status --batches.")
    ] = None,
    inspection: Annotated[
        int | None, typer.Option(help="Number (fid) of one inspection in the season's file.")
    ] = None,
    change: UndoChange = False,  # noqa: FBT002 - a flag
) -> None:
    """Take back what was recorded last, a batch, one inspection, or a change; nothing is deleted.

    Example: fieldmon undo season.gpkg
    """
    if (batch is not None) + (inspection is not None) + change > 1:
        raise SettingError("Give --batch, --inspection or --change, not two of them.")
    if change:
        setup = _open(season).undo_change()
        typer.echo(
            f"The last change was taken back: {setup.sampler}, {setup.robot.hours:g} h from "
            f"{setup.starts:%H:%M}, {setup.robot.look_s:g} s at a plant."
        )
        return
    typer.echo(_open(season).undo(batch, inspection))


def treat(
    season: SeasonFile,
    efficacy: Annotated[
        float, typer.Option(help="Chance that an infested plant is clean afterwards, 0 to 1.")
    ],
    area: Annotated[
        Path | None, typer.Option(help="File with the area treated; the whole plot if none.")
    ] = None,
    product: Annotated[str, typer.Option(help="What was used.")] = "",
    on: On = None,
) -> None:
    """Note that the plot or an area of it was sprayed; the chance falls there.

    Example: fieldmon treat season.gpkg --efficacy 0.8 --area corner.geojson --product soap
    """
    project, ground = _open(season), None
    if area is not None:
        import shapely  # noqa: PLC0415
        from shapely import MultiPolygon  # noqa: PLC0415

        from fieldmon.io.read import read_plots  # noqa: PLC0415

        read = read_plots(area)
        for finding in read.messages:
            typer.echo(str(finding), err=True)
        whole = shapely.union_all([field.boundary for field in read.value])
        ground = MultiPolygon(list(shapely.get_parts(whole)))
    day = _date(on)
    done = project.treat(day, efficacy, ground, product)
    if not done.new:
        typer.echo("This treatment was noted already; nothing changed.")
        return
    ahead = project.status(day).estimate
    typer.echo(
        f"Treatment noted as batch {done.batch}; about {ahead.expected:.1f} plants are believed "
        f"infested now ({ahead.low} to {ahead.high})."
    )


def change(  # noqa: PLR0913, PLR0917 - a command's options are its arguments
    season: SeasonFile,
    sampler: Annotated[str | None, typer.Option(help="Who chooses.")] = None,
    every: Annotated[int | None, typer.Option(help="Its every N-th, as in plan.")] = None,
    hours: Annotated[float | None, typer.Option(help="Working hours a day.")] = None,
    look: Annotated[float | None, typer.Option(help="Seconds spent looking at a plant.")] = None,
    speed: Annotated[float | None, typer.Option(help="Driving speed, km/h.")] = None,
    start: Annotated[str | None, typer.Option(help="Local time the work starts, HH:MM.")] = None,
    spread: Annotated[
        float | None, typer.Option(help="Chance a night to infest a neighbour, as believed.")
    ] = None,
) -> None:
    """Choose otherwise for a season; what was chosen before stays in its file.

    Example: fieldmon change season.gpkg --hours 6 --sampler naive
    """
    from dataclasses import replace  # noqa: PLC0415

    project = _open(season)
    seen = project.setup
    robot: dict[str, Any] = {"hours": hours, "look_s": look}
    robot["speed_m_s"] = None if speed is None else speed / 3.6
    robot = {name: value for name, value in robot.items() if value is not None}
    new = replace(seen, robot=replace(seen.robot, **robot))
    if sampler is not None:
        new = replace(new, sampler=sampler, sampler_settings={})
    if every is not None:
        new = replace(new, sampler_settings={"every": every})
    if start is not None:
        new = replace(new, starts=_time(start, "--start"))
    if spread is not None:
        rate = replace(seen.beliefs.spread, rate_per_day=spread)
        new = replace(new, beliefs=replace(seen.beliefs, spread=rate))
    if new == seen:
        typer.echo("Nothing was changed.")
        return
    project.change(new, seen)
    typer.echo("Changed; fieldmon plan uses it from now on.")


def salvage(
    season: SeasonFile,
    output: Annotated[Path, typer.Option("--output", "-o", help="New file to save it in.")],
) -> None:
    """Save what can be saved from a damaged season into a new file.

    Example: fieldmon salvage season.gpkg --output rescued.gpkg
    """
    from fieldmon.monitoring.salvage import salvage as save  # noqa: PLC0415

    done = save(season, output)
    for name, rows in done.rows.items():
        note = "  (some could not be read)" if name in done.lost else ""
        typer.echo(f"  {rows:8d}  {name}{note}")
    if done.whole:
        typer.echo(f"{output} is a season again. Compare it with: fieldmon status {output}")
    else:
        typer.echo(
            f"{output} holds what could be read, but the plot or its settings are lost: begin a "
            "new season with fieldmon init, and record the layer inspections into it."
        )


def _open(season: Path) -> Season:
    from fieldmon.monitoring import Season  # noqa: PLC0415

    return Season(season)


def _chosen(options: FindingsOptions, more: list[str] | None) -> FindingsOptions:
    for item in more or []:
        name, equals, value = item.partition("=")
        if not equals:
            raise SettingError(f"An option must be NAME=VALUE, but it is {item!r}.")
        options = options.choose(name.strip(), value.strip())
    return options


def _date(text: str | None) -> date:
    try:
        return date.today() if text is None else date.fromisoformat(text)  # noqa: DTZ011 - local
    except ValueError as error:
        raise SettingError(f"--date must be a day as YYYY-MM-DD, but it is {text!r}.") from error


def _time(text: str, flag: str = "--now") -> time:
    try:
        return datetime.strptime(text, "%H:%M").time()  # noqa: DTZ007 - local time
    except ValueError as error:
        raise SettingError(f"{flag} must be a time as HH:MM, but it is {text!r}.") from error
