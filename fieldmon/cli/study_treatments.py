"""`fieldmon study treatments`: seasons treated by zones, whole, or not at all."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_ranges import within
from fieldmon.cli.pest_options import PestName, pest_in_weather_of
from fieldmon.cli.progress import counting
from fieldmon.cli.study_output import can_be_folder, going_on
from fieldmon.compute.ranges import PAIRED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.studies.samplers.scenarios import Scenario
    from fieldmon.studies.verdicts.treated_seasons import TreatedSeason

_LOOKED_AT = (0.25, 0.5, 1.0)


def treatments(
    seeds: Annotated[
        int, typer.Option(help="Simulated seasons per scenario.", callback=within(PAIRED))
    ] = 10,
    sampler: Annotated[
        list[str] | None, typer.Option(help="Sampler; repeat for more. Default: all.")
    ] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the table (CSV).")
    ] = Path(),
    pest: PestName = None,
) -> None:
    """Compare treating zones above the threshold with treating whole plots, and with nothing.

    Compared are infested plant-days, hectares and money over seasons of 25 days, and the area of
    zones that leave about as many infested plants as treating the whole plot does. A study that
    was stopped continues where its table ends. With --pest the insects are that pest's, and the
    map knows it.

    Example: fieldmon study treatments --seeds 5 --sampler adaptive -o study
    """
    from fieldmon.samplers import kind_of
    from fieldmon.simulation import executor
    from fieldmon.simulation.experiment import run
    from fieldmon.studies.outcome_table import OutcomeTable
    from fieldmon.studies.verdicts.treated_seasons import (
        TreatedSeason,
        known_samplers,
        study_of_treatments,
        treated_scenarios,
    )

    can_be_folder(output)
    names = tuple(sampler or known_samplers())
    for name in names:
        kind_of(name)
    scenarios = treated_scenarios(pest_in_weather_of(pest))
    study = study_of_treatments(scenarios, range(seeds), names)
    file = output / "treatments.csv"
    table = OutcomeTable(file, [chunk.key for chunk in study.chunks()], TreatedSeason)
    with going_on(file), counting("Seasons") as count, table, executor.threads() as workers:
        run(study, workers, table, count)
    _tell(table.asked())
    _tell_areas(scenarios, seeds)
    typer.echo(f"Written: {file}")


def _tell(made: Sequence[TreatedSeason]) -> None:
    """Print the means by scenario, sampler and rule."""
    from fieldmon.studies.verdicts.treated_seasons import against_nothing

    typer.echo(
        f"{'scenario':42} {'sampler':15} {'rule':8} plant-days  ha sprayed   money  "
        "plant-days over those of nothing, with 95 %"
    )
    for key in dict.fromkeys((one.scenario, one.sampler, one.rule) for one in made):
        mine = [one for one in made if (one.scenario, one.sampler, one.rule) == key]
        days, area, money = (
            sum(getattr(one, name) for one in mine) / len(mine)
            for name in ("plant_days", "sprayed_ha", "cost")
        )
        same = [one for one in made if (one.scenario, one.sampler) == key[:2]]
        of = against_nothing(same, key[2])
        typer.echo(
            f"{key[0]:42} {key[1]:15} {key[2]:8} {days:10.0f} {area:11.2f} {money:7.0f}  "
            f"{of.mean:.3f} ({of.low:.3f} to {of.high:.3f})"
        )


def _tell_areas(scenarios: Sequence[Scenario], seeds: int) -> None:
    """Print what zones spray where they leave about as much as the whole plot's treatment."""
    from fieldmon.studies.verdicts.treated_seasons import area_at_equal_left

    typer.echo("\nZones that leave about as many infested plants as treating the whole plot:")
    for share in _LOOKED_AT:
        for scenario in scenarios:
            made = [area_at_equal_left(scenario, seed, share) for seed in range(seeds)]
            area, left, by_plant, known = (
                sum(getattr(one, name) for one in made) / seeds
                for name in ("share", "left", "by_plant", "all_known")
            )
            typer.echo(
                f"{scenario.start:10} {share:4.0%} looked at: {1 - area:4.0%} less area, "
                f"{left:.1f} times as many left; {1 - by_plant:4.0%} plant by plant, "
                f"{1 - known:4.0%} if all were known"
            )
