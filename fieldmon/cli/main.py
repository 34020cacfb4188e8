"""The `fieldmon` command. Heavy imports wait until a command needs them."""

from __future__ import annotations

import os
import sys
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import date, datetime
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, TypeAlias

import typer

from fieldmon.cli import rasters, study
from fieldmon.cli import season as season_cli
from fieldmon.cli.app import open_app
from fieldmon.cli.waiting import WAITING
from fieldmon.errors import ChoiceNeeded, FieldmonError, SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from fieldmon.infestation.observations import Observations
    from fieldmon.io.import_report import Imported, ImportMessage
    from fieldmon.io.readers.crews import Crew
    from fieldmon.io.readers.places import Places
    from fieldmon.io.readers.places import Plants as Measured
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers import Sampler
    from fieldmon.simulation.start import Start

#: a file, and what was chosen about how to read it
_Asked: TypeAlias = tuple[Path | None, list[str] | None]
PLOT_HELP = "Plot file: shapefile (.shp or .zip), GeoPackage, GeoJSON, KML, ..."

app = typer.Typer(
    name="fieldmon",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    help="Which plants to inspect for pests today, and in which order.\n\n"
    "Start with [bold]fieldmon app[/bold] to see everything on a map, or plan a day at once:\n\n"
    "    fieldmon plots estate.zip\n\n"
    "    fieldmon plan estate.zip --feature Gate --observations mites.csv -o route.geojson\n\n"
    "    fieldmon simulate estate.zip --feature Gate --observations mites.csv",
)


app.add_typer(study.app, name="study")
season_cli.register(app)
app.command(name="app")(open_app)


class SamplerName(StrEnum):
    """Who decides which plants come next."""

    NAIVE = "naive"
    BOUNCY = "bouncy"
    DYNAMIC = "dynamic"
    ADAPTIVE = "adaptive"
    ADAPTIVE_LOOKS = "adaptive-looks"
    SNAKE = "snake"
    SNAKE_RANDOM = "snake-random"
    NEIGHBOR = "neighbor"
    NEIGHBOR_RANDOM = "neighbor-random"
    RANDOM = "random"


PlotFile = Annotated[Path, typer.Argument(help=PLOT_HELP, show_default=False)]
MaybePlotFile = Annotated[
    Path | None,
    typer.Argument(help=f"{PLOT_HELP} Not needed if --plants are given.", show_default=False),
]
Feature = Annotated[
    str | None,
    typer.Option(help="Name or number (from 1) of the plot, where a file holds several."),
]
Choices = Annotated[
    list[str] | None,
    typer.Option(
        "--plot-option",
        help="What else the plot file leaves open, as NAME=VALUE; messages say which. "
        "E.g. crs=EPSG:2039, layer=parcels, member=plots.shp, swap_axes=yes.",
    ),
]
Crs = Annotated[
    str | None, typer.Option(help="Coordinate system of the plot file if it has none: EPSG:2039.")
]
Layer = Annotated[str | None, typer.Option(help="Layer of the plot file.")]
Records = Annotated[
    Path | None,
    typer.Option("--observations", help="Dated pest records: CSV, Excel, shapefile, GeoJSON, ..."),
]
RecordChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--record-option",
        help="What the records leave open, as NAME=VALUE: crs=EPSG:2039, date_order=dmy, "
        "columns=date=Datum, columns=count=Milben.",
    ),
]
Plants = Annotated[
    Path | None, typer.Option(help="Positions of plants measured on the plot (points).")
]
Paths = Annotated[
    Path | None, typer.Option(help="Paths and roads from which insects enter (lines).")
]
PlantsChoices = Annotated[
    list[str] | None,
    typer.Option("--plants-option", help="What the file of plants leaves open, as NAME=VALUE."),
]
PathsChoices = Annotated[
    list[str] | None,
    typer.Option("--paths-option", help="What the file of paths leaves open, as NAME=VALUE."),
]
Bearing = Annotated[
    float | None,
    typer.Option(help="Direction of the rows, degrees from north; found if not given."),
]
RowSpacing = Annotated[float | None, typer.Option(help="Metres from row to row.")]
PlantSpacing = Annotated[float | None, typer.Option(help="Metres from plant to plant in a row.")]
Headland = Annotated[float | None, typer.Option(help="Metres free of plants at both row ends.")]
Gate = Annotated[str | None, typer.Option(help="Where the day starts and ends: LON,LAT.")]
Scout = Annotated[bool, typer.Option("--scout", help="A person on foot instead of the robot.")]
Hours = Annotated[float | None, typer.Option(help="Working hours a day.")]
Look = Annotated[float | None, typer.Option("--look", help="Seconds spent looking at a plant.")]
Speed = Annotated[float | None, typer.Option(help="Driving speed, km/h.")]
RowChange = Annotated[float | None, typer.Option(help="Seconds added for changing rows.")]
Turn = Annotated[
    float | None, typer.Option(help="Seconds to turn to the other side of the same aisle.")
]
Every = Annotated[
    int | None,
    typer.Option(
        help="Every N-th plant or stop (bouncy 2, snake 1, neighbor 1) or 1/N (random 3)."
    ),
]
BothFaces = Annotated[
    bool, typer.Option("--both-faces", help="Inspect both faces of each row, each from its aisle.")
]
Outputs = Annotated[
    list[Path] | None,
    typer.Option(
        "--output",
        "-o",
        help="Route file to write, its format by its ending; repeat for several. "
        "route.geojson if none.",
    ),
]
EveryPlot = Annotated[
    bool,
    typer.Option("--all", help="Every plot of the file; --output is the folder of routes then."),
]
On = Annotated[str | None, typer.Option("--date", help="Day of the work, YYYY-MM-DD; today.")]
FlagOnly = Annotated[
    bool,
    typer.Option(
        "--flag-only", help="Plants found infested are only flagged, not treated at once."
    ),
]
StartTime = Annotated[str, typer.Option(help="Local time the work starts, HH:MM.")]


def main() -> None:
    """Run the command; a problem is a sentence and exit code 2, never a traceback."""
    try:
        with WAITING:
            code = app(standalone_mode=False)
        sys.exit(code if isinstance(code, int) else 0)
    except FieldmonError as error:
        _end(str(error), 2)
    except typer.Exit as stop:
        sys.exit(stop.exit_code)
    except (KeyboardInterrupt, typer.Abort):
        _end("Stopped; nothing was written that is not complete.", 130)
    except BrokenPipeError:
        sys.exit(0)
    except Exception as error:  # noqa: BLE001 - no traceback ever reaches a person
        _unexpected(error)


def _unexpected(error: Exception) -> NoReturn:
    # typer's own base of a wrong option or argument, wherever its version keeps it
    usage = next(c for c in typer.BadParameter.__mro__ if c.__name__ == "ClickException")
    if isinstance(error, usage):
        error.show()  # type: ignore[attr-defined]
        sys.exit(2)
    if os.environ.get("FIELDMON_DEBUG"):
        raise error
    _end(
        f"Sorry: fieldmon made a mistake of its own ({type(error).__name__}: {error}). "
        "Run the command again with FIELDMON_DEBUG=1 to see where, and report it.",
        1,
    )


def _end(sentence: str, code: int) -> NoReturn:
    typer.echo(sentence, err=True)
    sys.exit(code)


@app.command()
def plots(
    plot: PlotFile, crs: Crs = None, layer: Layer = None, plot_option: Choices = None
) -> None:
    """List the plots of a file, with their areas."""
    for number, field in enumerate(_read_plots(plot, None, crs, layer, plot_option), 1):
        area = field.frame().geometry_m(field.boundary).area
        typer.echo(f"{number:4d}  {area / 1e4:9.2f} ha  {field.name}")


@app.command()
def plan(  # noqa: PLR0913, PLR0917 - a command's options are its arguments
    context: typer.Context,
    plot: MaybePlotFile = None,
    output: Outputs = None,
    observations: Records = None,
    feature: Feature = None,
    sampler: Annotated[SamplerName, typer.Option(help="Who chooses.")] = SamplerName.ADAPTIVE,
    every: Every = None,
    on: On = None,
    start: StartTime = "06:00",
    now: Annotated[
        str | None,
        typer.Option(help="Of a season: plan the rest of the day from this local time, HH:MM."),
    ] = None,
    hours: Hours = None,
    look: Look = None,
    speed: Speed = None,
    row_change: RowChange = None,
    turn: Turn = None,
    scout: Scout = False,  # noqa: FBT002 - a flag
    bearing: Bearing = None,
    row_spacing: RowSpacing = None,
    plant_spacing: PlantSpacing = None,
    headland: Headland = None,
    both_faces: BothFaces = False,  # noqa: FBT002 - a flag
    gate: Gate = None,
    plants: Plants = None,
    paths: Paths = None,
    crs: Crs = None,
    layer: Layer = None,
    plot_option: Choices = None,
    record_option: RecordChoices = None,
    plants_option: PlantsChoices = None,
    paths_option: PathsChoices = None,
    risk: rasters.Risk = None,
    risk_option: rasters.RiskChoices = None,
    canopy: rasters.Canopy = None,
    canopy_below: rasters.CanopyBelow = None,
    canopy_option: rasters.CanopyChoices = None,
    chance_map: rasters.ChanceMap = None,
    every_plot: EveryPlot = False,  # noqa: FBT002 - a flag
) -> None:
    """Plan today's route on a plot or in a season, and write it for whoever drives.

    Files hold the line to drive, which crosses no row of plants, and the stops in order with
    arrival time, row, plant and chance of infestation. Without observations every plant has the
    same chance but for the plot's edge, from which insects come.

    In a season (see fieldmon init) the route follows from everything recorded so far; on a day of
    which something was recorded already, it is the rest of the day's.

    Example: fieldmon plan vines.zip --feature 3 --observations mites.csv --hours 6 -o route.geojson
    Example: fieldmon plan season.gpkg -o route.geojson
    Example: fieldmon plan estate.zip --all --observations mites.csv -o routes

    With --all, columns robot (robot or scout), hours, speed_km_h and look_s of the plot file say
    who works on each plot; options given here go before them.
    """
    from fieldmon.io.writers.geojson import RouteNotes  # noqa: PLC0415
    from fieldmon.planning.plan import PlanSettings, first_day  # noqa: PLC0415

    if plot is not None and season_cli.is_season(plot):
        season_cli.plan_season(context, plot, output)
        return
    if now is not None:
        raise SettingError("--now needs a season (see fieldmon init), but this is a plot file.")
    day, begins = _day(on), _clock(start)
    robot = _robot(scout, hours, look, speed, row_change, turn)
    plans = PlanSettings(robot, _sampler(sampler, every))
    given = {
        "row_bearing_deg": bearing,
        "row_spacing_m": row_spacing,
        "plant_spacing_m": plant_spacing,
        "headland_m": headland,
        "faces": 2 if both_faces else None,
    }
    if every_plot:
        if plot is None or any((plants, gate, feature, risk, canopy, chance_map)):
            raise SettingError(
                "--all plans every plot of one plot file: leave out --feature, --plants, --gate, "
                "--risk, --canopy and --chance-map."
            )
        by_hand = {
            "hours": hours,
            "look_s": look,
            "speed_m_s": speed and robot.speed_m_s,
            "row_change_s": row_change,
            "turn_180_s": turn,
        }
        who = (sampler, every, scout)
        crews = _read_crews(plot, paths, crs, layer, plot_option)
        records = _read_all_records(observations, record_option)
        began = datetime.combine(day.astype(date), begins)
        if output and (len(output) > 1 or output[0].suffix):
            raise SettingError(
                "With --all, --output must be one folder for the routes of all plots."
            )
        folder = output[0] if output else Path("routes")
        _plan_all(crews, records, (who, by_hand, given), (folder, began))
        return
    if plot is None:
        laid = _around(plants, plants_option, gate, given)
    else:
        fields = _read_plots(plot, feature, crs, layer, plot_option)
        beside = (plants, plants_option), (paths, paths_option)
        laid = _lay(_place(fields, *beside, gate, feature), given)
    named = partial(_named, plot, crs, layer, plot_option, (plants, plants_option))
    records = _read_records(observations, laid, record_option, named)
    laid = rasters.without_missing(laid, canopy, canopy_below, canopy_option, _tell)
    at_risk = rasters.risk_of(laid, risk, risk_option, _tell)
    _hear(records, day)
    today = first_day(laid, records, day, plans, at_risk)
    route = today.route
    if not len(route):
        raise SettingError(
            f"The working day must be long enough to reach a plant and come back, but "
            f"{plans.robot.hours:g} h are not. Give more --hours."
        )
    began = datetime.combine(day.astype(date), begins)
    typer.echo(
        f"{len(route)} of {len(laid.grid)} plants in {route.end_s / 3600:.1f} h, "
        f"{route.drive_m / 1000:.2f} km; about {route.expected_finds:.1f} of them infested, "
        f"about {route.expected_found:.1f} of these would be found."
    )
    season_cli.hand_off(route, RouteNotes(laid.field.name, sampler.value, began), output)
    rasters.write_map(chance_map, laid, today.chance)


@app.command()
def init(  # noqa: PLR0913, PLR0917 - a command's options are its arguments
    season: Annotated[Path, typer.Argument(help="File of the season to make: season.gpkg.")],
    plot: MaybePlotFile = None,
    observations: Records = None,
    feature: Feature = None,
    sampler: Annotated[SamplerName, typer.Option(help="Who chooses.")] = SamplerName.ADAPTIVE,
    every: Every = None,
    on: Annotated[
        str | None, typer.Option("--begins", help="First day of the season, YYYY-MM-DD; today.")
    ] = None,
    start: StartTime = "06:00",
    flag_only: FlagOnly = False,  # noqa: FBT002 - a flag
    spread: Annotated[
        float, typer.Option(help="Chance a night that a plant infests its neighbour, as believed.")
    ] = 0.02,
    seed: Annotated[int, typer.Option(help="For samplers that draw.")] = 1,
    hours: Hours = None,
    look: Look = None,
    speed: Speed = None,
    row_change: RowChange = None,
    turn: Turn = None,
    scout: Scout = False,  # noqa: FBT002 - a flag
    bearing: Bearing = None,
    row_spacing: RowSpacing = None,
    plant_spacing: PlantSpacing = None,
    headland: Headland = None,
    both_faces: BothFaces = False,  # noqa: FBT002 - a flag
    gate: Gate = None,
    plants: Plants = None,
    paths: Paths = None,
    crs: Crs = None,
    layer: Layer = None,
    plot_option: Choices = None,
    record_option: RecordChoices = None,
    plants_option: PlantsChoices = None,
    paths_option: PathsChoices = None,
    risk: rasters.Risk = None,
    risk_option: rasters.RiskChoices = None,
    canopy: rasters.Canopy = None,
    canopy_below: rasters.CanopyBelow = None,
    canopy_option: rasters.CanopyChoices = None,
) -> None:
    """Begin a season on a plot: one GeoPackage that grows with every day's findings.

    QGIS and QField open it as it is. Then, every day: fieldmon plan, the work, fieldmon record.

    Example: fieldmon init season.gpkg estate.zip --feature Gate --observations mites.csv
    """
    from dataclasses import replace  # noqa: PLC0415

    from fieldmon.monitoring import Season, SeasonSetup  # noqa: PLC0415
    from fieldmon.monitoring.history import Beliefs  # noqa: PLC0415
    from fieldmon.samplers import EVERY  # noqa: PLC0415

    day, beliefs = _day(on), Beliefs(treated=not flag_only)
    setup = SeasonSetup(
        day.astype(date),
        _clock(start),
        _robot(scout, hours, look, speed, row_change, turn),
        sampler.value,
        {} if every is None or sampler.value not in EVERY else {"every": every},
        beliefs=replace(beliefs, spread=replace(beliefs.spread, rate_per_day=spread)),
        seed=seed,
    )
    given = {
        "row_bearing_deg": bearing,
        "row_spacing_m": row_spacing,
        "plant_spacing_m": plant_spacing,
        "headland_m": headland,
        "faces": 2 if both_faces else None,
    }
    with _noting() as notes:
        if plot is None:
            laid = _around(plants, plants_option, gate, given)
        else:
            fields = _read_plots(plot, feature, crs, layer, plot_option)
            beside = (plants, plants_option), (paths, paths_option)
            laid = _lay(_place(fields, *beside, gate, feature), given)
        named = partial(_named, plot, crs, layer, plot_option, (plants, plants_option))
        records = _read_records(observations, laid, record_option, named)
        laid = rasters.without_missing(laid, canopy, canopy_below, canopy_option, _tell)
        at_risk = rasters.risk_of(laid, risk, risk_option, _tell)
    _hear(records, day)
    project = Season.create(season, laid, records, setup, season_cli.remarks(notes), at_risk)
    ahead = project.status(setup.begins).outlook
    typer.echo(
        f"Season begun in {season}: {len(records)} records, about {ahead.expected:.0f} plants "
        f"believed infested ({ahead.low} to {ahead.high})."
    )
    typer.echo(f"Next: fieldmon plan {season} -o route.geojson")


@app.command()
def simulate(  # noqa: PLR0913, PLR0917 - a command's options are its arguments
    plot: MaybePlotFile = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Table to write (CSV).")
    ] = None,
    observations: Records = None,
    feature: Feature = None,
    sampler: Annotated[
        list[SamplerName] | None,
        typer.Option(help="Who chooses; repeat to compare. Naive, bouncy and dynamic if none."),
    ] = None,
    every: Every = None,
    days: Annotated[int, typer.Option(help="Working days.")] = 25,
    seed: Annotated[int, typer.Option(help="Seed: the same seed, the same season.")] = 1,
    infested: Annotated[float, typer.Option(help="Share of plants infested at the start.")] = 0.02,
    spread: Annotated[float, typer.Option(help="Chance a night to infest each neighbour.")] = 0.1,
    on: On = None,
    hours: Hours = None,
    look: Look = None,
    speed: Speed = None,
    row_change: RowChange = None,
    turn: Turn = None,
    scout: Scout = False,  # noqa: FBT002 - a flag
    bearing: Bearing = None,
    row_spacing: RowSpacing = None,
    plant_spacing: PlantSpacing = None,
    headland: Headland = None,
    both_faces: BothFaces = False,  # noqa: FBT002 - a flag
    gate: Gate = None,
    plants: Plants = None,
    paths: Paths = None,
    crs: Crs = None,
    layer: Layer = None,
    plot_option: Choices = None,
    record_option: RecordChoices = None,
    plants_option: PlantsChoices = None,
    paths_option: PathsChoices = None,
    risk: rasters.Risk = None,
    risk_option: rasters.RiskChoices = None,
    canopy: rasters.Canopy = None,
    canopy_below: rasters.CanopyBelow = None,
    canopy_option: rasters.CanopyChoices = None,
) -> None:
    """Simulate a season on a plot: insects spread at night, samplers look for them by day.

    The start is drawn from the chance map of the records; all samplers meet the same insects.
    Detection is all finds so far in percent of all infestations so far.

    Example: fieldmon simulate vines.zip --feature 3 --sampler naive --sampler dynamic --days 10
    """
    from fieldmon.planning.plan import PlanSettings, first_day  # noqa: PLC0415

    day = _day(on)
    robot = _robot(scout, hours, look, speed, row_change, turn)
    given = {
        "row_bearing_deg": bearing,
        "row_spacing_m": row_spacing,
        "plant_spacing_m": plant_spacing,
        "headland_m": headland,
        "faces": 2 if both_faces else None,
    }
    if plot is None:
        laid = _around(plants, plants_option, gate, given)
    else:
        fields = _read_plots(plot, feature, crs, layer, plot_option)
        beside = (plants, plants_option), (paths, paths_option)
        laid = _lay(_place(fields, *beside, gate, feature), given)
    named = partial(_named, plot, crs, layer, plot_option, (plants, plants_option))
    records = _read_records(observations, laid, record_option, named)
    laid = rasters.without_missing(laid, canopy, canopy_below, canopy_option, _tell)
    at_risk = rasters.risk_of(laid, risk, risk_option, _tell)
    _hear(records, day)
    begin = _start(
        laid, first_day(laid, records, day, PlanSettings(robot), at_risk).chance, infested, seed
    )
    rows = []
    for name in sampler or list(SamplerName)[:3]:
        rows += _season(laid, robot, (name, _sampler(name, every)), begin, (days, spread, seed))
    header = "sampler,day,detection_pct,visited_pct,ever_visited_pct,found,infested_left"
    if output is not None:
        from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415

        write_whole(output, "\n".join([header, *rows, ""]).encode())
        typer.echo(f"Table written to {output}")


def _read_plots(
    path: Path,
    feature: str | None,
    crs: str | None,
    layer: str | None,
    more: list[str] | None,
) -> tuple[Field, ...]:
    read = _plots_of(path, feature, crs, layer, more)
    _tell(read.messages, path, "--plot-option")
    return read.value


def _plots_of(
    path: Path,
    feature: str | None,
    crs: str | None,
    layer: str | None,
    more: list[str] | None,
) -> Imported[tuple[Field, ...]]:
    from fieldmon.io.options import PlotOptions  # noqa: PLC0415
    from fieldmon.io.read import read_plots  # noqa: PLC0415

    options = PlotOptions()
    for name, value in (("crs", crs), ("layer", layer), ("feature", feature)):
        if value is not None:
            options = options.choose(name, value)
    with _asking("--plot-option"):
        return read_plots(path, _chosen(options, more))


def _read_crews(
    path: Path,
    paths: Path | None,
    crs: str | None,
    layer: str | None,
    more: list[str] | None,
) -> list[tuple[Field, Crew]]:
    """Return every plot of a file, and who works on it."""
    from dataclasses import replace  # noqa: PLC0415

    from fieldmon.io.options import PlotOptions, ReadOptions  # noqa: PLC0415
    from fieldmon.io.read import read_crews, read_lines  # noqa: PLC0415

    options = PlotOptions()
    for name, value in (("crs", crs), ("layer", layer)):
        if value is not None:
            options = options.choose(name, value)
    with _asking("--plot-option"):
        read, crews = read_crews(path, _chosen(options, more))
    _tell(read.messages, path, "--plot-option")
    fields = read.value
    if paths is not None:
        lines = read_lines(paths, ReadOptions())
        _tell(lines.messages, paths)
        fields = tuple(replace(field, paths=lines.value) for field in fields)
    return [(field, crews[field.name]) for field in fields]


def _read_all_records(path: Path | None, more: list[str] | None) -> Observations:
    """Return the records of all plots."""
    from fieldmon.infestation.observations import Observations  # noqa: PLC0415

    if path is None:
        return Observations.none()
    from fieldmon.io.options import RecordOptions  # noqa: PLC0415
    from fieldmon.io.read import read_records  # noqa: PLC0415

    with _asking("--record-option"):
        read = read_records(path, _chosen(RecordOptions(), more))
    _tell(read.messages, path, "--record-option")
    return read.value


def _plan_all(
    plots: list[tuple[Field, Crew]],
    records: Observations,
    ordered: tuple[tuple[SamplerName, int | None, bool], dict[str, Any], dict[str, Any]],
    to: tuple[Path, datetime],
) -> None:
    """Plan every plot into a folder, given who chooses, the robot's settings and the planting's."""
    import numpy as np  # noqa: PLC0415

    from fieldmon.cli import plan_all  # noqa: PLC0415
    from fieldmon.planning.batch import Orders  # noqa: PLC0415
    from fieldmon.samplers import EVERY  # noqa: PLC0415

    (name, every, scout), robot, planting = ordered
    folder, began = to
    orders = Orders(
        day=np.datetime64(began.date(), "D"),
        sampler=name.value,
        every=every if name.value in EVERY else None,
        on_foot=scout,
        robot={setting: value for setting, value in robot.items() if value is not None},
        planting={setting: value for setting, value in planting.items() if value is not None},
    )
    _hear(records, orders.day)
    plan_all.plan_all(plots, orders, plan_all.Day(records, folder, began))


def _read_records(
    path: Path | None,
    plot: Plot,
    more: list[str] | None,
    named: Callable[[PlantGrid], Places],
) -> Observations:
    """Return the records on a plot; `named` is asked for what they name if they do."""
    from fieldmon.infestation.observations import Observations  # noqa: PLC0415

    if path is None:
        return Observations.none()
    from fieldmon.io.options import RecordOptions  # noqa: PLC0415
    from fieldmon.io.read import read_records  # noqa: PLC0415
    from fieldmon.io.readers.nearby import on_plants  # noqa: PLC0415

    options = _chosen(RecordOptions(), more)
    with _asking("--record-option"):
        try:
            read = read_records(path, options, near=plot.field)
        except ChoiceNeeded as question:
            if question.option != "places":
                raise
            read = read_records(path, options, plot.field, named(plot.grid))
    _tell(read.messages, path, "--record-option")
    _tell(on_plants(read.value, plot.grid), path)
    return read.value


def _named(
    plot: Path | None,
    crs: str | None,
    layer: str | None,
    more: list[str] | None,
    plants: _Asked,
    grid: PlantGrid,
) -> Places:
    """Return the plots and plants of the command's files by their names."""
    from fieldmon.io.readers.places import Places  # noqa: PLC0415

    # what these files have to say was said before
    fields = () if plot is None else _plots_of(plot, None, crs, layer, more).value
    return Places.of(fields, grid, None if plants[0] is None else _read_plants(*plants).value)


def _place(
    fields: tuple[Field, ...],
    plants: _Asked,
    paths: _Asked,
    gate: str | None,
    feature: str | None,
) -> Field:
    """Return the one plot that is meant, with its plants, paths and gate."""
    from dataclasses import replace  # noqa: PLC0415

    from fieldmon.io.options import ReadOptions  # noqa: PLC0415
    from fieldmon.io.read import read_lines  # noqa: PLC0415

    if len(fields) > 1 and feature is None:
        names = tuple(field.name for field in fields)
        listed = ", ".join(names[:12]) + (", ..." if len(names) > 12 else "")
        raise ChoiceNeeded(
            f"One plot must be chosen, but the file holds {len(names)}: {listed}. "
            f'Choose one by name or number: --feature "{names[0]}" or --feature 1.',
            "feature",
            names,
        )
    field = fields[0]
    if plants[0] is not None:
        measured = _read_plants(*plants)
        _tell(measured.messages, plants[0], "--plants-option")
        field = replace(field, plants=measured.value.lonlat.copy())
    if paths[0] is not None:
        with _asking("--paths-option"):
            lines = read_lines(paths[0], _chosen(ReadOptions(), paths[1]))
        _tell(lines.messages, paths[0], "--paths-option")
        field = replace(field, paths=lines.value)
    return field if gate is None else replace(field, gate=_lonlat(gate))


def _lay(field: Field, given: dict[str, float | None]) -> Plot:
    from fieldmon.plot.plot import Plot, planting_of  # noqa: PLC0415

    planting = planting_of(field, **given)
    plot = Plot.of(field, planting)
    _describe(plot)
    if field.plants is None:
        for name in ("row_spacing_m", "plant_spacing_m"):
            if given[name] is None and getattr(field, name) is None:
                option = name.removesuffix("_m").replace("_", "-")
                typer.echo(
                    f"guessed: {option.replace('-', ' ')} {getattr(planting, name):g} m "
                    f"[--{option}]",
                    err=True,
                )
    return plot


def _read_plants(path: Path | None, more: list[str] | None) -> Imported[Measured]:
    from fieldmon.io.options import ReadOptions  # noqa: PLC0415
    from fieldmon.io.read import read_plants  # noqa: PLC0415

    if path is None:
        raise SettingError("Give a plot file, or the positions of its plants with --plants FILE.")
    with _asking("--plants-option"):
        return read_plants(path, _chosen(ReadOptions(), more))


def _around(
    plants: Path | None,
    plants_option: list[str] | None,
    gate: str | None,
    given: dict[str, float | None],
) -> Plot:
    """Return the plot of measured plants without a boundary."""
    from fieldmon.plot.layout import Planting  # noqa: PLC0415
    from fieldmon.plot.plot import Plot  # noqa: PLC0415

    measured = _read_plants(plants, plants_option)
    _tell(measured.messages, plants, "--plants-option")
    by_hand = {name: value for name, value in given.items() if value is not None}
    lonlat = measured.value.lonlat.copy()
    planting = Planting(**by_hand)  # type: ignore[arg-type]
    name = "plants" if plants is None else plants.stem
    plot = Plot.around(name, lonlat, planting, None if gate is None else _lonlat(gate))
    _describe(plot)
    return plot


def _describe(plot: Plot) -> None:
    grid = plot.grid
    typer.echo(
        f"{plot.field.name}: {len(grid)} plants in {grid.n_rows} rows, bearing "
        f"{grid.frame.bearing_deg % 180:.1f} degrees, rows {grid.row_spacing_m:.2f} m and plants "
        f"{grid.plant_spacing_m:.2f} m apart."
    )


def _start(plot: Plot, chance: Any, infested: float, seed: int) -> Start:  # noqa: ANN401
    from fieldmon.compute.random_streams import RandomStreams  # noqa: PLC0415
    from fieldmon.infestation.prior import start_infested  # noqa: PLC0415
    from fieldmon.simulation.start import Start  # noqa: PLC0415

    if not 0.0 < infested < 1.0:
        raise SettingError(
            f"The share infested at the start must be between 0 and 1, but it is {infested}."
        )
    begin = start_infested(chance, infested, RandomStreams(seed).of("start"))
    return Start(begin[plot.grid.vine], chance)


def _season(
    plot: Plot,
    robot: Robot,
    sampler: tuple[SamplerName, Sampler],
    begin: Start,
    numbers: tuple[int, float, int],
) -> list[str]:
    from fieldmon.compute.random_streams import RandomStreams  # noqa: PLC0415
    from fieldmon.infestation.spread import Spread  # noqa: PLC0415
    from fieldmon.simulation.season import SeasonSettings, simulated_days  # noqa: PLC0415

    n_days, rate, seed = numbers
    settings = SeasonSettings(n_days=n_days, spread=Spread(rate))
    name, decides = sampler
    walk = simulated_days(plot.aisles, robot, decides, begin, settings, RandomStreams(seed))
    rows = []
    typer.echo(f"\n{name}\n day  detection %  visited %  found  infested left")
    for day in walk:
        typer.echo(
            f"{day.number + 1:4d}  {day.detection_pct:11.1f}  {day.visited_pct:9.1f}  "
            f"{day.found:5d}  {day.left:13d}"
        )
        rows.append(
            f"{name},{day.number + 1},{day.detection_pct:.4f},{day.visited_pct:.4f},"
            f"{day.ever_visited_pct:.4f},{day.found},{day.left}"
        )
    return rows


def _chosen(options: Any, more: list[str] | None) -> Any:  # noqa: ANN401 - any of three options
    for item in more or []:
        name, equals, value = item.partition("=")
        if not equals:
            raise SettingError(f"An option must be NAME=VALUE, but it is {item!r}.")
        options = options.choose(name.strip(), value.strip())
    return options


@contextmanager
def _asking(flag: str) -> Iterator[None]:
    """Say with a question how to answer it on the command line."""
    try:
        yield
    except ChoiceNeeded as question:
        answer = question.choices[0] if question.choices else "..."
        named = question.option in {"crs", "layer", "feature"} and flag == "--plot-option"
        how = f"--{question.option} " if named else f"{flag} {question.option}="
        raise ChoiceNeeded(
            f'{question} Answer with {how}"{answer}", for instance.',
            question.option,
            question.choices,
        ) from None


def _tell(findings: Iterable[ImportMessage], source: object = "", flag: str = "") -> None:
    for finding in findings:
        typer.echo(finding.line(flag), err=True)
        for notes in _NOTES.get():
            notes.append((str(source), finding))


# what is being noted beside being printed, see _noting
_NOTES: ContextVar[tuple[list[tuple[str, ImportMessage]], ...]] = ContextVar("notes", default=())


@contextmanager
def _noting() -> Iterator[list[tuple[str, ImportMessage]]]:
    """Note what imports have to say, with the file it is about."""
    notes: list[tuple[str, ImportMessage]] = []
    token = _NOTES.set((notes,))
    try:
        yield notes
    finally:
        _NOTES.reset(token)


def _hear(records: Observations, day: Any) -> None:  # noqa: ANN401 - a numpy day
    from fieldmon.infestation.prior import usable  # noqa: PLC0415

    for remark in usable(records, day).remarks():
        typer.echo(remark, err=True)


def _robot(
    scout: bool,  # noqa: FBT001 - a flag handed on
    hours: float | None,
    look: float | None,
    speed: float | None,
    row_change: float | None,
    turn: float | None,
) -> Robot:
    from dataclasses import replace  # noqa: PLC0415

    from fieldmon.plot import robot  # noqa: PLC0415

    base = robot.scout() if scout else robot.Robot()
    return replace(
        base,
        hours=base.hours if hours is None else hours,
        look_s=base.look_s if look is None else look,
        speed_m_s=base.speed_m_s if speed is None else speed / 3.6,
        row_change_s=base.row_change_s if row_change is None else row_change,
        turn_180_s=base.turn_180_s if turn is None else turn,
    )


def _sampler(name: SamplerName, every: int | None) -> Sampler:
    from fieldmon.samplers import EVERY, sampler  # noqa: PLC0415

    if every is None or name.value not in EVERY:
        return sampler(name.value)
    return sampler(name.value, every=every)


def _day(text: str | None) -> Any:  # noqa: ANN401 - a numpy day, imported late
    import numpy as np  # noqa: PLC0415

    try:
        day = date.today() if text is None else date.fromisoformat(text)  # noqa: DTZ011 - local day
    except ValueError as error:
        raise SettingError(f"--date must be a day as YYYY-MM-DD, but it is {text!r}.") from error
    return np.datetime64(day, "D")


def _clock(text: str) -> Any:  # noqa: ANN401 - a time
    try:
        return datetime.strptime(text, "%H:%M").time()  # noqa: DTZ007 - local time
    except ValueError as error:
        raise SettingError(f"--start must be a time as HH:MM, but it is {text!r}.") from error


def _lonlat(text: str) -> tuple[float, float]:
    try:
        lon, lat = (float(part) for part in text.split(","))
    except ValueError as error:
        raise SettingError(
            f"--gate must be LON,LAT in degrees, such as 35.15,30.36, but it is {text!r}."
        ) from error
    return lon, lat


if __name__ == "__main__":
    main()
