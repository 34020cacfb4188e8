"""`fieldmon salvage`: what is left of a damaged season. Heavy imports wait."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.options import SeasonFile


def salvage(
    season: SeasonFile,
    output: Annotated[Path, typer.Option("--output", "-o", help="New file to save it in.")],
) -> None:
    """Save what can be saved from a damaged season into a new file.

    Example: fieldmon salvage season.gpkg --output rescued.gpkg
    """
    from fieldmon.monitoring.season.salvage import salvage as save

    done = save(season, output)
    for name, rows in done.rows.items():
        lost = "some could not be read" if rows else "what it had could not be read"
        note = f"  ({lost})" if name in done.lost else ""
        typer.echo(f"  {rows:8d}  {name}{note}")
    if done.whole:
        again = shlex.quote(str(output))
        if done.gone:
            typer.echo(f"Lost, as its log and status say from now on: {', '.join(done.gone)}.")
        typer.echo(f"{output} is a season again. Compare it with: fieldmon status {again}")
    else:
        typer.echo(
            f"{output} holds what could be read, but it is no season: {done.why} If the plot or "
            "its settings are lost, begin a new season with fieldmon init, and record the layer "
            "inspections into it."
        )
