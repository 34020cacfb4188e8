"""How far places are from a plot, and which measured plants are not of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np
import shapely

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import worded
from fieldmon.plot.projection import GEOD

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field

#: what may be done with plants outside their plot
FAR = ("keep", "drop")

_FAR_M = 100_000.0
# a plant so far outside a boundary may be one of the plot: a phone is off by as much
_GPS_M = 5.0


@dataclass(frozen=True, eq=False)
class PlantsOutside:
    """Which of a plot's measured plants stand outside it, and what is done with them.

    Parameters
    ----------
    plot
        The plot's name.
    away_m
        ``(n,)`` how far each plant is from the plot's area; 0 on it.
    left_out
        ``(n,)`` whether it is left out.
    all_stay
        Whether none is left out however far it is, as that was said or none is near the plot.
    """

    plot: str
    away_m: NDArray[np.float64]
    left_out: NDArray[np.bool_]
    all_stay: bool

    def __repr__(self) -> str:
        return f"<PlantsOutside {self.plot}: {int(self.left_out.sum())} left out>"

    @classmethod
    def of(cls, lonlat: NDArray[np.float64], field: Field, far: str | None = None) -> Self:
        """Leave out plants ``(n, 2)`` that are outside by more than GPS errs.

        None, where not one is near the plot. ``far="keep"`` leaves out none, ``far="drop"`` all
        that are not on the plot.
        """
        away_m = distance_m(lonlat, field)
        outside = away_m > (0.0 if far == "drop" else _GPS_M)
        all_stay = far == "keep" or bool(outside.all())
        return cls(field.name, away_m, outside & (not all_stay), all_stay)

    def of_left_out(self) -> str:
        """Return what to say of plants that are left out; empty: there are none."""
        if not self.left_out.any():
            return ""
        return worded(
            "{n} of {all} {all:plant stands|plants stand} outside {plot} and {n:was|were} left "
            "out: {away} away.",
            n=int(self.left_out.sum()),
            all=len(self.left_out),
            plot=self.plot,
            away=between_m(self.away_m[self.left_out]),
        )

    def of_beside(self) -> str:
        """Return what to say of plants just outside that stay; empty: there are none."""
        beside = (self.away_m > 0.0) & ~self.left_out
        if self.all_stay or not beside.any():
            return ""
        return worded(
            "{n} {n:plant stands|plants stand} outside {plot}, up to {away} away, and {n:is|are} "
            "taken to be of it: a boundary may be drawn tight.",
            n=int(beside.sum()),
            plot=self.plot,
            away=distance_figure(float(self.away_m[beside].max())),
        )


def distance_m(lonlat: NDArray[np.float64], field: Field) -> NDArray[np.float64]:
    """Return how far each position is from a plot's area ``(n,)``; 0 on it."""
    west, south, east, north = field.boundary.bounds
    lon, lat = (west + east) / 2, (south + north) / 2
    possible = np.clip(lonlat[:, 1], -90, 90)
    away = np.asarray(
        GEOD.inv(np.full(len(lonlat), lon), np.full(len(lonlat), lat), lonlat[:, 0], possible)[2]
    )
    close = away < _FAR_M
    frame = field.frame()
    area = frame.geometry_m(field.boundary)
    shapely.prepare(area)
    away[close] = shapely.distance(area, shapely.points(frame.xy_m(lonlat[close])))
    return away


def between_m(away_m: NDArray[np.float64]) -> str:
    """Return the least and the greatest of distances, once where they read alike."""
    nearest, farthest = (distance_figure(float(end)) for end in (away_m.min(), away_m.max()))
    if str(nearest) == str(farthest):
        return nearest
    return worded("{nearest} to {farthest}", nearest=nearest, farthest=farthest)
