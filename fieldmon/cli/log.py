"""`fieldmon log`: what was seen, planned, advised and treated, and whether that holds."""

from __future__ import annotations

import typer

from fieldmon.cli.options import SeasonFile
from fieldmon.cli.waiting import counting
from fieldmon.errors import FileProblem


def log(season: SeasonFile) -> None:
    """Show the log of a season, and check it and the file for changes to the past.

    A changed past is refused, with the entry that was changed. Give the last digest to somebody
    else: then nobody can rewrite the whole log unnoticed.

    The entries come first. Then every morning is worked out again, which takes a long season half
    a minute, and held to its digest.

    Example: fieldmon log season.gpkg
    """
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.season_log import lines

    kept = Season(season)
    typer.echo("\n".join(lines(kept.log())))
    wrong = kept.held_to_log()
    if wrong:
        raise FileProblem(
            f"The file must say what its log says, but it does not: {' '.join(wrong)} Go back to a "
            "copy from before."
        )
    with counting("Mornings worked out again") as count:
        said = kept.other_maps(tell=count)
    for sentence in said:
        typer.echo(f"doubtful: {sentence}", err=True)
