"""`fieldmon study prior` and `fieldmon study calibrate`: the thesis's chapter 5, made again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.waiting import progress, shown
from fieldmon.errors import ChoiceNeeded, FileProblem

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.studies.thesis.chapter5.calibrate import FittedChoices
    from fieldmon.studies.thesis.chapter5.sites import Site
    from fieldmon.studies.thesis.chapter5.study import PriorStudy

_Folder = Annotated[Path, typer.Option("--output", "-o", help="Folder for tables and report.")]
_Seed = Annotated[int, typer.Option(help="The same seed, the same figures.")]


def register(app: typer.Typer) -> None:
    """Add the commands of chapter 5 to ``fieldmon study``."""
    app.command("prior")(prior)
    app.command("calibrate")(calibrate)


def prior(  # noqa: PLR0913, PLR0917 - a command's options are its arguments
    scenario: Annotated[
        list[str] | None, typer.Option(help="A, B or C; may be given again.")
    ] = None,
    sweep: Annotated[
        list[str] | None,
        typer.Option(help="size, spread, time or detection; may be given again."),
    ] = None,
    seeds: Annotated[int, typer.Option(help="Paired seasons of each configuration.")] = 100,
    seed: _Seed = 1,
    output: _Folder = Path(),
    maps: Annotated[
        Path | None,
        typer.Option(help="Folder of mapped plants: run the samplers on those real maps instead."),
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Plot file: run the samplers on that plot instead.")
    ] = None,
    feature: Annotated[str | None, typer.Option(help="Which plot of the file.")] = None,
    observations: Annotated[
        Path | None, typer.Option(help="Pest records of that plot: they seed the start.")
    ] = None,
) -> None:
    """Run Dynamic, Naive and Bouncy with prior information beside the published figures.

    Without --scenario and --sweep all of them. Ctrl-C keeps what is done. With --plot or --maps
    on your own plot, or on mapped plants, with the same rules.

    Example: fieldmon study prior --scenario C --seeds 100 -o study
    """
    from fieldmon.studies.thesis.chapter5.published import PARTS  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter5.report import report_html  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter5.study import rows, run_prior  # noqa: PLC0415
    from fieldmon.studies.tidy_csv import csv_text  # noqa: PLC0415

    _must_be_folder(output)
    if maps is not None:
        _on_maps(maps, seeds, seed, output)
        return
    if plot is not None:
        _on_plot((plot, feature, observations), seeds, seed, output)
        return
    parts = (*(scenario or []), *(sweep or [])) or PARTS
    with progress("Simulating") as bar:
        made = run_prior(parts, seeds, seed, progress=shown(bar))
    _tell(made)
    name = "prior" if parts == PARTS else "prior_" + "_".join(parts)
    _write(
        output,
        {
            f"{name}.csv": csv_text(rows(made)),
            f"{name}_published.csv": csv_text(made.compared),
            f"{name}.html": report_html(made),
        },
    )


def calibrate(
    drawn: Annotated[int, typer.Option(help="Open choices drawn at first.")] = 500,
    kept: Annotated[int, typer.Option(help="How many of them are tried on everything.")] = 20,
    steps: Annotated[int, typer.Option(help="Steps of improving one choice or two.")] = 400,
    seeds: Annotated[int, typer.Option(help="Paired seasons in the final comparison.")] = 20,
    seed: _Seed = 1,
    output: _Folder = Path(),
) -> None:
    """Search what the thesis leaves open for the best fit to its published figures.

    Tells the best joint fit, the best fit of each part alone, and which parts conflict. Takes
    about half an hour on two cores; Ctrl-C keeps what was tried on everything.
    """
    from fieldmon.studies.thesis.chapter5.calibrate import Effort, candidates_csv  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter5.calibrate import calibrate as search  # noqa: PLC0415

    _must_be_folder(output)
    effort = Effort(drawn=drawn, kept=kept, steps=steps, final_seeds=seeds)
    with progress("Searching") as bar:
        found = search(effort, seed, shown(bar))
    _tell_fit(found)
    _write(output, {"prior_calibration.csv": candidates_csv(found.tried)})


def _on_maps(folder: Path, seeds: int, seed: int, output: Path) -> None:
    from fieldmon.plot.robot import Robot  # noqa: PLC0415
    from fieldmon.studies.plant_maps import read_plant_maps  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter5.mapped_plots import MapRules, run_maps  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter5.report import maps_html  # noqa: PLC0415
    from fieldmon.studies.tidy_csv import csv_text  # noqa: PLC0415

    rules = MapRules(Robot(), CALIBRATED.spread)
    maps = read_plant_maps(folder)
    with progress("Inspecting") as bar:
        table = run_maps(maps, rules, seeds, seed, shown(bar))
    for row in table:
        if row.visited_pct == 25.0 and row.seeds:
            typer.echo(
                f"{row.map} {row.date}: {row.sampler} finds {row.mean:.0f} % of {row.infested} "
                "infested plants (less those found before) in the first 25 % visited"
            )
    _write(output, {"prior_maps.csv": csv_text(table), "prior_maps.html": maps_html(table)})


def _on_plot(
    files: tuple[Path, str | None, Path | None], seeds: int, seed: int, output: Path
) -> None:
    from fieldmon.studies.thesis.chapter5.report import report_html  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter5.study import rows, run_site  # noqa: PLC0415
    from fieldmon.studies.tidy_csv import csv_text  # noqa: PLC0415

    site = _site(*files)
    with progress("Simulating") as bar:
        made = run_site(site, seeds, seed, progress=shown(bar))
    for part in made.parts:
        for runs in part.runs:
            typer.echo(
                f"{part.title}: {runs.trial.sampler} finds {runs.end_pct.mean():.0f} % in 25 days"
            )
    _write(output, {"prior_plot.csv": csv_text(rows(made)), "prior_plot.html": report_html(made)})


def _site(file: Path, feature: str | None, observations: Path | None) -> Site:
    """Return a plot of a file; its records' chance map if there are any, on their last day."""
    import numpy as np  # noqa: PLC0415

    from fieldmon.infestation.prior import PriorSettings, prior_chance  # noqa: PLC0415
    from fieldmon.io.options import PlotOptions  # noqa: PLC0415
    from fieldmon.io.read import read_plots, read_records  # noqa: PLC0415
    from fieldmon.plot.plot import Plot  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter5.sites import Site  # noqa: PLC0415

    read = read_plots(file, PlotOptions(feature=feature))
    _say(read.messages)
    fields = read.value
    if len(fields) > 1:
        names = tuple(field.name for field in fields)
        raise ChoiceNeeded(
            f"One plot must be chosen, but the file holds {len(names)}: {', '.join(names[:12])}. "
            f'Choose one by name or number: --feature "{names[0]}".',
            "feature",
            names,
        )
    plot = Plot.of(fields[0])
    if observations is None:
        return Site(plot.field.name, plot.aisles, plot.field)
    heard = read_records(observations, near=plot.field)
    _say(heard.messages)
    records = heard.value
    dated = records.day[~np.isnat(records.day)]
    last = dated.max() if dated.size else np.datetime64("today", "D")
    chance = prior_chance(plot.grid, plot.field, records, last, PriorSettings())
    return Site(plot.field.name, plot.aisles, plot.field, chance)


def _say(findings: Iterable[ImportMessage]) -> None:
    for finding in findings:
        typer.echo(str(finding), err=True)


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


def _tell_fit(found: FittedChoices) -> None:
    if found.stopped:
        typer.echo("Stopped: this is the best of what was tried.")
    off = ", ".join(f"{part} {steps:.2f}" for part, steps in found.best.off.items())
    typer.echo(f"Best joint fit, {found.best.joint:.2f} steps off (5 points or a day): {off}")
    for sentence in found.best.choices.sentences():
        typer.echo(f"  {sentence}")
    for part, best in found.per_part.items():
        typer.echo(f"Best fit of {part} alone: {best.off[part]:.2f} steps off")
        typer.echo(f"  {'; '.join(best.choices.sentences())}")
    for one, other, alone, both in found.conflicts:
        typer.echo(
            f"{one} and {other} pull apart: alone each is met to {alone:.2f} steps or better, "
            f"together to {both:.2f}"
        )


def _must_be_folder(output: Path) -> None:
    if not output.is_dir():
        raise FileProblem(f"The folder {output} must exist, but it does not. Make it first.")


def _write(folder: Path, texts: dict[str, str]) -> None:
    from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415

    for name, text in texts.items():
        write_whole(folder / name, text.encode())
        typer.echo(f"Written: {folder / name}")
