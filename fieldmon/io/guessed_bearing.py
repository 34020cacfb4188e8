"""Along which direction rows are laid where nobody said it, and how sure that is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.io.import_report import doubtful
from fieldmon.plot import outline_bearing
from fieldmon.plot.plot import planting_of
from fieldmon.plot.projection import goes_round

if TYPE_CHECKING:
    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.plot_request import PlantingChoices
    from fieldmon.plot.field import Field
    from fieldmon.plot.outline_bearing import OutlineBearing


def guessed_bearing(field: Field, choices: PlantingChoices) -> OutlineBearing | None:
    """Return along which of its sides a plot's rows are laid; None where that is known."""
    if not choices.in_rows:
        return None
    return outline_bearing.guessed_bearing(field, planting_of(field, **choices.given()))


def doubts_of_bearing(field: Field, choices: PlantingChoices) -> tuple[ImportMessage, ...]:
    """Return the doubt that rows may run otherwise: their ends move by more than a row spacing.

    A plot on both sides of longitude 180 is doubted for that instead (`said_of_place`).
    """
    west, _, east, _ = field.boundary.bounds
    if not choices.in_rows or goes_round([west, east]):
        return ()
    said = outline_bearing.doubt_of_bearing(field, planting_of(field, **choices.given()))
    many = "Of {n} plots the rows' bearing is in doubt"
    return (doubtful(said, field.name, many=many),) if said else ()
