"""`fieldmon drive`: a day driven, simulated or live. Heavy imports wait."""

from __future__ import annotations

from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from datetime import datetime, time, timedelta
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Protocol

import typer

from fieldmon.cli.files_to_plot import prepared
from fieldmon.cli.messages import tell_assumed, tell_past_midnight
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import refusing, within
from fieldmon.cli.options import (
    Every,
    Feature,
    MaybePlotFile,
    PlotFiles,
    RecordsFile,
    WorkDate,
    WorkerOptions,
    sampler_of,
)
from fieldmon.cli.sampler_names import OneSampler
from fieldmon.cli.season_files import (
    refuse_too_wide,
    refuse_unrecorded,
    refuse_what_was_chosen,
)
from fieldmon.cli.stopped import STOPPED_CODE
from fieldmon.cli.times import day, day_on
from fieldmon.cli.told_to_end import as_at_ctrl_c, told_to_end
from fieldmon.compute.ranges import CHANCE, SEED
from fieldmon.errors import SettingError
from fieldmon.samplers import USUAL_SAMPLER

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Sequence
    from datetime import date

    from fieldmon.drive.day import DrivenDay
    from fieldmon.drive.errand import DrivingRobot
    from fieldmon.drive.mujoco_robot import Physics
    from fieldmon.drive.recording import Recording
    from fieldmon.drive.vda5050.fleet import Vda5050Robot
    from fieldmon.drive.vda5050.mqtt import RobotName
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.planning.members import TeamMember
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot

BrokerName = Annotated[
    str, typer.Option("--broker", help="MQTT broker: HOST:PORT or mqtts://USER:PASSWORD@HOST:PORT.")
]
Serial = Annotated[str, typer.Option(help="Serial number of the robot, as in its topics.")]
RobotModel = Annotated[
    Path | None,
    typer.Option(
        "--robot-model",
        help="Model of a robot for mujoco, URDF or MJCF (docs: drive names its joints).",
    ),
]
SteeringName = Annotated[
    str,
    typer.Option(
        help="For mujoco's own robot. differential: two driven wheels. ackermann: a steered axle, "
        "which turns at corners by arcs and shunts."
    ),
]


def _too_rough(height_m: float) -> str:
    from fieldmon.drive.ground import ROUGH_M

    return ROUGH_M.broken(height_m)


Rough = Annotated[
    float,
    typer.Option(
        help="With mujoco: height of bumps in metres (standard deviation).",
        callback=refusing(_too_rough),
    ),
]
GroundHeights = Annotated[
    Path | None, typer.Option("--ground", help="With mujoco: raster of heights (GeoTIFF), metres.")
]
Version = Annotated[str, typer.Option("--vda", help="Version of VDA 5050: 2.1 or 3.0.")]
Maker = Annotated[str, typer.Option("--manufacturer", help="Manufacturer, as in its topics.")]


class Drives(StrEnum):
    """Who drives."""

    CHARGED = "charged"
    MUJOCO = "mujoco"
    VDA5050 = "vda5050"


@dataclass(frozen=True)
class DriveOptions:
    """What `fieldmon drive` is told."""

    plot: MaybePlotFile = None
    robot: Annotated[
        Drives,
        typer.Option(
            help="charged: the seconds that are charged, no physics. mujoco: wheels in a physical "
            "simulation. vda5050: a robot that takes orders over MQTT."
        ),
    ] = Drives.CHARGED
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Table of the day (CSV); a table of its stops is written beside it.",
        ),
    ] = None
    bag: Annotated[
        Path | None, typer.Option(help="Bag of ROS 2 (.mcap), for RViz and Foxglove.")
    ] = None
    records: RecordsFile = None
    feature: Feature = None
    sampler: OneSampler = USUAL_SAMPLER
    every: Every = None
    on: WorkDate = None
    infested: Annotated[
        float,
        typer.Option(
            help="Share of plants that a simulated robot finds infested.", callback=within(CHANCE)
        ),
    ] = 0.02
    seed: Annotated[
        int, typer.Option(help="Seed of simulated insects and noise.", callback=within(SEED))
    ] = 1
    gnss: Annotated[
        float,
        typer.Option(
            help="Noise of simulated positions, metres (standard deviation).",
            callback=within(0, 100, unit=" metres"),
        ),
    ] = 0.0
    robot_model: RobotModel = None
    steering: SteeringName = "differential"
    rough: Rough = 0.0
    ground: GroundHeights = None
    made_up: Annotated[
        bool,
        typer.Option("--made-up", help="Record a simulated robot's made-up finds in the season."),
    ] = False
    broker: BrokerName = "127.0.0.1:1883"
    serial: Serial = "robot1"
    manufacturer: Maker = "fieldmon"
    vda: Version = "2.1"
    worker: WorkerOptions = field(default_factory=WorkerOptions)
    files: PlotFiles = field(default_factory=PlotFiles)


#: what goes with a season too; who works, what is known and who chooses are its own
_OF_A_SEASON = {
    *("plot", "robot", "output", "bag", "on", "infested", "seed", "gnss", "robot_model"),
    *("steering", "rough", "ground", "made_up", "broker", "serial", "manufacturer", "vda"),
}


@with_options
def drive(context: typer.Context, options: DriveOptions) -> None:
    """Drive a day on a plot or in a season: plant by plant, learning from each find.

    On a plot finds are simulated, and only -o and --bag write files, also at Ctrl-C; the same
    command then begins anew.

    In a season every result is in the file before the next plant is asked for. A day is one batch,
    and after a crash the same command continues from the last plant. A simulated robot makes up
    its finds, so a season accepts them only with --made-up. A team's robots drive at once by VDA
    5050, each with its name as serial number; its scouts are left out.

    Example: fieldmon drive estate.zip --feature Gate --rover --hours 1 --robot mujoco -o driven.csv
    Example: fieldmon drive estate.zip --feature Gate --rover --robot mujoco --steering ackermann
    Example: fieldmon drive season.gpkg --robot vda5050 --broker farm.local --serial robot1
    """
    from fieldmon.monitoring.changes.transactions import is_season

    with told_to_end(as_at_ctrl_c):
        if options.plot is None or not is_season(options.plot):
            _plot(options)
            return
        refuse_what_was_chosen(context, _OF_A_SEASON)
        from fieldmon.drive.one_drive import one_drive

        if _team(context, options, options.plot):
            return
        with one_drive(options.plot, _name(options)):
            _season(options, options.plot)


def _plot(options: DriveOptions) -> None:
    """Drive a day on a plot of which nothing but records is known, and write what came of it."""
    import numpy as np

    from fieldmon.drive.day import DrivenDay, drive_day
    from fieldmon.infestation.prior.prior import prior_chance
    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.monitoring.estimates.monitor import Monitor
    from fieldmon.planning.assumptions import assumed_by
    from fieldmon.plot.local_clock import local_clock, utc_now

    _refuse_written_over(None, (options,))
    worker = options.worker.robot()
    if options.steering == "ackermann":
        from fieldmon.drive.robot_body import with_turning_radius

        worker = with_turning_radius(worker)
    known = prepared(options.files.request(options.plot, options.feature, options.records))
    plot, on = known.plot, day_on(known.plot.field, day(options.on))
    aisles, prior = plot.aisles.for_robot(worker), PriorSettings()
    chance = prior_chance(
        plot.grid, plot.field, known.records, np.datetime64(on, "D"), prior, known.risk
    )
    decides = sampler_of(options.sampler, options.every)
    monitor = Monitor(plot, decides, worker, chance, seed=options.seed)
    tell_assumed(assumed_by((), prior, worker, plot.grid))
    if told := aisles.narrow_sentence():
        typer.echo(told)
    clock, so_far = local_clock(plot.field), DrivenDay()

    def tables(*, stopped: bool) -> None:
        _write(so_far, on, options, _name(options))
        if stopped:
            typer.echo("The day is not over; the same command begins it anew.")

    with monitor.day() as today, _driver(options, plot, worker, (chance, on)) as driver:
        robot, recording = driver
        is_now = _live(robot) is not None and on == clock.today()
        begins = utc_now() if is_now else clock.moment(on, time(6))
        bag = partial(_write_bag, (recording, so_far), begins, options)
        watch = recording.note if _live(robot) is None else recording.note_live
        with _written(bag, tables), _home_when_told(robot, so_far, options.serial):
            drive_day(today, aisles, (worker, robot), watch, so_far)


def _season(options: DriveOptions, file: Path) -> None:
    """Drive what is left of a day of a season, each plant told recorded at once."""
    from fieldmon.drive.day import DrivenDay, drive_day
    from fieldmon.drive.day_clock import time_results
    from fieldmon.drive.season_day import SeasonDay
    from fieldmon.monitoring import Season
    from fieldmon.plot.local_clock import grid_clock

    if options.robot is not Drives.VDA5050 and not options.made_up:
        raise SettingError(
            f"A season takes what was found, but a {options.robot.value} robot makes its finds up. "
            "Drive a copy of the season with --made-up, or a robot with --robot vda5050."
        )
    season = Season(file)
    _refuse_written_over(season, (options,))
    on = day_on(season.plot.field, day(options.on))
    settings = season.planned_by(on)
    worker = settings.robot
    aisles = season.plot.aisles.for_robot(worker)
    is_real = options.robot is Drives.VDA5050
    made_up = "" if is_real else ", finds made up"
    today = SeasonDay(
        season, on, f"{_name(options)}{made_up}", name=options.serial if is_real else ""
    )
    tell_assumed(season.assumed(settings))
    tell_past_midnight(on, settings)
    _tell_others(season, on, today.left_out)
    _tell_before(season, on, _name(options), today.at)
    if told := aisles.narrow_sentence():
        typer.echo(told)
    if today.batch is not None:
        typer.echo(f"{on} goes on after plant {today.at} (batch {today.batch}).")
        _tell_plan(goes_on=today.goes_on)
    before = season.contents([today.batch])[today.batch].n if today.batch is not None else 0
    to, so_far = _next_part(options) if before else options, DrivenDay()

    def tables(*, stopped: bool) -> None:
        _write(so_far, on, to, _name(options), before)
        _tell_replanned(today.replanned - 1)
        if stopped:
            _tell_stopped(season, on, today.batch)

    with _driver(options, season.plot, worker, (season.morning(on), on)) as (robot, recording):

        def bag() -> None:
            begins = _begins(season, on, today.begun_s)
            _write_bag((recording, so_far), begins, to)

        with _written(bag, tables), _home_when_told(robot, so_far, options.serial):
            if told := time_results(today, grid_clock(season.plot.grid), _live(robot)):
                _say(told)
            watch = recording.note if _live(robot) is None else recording.note_live
            drive_day(today, aisles, (worker, robot), watch, so_far)


class _Tables(Protocol):
    """Writes the tables of a day, and says what came of it."""

    def __call__(self, *, stopped: bool) -> None: ...


@contextmanager
def _written(bag: Callable[[], None], tables: _Tables) -> Iterator[None]:
    """Write what was driven, whatever ends the day; at Ctrl-C end the command so."""
    try:
        try:
            yield
        finally:
            bag()
    except BaseException as end:
        tables(stopped=True)
        if isinstance(end, KeyboardInterrupt):
            raise SystemExit(STOPPED_CODE) from end  # what was written is said already
        raise
    tables(stopped=False)


def _team(context: typer.Context, options: DriveOptions, file: Path) -> bool:
    """Let a season's team drive its day by VDA 5050, a robot each; return whether it has one."""
    from fieldmon.monitoring import Season

    season = Season(file)
    on = day_on(season.plot.field, day(options.on))
    settings = season.planned_by(on)
    if not settings.team:
        return False
    if options.robot is not Drives.VDA5050:
        raise SettingError(
            f"A season's team drives by VDA 5050, but --robot is {options.robot.value}. Give "
            "--robot vda5050; fieldmon stand-in simulates the robots."
        )
    if (told := context.get_parameter_source("serial")) and told.name == "COMMANDLINE":
        names = ", ".join(one.name for one in settings.team)
        raise SettingError(
            f"A team's robots have their names as serial numbers ({names}), but --serial was given "
            "too. Leave it away, or rename them with: fieldmon change --robots"
        )
    from fieldmon.drive.one_drive import one_drive

    with one_drive(file, f"a team ({options.manufacturer})", is_team=True):
        _team_day(options, season, on, settings)
    return True


def _team_day(
    options: DriveOptions, season: Season, on: date, settings: MonitoringSettings
) -> None:
    """Let a season's team drive what is left of its day, and write what came of it."""
    from fieldmon.drive.recording import Recording
    from fieldmon.drive.team_season import TeamSeason, robots_of
    from fieldmon.drive.vda5050.mqtt import Broker
    from fieldmon.drive.vda5050.team import drive_team

    robots = robots_of(settings.team)
    own = dict(zip((one.name for one in robots), _options_of_each(options, robots), strict=True))
    _refuse_written_over(season, own.values())
    refuse_too_wide(season, settings.team)
    today = TeamSeason(season, on, options.manufacturer)
    tell_assumed(season.assumed(settings))
    tell_past_midnight(on, settings)
    _tell_left_out([one.name for one in today.team if one not in today.robots])
    if today.batch is not None:
        typer.echo(f"{on} goes on (batch {today.batch}).")
        _tell_plan(goes_on=today.goes_on)
    before = {one.name: len(season.worked(on, one.name)) for one in today.robots}
    own |= {name: _next_part(own[name]) for name, n in before.items() if n}
    recordings = {
        one.name: Recording(today.member(one.name).aisles, one.robot, season.morning(on))
        for one in today.robots
    }
    broker = Broker.of(options.broker)
    begun: dict[str, DrivenDay] = {}
    driven = begun
    try:
        driven = drive_team(today, broker, _robot_name(options), _say, recordings, begun)
    except KeyboardInterrupt:  # who would not wait
        today.stops += 1
    finally:  # whatever ended it
        for name in sorted(begun):
            _write(begun[name], on, own[name], name, before[name])
            begun_s = begun[name].begun_s
            planned_s = season.begun_s(on, name) if begun_s is None else begun_s
            begins = _begins(season, on, planned_s)
            _write_bag((recordings[name], begun[name]), begins, own[name])
    missing = dict.fromkeys(each.broken for each in driven.values() if each.broken)
    _tell_replanned(today.replanned - 1)
    if today.stops:
        _tell_stopped(season, on, today.batch)
        raise SystemExit(STOPPED_CODE)
    if missing:
        raise SettingError(" ".join(missing))


def _options_of_each(
    options: DriveOptions, robots: tuple[TeamMember, ...]
) -> Iterator[DriveOptions]:
    """Yield what each robot of a team is told: its own files, and its name as its serial."""
    from fieldmon.cli.team_files import files_of_each

    asked = [path for path in (options.output, options.bag) if path is not None]
    files = files_of_each(asked, robots) if asked else [[] for _ in robots]
    for one, paths in zip(robots, files, strict=True):
        own = iter(paths)
        output = next(own) if options.output is not None else None
        bag = next(own) if options.bag is not None else None
        yield replace(options, output=output, bag=bag, serial=one.name)


def _tell_left_out(scouts: list[str]) -> None:
    """Print who of a team does not drive."""
    if scouts:
        typer.echo(
            f"Left out, as scouts go on foot: {', '.join(scouts)}. fieldmon plan writes their "
            "routes.",
            err=True,
        )


def _tell_others(season: Season, on: date, left_out: Sequence[tuple[int, int]]) -> None:
    """Print that others are out, and what is left to them."""
    if not (codes := season.codes_on(on)):
        return
    out = "is out with a route" if len(codes) == 1 else "are out with routes"
    theirs = f"{' and '.join(codes)} {out} of their own"
    if rows := ", ".join(f"{first}-{last}" for first, last in sorted(left_out)):
        theirs += f"; the robot leaves rows {rows} to them"
    said = [f"{theirs}."]
    if None in codes.values():
        said.append("Whoever has a code for the whole plot may be sent to the same plants.")
    typer.echo(" ".join(said), err=True)


def _tell_before(season: Season, on: date, name: str, at: int) -> None:
    """Print that other robots were driven on a day, and where this one is taken to stand."""
    drives = {
        one.source.removesuffix(f" {on}")
        for one in season.batches()
        if one.kind == "findings" and not one.undone and one.source.endswith(f" {on}")
    }
    if others := sorted(other for other in drives - {name} if "/" in other):
        where = "the gate" if at < 0 else f"plant {at}, where that ended"
        were = "was" if len(others) == 1 else "were"
        typer.echo(
            f"{' and '.join(others)} {were} driven on {on} before. {name} is taken to stand at "
            f"{where}.",
            err=True,
        )


def _tell_plan(*, goes_on: bool) -> None:
    """Print by which plan a day goes on."""
    typer.echo(
        "It follows what is left of the plan given out last."
        if goes_on
        else "Planned anew: the plan given out last is done, or results or hours changed it."
    )


def _tell_replanned(n: int) -> None:
    """Print how often a day was planned anew while it was driven."""
    from fieldmon.compute.wording import counted

    if n:
        typer.echo(f"Planned anew {counted(n, 'time')} after finds or delays; each plan is kept.")


def _tell_stopped(season: Season, on: date, batch: int | None) -> None:
    """Print what is kept of a day that somebody stopped."""
    from fieldmon.compute.wording import counted

    n = counted(0 if batch is None else season.contents([batch])[batch].n, "result")
    typer.echo(f"{n} of {on} in the season; the same command goes on from there.")


def _begins(season: Season, on: date, begun_s: float) -> datetime:
    """Return the moment from which the seconds of a day's driving count."""
    from fieldmon.plot.local_clock import local_clock

    begins = datetime.combine(on, time()) + timedelta(seconds=begun_s)
    return local_clock(season.plot.field).moment(begins.date(), begins.time())


def _write_bag(noted: tuple[Recording, DrivenDay], begins: datetime, options: DriveOptions) -> None:
    """Write the bag, if asked for."""
    if options.bag is None:
        return
    from fieldmon.drive.bag import write_bag

    recording, driven = noted
    recording.end(driven)
    bag, *layouts = write_bag(recording, begins, options.bag)
    beside = " and ".join(path.name for path in layouts)
    typer.echo(f"Bag written to {bag}; layouts beside it: {beside}")


def _next_part(options: DriveOptions) -> DriveOptions:
    """Return where what is driven since a day went on is written: beside what was before.

    Tables and bag go by one number.
    """
    to, part = options, 2
    while any(file.exists() for file in (*_tables_of(to), to.bag) if file is not None):
        output, bag = (
            None if path is None else path.with_stem(f"{path.stem}-{part}")
            for path in (options.output, options.bag)
        )
        to, part = replace(options, output=output, bag=bag), part + 1
    return to


def _tables_of(options: DriveOptions) -> tuple[Path, ...]:
    """Return the tables that are written: of the day, and of its stops."""
    from fieldmon.drive.day_tables import stops_path

    return () if options.output is None else (options.output, stops_path(options.output))


@contextmanager
def _driver(
    options: DriveOptions, plot: Plot, worker: Robot, believed: tuple[Any, date]
) -> Iterator[tuple[DrivingRobot, Recording]]:
    """Yield whoever drives, and what it notes."""
    from fieldmon.drive.recording import Recording

    recording = Recording(plot.aisles.for_robot(worker), worker, believed[0])
    if options.robot is Drives.VDA5050:
        from fieldmon.drive.vda5050.fleet import live_robot
        from fieldmon.drive.vda5050.mqtt import Broker

        who = _robot_name(options)
        with live_robot(Broker.of(options.broker), who, str(believed[1]), _say) as live:
            live.sees = recording.see
            yield live, recording
        return
    from fieldmon.drive.simulated_robots import MadeUp, simulated_robot

    made_up = MadeUp(options.infested, options.seed)
    decides = sampler_of(options.sampler, options.every)
    physics = _physics(options, plot, worker)
    yield simulated_robot(options.robot.value, recording, decides, made_up, physics), recording


@contextmanager
def _home_when_told(robot: DrivingRobot, driven: DrivenDay, name: str) -> Iterator[None]:
    """Let a live robot end the plant in hand and drive home, as a team's do, when told to end.

    The second time nobody is waited for.
    """
    if (live := _live(robot)) is None:
        yield
        return
    from fieldmon.drive.vda5050.team import STOPPING

    def end() -> None:
        driven.ends += 1
        if driven.ends > 1 or not live.has_order:
            raise KeyboardInterrupt
        with suppress(RuntimeError):  # where something is being printed
            _say(STOPPING[0].format(names=name))

    live.stops = lambda: driven.ends
    try:
        with told_to_end(end, also=("SIGINT",)):
            yield
    except KeyboardInterrupt:
        if live.has_order:
            _say(f"{STOPPING[1]} The robot still ends what it was ordered last.")
        raise
    if driven.ends:
        raise KeyboardInterrupt


def _live(robot: DrivingRobot) -> Vda5050Robot | None:
    """Return a robot that is driven live; None: it is simulated."""
    from fieldmon.drive.vda5050.fleet import Vda5050Robot

    return robot if isinstance(robot, Vda5050Robot) else None


def _physics(options: DriveOptions, plot: Plot, worker: Robot) -> Physics | None:
    """Return what a robot is and meets in MuJoCo; refuse what others have no use for."""
    said = {
        "--robot-model": options.robot_model is not None,
        "--steering": options.steering != "differential",
        "--rough": options.rough != 0.0,
        "--ground": options.ground is not None,
        "--gnss": options.gnss != 0.0,
    }
    if options.robot is not Drives.MUJOCO:
        if vain := [option for option, given in said.items() if given]:
            raise SettingError(f"{vain[0]} goes with --robot mujoco: nobody else drives by it.")
        return None
    if options.ground is not None and options.rough:
        raise SettingError("Give one of --ground and --rough: heights of a raster are as they are.")
    if options.robot_model is not None and options.steering != "differential":
        raise SettingError("The joints of a --robot-model say how it steers: give no --steering.")
    from fieldmon.drive.ground import ground_of_raster, rough_ground
    from fieldmon.drive.mujoco_robot import Physics
    from fieldmon.drive.robot_body import RobotBody

    body = RobotBody.of(worker, options.steering, options.robot_model)
    heights, ground = options.ground, None
    if heights is not None:
        ground = ground_of_raster(plot.grid, plot.field, heights)
    elif options.rough:
        ground = rough_ground(plot.grid, options.rough, options.seed)
    return Physics(body, options.gnss, options.seed, ground)


def _write(driven: DrivenDay, on: date, options: DriveOptions, name: str, before: int = 0) -> None:
    """Say what a day came to, and write its tables; `before` were inspected in an earlier run."""
    from fieldmon.compute.wording import counted
    from fieldmon.drive.day_tables import day_table, in_words, stop_table

    who = f"{name}, {on}" if options.serial == name else f"{on}"
    typer.echo(f"{who}: {in_words(driven)}")
    if before:
        typer.echo(
            f"This is since it went on: {counted(before, 'inspection')} of the day before that "
            "are in the season."
        )
    if options.output is None:
        return
    from fieldmon.io.atomic_write import write_whole

    to, stops = _tables_of(options)
    write_whole(to, day_table(driven, on, name, before))
    write_whole(stops, stop_table(driven))
    typer.echo(f"Written to {to} and {stops}")


def _refuse_written_over(season: Season | None, each: Collection[DriveOptions]) -> None:
    """Refuse files that cannot be written, and tables that would replace what was filled in."""
    from fieldmon.drive.bag import require_bag
    from fieldmon.drive.day_tables import is_driven_table
    from fieldmon.io.atomic_write import require_place

    files = [file for one in each for file in _tables_of(one)]
    for file in files:
        require_place(file)
    for one in each:
        if one.bag is not None:
            require_bag(one.bag)
    refuse_unrecorded(season, [file for file in files if not is_driven_table(file)])


def _robot_name(options: DriveOptions) -> RobotName:
    from fieldmon.drive.vda5050.mqtt import RobotName
    from fieldmon.drive.vda5050.versions import known_version

    return RobotName(options.manufacturer, options.serial, known_version(options.vda))


def _name(options: DriveOptions) -> str:
    """Return what the robot is called in tables and batches."""
    if options.robot is Drives.VDA5050:
        return f"{options.manufacturer}/{options.serial}"
    return str(options.robot)


def _say(told: str) -> None:
    typer.echo(told, err=True)
