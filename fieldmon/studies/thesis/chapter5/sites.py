"""Where chapter 5 is played: squares of the thesis, or any plot; which plants are infested."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import routine
from fieldmon.compute.random_streams import coin, coin_table
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs.independent_plants import learn
from fieldmon.infestation.prior.prior import edge_chance, path_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.plot.layout import rectangle
from fieldmon.plot.travel import Aisles
from fieldmon.simulation.start import Start, season_start
from fieldmon.studies.thesis.chapter5.open_choices import side_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import Csr, PlantGrid
    from fieldmon.studies.thesis.chapter5.open_choices import StartUp

    Floats = NDArray[np.float64]

_LEAST, _MOST = 1e-6, 1.0 - 1e-6
# seeds of clusters that fall on infested plants before the plot's margin is taken as full
_PATIENCE = 20
_TRIES = 50


@dataclass(frozen=True, eq=False)
class Site:
    """A plot on which seasons are played.

    Parameters
    ----------
    name
        What it is called in tables.
    aisles
        Its plants and ways.
    field
        Where its paths are; None: it has none.
    chance
        ``(n,)`` chance map from records, where there are any: then starts are drawn from it and
        it is what the samplers know, in place of a `StartUp`'s clusters.
    """

    name: str
    aisles: Aisles
    field: Field | None = None
    chance: Floats | None = None

    @cached_property
    def grid(self) -> PlantGrid:
        """The plants."""
        return self.aisles.grid

    def entering(self, depth_m: float) -> Floats:
        """Return the weight with which each plant is where insects enter, ``(n,)``."""
        if depth_m not in self._entering:
            rule = PriorSettings(
                edge_chance=1.0, edge_depth_m=depth_m, path_chance=1.0, path_depth_m=depth_m
            )
            clean = 1.0 - edge_chance(self.grid, rule)
            if self.field is not None:
                clean = clean * (1.0 - path_chance(self.grid, self.field, rule))
            self._entering[depth_m] = 1.0 - clean
        return self._entering[depth_m]

    @cached_property
    def _entering(self) -> dict[float, Floats]:
        return {}


@lru_cache(maxsize=32)
def square(hectares: float) -> Site:
    """Return the thesis's square plot of so many hectares."""
    side = side_of(hectares)
    return Site(f"{hectares:g} ha", Aisles.of(rectangle(side, side)))


def first_morning(site: Site, start: StartUp, streams: RandomStreams) -> Start:
    """Draw which plants are infested and what is believed; streams ``start`` and ``records``.

    On a site with a chance map each plant is drawn by its own chance, with the mean that `start`
    names, and the map is what is believed. Elsewhere clusters grow as `start` says; believed is
    each plant's chance of being in one, and 0.95 at recorded plants, 0.3 and more beside them.
    """
    if site.chance is not None:
        return season_start(site.grid, site.chance, start.share, streams)
    n = len(site.grid)
    infested = np.zeros(n, np.bool_)
    wanted = max(1, round(start.share * n))
    margin = site.entering(start.depth_m)
    rule = (wanted, start.margin_share, 1.0 / start.cluster_size)
    _grow(infested, np.cumsum(margin), site.grid.adjacent, rule, streams.key("start"))
    everywhere = (1.0 - start.margin_share) / n
    believed = wanted * (everywhere + start.margin_share * margin / margin.sum())
    told = infested & (coin_table(streams.key("records"), n) < start.recorded_share)
    plants = np.flatnonzero(told).astype(np.int32)
    finds = np.ones(len(plants), np.bool_)
    base = np.clip(believed, _LEAST, 0.5)
    heard = learn(base, site.grid, plants, finds, Learning(treated=False))
    heard[plants] = PriorSettings().at_record
    return Start(infested, heard)


@routine
def _grow(
    infested: NDArray[np.bool_],
    margin: Floats,
    adjacent: Csr,
    rule: tuple[int, float, float],
    key: np.uint64,
) -> None:
    """Infest clusters until so many plants are infested; `margin` is a running sum of weights."""
    wanted, margin_share, stop = rule
    n, c, fails, done = infested.size, 0, 0, 0
    member = np.empty(wanted, np.int64)
    while done < wanted:
        if coin(key, c) < margin_share and fails < _PATIENCE * wanted:
            seed = np.searchsorted(margin, coin(key, c + 1) * margin[-1], side="right")
            seed = min(seed, n - 1)
        else:
            seed = int(coin(key, c + 1) * n)
        c += 2
        if infested[seed]:
            fails += 1
            continue
        first = done
        infested[seed], member[done] = True, seed
        done += 1
        while done < wanted and coin(key, c) >= stop:
            c += 1
            # a cluster walled in by others may not find room for its next plant
            for _ in range(_TRIES):
                parent = member[first + int(coin(key, c) * (done - first))]
                low, high = adjacent.start[parent], adjacent.start[parent + 1]
                child = parent
                if high > low:
                    child = adjacent.plant[low + int(coin(key, c + 1) * (high - low))]
                c += 2
                if not infested[child]:
                    infested[child], member[done] = True, child
                    done += 1
                    break
            else:
                break
        c += 1
