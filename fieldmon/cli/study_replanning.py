"""`fieldmon study replanning`: what planning again after a find brings. Heavy imports wait."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldmon.cli.option_ranges import of_robot, within
from fieldmon.cli.progress import progress
from fieldmon.compute.ranges import CHANCE, PAIRED


def replanning(
    seeds: Annotated[
        int, typer.Option(help="Seasons of each, with the same insects.", callback=within(PAIRED))
    ] = 100,
    hours: Annotated[
        float,
        typer.Option(help="Working hours per day.", callback=of_robot("hours")),
    ] = 4.0,
    spread: Annotated[
        float, typer.Option(help="Chance per night to infest a neighbour.", callback=within(CHANCE))
    ] = 0.3,
) -> None:
    """Compare Adaptive with itself held to its plan of the morning, and with the best route.

    Seasons on the thesis's plot of 28 x 28 plants: infested plant-days, and the difference from
    Adaptive with its 95 % interval.

    Example: fieldmon study replanning --seeds 20
    """
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.studies.routes.seasons import OF_EACH_SEED, season_sentences, seasons
    from fieldmon.studies.samplers.scenarios import Scenario

    scenario = Scenario("A", Spread(spread, "one"))
    made = []
    with progress("Seasons", OF_EACH_SEED * seeds) as bar:
        for one in seasons(scenario, range(seeds), hours):
            made.append(one)
            bar.update(1)
    for sentence in season_sentences(made):
        typer.echo(sentence)
