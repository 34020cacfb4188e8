"""`fieldmon study verdicts`: looks until a verdict, and how often it is right."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_ranges import within
from fieldmon.cli.pest_options import PestName, pest_in_weather_of
from fieldmon.cli.progress import counting
from fieldmon.cli.study_output import can_be_folder, going_on, tell_not_read
from fieldmon.compute.ranges import PAIRED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.studies.verdicts.until_verdict import VerdictSummary

# 1.96 standard deviations of a share of one half
_WIDEST = 0.98


def verdicts(
    seeds: Annotated[
        int, typer.Option(help="Simulated plots per question.", callback=within(PAIRED))
    ] = 100,
    maps: Annotated[
        Path | None,
        typer.Option(
            help="Folder with maps of plants, public ones or NAME.map.csv (docs: strategies), to "
            "compare on these too."
        ),
    ] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the table (CSV).")
    ] = Path(),
    pest: PestName = None,
) -> None:
    """Compare Decide with a W walk, with Wald's test alone and with Adaptive.

    Compared are the inspections until a verdict, and how often it is right. A study that was
    stopped continues where its table ends; 100 seeds take some minutes. With --pest, what can be
    seen of plants is that pest's; a day has no nights, so nothing spreads.

    Example: fieldmon study verdicts --seeds 20 -o study
    """
    from fieldmon.simulation import executor
    from fieldmon.simulation.experiment import run
    from fieldmon.studies.outcome_table import OutcomeTable
    from fieldmon.studies.samplers.mapped_plots import FILES
    from fieldmon.studies.verdicts.until_verdict import (
        VerdictOutcome,
        real_questions,
        study_of_verdicts,
        summaries,
        usual_questions,
    )

    can_be_folder(output)
    pest_in_weather = pest_in_weather_of(pest)
    real, left = ([], []) if maps is None else real_questions(maps)
    if maps is not None:
        tell_not_read(maps, FILES)
    if left:
        typer.echo(
            f"Left out: {', '.join(left)}. Only maps are asked about of which between 0.5 % and "
            "half of the plants are infested.",
            err=True,
        )
    questions = usual_questions() + real
    questions = [replace(each, pest_in_weather=pest_in_weather) for each in questions]
    study, file = study_of_verdicts(questions, range(seeds)), output / "verdicts.csv"
    table = OutcomeTable(file, [chunk.key for chunk in study.chunks()], VerdictOutcome)
    with going_on(file), counting("Plots") as count, table, executor.threads() as workers:
        run(study, workers, table, count)
    _tell(summaries(table.asked()), seeds)
    typer.echo(f"Written: {file}")


def _tell(told: Sequence[VerdictSummary], seeds: int) -> None:
    """Print what each contender came to on each question, and what the columns mean."""
    from fieldmon.studies.verdicts.until_verdict import APART

    wide = max(34, *(len(one.question) for one in told))
    typer.echo(f"{'question':{wide}} {'contender':26} looks  of W  right  apart  none")
    for one in told:
        typer.echo(
            f"{one.question:{wide}} {one.contender:26} {one.looks:5.0f} {one.of_w:5.2f} "
            f"{one.right:6.2f} {one.right_apart:6.2f} {one.undecided:5.2f}"
        )
    typer.echo(
        "looks: inspections until the verdict, on average. of W: over those of the whole W walk. "
        "right: share of right verdicts. apart: the same where the share infested is "
        f"{APART:g} times the threshold or more, or 1/{APART:g} of it or less. none: share of "
        f"plots without a verdict. With {seeds} plots a question a share may be off by "
        f"{_WIDEST / seeds**0.5:.2f} (95 %)."
    )
