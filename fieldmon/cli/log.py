"""`fieldmon log`: what was seen, planned, advised and treated, and whether that holds."""

from __future__ import annotations

import typer

from fieldmon.cli.options import SeasonFile
from fieldmon.errors import FileProblem


def log(season: SeasonFile) -> None:
    """Show the log of a season, and hold it to its digests and the file to it.

    A changed past is refused, with the entry it was changed in. Give the last digest to somebody
    else: with it nobody can write the whole log anew unnoticed.

    Example: fieldmon log season.gpkg
    """
    from fieldmon.monitoring import Season  # noqa: PLC0415
    from fieldmon.monitoring.season_log import lines  # noqa: PLC0415

    kept = Season(season)
    typer.echo("\n".join(lines(kept.log())))
    wrong = kept.held_to_log()
    if wrong:
        raise FileProblem(
            f"The file must say what its log says, but it does not: {' '.join(wrong)} Go back to a "
            "copy from before."
        )
    for sentence in kept.other_maps():
        typer.echo(f"doubtful: {sentence}", err=True)
