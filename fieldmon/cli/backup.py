"""`fieldmon backup`: a copy of a season, whoever works on it. Heavy imports wait."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.options import SeasonFile


def backup(
    season: SeasonFile,
    output: Annotated[Path, typer.Option("--output", "-o", help="New file for the copy.")],
) -> None:
    """Copy a season, even while others work on it.

    The copy is whole and is one file. A file that exists is never overwritten.

    Example: fieldmon backup season.gpkg --output /media/stick/season-monday.gpkg
    """
    from fieldmon.monitoring import Store

    Store(season).back_up(output)
    typer.echo(f"{output} is a copy of {season} as it is now.")
