"""`fieldmon study weather`: what knowing the weather brings. Heavy imports wait."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldmon.cli.option_ranges import within
from fieldmon.cli.pest_options import PestName, tell_pest
from fieldmon.cli.progress import counting
from fieldmon.compute.ranges import DAYS, PAIRED


def weather(
    seeds: Annotated[
        int, typer.Option(help="Seasons of each, with the same insects.", callback=within(PAIRED))
    ] = 100,
    shape: Annotated[
        str, typer.Option(help="One shape of the weather, such as 'heat wave'; empty: all of them.")
    ] = "",
    pest: PestName = None,
    days: Annotated[int, typer.Option(help="Days of a season.", callback=within(DAYS))] = 20,
) -> None:
    """Compare Adaptive that knows temperature and wind with Adaptive that believes averages.

    Without --pest the insects are a mite that the wind carries.

    Example: fieldmon study weather --seeds 20 --shape "steady wind"
    """
    from fieldmon.io.readers.pest_file import pest_of
    from fieldmon.studies.weather_known import (
        CARRIED,
        SHAPES,
        changes_nothing,
        must_be_shapes,
        worth_of_weather,
    )

    names = [shape] if shape else list(SHAPES)
    must_be_shapes(names, days)
    lives = pest_of(pest) if pest else CARRIED
    if pest:
        tell_pest(lives)
    for said in changes_nothing(lives):
        typer.echo(said, err=True)
    for name in names:
        with counting(name) as count:
            (worth,) = worth_of_weather(range(seeds), [name], lives, days, count)
        typer.echo(worth.sentence())
