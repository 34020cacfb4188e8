"""`fieldmon study ...`: published experiments, made again. Heavy imports wait."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli import study_run, study_samplers
from fieldmon.cli.study_prior import register as register_prior
from fieldmon.cli.waiting import progress, shown
from fieldmon.errors import FileProblem

app = typer.Typer(
    no_args_is_help=True, help="Published experiments, made again, and studies of one's own."
)
register_prior(app)
app.command("samplers")(study_samplers.samplers)
app.command("beliefs")(study_samplers.beliefs)
study_run.register(app)


@app.callback()
def study() -> None:
    """Make published experiments again, or run a study of one's own plots."""


@app.command("no-prior")
def no_prior(
    table: Annotated[
        str,
        typer.Option(
            help="2, 3, 4, 5 or 2-5 (the printed tables), severity, bigger, trend, equal, "
            "everywhere, slips, or all."
        ),
    ] = "2-5",
    replicates: Annotated[int, typer.Option(help="Simulated seasons a row.")] = 400,
    seed: Annotated[int, typer.Option(help="The same seed, the same figures.")] = 1,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the table (CSV) and report (HTML).")
    ] = Path(),
    golden: Annotated[
        list[Path] | None,
        typer.Option(help="Compare with exact runs instead; exit code 1 where rows differ."),
    ] = None,
    night: Annotated[
        str | None,
        typer.Option(help="Which night the exact runs are of: published or corrected."),
    ] = None,
) -> None:
    """Run the thesis's samplers without prior information beside its printed tables.

    Example: fieldmon study no-prior --table 2 --replicates 400 -o study
    """
    if golden:
        _compare(golden, night)
        return
    from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter4.report import report_html  # noqa: PLC0415
    from fieldmon.studies.thesis.chapter4.study import run_no_prior  # noqa: PLC0415
    from fieldmon.studies.tidy_csv import csv_text  # noqa: PLC0415

    if not output.is_dir():
        raise FileProblem(f"The folder {output} must exist, but it does not. Make it first.")
    with progress("Simulating") as bar:
        made = run_no_prior(table, replicates, seed, shown(bar))
    for part in made.tables:
        typer.echo(f"\n{part.title}")
        for sentence in part.summary:
            typer.echo(f"  {sentence}")
    for ending, text in (("csv", csv_text(made.cells)), ("html", report_html(made))):
        to = output / f"no_prior_{table}.{ending}"
        write_whole(to, text.encode())
        typer.echo(f"Written: {to}")


def _compare(files: list[Path], night: str | None) -> None:
    """Print which rows of exact runs differ; end with exit code 1 if any does."""
    from fieldmon.studies.thesis.chapter4.exact_runs import compare_golden  # noqa: PLC0415

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
