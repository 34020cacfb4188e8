"""`fieldmon correct`: what another program changed is taken as corrections. Heavy imports wait."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldmon.cli.options import SeasonFile
from fieldmon.errors import SettingError


def correct(
    season: SeasonFile,
    who: Annotated[str, typer.Option(help="Whose corrections these are.", show_default=False)],
) -> None:
    """Accept inspections that QGIS or another program changed, as somebody's corrections.

    Until then the season refuses to go on, and names the rows. fieldmon undo brings back what
    stood there before.

    Example: fieldmon correct season.gpkg --who Ann
    """
    if not who.strip():
        raise SettingError("--who must name whose corrections these are, but it is empty.")
    from fieldmon.monitoring import Season

    n = Season(season).correct(who.strip())
    if n:
        typer.echo(f"{n} correction{'s' if n > 1 else ''} taken, by {who.strip()}.")
    else:
        typer.echo("Nothing was changed by another program.")
