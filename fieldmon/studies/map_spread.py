"""Spread foretold on mapped plots, from one date to the next, and what was seen.

Each way of spreading has its numbers fitted on one half of a plot and foretells the other, so that
none is told what it is asked. Scored are the plants that were clean: minus the logarithm of the
chance given to what was seen, on average.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import minimize

from fieldmon.errors import FileProblem
from fieldmon.infestation.dispersal import Dispersal
from fieldmon.infestation.kernels import DistanceKernel
from fieldmon.studies.plant_maps import PUBLIC_MAPS, read_plant_map

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.studies.plant_maps import PlantMap

    Floats = NDArray[np.float64]
    Mask = NDArray[np.bool_]

#: public maps of several dates
DATED = ("citrus_ctv_IVI3and4.csv", "hop_viruses_HpLV.csv", "DidymellaWatermelon.csv")
# no chance is taken for less or more (our choice): what was not foretold at all costs so much
_LEAST = 1e-3
# mean jumps, in plants, from which a kernel's is taken; and how often the rows are preferred
_REACHES = (0.7, 1.5, 3.0, 6.0, 12.0)
_ALONG = (0.33, 1.0, 3.0)
# a date must bring so many, and leave so many clean
_FEW = 5


class Interval(NamedTuple):
    """Two dates of a mapped plot.

    Parameters
    ----------
    name
        Map and dates.
    grid
        Its plants.
    before, after
        ``(n,)`` who was infested.
    half
        ``(n,)`` which half of the plot each plant is in.
    """

    name: str
    grid: PlantGrid
    before: Mask
    after: Mask
    half: Mask


@dataclass(frozen=True)
class MapScores:
    """Logarithmic scores of one interval, less is better.

    Parameters
    ----------
    name
        Map and dates.
    clean, new
        Plants that were clean, and that were infested by the second date.
    no_change
        Nothing happens.
    evenly
        So many are infested anywhere, all alike.
    thesis
        The thesis's rule: with a chance each plant next to an infested one.
    kernel
        An exponential kernel with arrivals from outside.
    reach
        Its mean jump in plants, of either half.
    """

    name: str
    clean: int
    new: int
    no_change: float
    evenly: float
    thesis: float
    kernel: float
    reach: tuple[float, float]

    def sentence(self) -> str:
        """Return them in words."""
        return (
            f"{self.name:34} {self.new:3d} of {self.clean:4d} new; log score: no change "
            f"{self.no_change:.3f}, evenly {self.evenly:.3f}, the thesis's rule {self.thesis:.3f}, "
            f"kernel {self.kernel:.3f} (mean jump {self.reach[0]:g} and {self.reach[1]:g} plants)"
        )


def intervals_in(folder: Path) -> list[Interval]:
    """Return the dates that follow each other on the public maps of a folder and its folders."""
    files = sorted(path for path in folder.rglob("*") if path.name in DATED)
    if not files:
        raise FileProblem(f"{folder} must hold one of {', '.join(DATED)}, but it does not.")
    maps = [each for path in files for each in read_plant_map(path, PUBLIC_MAPS[path.name])]
    return [interval for each in maps for interval in _intervals(each)]


def _intervals(of: PlantMap) -> list[Interval]:
    grid = of.aisles().grid
    half = np.arange(len(grid)) % of.n_plants >= of.n_plants // 2
    made = []
    for k in range(len(of.dates) - 1):
        before, after = of.infested[k], of.infested[k + 1]
        new, clean = np.count_nonzero(after & ~before), np.count_nonzero(~before)
        if new >= _FEW and clean - new >= _FEW and before.any():
            name = f"{of.name} {of.dates[k]} to {of.dates[k + 1]}"
            made.append(Interval(name, grid, before, after, half))
    return made


def scores(of: Interval) -> MapScores:
    """Return how well each way of spreading foretells an interval."""
    ways: dict[str, list[Callable[[Floats], Floats]]] = {
        "no_change": [_nothing],
        "evenly": [_evenly],
        "thesis": [_beside(of)],
        "kernel": _kernels(of),
    }
    scored, reaches = {}, []
    for name, candidates in ways.items():
        total = 0.0
        for half in (False, True):
            told, asked = (~of.before & (of.half == side) for side in (half, not half))
            chance, which = _fitted(candidates, of, told)
            total += _minus_log(chance[asked], of.after[asked]).sum()
            if name == "kernel":
                reaches.append(_REACHES[which // len(_ALONG)])
        scored[name] = float(total / np.count_nonzero(~of.before))
    new = int(np.count_nonzero(of.after & ~of.before))
    clean = int(np.count_nonzero(~of.before))
    return MapScores(of.name, clean, new, **scored, reach=(reaches[0], reaches[1]))


def _nothing(_: Floats) -> Floats:
    none: Floats = np.zeros(1)
    return none


def _evenly(numbers: Floats) -> Floats:
    rate: Floats = np.exp(numbers[:1])
    return rate


def _beside(of: Interval) -> Callable[[Floats], Floats]:
    """Return what the thesis's rule brings to each plant, by the rate."""
    start, other = of.grid.adjacent
    plants = np.repeat(np.arange(len(of.before)), np.diff(start))
    near = np.bincount(plants, of.before[other], len(of.before))

    def brought(numbers: Floats) -> Floats:
        rates: Floats = np.exp(numbers[0]) * near
        return rates

    return brought


def _kernels(of: Interval) -> list[Callable[[Floats], Floats]]:
    """Return what each candidate kernel brings to each plant, by its rate and that of arrivals."""
    spacing_m = float(np.sqrt(of.grid.row_spacing_m * of.grid.plant_spacing_m))
    return [
        _by_kernel(of, DistanceKernel("exponential", reach * spacing_m, 1.0 / along))
        for reach in _REACHES
        for along in _ALONG
    ]


def _by_kernel(of: Interval, kernel: DistanceKernel) -> Callable[[Floats], Floats]:
    landed = Dispersal.of(of.grid, kernel).landed(of.before.astype(float))

    def brought(numbers: Floats) -> Floats:
        rates: Floats = np.exp(numbers[0]) * landed + np.exp(numbers[1])
        return rates

    return brought


def _fitted(
    candidates: list[Callable[[Floats], Floats]], of: Interval, told: Mask
) -> tuple[Floats, int]:
    """Return every plant's chance by the candidate that fits the plants told best, and which."""
    best, chance, which = np.inf, np.zeros(len(of.before)), 0
    for k, brought in enumerate(candidates):

        def score(numbers: Floats, brought: Callable[[Floats], Floats] = brought) -> float:
            return float(_minus_log(_chance(brought, numbers, of)[told], of.after[told]).sum())

        begins = np.log(np.array([0.2, 0.02]))
        made = minimize(score, begins, method="Nelder-Mead", options={"maxiter": 200})
        if made.fun < best:
            best, chance, which = made.fun, _chance(brought, made.x, of), k
    return chance, which


def _chance(brought: Callable[[Floats], Floats], numbers: Floats, of: Interval) -> Floats:
    rates = np.broadcast_to(brought(np.clip(numbers, -12.0, 4.0)), of.before.shape)
    chance: Floats = np.clip(-np.expm1(-rates), _LEAST, 1.0 - _LEAST)
    return chance


def _minus_log(chance: Floats, seen: Mask) -> Floats:
    return -np.log(np.where(seen, chance, 1.0 - chance))
