"""Plots that a file may put elsewhere: by a mistyped corner, or in another UTM zone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import FileProblem
from fieldmon.io.import_report import ImportMessage, doubtful, dropped
from fieldmon.io.parse.crs import middle_of, system, transformation_from, utm_zone
from fieldmon.io.parse.georeference import few_unplaceable, written
from fieldmon.io.parse.utm_zones import of_another_zone
from fieldmon.io.readers.plot_areas import shapes_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import PlotOptions

_TWO = 2


def mistyped_corners(
    shapes: NDArray[np.object_], crs: str | None, options: PlotOptions
) -> dict[int, tuple[int, str]]:
    """Return, by area, the number of its first corner that lies nowhere on the earth, and it."""
    xy, of = shapely.get_coordinates(shapes, return_index=True)
    corner = np.arange(len(xy)) - np.searchsorted(of, of)
    # an outline ends where it begins: that corner counts once
    open_end = np.flatnonzero(np.append(of[1:] == of[:-1], False))
    wrong = open_end[few_unplaceable(xy[open_end], crs, options)]
    return {int(of[k]): (int(corner[k]) + 1, written(xy[k])) for k in wrong[::-1].tolist()}


def said_of_mistyped(mistyped: dict[int, tuple[int, str]], names: list[str]) -> list[ImportMessage]:
    """Return a message for each plot with a mistyped corner; refuse where no other is left."""
    if mistyped and len(mistyped) == len(names):
        raise wrong_corner(names[0], *mistyped[0])
    many = "{n} plots have a corner that lies nowhere on the earth, and were left out"
    return [
        dropped(
            worded(
                "Corner {number}, {at}, lies nowhere on the earth: correct it. The plot was left "
                "out.",
                number=number,
                at=at,
            ),
            names[k],
            many=many,
        )
        for k, (number, at) in sorted(mistyped.items())
    ]


def wrong_corner(name: str, number: int, at: str) -> FileProblem:
    """Return the error of a plot, no other being left, one of whose corners is mistyped."""
    return FileProblem(
        worded(
            "Every corner of {name} must lie on the earth, but corner {number}, {at}, does not. "
            "Correct it.",
            name=name,
            number=number,
            at=at,
        )
    )


def in_another_zone(
    areas: Layer, names: list[str], chosen: NDArray[np.int64], options: PlotOptions
) -> tuple[ImportMessage, ...]:
    """Return a doubt where plots, read in one UTM zone, seem to be written in the next."""
    crs = system(options.crs or areas.crs or "")
    zone, xy = utm_zone(crs), middles_of(shapes_of(areas))
    if options.swap_axes:
        xy = xy[:, ::-1]
    if zone is None or len(xy) < _TWO:
        return ()
    far = of_another_zone(transformation_from(crs, middle_of(xy)).lonlat(xy), zone)
    some = [] if far is None else [names[k] for k in chosen.tolist() if far.which[k]]
    if far is None or not some:
        return ()
    return (
        doubtful(
            worded(
                "{n} {n:plot lies|plots lie} {away:.0f} km from the others ({names}), but as UTM "
                "zone {zone} {n:it|they} would lie {near:.0f} km from them. If {n:it is|they are} "
                "of that zone, bring all plots into one, or those of each into a file of its own.",
                n=len(some),
                away=far.away_km,
                names=first_few(some),
                zone=far.zone,
                near=far.near_km,
            )
        ),
    )


def middles_of(shapes: NDArray[np.object_]) -> NDArray[np.float64]:
    """Return the middle of the bounds of each shape ``(n, 2)``, as the file writes it."""
    west, south, east, north = shapely.bounds(shapes).T
    return np.stack([west + east, south + north], axis=1) / 2
