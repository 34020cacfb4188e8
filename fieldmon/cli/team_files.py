"""Who is in a team, as told, and the files that each of it is given. Heavy imports wait."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.outputs import ROUTE, write_route
from fieldmon.compute.wording import estimate
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from datetime import datetime, time

    from fieldmon.cli.worker_options import WorkerOptions
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.route import Route
    from fieldmon.plot.robot import Robot


def members_of(
    robots: str, usual: time, worker: WorkerOptions, robot: Robot | None = None
) -> tuple[tuple[TeamMember, ...], time]:
    """Return the team of ``--robots``, and the local time at which the first of it starts.

    `robot` is what those are of whom the table says no more; None: as the worker's options say.
    """
    usual_robot = worker.robot() if robot is None else robot
    from fieldmon.io.readers.team import read_team
    from fieldmon.planning.members import team_of
    from fieldmon.planning.stated_team import team_stated

    if robots.isdecimal():
        return team_of(int(robots), usual_robot), usual

    def kind(who: str) -> Robot:
        if who == "scout" or (who == "robot" and (worker.scout or usual_robot.on_foot)):
            return replace(worker, scout=who == "scout").robot()
        return usual_robot

    members, first = team_stated(read_team(Path(robots)), usual, kind)
    _tell_team(members)
    return members, first


def _tell_team(members: Sequence[TeamMember]) -> None:
    """Say what a table was taken for: lines may leave out what the options say."""
    said = "; ".join(
        f"{one.name}, {'scout' if one.robot.on_foot else 'robot'}, {one.robot.hours:g} h"
        f"{_wide(one.robot)}"
        for one in members
    )
    typer.echo(f"seen: The team is {said}.", err=True)


def _wide(robot: Robot) -> str:
    return "" if robot.width_m is None else f", {robot.width_m:g} m wide"


def files_of_each(outputs: list[Path] | None, members: tuple[TeamMember, ...]) -> list[list[Path]]:
    """Return the files of each member: those asked for, with its name."""
    from fieldmon.io.writers.file_names import plain_name

    names = [plain_name(member.name) for member in members]
    if len({name.casefold() for name in names}) < len(names):
        raise SettingError(
            f"Members must have names that differ in file names, but they are {', '.join(names)}."
        )
    made = []
    for name in names:
        parts = [(path, *path.name.partition(".")) for path in outputs or [ROUTE]]
        made.append(
            [path.with_name(f"{stem}-{name}{dot}{rest}") for path, stem, dot, rest in parts]
        )
    return made


def tell_member(name: str, start: datetime, route: Route) -> None:
    """Say what one of a team is to do."""
    stops = route.aisles.grid.counted(len(route))
    typer.echo(
        f"{name}: from {start:%H:%M}, {stops} in {route.end_s / 3600:.1f} h, "
        f"{route.drive_m / 1000:.2f} km; about {estimate(route.expected_finds)} finds."
    )
    for said in route.ways_said:
        typer.echo(f"{name}: {said}")


def write_member(name: str, route: Route, paths: list[Path], language: str = "") -> None:
    """Write the route of one of a team, if it has one, and say where, as `write_routes`."""
    if not len(route):
        typer.echo(f"{name} has no route: its hours are over, or the others leave it none in them.")
        return
    for path in paths:
        for written in write_route(route, path, language):
            typer.echo(f"Route of {name} written to {written}")
