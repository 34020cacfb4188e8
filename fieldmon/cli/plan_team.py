"""`fieldmon plan --robots`: a day of several robots and scouts. Heavy imports wait."""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.messages import tell_assumed, tell_unusable
from fieldmon.cli.outputs import write_chance_map
from fieldmon.cli.preparing import prepared
from fieldmon.cli.times import WorkStart, clock
from fieldmon.cli.waiting import counting
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from datetime import datetime, time

    from fieldmon.cli.plan import PlanOptions
    from fieldmon.planning.team import TeamMember, TeamPlan

_NOT_IN_A_NAME = re.compile(r"[^\w-]+")


def plan_team(context: typer.Context, options: PlanOptions, robots: str) -> None:
    """Plan a day of a team on one plot, and write a file for each."""
    import numpy as np  # noqa: PLC0415

    from fieldmon.infestation.prior import PriorSettings, prior_chance  # noqa: PLC0415
    from fieldmon.planning import team  # noqa: PLC0415
    from fieldmon.planning.assumptions import assumed_by  # noqa: PLC0415

    for name in ("sampler", "every", "every_plot"):
        source = context.get_parameter_source(name)
        if source is not None and source.name == "COMMANDLINE":
            flag = "all" if name == "every_plot" else name
            raise SettingError(f"--robots plans best routes on one plot: leave out --{flag}.")
    members, first = _members(options, robots)
    starts, files = WorkStart(options.starts().on, first), _files(options.output, members)
    known = prepared(options.files.request(options.plot, options.feature, options.observations))
    plot, prior = known.plot, PriorSettings()
    begins = starts.on_plot(plot.field)
    on = np.datetime64(begins.date(), "D")
    tell_unusable(known.records, on)
    chance = prior_chance(plot.grid, plot.field, known.records, on, prior, known.risk)
    with counting("Routes") as count:
        planned = team.plan_team(plot, chance, members, progress=count)
    _tell(planned, begins)
    assumed = (one for member in members for one in assumed_by((), prior, member.robot, plot.grid))
    tell_assumed({str(one): one for one in assumed}.values())
    _write(planned, begins, plot.field.name, files)
    write_chance_map(options.chance_map, plot, chance)


def _members(options: PlanOptions, robots: str) -> tuple[tuple[TeamMember, ...], time]:
    """Return the team, and the local time at which the first of it starts."""
    from fieldmon.io.readers.team import read_team  # noqa: PLC0415
    from fieldmon.planning.team import TeamMember, team_of  # noqa: PLC0415

    usual, worker = options.starts().at, options.worker
    if robots.isdigit():
        return team_of(int(robots), worker.robot()), usual
    stated = read_team(Path(robots))
    starts = [usual if one.start is None else clock(one.start, "start") for one in stated]
    first = min(starts)
    members = [
        TeamMember(
            one.name,
            replace(replace(worker, scout=worker.scout or one.scout).robot(), **one.settings),  # type: ignore[arg-type]
            one.gate,
            60.0 * (60 * (start.hour - first.hour) + start.minute - first.minute),
        )
        for one, start in zip(stated, starts, strict=True)
    ]
    return tuple(members), first


def _files(outputs: list[Path] | None, members: tuple[TeamMember, ...]) -> list[list[Path]]:
    """Return the files of each member: those asked for, with its name."""
    names = [_NOT_IN_A_NAME.sub("_", member.name) for member in members]
    if len({name.casefold() for name in names}) < len(names):
        raise SettingError(
            f"Members must have names that differ in file names, but they are {', '.join(names)}."
        )
    made = []
    for name in names:
        parts = [(path, *path.name.partition(".")) for path in outputs or [Path("route.geojson")]]
        made.append(
            [path.with_name(f"{stem}-{name}{dot}{rest}") for path, stem, dot, rest in parts]
        )
    return made


def _tell(planned: TeamPlan, begins: datetime) -> None:
    for member, day, starts_s in zip(planned.members, planned.days, planned.starts_s, strict=True):
        route = day.route
        start = begins + timedelta(seconds=round(float(starts_s)))
        typer.echo(
            f"{member.name}: from {start:%H:%M}, {len(route)} plants in "
            f"{route.end_s / 3600:.1f} h, {route.drive_m / 1000:.2f} km; "
            f"about {route.expected_found:.1f} finds."
        )
    typer.echo(planned.sentence)


def _write(planned: TeamPlan, begins: datetime, plot: str, files: list[list[Path]]) -> None:
    from fieldmon.io.writers.geojson import RouteNotes  # noqa: PLC0415

    parts = zip(planned.members, planned.days, planned.starts_s, files, strict=True)
    for member, day, starts_s, paths in parts:
        if not len(day.route):
            typer.echo(f"{member.name} has no route: the others leave it none in its hours.")
            continue
        start = begins + timedelta(seconds=round(float(starts_s)))
        route = replace(day.route, notes=RouteNotes(plot, "best routes", start, member.name))
        for path in paths:
            for written in route.to_file(path):
                typer.echo(f"Route of {member.name} written to {written}")
