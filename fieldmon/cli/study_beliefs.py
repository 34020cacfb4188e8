"""`fieldmon study beliefs`: chance maps against what came true. Heavy imports wait."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_ranges import within
from fieldmon.cli.pest_options import PestName, pest_in_weather_of
from fieldmon.cli.scenario_names import beginning_so
from fieldmon.cli.study_output import can_be_folder, write_all
from fieldmon.compute.ranges import SEASONS, AllowedRange

if TYPE_CHECKING:
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.studies.samplers.calibration import Calibration
    from fieldmon.studies.samplers.scenarios import Scenario

# how long the seasons are
_DAYS = 12
_APART = AllowedRange(1, _DAYS)


def beliefs(
    seeds: Annotated[
        int, typer.Option(help="Simulated seasons per chance map.", callback=within(SEASONS))
    ] = 10,
    scenario: Annotated[
        str | None,
        typer.Option(
            "--scenario",
            "--cell",
            help="Beginning of the scenario's name (see study samplers); clusters on 5 ha if "
            "left out.",
        ),
    ] = None,
    sampler: Annotated[str, typer.Option(help="Sampler that inspects.")] = "adaptive",
    visit_every: Annotated[
        int,
        typer.Option(
            "--visit-every",
            "--every",
            help="Days from one visit to the next, the first on day 1.",
            callback=within(_APART),
        ),
    ] = 1,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the report (HTML).")
    ] = Path(),
    pest: PestName = None,
) -> None:
    """Compare chance maps with what came true: reliability, scores, intervals, cost.

    Each map sends the sampler through seasons of its own. Intervals are counted on mornings with
    infested plants, but for the first, whose number is told.

    With --pest only the map of traced pairs is run, as the others do not follow pests.

    Example: fieldmon study beliefs --seeds 20 --sampler naive -o study
    """
    from fieldmon.samplers import sampler as named
    from fieldmon.studies.samplers.calibration import (
        BELIEFS,
        BELIEFS_OF_PESTS,
        calibration,
        report_html,
    )

    can_be_folder(output)
    pest_in_weather = pest_in_weather_of(pest)
    chosen = _scenario(scenario or "", pest_in_weather)
    made, inspects = {}, named(sampler)
    visited = replace(chosen, visit_every=visit_every)
    for name, believe in (BELIEFS if pest_in_weather is None else BELIEFS_OF_PESTS).items():
        made[name] = c = calibration([visited], inspects, believe, seeds, _DAYS)
        typer.echo(f"{name:24} {_scores(c)}")
    days = "on each" if visit_every == 1 else f"every {visit_every} days"
    about = f"{chosen.name}; {seeds} seasons of {_DAYS} days, inspected {days} by {sampler}."
    write_all(output, {"beliefs.html": report_html(made, about, seeds)})


def _scenario(begins: str, pest: PestInWeather | None) -> Scenario:
    """Return the first scenario whose name begins so; of a pest, as that spreads."""
    from fieldmon.studies.samplers.scenarios import (
        Scenario,
        all_scenarios,
        in_worlds,
        with_pest,
    )

    known = [Scenario(), *all_scenarios(), *in_worlds()]
    known = known if pest is None else with_pest(known, pest)
    return beginning_so([begins], known)[0]


def _scores(of: Calibration) -> str:
    """Return in a line how well a chance map said what came true, and what it cost."""
    return (
        f"Brier {of.brier:.5f}, log score {of.log_score:.4f} "
        f"(as suspicious or not {of.suspicious_log_score:.4f}), skill {of.skill:.2f}, intervals "
        f"of 90 and 50 % hold on {_held(of)}, {1000 * of.seconds_a_day:.0f} ms a day"
    )


def _held(of: Calibration) -> str:
    """Return how often intervals held, and of how many mornings that is."""
    if not of.mornings:
        return "no morning: none but the first had infested plants"
    shares = f"{100 * of.covered:.0f} and {100 * of.half_covered:.0f} %"
    mornings = f"morning{'s' * (of.mornings != 1)}"
    return f"{shares} of {of.mornings} {mornings} with infested plants"
