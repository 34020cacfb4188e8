"""A season's team drives its day by VDA 5050, a robot each. Heavy imports wait."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.drive_messages import say, tell_left_out, tell_plan, tell_replanned, tell_stopped
from fieldmon.cli.drive_options import Drives
from fieldmon.cli.driven_files import (
    moment_begun,
    next_part,
    refuse_written_over,
    write_bag_of,
    write_tables,
)
from fieldmon.cli.messages import tell_assumed, tell_past_midnight
from fieldmon.cli.season_files import is_told, refuse_too_wide, season_of
from fieldmon.cli.stopped import STOPPED_CODE
from fieldmon.cli.times import day, day_on
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from datetime import date
    from pathlib import Path

    from fieldmon.cli.drive_options import DriveOptions
    from fieldmon.drive.day import DrivenDay
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.planning.members import TeamMember


def drive_as_team(context: typer.Context, options: DriveOptions, file: Path) -> bool:
    """Let a season's team drive its day by VDA 5050, a robot each; return whether it has one."""
    season = season_of(file)
    on = day_on(season.plot.field, day(options.on))
    settings = season.planned_by(on)
    if not settings.team:
        return False
    if options.robot is not Drives.VDA5050:
        raise SettingError(
            f"A season's team drives by VDA 5050, but --robot is {options.robot.value}. Give "
            "--robot vda5050; fieldmon stand-in simulates the robots."
        )
    if is_told(context, "serial"):
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
    refuse_written_over(season, own.values())
    refuse_too_wide(season, settings.team)
    today = TeamSeason(season, on, options.manufacturer)
    tell_assumed(season.assumed(settings))
    tell_past_midnight(on, settings)
    tell_left_out([one.name for one in today.team if one not in today.robots])
    if today.batch is not None:
        typer.echo(f"{on} goes on (batch {today.batch}).")
        tell_plan(goes_on=today.goes_on)
    before = {one.name: len(season.work(on, one.name).inspections) for one in today.robots}
    own |= {name: next_part(own[name]) for name, n in before.items() if n}
    recordings = {
        one.name: Recording(today.member(one.name).aisles, one.robot, season.morning(on))
        for one in today.robots
    }
    broker = Broker.of(options.broker)
    begun: dict[str, DrivenDay] = {}
    driven = begun
    try:
        driven = drive_team(today, broker, options.robot_name(), say, recordings, begun)
    except KeyboardInterrupt:  # who would not wait
        today.stops += 1
    finally:  # whatever ended it
        for name in sorted(begun):
            write_tables(begun[name], on, own[name], name, before[name])
            begun_s = begun[name].begun_s
            planned_s = season.work(on, name).begun_s if begun_s is None else begun_s
            begins = moment_begun(season, on, planned_s)
            write_bag_of((recordings[name], begun[name]), begins, own[name])
    missing = dict.fromkeys(each.broken for each in driven.values() if each.broken)
    tell_replanned(today.replanned - 1)
    if today.stops:
        tell_stopped(season, on, today.batch)
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
