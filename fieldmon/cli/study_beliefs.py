"""`fieldmon study beliefs`: chance maps against what came true. Heavy imports wait."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.study_output import must_be_folder, write_all
from fieldmon.errors import SettingError


def beliefs(
    seeds: Annotated[int, typer.Option(min=1, help="Simulated seasons a belief.")] = 10,
    scenario: Annotated[
        str,
        typer.Option(
            "--scenario",
            "--cell",
            help="How the name of the scenario begins (see `study samplers`).",
        ),
    ] = "B, spread 30% to one, clusters, prior none",
    sampler: Annotated[str, typer.Option(help="Who inspects meanwhile.")] = "adaptive",
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the report (HTML).")
    ] = Path(),
) -> None:
    """Compare chance maps by what came true: reliability, scores, intervals, cost.

    Example: fieldmon study beliefs --seeds 20 --sampler naive -o study
    """
    from fieldmon.samplers import sampler as named  # noqa: PLC0415
    from fieldmon.studies.samplers.calibration import (  # noqa: PLC0415
        BELIEFS,
        calibration,
        report_html,
    )
    from fieldmon.studies.samplers.scenarios import all_scenarios, in_worlds  # noqa: PLC0415

    must_be_folder(output)
    known = (*all_scenarios(), *in_worlds())
    chosen = next((each for each in known if each.name.startswith(scenario)), None)
    if chosen is None:
        raise SettingError(f"A scenario must begin with {scenario!r}, but none does.")
    made = {}
    for name, believe in BELIEFS.items():
        made[name] = c = calibration([chosen], named(sampler), believe, seeds)
        typer.echo(
            f"{name:24} Brier {c.brier:.5f}, log score {c.log_score:.4f} "
            f"(as suspicious or not {c.suspicious_log_score:.4f}), skill {c.skill:.2f}, intervals "
            f"of 90 and 50 % hold {c.covered:.0%} and {c.half_covered:.0%}, "
            f"{1000 * c.seconds_a_day:.0f} ms a day"
        )
    about = f"{chosen.name}; {seeds} seasons of 12 days inspected by {sampler}."
    write_all(output, {"beliefs.html": report_html(made, about)})
