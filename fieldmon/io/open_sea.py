"""Whether a plot lies in the open sea, as where longitude and latitude changed places."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful
from fieldmon.plot.local_clock import at_sea
from fieldmon.plot.projection import goes_round, on_both_sides

if TYPE_CHECKING:
    from fieldmon.plot.field import Field


def said_of_place(field: Field, *, exchanged: bool = False) -> tuple[ImportMessage, ...]:
    """Doubt a plot in the open sea; offer to exchange its axes where that brings it ashore.

    Coastal waters count as land: a plot may well lie on an island that no map of zones shows. The
    middle of a plot on both sides of longitude 180 lies nowhere near it: that is doubted instead.
    Where they were `exchanged` already, it offers to leave them as they were.
    """
    west, south, east, north = field.boundary.bounds
    if goes_round([west, east]):
        return (doubtful(on_both_sides(), field.name),)
    lon, lat = float(np.mean([west, east])), float(np.mean([south, north]))
    if not at_sea(lon, lat):
        return ()
    if abs(lon) <= 90.0 and not at_sea(lat, lon):
        said = worded(
            "It lies in the open sea, at latitude {lat:.4f}, longitude {lon:.4f}. With those "
            "exchanged it would lie on land: exchange them if that is right.",
            lon=lon,
            lat=lat,
        )
        remedy = Remedy(
            "swap_axes",
            "no" if exchanged else "yes",
            worded("Exchange longitude and latitude"),
        )
    else:
        remedy = None
        said = worded(
            "It lies in the open sea, at latitude {lat:.4f}, longitude {lon:.4f}. Check the "
            "coordinate system.",
            lon=lon,
            lat=lat,
        )
    many = "{n} plots lie in the open sea. Check the coordinate system"
    return (doubtful(said, field.name, remedy, many=many),)
