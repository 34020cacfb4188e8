"""`fieldmon plan`: a day on a plot, on every plot of a file, or of a season. Heavy imports wait."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.files_to_plot import estate, prepared
from fieldmon.cli.messages import tell_assumed, tell_unusable
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.options import (
    sampler_of,
)
from fieldmon.cli.outputs import (
    ROUTE,
    check_outputs,
    day_in_words,
    write_chance_map,
    write_routes,
)
from fieldmon.cli.pest_options import prior_of
from fieldmon.cli.plan_options import PlanOptions
from fieldmon.cli.plan_season import plan_season
from fieldmon.cli.plan_team import plan_team
from fieldmon.cli.season_files import refuse_unrecorded
from fieldmon.errors import SettingError
from fieldmon.samplers.own import label_of

if TYPE_CHECKING:
    from fieldmon.io.plot_request import PlotRequest

# how far below what no route can exceed a plan says that another one may find more
_FAR_BELOW = 0.05


@with_options
def plan(context: typer.Context, options: PlanOptions) -> None:
    """Plan today's route on a plot or in a season, and write it to files.

    A route file holds the line to drive, which crosses no row of plants, and the stops in order,
    with arrival time, row, plant and chance of infestation. Without records every plant has
    the same chance, except at the plot's edge, from which insects come.

    In a season (see fieldmon init) the route uses everything recorded so far. If something was
    already recorded on that day, the rest of the day is planned. Plants where people may not be
    yet after a treatment are left out.

    Example: fieldmon plan vines.zip --feature 3 --records mites.csv --hours 6 -o route.geojson
    Example: fieldmon plan season.gpkg -o route.geojson
    Example: fieldmon plan vines.zip --feature 3 --robots 2 --hours 4 -o route.geojson
    Example: fieldmon plan estate.zip --all --records mites.csv -o routes

    For a whole day, it also states how much any other route of the same hours could gain at most.

    With --pest, that pest's detection rate is used. With --weather, a record counts half after one
    generation of the pest.

    With --robots, no plant is visited twice, and no two robots are in one aisle at once.

    With --all, columns robot (robot or scout), hours, speed_km_h and look_s of the plot file say
    who works on each plot. Options given here override them.
    """
    from fieldmon.monitoring.changes.transactions import is_season

    if not options.every_plot:
        check_outputs(options.output, options.chance_map)
    if options.plot is not None and is_season(options.plot):
        _refuse_what_a_season_keeps(options)
        plan_season(context, options, options.plot)
        return
    if options.now is not None:
        raise SettingError("--now needs a season (see fieldmon init), but this is a plot file.")
    for flag, is_given in (
        ("--as-now", options.as_now),
        ("--enter-treated", options.enter_treated),
    ):
        if is_given:
            raise SettingError(
                f"{flag} needs a season (see fieldmon init), but this is a plot file."
            )
    if options.passing is not None and options.robots is None:
        raise SettingError("--passing goes with --robots: one alone meets nobody.")
    if options.robots is not None:
        plan_team(context, options, options.robots)
    elif options.every_plot:
        _plan_every_plot(options)
    else:
        _plan_one(options)


def _refuse_what_a_season_keeps(options: PlanOptions) -> None:
    for flag, given in (("--robots", options.robots), ("--background", options.background)):
        if given is not None:
            raise SettingError(
                f"{flag} goes with a plot file, but this is a season, which keeps it. Change it "
                f"with: fieldmon change {flag}"
            )


def _plan_one(options: PlanOptions) -> None:
    import numpy as np

    from fieldmon.io.writers.day_file import RouteNotes
    from fieldmon.planning.assumptions import assumed_by
    from fieldmon.planning.bound_wording import share_above
    from fieldmon.planning.day_bound import with_bound
    from fieldmon.planning.plan import PlanSettings, first_day

    refuse_unrecorded(None, options.output or [ROUTE])
    robot, starts = options.pest_options.seen(options.worker.robot()), options.starts()
    request = options.files.request(options.plot, options.feature, options.records)
    known = prepared(request)
    begins = starts.on_plot(known.plot.field)
    on = np.datetime64(begins.date(), "D")
    pest_in_weather = options.pest_options.in_weather(known.plot.field, begins.date())
    sampler, name = sampler_of(options.sampler, options.every), label_of(options.sampler)
    prior = prior_of(pest_in_weather, begins.date(), options.background)
    settings = PlanSettings(robot, sampler, prior)
    tell_unusable(known.records, on, prior)
    today = first_day(known.plot, known.records, on, settings, known.risk)
    if not len(today.route):
        raise SettingError(
            f"The working day must be long enough to reach a plant and come back, but "
            f"{robot.hours:g} h are not. Give more --hours."
        )
    if options.bound:
        today = with_bound(today)
    typer.echo(f"{day_in_words(today.route)}\nPlanned by {name}.")
    route = today.route
    if route.found_bound and share_above(route.expected_finds, route.found_bound) > _FAR_BELOW:
        typer.echo(
            "If nobody plans again after a find, a fixed route may find more: add --robots 1."
        )
    tell_assumed(assumed_by((), settings.prior, robot, known.plot.grid))
    notes = RouteNotes(known.plot.field.name, name, begins)
    write_routes(replace(today.route, notes=notes), options.output)
    write_chance_map(options.chance_map, known.plot, today.chance)


def _plan_every_plot(options: PlanOptions) -> None:
    """Plan every plot of the file into a folder."""
    import numpy as np

    from fieldmon.cli.plan_all import EstateDay, plan_all
    from fieldmon.planning.many_plots import Orders

    worker, starts = options.worker, options.starts()
    # what cannot be is refused before any plot is read
    worker.robot()
    sampler_of(options.sampler, options.every)
    request, folder = _request_of_all(options), _folder(options.output)
    plots = estate(request)
    begins = starts.on_plot(plots.fields[0])
    pest_in_weather = options.pest_options.in_weather(plots.fields[0], begins.date())
    orders = Orders(
        day=np.datetime64(begins.date(), "D"),
        sampler=options.sampler,
        every=options.every,
        on_foot=worker.scout,
        robot=worker.given(),
        planting=request.planting.given(),
        bound=options.bound,
        prior=prior_of(pest_in_weather, begins.date(), options.background),
        pest=None if pest_in_weather is None else pest_in_weather.pest,
        rover=worker.rover,
        robot_times=worker.robot_times,
        at=starts.at,
    )
    tell_unusable(plots.records.anywhere, orders.day, orders.prior)
    plan_all(plots, orders, EstateDay(plots.records, folder, begins))


def _request_of_all(options: PlanOptions) -> PlotRequest:
    """Return what to prepare for every plot; refuse what is of one plot only."""
    files, rasters = options.files.files, options.files.rasters
    of_one = options.feature, files.plants, files.gate, rasters.risk, rasters.canopy
    no_rows = options.files.rows.no_rows
    if options.plot is None or any((*of_one, options.chance_map, no_rows)):
        raise SettingError(
            "--all plans every plot of one plot file: leave out --feature, --plants, --gate, "
            "--risk, --canopy, --chance-map and --no-rows."
        )
    return options.files.request(options.plot, None, options.records)


def _folder(outputs: list[Path] | None) -> Path:
    """Return where the routes of all plots go."""
    if outputs and (len(outputs) > 1 or outputs[0].suffix):
        raise SettingError("With --all, --output must be one folder for the routes of all plots.")
    return outputs[0] if outputs else Path("routes")
