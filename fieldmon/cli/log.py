"""`fieldmon log`: what was seen, planned, advised and treated, and whether that holds."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldmon.cli.options import SeasonFile
from fieldmon.cli.progress import counting
from fieldmon.cli.season_files import season_of

AllMornings = Annotated[
    bool,
    typer.Option("--mornings", help="Work all mornings of a long season out again: half a minute."),
]

AllEntries = Annotated[
    bool,
    typer.Option("--all", help="Show every entry: of a driven day there is one for each plant."),
]


def log(
    season: SeasonFile,
    mornings: AllMornings = False,  # noqa: FBT002 - a flag
    every: AllEntries = False,  # noqa: FBT002 - as above
) -> None:
    """Show the log of a season, and check it and the file for changes to the past.

    A day that a robot or a phone told plant by plant is one line; --all shows every entry.

    A changed past is refused, with the entry that was changed. Give the last digest to somebody
    else: then nobody can rewrite the whole log unnoticed.

    Mornings are worked out again and held to their digests: all of a short season, of a long one
    the last ones, or all with --mornings.

    Example: fieldmon log season.gpkg
    """
    from fieldmon.monitoring.changes.outside_changes import refuse_unlike_log
    from fieldmon.monitoring.changes.season_log import lines
    from fieldmon.monitoring.estimates.verifying import changed_maps, check_against_log, is_short
    from fieldmon.plot.local_clock import local_clock

    kept = season_of(season)
    typer.echo("\n".join(lines(kept.log(), local_clock(kept.plot.field), whole=every)))
    refuse_unlike_log(check_against_log(kept))
    whole = mornings or is_short(kept)
    with counting("Mornings worked out again") as count:
        said = changed_maps(kept, whole=whole, tell=count)
    for sentence in said:
        typer.echo(f"doubtful: {sentence}", err=True)
    if not whole:
        typer.echo(
            "worked out again: the last mornings only; fieldmon log --mornings does all", err=True
        )
