"""Worlds: what insects may do that no chance map of ours was told.

Nothing here is shared with a belief. An infestation jumps a distance drawn in plants, whatever
stands between; what lands where no plant stands is lost. Every draw belongs to a plant and a
night, so that all samplers meet the same insects.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]
    Jump = Callable[[np.random.Generator, int], Floats]

# what lands farther from every plant than this, in plants, is lost
_REACHED = 0.75
# share of a night's infestations from outside along an edge, by depth in plants
_DEPTH = 2.0
_STEPS = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])


def _to_one_adjacent(draws: np.random.Generator, n: int) -> Floats:
    return _STEPS[draws.integers(0, 4, n)]


def _along_the_row(draws: np.random.Generator, n: int) -> Floats:
    """Nine of ten go to the next plant of the row."""
    along, step = draws.random(n) < 0.9, draws.integers(0, 2, n)
    return _STEPS[np.where(along, step, step + 2)]


def _turned(reach: Floats, angle: Floats) -> Floats:
    return np.column_stack([reach * np.cos(angle), reach * np.sin(angle)])


def _cauchy(draws: np.random.Generator, n: int) -> Floats:
    """As far as a two-dimensional Cauchy distribution of scale 1 has it."""
    reach = np.sqrt(np.maximum(draws.random(n), 1e-9) ** -2.0 - 1.0)
    return _turned(reach, draws.uniform(0.0, 2.0 * np.pi, n))


def _exponential(mean: float) -> Jump:
    def jump(draws: np.random.Generator, n: int) -> Floats:
        return _turned(draws.exponential(mean, n), draws.uniform(0.0, 2.0 * np.pi, n))

    return jump


def _downwind(draws: np.random.Generator, n: int) -> Floats:
    """Four plants on average, within 45 degrees of one direction."""
    return _turned(draws.exponential(4.0, n), np.pi / 6 + draws.uniform(-1.0, 1.0, n) * np.pi / 4)


@dataclass(frozen=True)
class World:
    """What insects do in a season.

    Parameters
    ----------
    jump
        Draws where ``(n, 2)`` infestations land, in plants along and across the rows.
    anywhere
        Share of jumps that land on any plant of the plot.
    arrivals, at_edge
        Share of all plants that is infested from outside in a night, and whether near the plot's
        edge and roads only.
    hidden_nights
        Nights for which an infestation spreads and cannot be found.
    rate
        Chance that an infested plant sends one infestation in a night.
    """

    jump: Jump = _to_one_adjacent
    anywhere: float = 0.0
    arrivals: float = 0.0
    at_edge: bool = False
    hidden_nights: int = 0
    rate: float = 0.3

    def night(
        self, grid: PlantGrid, infested: NDArray[np.bool_], key: np.uint64
    ) -> NDArray[np.bool_]:
        """Return which plants are infested the next morning, ``(n,)``."""
        draws = np.random.default_rng(int(key))
        after = infested.copy()
        senders = np.flatnonzero(infested)
        reached = self.reached(grid, draws, senders)
        sends = (draws.random(len(grid)) < self.rate)[senders] & (reached >= 0)
        after[reached[sends]] = True
        return after | self._arrived(grid, draws)

    def reached(
        self, grid: PlantGrid, draws: np.random.Generator, senders: NDArray[np.intp]
    ) -> NDArray[np.intp]:
        """Draw which plant an infestation sent by each of `senders` ``(k,)`` reaches; -1: none.

        Draws are made for all plants: those of one do not hang on who else is infested.
        """
        n, spacing = len(grid), np.array([grid.plant_spacing_m, grid.row_spacing_m])
        jumps = self.jump(draws, n)[senders]
        anywhere = (draws.random(n) < self.anywhere)[senders]
        far = draws.integers(0, n, n)[senders]
        apart, landed = grid.tree.query(
            grid.xy_m[senders] + jumps * spacing,
            distance_upper_bound=_REACHED * float(spacing.max()),
        )
        return np.where(anywhere, far, np.where(np.isfinite(apart), landed, -1))

    def _arrived(self, grid: PlantGrid, draws: np.random.Generator) -> NDArray[np.bool_]:
        n = len(grid)
        chance = np.full(n, self.arrivals)
        if self.at_edge:
            near = near_edge(grid)
            chance *= near / near.mean()
        arrived: NDArray[np.bool_] = draws.random(n) < chance
        return arrived


def near_edge(grid: PlantGrid) -> Floats:
    """Return how near the plot's edge each plant stands, ``(n,)``: 1 at it, 1/e two plants in."""
    edge = shapely.boundary(grid.drivable_m)
    shapely.prepare(edge)
    spacing_m = np.sqrt(grid.plant_spacing_m * grid.row_spacing_m)
    near: Floats = np.exp(-shapely.distance(edge, shapely.points(grid.xy_m)) / _DEPTH / spacing_m)
    return near


WORLDS = {
    "adjacent plants": World(),
    "10% random jumps": World(anywhere=0.1),
    "along the row": World(_along_the_row),
    "Cauchy": World(_cauchy),
    "exponential, mean 2": World(_exponential(2.0)),
    "exponential, mean 4": World(_exponential(4.0)),
    "wind": World(_downwind),
    "edges and road all season": World(arrivals=0.001, at_edge=True),
    "arrivals anywhere": World(arrivals=0.001),
    "hidden for 4 nights": World(hidden_nights=4),
}
"""By name. Where nothing else is said, an infested plant infests one beside it, 30 % a night."""
