"""`fieldmon study spread`: spread foretold on mapped plots, and what was seen."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.study_output import tell_not_read


def spread(
    folder: Annotated[
        Path,
        typer.Argument(
            help="Folder with maps of several dates: public ones, or NAME.map.csv (docs: "
            "strategies)."
        ),
    ],
) -> None:
    """Predict mapped plots from date to date; compare with no change and the thesis's rule.

    Each way is fitted on one half of a plot and predicts the other. Scores are of the plants that
    were clean, minus the logarithm of the chance given to what was seen: less is better.

    Example: fieldmon study spread maps
    """
    from fieldmon.studies.map_spread import DATED, intervals_in, scores

    intervals = intervals_in(folder)
    tell_not_read(folder, DATED)
    for each in intervals:
        typer.echo(scores(each).sentence())
