"""`fieldmon study spread`: spread foretold on mapped plots, and what was seen."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def spread(
    folder: Annotated[Path, typer.Argument(help="Folder with public maps of several dates.")],
) -> None:
    """Predict mapped plots from date to date; compare with no change and the thesis's rule.

    Example: fieldmon study spread maps
    """
    from fieldmon.studies.map_spread import intervals_in, scores

    for each in intervals_in(folder):
        typer.echo(scores(each).sentence())
