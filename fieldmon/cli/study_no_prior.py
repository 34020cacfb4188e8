"""`fieldmon study no-prior`: the thesis's chapter 4, made again. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import StudySeed
from fieldmon.cli.pest_options import PestName, check_no_pest
from fieldmon.cli.progress import counting
from fieldmon.cli.study_output import can_be_folder, write_all
from fieldmon.compute.ranges import SEASONS
from fieldmon.errors import FileProblem


@dataclass(frozen=True)
class NoPriorOptions:
    """What `fieldmon study no-prior` is told."""

    table: Annotated[
        str,
        typer.Option(
            help="2, 3, 4, 5 or 2-5 (the printed tables), severity, bigger, trend, equal, "
            "everywhere, slips, or all."
        ),
    ] = "2-5"
    replicates: Annotated[
        int, typer.Option(help="Simulated seasons per row.", callback=within(SEASONS))
    ] = 400
    seed: StudySeed = 1
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the table (CSV) and report (HTML).")
    ] = Path()
    golden: Annotated[
        list[Path] | None,
        typer.Option(help="Compare with exact runs instead; exit code 1 where rows differ."),
    ] = None
    night: Annotated[
        str | None,
        typer.Option(help="Which night the exact runs are of: published or corrected."),
    ] = None
    pest: PestName = None


@with_options
def no_prior(options: NoPriorOptions) -> None:
    """Run the thesis's samplers without prior information; compare with its printed tables.

    It takes no --pest: the tables are of the thesis's own rule.

    Example: fieldmon study no-prior --table 2 --replicates 400 -o study
    """
    check_no_pest(options.pest, "study no-prior")
    if options.golden:
        _compare(options.golden, options.night)
        return
    from fieldmon.studies.thesis.chapter4.report import report_html
    from fieldmon.studies.thesis.chapter4.study import run_no_prior
    from fieldmon.studies.tidy_csv import csv_text

    can_be_folder(options.output)
    with counting("Simulating") as count:
        made = run_no_prior(options.table, options.replicates, options.seed, count)
    for part in made.tables:
        typer.echo(f"\n{part.title}")
        for sentence in part.summary:
            typer.echo(f"  {sentence}")
    name = f"no_prior_{options.table}"
    written = {f"{name}.csv": csv_text(made.cells), f"{name}.html": report_html(made)}
    write_all(options.output, written)


def _compare(files: list[Path], night: str | None) -> None:
    """Print which rows of exact runs differ; end with exit code 1 if any does."""
    from fieldmon.studies.thesis.chapter4.exact_runs import compare_golden

    all_equal = True
    for file in files:
        try:
            text = file.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise FileProblem(
                f"{file} must be a readable text file (CSV), but it is not ({error})."
            ) from error
        comparison = compare_golden(text, file.name, night)
        typer.echo(str(comparison))
        for difference in comparison.differences:
            typer.echo(str(difference))
        all_equal = all_equal and comparison.equal
    if not all_equal:
        raise typer.Exit(1)
