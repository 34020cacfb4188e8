"""`fieldmon plan --robots`: a day of several robots and scouts. Heavy imports wait."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.files_to_plot import believed, prepared
from fieldmon.cli.messages import tell_assumed
from fieldmon.cli.outputs import write_chance_map
from fieldmon.cli.pest_options import prior_of
from fieldmon.cli.progress import counting
from fieldmon.cli.season_files import is_told, refuse_unrecorded
from fieldmon.cli.team_files import (
    files_of_each,
    members_of,
    tell_member,
    write_member,
)
from fieldmon.cli.times import WorkStart
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.cli.plan_options import PlanOptions
    from fieldmon.planning.team import TeamPlan


def plan_team(context: typer.Context, options: PlanOptions, robots: str) -> None:
    """Plan a day of a team on one plot, and write a file for each."""
    from fieldmon.planning import team
    from fieldmon.planning.assumptions import assumed_by_team

    for name in ("sampler", "every", "every_plot"):
        if is_told(context, name):
            flag = "all" if name == "every_plot" else name
            raise SettingError(f"--robots plans best routes on one plot: leave out --{flag}.")
    members, first = members_of(robots, options.starts().at, options.worker)
    starts, files = WorkStart(options.starts().on, first), files_of_each(options.output, members)
    refuse_unrecorded(None, (file for each in files for file in each))
    known = prepared(options.files.request(options.plot, options.feature, options.records))
    plot, begins = known.plot, starts.on_plot(known.plot.field)
    pest_in_weather = options.pest_options.in_weather(plot.field, begins.date())
    prior = prior_of(pest_in_weather, begins.date(), options.background)
    members = tuple(replace(one, robot=options.pest_options.seen(one.robot)) for one in members)
    chance = believed(known, begins.date(), prior)
    with counting("Routes") as count:
        planned = team.plan_team(
            plot, chance, members, progress=count, passing_m=options.passing or 0.0, on=begins
        )
    _tell(planned)
    tell_assumed(assumed_by_team((), prior, members, plot.grid))
    for member, route, paths in zip(planned.members, planned.routes, files, strict=True):
        write_member(member.name, route, paths)
    write_chance_map(options.chance_map, plot, chance)


def _tell(planned: TeamPlan) -> None:
    for member, route in zip(planned.members, planned.routes, strict=True):
        if route.notes is not None and route.notes.start is not None:
            tell_member(member.name, route.notes.start, route)
    typer.echo(f"{planned.sentence}\nPlanned as best routes, which no find changes.")
