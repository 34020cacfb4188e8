"""From records, edges, paths and rasters to a chance of infestation for every plant.

A plant can be infested in several ways that are taken as independent: from anywhere (background),
from the plot's edge, from a path, for a reason that a raster shows. Those make the *base*, from
which dated records then move each plant away (`record_kernel`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from scipy.special import expit, logit

from fieldmon.compute.array_arguments import array_of_plants
from fieldmon.compute.wording import worded
from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.chance_bounds import MOST_CHANCE
from fieldmon.infestation.nearby_plants import SearchRows, distance_m
from fieldmon.infestation.prior.record_kernel import record_chance
from fieldmon.infestation.records import usable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.infestation.records import Records
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

# edges and paths are followed no farther than they change a chance by this
_LEAST_CHANGE = 1e-4


def prior_chance(
    grid: PlantGrid,
    field: Field,
    records: Records,
    on_day: np.datetime64,
    settings: PriorSettings,
    risk: Floats | None = None,
) -> Floats:
    """Return the chance of infestation of every plant on a morning, ``(n,)`` in [0, 1].

    Only the `usable` records count. `risk` is one more way of being infested, ``(n,)`` in [0, 1],
    from a raster for instance; NaN where it says nothing.

    Raises
    ------
    ObservationError
        If there are records and none is near enough to say anything about a plant, or if `risk`
        does not fit the plants.
    """
    ways = [
        np.full(len(grid), settings.background_chance),
        edge_chance(grid, settings),
        path_chance(grid, field, settings),
    ]
    if risk is not None:
        ways.append(_checked_risk(grid, risk))
    clean = np.prod([1.0 - way for way in ways], axis=0)
    base = np.minimum(1.0 - clean, MOST_CHANCE)
    return record_chance(grid, base, usable(records, on_day).records, on_day, settings)


def edge_chance(grid: PlantGrid, settings: PriorSettings) -> Floats:
    """Return the chance that a plant was infested from the plot's edge, ``(n,)``."""
    edges = shapely.boundary(grid.drivable_m)
    return _from_lines(grid, edges, settings.edge_chance, settings.edge_depth_m)


def path_chance(grid: PlantGrid, field: Field, settings: PriorSettings) -> Floats:
    """Return the chance that a plant was infested from a path or road, ``(n,)``."""
    lon, lat = grid.frame.lon, grid.frame.lat
    # the roads of a whole country may come along: those within a day's drive do
    paths = shapely.clip_by_rect(field.paths, lon - 0.7, lat - 0.7, lon + 0.7, lat + 0.7)
    paths_m = grid.frame.geometry_m(paths)
    return _from_lines(grid, paths_m, settings.path_chance, settings.path_depth_m)


def scaled(chance: Floats, expected_share: float) -> Floats:
    """Return the chances ``(n,)`` with the given mean, every plant's odds times the same number.

    Plants at exactly 0 or 1 stay there; raise `SettingError` where that leaves no room.
    """
    free = (chance > 0.0) & (chance < 1.0)
    certain = np.count_nonzero(chance >= 1.0)
    wanted = expected_share * len(chance) - certain
    if not free.any():
        raise SettingError(
            worded(
                "Some plants must have a chance between 0 and 1, or nothing is left to draw, but "
                "all are at 0 or 1."
            )
        )
    if not (0.0 < wanted < np.count_nonzero(free)):
        raise SettingError(
            worded(
                "The expected share of infested plants must lie strictly between {certain:.6g} "
                "and {certain_2:.6g} here (plants at chance 0 or 1 stay there), but it is "
                "{expected_share}.",
                certain=certain / max(len(chance), 1),
                certain_2=(certain + np.count_nonzero(free)) / max(len(chance), 1),
                expected_share=expected_share,
            )
        )
    after = chance.copy()
    after[free] = expit(logit(chance[free]) + _odds_shift(chance[free], wanted))
    return after


def odds_ratio(chance: Floats, expected_share: float) -> float:
    """Return what all odds of chances ``(n,)`` must be multiplied by for this mean.

    Plants at exactly 0 or 1 stay there; the mean must leave room for that.
    """
    free = chance[(chance > 0.0) & (chance < 1.0)]
    certain = np.count_nonzero(chance >= 1.0)
    return float(np.exp(_odds_shift(free, expected_share * len(chance) - certain)))


def _odds_shift(chance: Floats, wanted: float) -> float:
    """Return what is added to all log-odds of chances within 0 and 1 for them to sum up to this."""
    odds = logit(chance)
    share = wanted / len(odds)

    def excess(shift: float) -> float:
        return float(np.mean(expit(odds + shift))) - share

    from scipy.optimize import brentq  # noqa: PLC0415 - heavy, and seldom needed

    least, most = logit(share) - odds.max(), logit(share) - odds.min()
    return float(brentq(excess, least - 1e-9, most + 1e-9, xtol=1e-13, rtol=1e-15))


def start_infested(
    chance: Floats, expected_share: float | None, rng: np.random.Generator
) -> NDArray[np.bool_]:
    """Draw which plants are infested on the first morning, ``(n,)``, each plant by its own chance.

    With `expected_share` the chances are :func:`scaled` to that mean first. The same generator
    state and more chance infest the same plants and others besides.
    """
    odds = chance if expected_share is None else scaled(chance, expected_share)
    drawn: NDArray[np.bool_] = rng.random(len(odds)) < odds
    return drawn


def _checked_risk(grid: PlantGrid, given: Floats) -> Floats:
    risk = np.atleast_1d(array_of_plants(np.float64, "A risk map", given))
    if risk.shape != (len(grid),):
        raise ObservationError(
            worded(
                "A risk map must have one entry a plant ({n}), but it has {n_2}.",
                n=len(grid),
                n_2=" x ".join(str(size) for size in risk.shape),
            )
        )
    known = risk[~np.isnan(risk)]
    if known.size and (known.min() < 0.0 or known.max() > 1.0):
        raise ObservationError(
            worded(
                "A risk map must hold chances in 0..1 (NaN where it says nothing), but it runs "
                "from {least:.6g} to {most:.6g}. Scale the raster to chances first.",
                least=known.min(),
                most=known.max(),
            )
        )
    return np.where(np.isnan(risk), 0.0, risk)


def _from_lines(grid: PlantGrid, lines: shapely.Geometry, chance: float, depth_m: float) -> Floats:
    """Return a chance that falls by 1/e every `depth_m` away from lines (metres), ``(n,)``."""
    points, line = shapely.get_coordinates(shapely.get_parts(lines), return_index=True)
    ahead = np.flatnonzero(line[1:] == line[:-1])
    pieces = np.concatenate([points[ahead], points[ahead + 1]], axis=1)
    farthest_m = depth_m * np.log(max(chance / _LEAST_CHANGE, 1.0))
    search = SearchRows.of(grid)
    away_m = search.numbered(distance_m(search.rows, pieces, farthest_m))
    return chance * np.exp(-away_m / depth_m)
