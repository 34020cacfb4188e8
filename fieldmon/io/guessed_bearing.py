"""Along which direction rows are laid where nobody said it, and how sure that is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import doubtful
from fieldmon.plot.outline_bearing import bearing_of
from fieldmon.plot.plot import planting_of

if TYPE_CHECKING:
    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.plot_request import PlantingChoices
    from fieldmon.plot.field import Field
    from fieldmon.plot.outline_bearing import OutlineBearing


def guessed_bearing(field: Field, choices: PlantingChoices) -> OutlineBearing | None:
    """Return along which of its sides a plot's rows are laid; None where that is known."""
    drawn = field.plants is not None or field.blocks or not field.row_lines.is_empty
    if drawn or not choices.in_rows or not field.in_rows:
        return None
    if planting_of(field, **choices.given()).row_bearing_deg is not None:
        return None
    return bearing_of(field)


def doubts_of_bearing(field: Field, choices: PlantingChoices) -> tuple[ImportMessage, ...]:
    """Return the doubt that rows may run otherwise: their ends move by more than a row spacing."""
    bearing = guessed_bearing(field, choices)
    if bearing is None or not bearing.off_deg:
        return ()
    many = "Of {n} plots the rows' bearing is in doubt"
    rows = {"along": bearing.bearing_deg, "off": max(bearing.off_deg, 1.0)}
    if bearing.or_deg is not None:
        said = worded(
            "Rows are laid along {along:.0f} degrees, the longest side of a ragged outline, but "
            "that along {other:.0f} degrees is about as long: say the rows' bearing.",
            other=bearing.or_deg,
            **rows,
        )
        return (doubtful(said, field.name, many=many),)
    frame = field.frame(bearing.bearing_deg)
    long_m = np.ptp(frame.xy_m(shapely.get_coordinates(field.boundary))[:, 0])
    spacing_m = planting_of(field, **choices.given()).row_spacing_m
    if long_m * np.tan(np.deg2rad(min(bearing.off_deg, 80.0))) <= spacing_m:
        return ()
    said = worded(
        "Rows are laid along {along:.0f} degrees, the longest side of a ragged outline. It may be "
        "off by {off:.0f} {off:degree|degrees}: say the rows' bearing.",
        **rows,
    )
    return (doubtful(said, field.name, many=many),)
