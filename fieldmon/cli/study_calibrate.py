"""`fieldmon study calibrate`: what the thesis's chapter 5 leaves open. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import StudySeed
from fieldmon.cli.pest_options import PestName, check_no_pest
from fieldmon.cli.progress import counting
from fieldmon.cli.study_output import can_be_folder, write_all
from fieldmon.compute.ranges import SEASONS

if TYPE_CHECKING:
    from fieldmon.studies.thesis.chapter5.calibrate import FittedChoices


@dataclass(frozen=True)
class CalibrateOptions:
    """What `fieldmon study calibrate` is told."""

    drawn: Annotated[
        int,
        typer.Option(help="How many open choices are drawn at first.", callback=within(SEASONS)),
    ] = 500
    kept: Annotated[
        int,
        typer.Option(help="How many of them are tried on everything.", callback=within(SEASONS)),
    ] = 20
    steps: Annotated[
        int,
        typer.Option(help="Steps of improving one choice or two.", callback=within(0, 1_000_000)),
    ] = 400
    seeds: Annotated[
        int, typer.Option(help="Paired seasons in the final comparison.", callback=within(SEASONS))
    ] = 20
    seed: StudySeed = 1
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for tables and report.")
    ] = Path()
    pest: PestName = None


@with_options
def calibrate(options: CalibrateOptions) -> None:
    """Search what the thesis leaves open for the best fit to its published figures.

    Tells the best joint fit, the best fit of each part alone, and which parts conflict. Takes
    about half an hour on two cores; Ctrl-C keeps what was tried on everything. It takes no --pest:
    the figures are of the thesis's own rule.
    """
    check_no_pest(options.pest, "study calibrate")
    from fieldmon.studies.thesis.chapter5.calibrate import Effort, candidates_csv
    from fieldmon.studies.thesis.chapter5.calibrate import calibrate as search

    can_be_folder(options.output)
    tried = {"drawn": options.drawn, "kept": options.kept, "steps": options.steps}
    effort = Effort(**tried, final_seeds=options.seeds)
    with counting("Searching") as count:
        found = search(effort, options.seed, count)
    _tell_fit(found)
    write_all(options.output, {"prior_calibration.csv": candidates_csv(found.tried)})


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
