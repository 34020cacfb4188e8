"""`fieldmon study prior`: the thesis's chapter 5, made again. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.files_to_plot import prepared
from fieldmon.cli.messages import Terminal
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import StudySeed
from fieldmon.cli.pest_options import PestName, pest_in_weather_of
from fieldmon.cli.progress import counting
from fieldmon.cli.study_output import can_be_folder, tell_not_read, write_all
from fieldmon.compute.ranges import SEASONS
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.studies.thesis.chapter5.open_choices import OpenChoices
    from fieldmon.studies.thesis.chapter5.sites import Site
    from fieldmon.studies.thesis.chapter5.study import PriorStudy


@dataclass(frozen=True)
class PriorOptions:
    """What `fieldmon study prior` is told."""

    scenario: Annotated[list[str] | None, typer.Option(help="A, B or C; repeat for more.")] = None
    sweep: Annotated[
        list[str] | None,
        typer.Option(help="size, spread, time or detection; repeat for more."),
    ] = None
    seeds: Annotated[
        int, typer.Option(help="Paired seasons of each configuration.", callback=within(SEASONS))
    ] = 100
    seed: StudySeed = 1
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for tables and report.")
    ] = Path()
    maps: Annotated[
        Path | None,
        typer.Option(
            help="Folder of mapped plants, public ones or NAME.map.csv (docs: strategies): run "
            "the samplers on those real maps instead."
        ),
    ] = None
    plot: Annotated[
        Path | None, typer.Option(help="Plot file: run the samplers on that plot instead.")
    ] = None
    feature: Annotated[str | None, typer.Option(help="Which plot of the file.")] = None
    records: Annotated[
        Path | None, typer.Option(help="Pest records of that plot, from which seasons start.")
    ] = None
    pest: PestName = None

    @property
    def choices(self) -> OpenChoices:
        """Return what the thesis leaves open; with the pest that was named instead of its rule."""
        from dataclasses import replace

        from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED

        if self.pest is None:
            return CALIBRATED
        if self.maps is not None:
            raise SettingError("--pest goes without --maps: on mapped plants nothing spreads.")
        return replace(CALIBRATED, pest=pest_in_weather_of(self.pest))


@with_options
def prior(options: PriorOptions) -> None:
    """Run Dynamic, Naive and Bouncy with prior information; compare with the published figures.

    Without --scenario and --sweep, all of them are run. Ctrl-C keeps what is done. --plot and
    --maps run them on your own plot, or on mapped plants, with the same rules. With --pest that
    pest, at the temperature of its figures, replaces the thesis's rule, and nothing is compared
    with the thesis.

    Example: fieldmon study prior --scenario C --seeds 100 -o study
    """
    can_be_folder(options.output)
    choices = options.choices
    if options.maps is not None:
        _on_maps(options.maps, options)
    elif options.plot is not None:
        _on_plot(options.plot, options, choices)
    else:
        _as_published(options, choices)


def _as_published(options: PriorOptions, choices: OpenChoices) -> None:
    """Run what the thesis ran, and compare the figures."""
    from fieldmon.studies.thesis.chapter5.published import PARTS
    from fieldmon.studies.thesis.chapter5.report import report_html
    from fieldmon.studies.thesis.chapter5.study import rows, run_prior
    from fieldmon.studies.tidy_csv import csv_text

    parts = (*(options.scenario or []), *(options.sweep or [])) or PARTS
    with counting("Simulating") as count:
        made = run_prior(parts, options.seeds, options.seed, choices, count)
    _tell(made)
    name = "prior" if parts == PARTS else "prior_" + "_".join(parts)
    written = {f"{name}.csv": csv_text(rows(made)), f"{name}.html": report_html(made)}
    if choices.pest is None:
        written[f"{name}_published.csv"] = csv_text(made.compared)
    write_all(options.output, written)


def _on_maps(folder: Path, options: PriorOptions) -> None:
    """Run the samplers on mapped plants."""
    from fieldmon.compute.wording import counted
    from fieldmon.plot.robot import Robot
    from fieldmon.studies.plant_maps import PUBLIC_MAPS, read_plant_maps
    from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
    from fieldmon.studies.thesis.chapter5.mapped_plots import MapRules, run_maps
    from fieldmon.studies.thesis.chapter5.report import maps_html
    from fieldmon.studies.tidy_csv import csv_text

    rules = MapRules(Robot().with_times("thesis"), CALIBRATED.spread)
    maps = read_plant_maps(folder)
    tell_not_read(folder, tuple(PUBLIC_MAPS))
    for each in maps:
        if unknown := int((~each.known).any(axis=0).sum()):
            typer.echo(f"{each.name}: {counted(unknown, 'plant')} of unknown state left out")
    with counting("Inspecting") as count:
        table = run_maps(maps, rules, options.seeds, options.seed, count)
    for row in table:
        if row.visited_pct == 0.0 and row.sampler == table[0].sampler and not row.infested:
            typer.echo(f"{f'{row.map} {row.date}'.rstrip()}: no plant is infested")
        if row.visited_pct == 25.0 and row.seeds and row.infested:
            typer.echo(
                f"{row.map} {row.date}: {row.sampler} finds {row.mean:.0f} % of {row.infested} "
                "infested plants (less those found before) in the first 25 % visited"
            )
    written = {"prior_maps.csv": csv_text(table), "prior_maps.html": maps_html(table)}
    write_all(options.output, written)


def _on_plot(plot: Path, options: PriorOptions, choices: OpenChoices) -> None:
    """Run the samplers on a plot of one's own."""
    from fieldmon.studies.thesis.chapter5.report import report_html
    from fieldmon.studies.thesis.chapter5.study import rows, run_site
    from fieldmon.studies.tidy_csv import csv_text

    site = site_of(plot, options.feature, options.records)
    with counting("Simulating") as count:
        made = run_site(site, options.seeds, options.seed, choices, count)
    for part in made.parts:
        for runs in part.runs:
            typer.echo(
                f"{part.title}: {runs.trial.sampler} finds {runs.end_pct.mean():.0f} % in 25 days"
            )
    written = {"prior_plot.csv": csv_text(rows(made)), "prior_plot.html": report_html(made)}
    write_all(options.output, written)


def site_of(file: Path, feature: str | None, records: Path | None) -> Site:
    """Return a plot of a file; its records' chance map if there are any, on their last day."""
    import numpy as np

    from fieldmon.infestation.prior.prior import prior_chance
    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.io.options import PlotOptions
    from fieldmon.io.plot_request import PlotRequest, PlotSources, RecordSource
    from fieldmon.studies.thesis.chapter5.sites import Site

    sources = PlotSources(file, PlotOptions(feature=feature))
    asked = None if records is None else RecordSource(records)
    known = prepared(PlotRequest(sources, records=asked), Terminal(flags={}, takes_rows=False))
    plot = known.plot
    if records is None:
        return Site(plot.field.name, plot.aisles, plot.field)
    days = known.records.day
    dated = days[~np.isnat(days)]
    last = dated.max() if dated.size else np.datetime64("today", "D")
    chance = prior_chance(plot.grid, plot.field, known.records, last, PriorSettings())
    return Site(plot.field.name, plot.aisles, plot.field, chance)


def _tell(study: PriorStudy) -> None:
    if study.stopped:
        typer.echo("Stopped: these are the configurations that were done.")
    for part in study.parts:
        typer.echo(f"\n{part.title}")
        for each in part.compared:
            typer.echo(
                f"  {each.what}: published {each.published}, ours {each.ours:.1f} "
                f"({each.low:.1f} to {each.high:.1f}), {each.difference:+.1f}, {each.verdict}"
            )
