"""`fieldmon drive`: a day driven, simulated or live. Heavy imports wait."""

from __future__ import annotations

from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import typer

from fieldmon.cli.drive_messages import (
    say,
    tell_before,
    tell_others,
    tell_plan,
    tell_replanned,
    tell_stopped,
)
from fieldmon.cli.drive_options import DriveOptions, Drives
from fieldmon.cli.drive_team import drive_as_team
from fieldmon.cli.driven_files import (
    moment_begun,
    next_part,
    refuse_written_over,
    write_bag_of,
    write_tables,
)
from fieldmon.cli.files_to_plot import prepared
from fieldmon.cli.messages import tell_assumed, tell_past_midnight
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.options import sampler_of
from fieldmon.cli.season_files import is_told, refuse_what_was_chosen, season_of
from fieldmon.cli.stopped import STOPPED_CODE
from fieldmon.cli.times import clock, day, day_on
from fieldmon.cli.told_to_end import as_at_ctrl_c, told_to_end
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from datetime import date

    from fieldmon.drive.day import DrivenDay
    from fieldmon.drive.errand import DrivingRobot
    from fieldmon.drive.mujoco_robot import Physics
    from fieldmon.drive.recording import Recording
    from fieldmon.drive.vda5050.fleet import Vda5050Robot
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot

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
            if options.robot is Drives.VDA5050 and is_told(context, "start"):
                raise SettingError(
                    "--start goes with a simulated robot: a live one begins with its order."
                )
            _plot(options)
            return
        refuse_what_was_chosen(context, _OF_A_SEASON)
        from fieldmon.drive.one_drive import one_drive

        if drive_as_team(context, options, options.plot):
            return
        with one_drive(options.plot, options.name):
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

    starts = clock(options.start)
    refuse_written_over(None, (options,))
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
    local, so_far = local_clock(plot.field), DrivenDay()

    def tables(*, stopped: bool) -> None:
        write_tables(so_far, on, options, options.name)
        if stopped:
            typer.echo("The day is not over; the same command begins it anew.")

    with monitor.day() as today, _driver(options, plot, worker, (chance, on)) as driver:
        robot, recording = driver
        is_now = _live(robot) is not None and on == local.today()
        begins = utc_now() if is_now else local.moment(on, starts)
        bag = partial(write_bag_of, (recording, so_far), begins, options)
        watch = recording.note if _live(robot) is None else recording.note_live
        with _written(bag, tables), _home_when_told(robot, so_far, options.serial):
            drive_day(today, aisles, (worker, robot), watch, so_far)


def _season(options: DriveOptions, file: Path) -> None:
    """Drive what is left of a day of a season, each plant told recorded at once."""
    from fieldmon.drive.day import DrivenDay, drive_day
    from fieldmon.drive.day_clock import time_results
    from fieldmon.drive.season_day import SeasonDay
    from fieldmon.plot.local_clock import grid_clock

    if options.robot is not Drives.VDA5050 and not options.made_up:
        raise SettingError(
            f"A season takes what was found, but a {options.robot.value} robot makes its finds up. "
            "Drive a copy of the season with --made-up, or a robot with --robot vda5050."
        )
    season = season_of(file)
    refuse_written_over(season, (options,))
    on = day_on(season.plot.field, day(options.on))
    settings = season.planned_by(on)
    worker = settings.robot
    aisles = season.plot.aisles.for_robot(worker)
    is_real = options.robot is Drives.VDA5050
    made_up = "" if is_real else ", finds made up"
    today = SeasonDay(
        season, on, f"{options.name}{made_up}", name=options.serial if is_real else ""
    )
    tell_assumed(season.assumed(settings))
    tell_past_midnight(on, settings)
    tell_others(season, on, today.left_out)
    tell_before(season, on, options.name, today.at)
    if told := aisles.narrow_sentence():
        typer.echo(told)
    if today.batch is not None:
        typer.echo(f"{on} goes on after plant {today.at} (batch {today.batch}).")
        tell_plan(goes_on=today.goes_on)
    before = season.contents([today.batch])[today.batch].n if today.batch is not None else 0
    to, so_far = next_part(options) if before else options, DrivenDay()

    def tables(*, stopped: bool) -> None:
        write_tables(so_far, on, to, options.name, before)
        tell_replanned(today.replanned - 1)
        if stopped:
            tell_stopped(season, on, today.batch)

    with _driver(options, season.plot, worker, (season.morning(on), on)) as (robot, recording):

        def bag() -> None:
            begins = moment_begun(season, on, today.begun_s)
            write_bag_of((recording, so_far), begins, to)

        with _written(bag, tables), _home_when_told(robot, so_far, options.serial):
            if told := time_results(today, grid_clock(season.plot.grid), _live(robot)):
                say(told)
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

        who = options.robot_name()
        with live_robot(Broker.of(options.broker), who, str(believed[1]), say) as live:
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
            say(STOPPING[0].format(names=name))

    live.stops = lambda: driven.ends
    try:
        with told_to_end(end, also=("SIGINT",)):
            yield
    except KeyboardInterrupt:
        if live.has_order:
            say(f"{STOPPING[1]} The robot still ends what it was ordered last.")
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
