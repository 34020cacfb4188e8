"""Spread foretold on mapped plots, from one date to the next, and what was seen.

Each way of spreading has its numbers fitted on one half of a plot and foretells the other, so that
none is told what it is asked. Scored are the plants that were clean: minus the logarithm of the
chance given to what was seen, on average.

Half of a plot tells little of which kernel it is, and the one that fits it best foretells the other
half worse than no kernel at all where few plants were infested. So the last way takes all of them,
and as many anywhere besides, each as likely as it foretold what was seen so far, on earlier dates
too (Bayesian model averaging: Hoeting et al. 1999, Stat. Sci. 14:382).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import minimize

from fieldmon.compute.wording import counted
from fieldmon.errors import FileProblem
from fieldmon.infestation.insects.dispersal import Dispersal
from fieldmon.infestation.insects.kernels import DistanceKernel
from fieldmon.studies.plant_maps import read_plant_maps

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.studies.plant_maps import PlantMap

    Floats = NDArray[np.float64]
    Mask = NDArray[np.bool_]
    #: how many numbers are fitted, and what they bring to each plant
    _Way = tuple[int, Callable[[Floats], Floats]]

#: public maps of several dates
DATED = ("citrus_ctv_IVI3and4.csv", "hop_viruses_HpLV.csv", "DidymellaWatermelon.csv")
# no chance is taken for less or more (our choice): what was not foretold at all costs so much
_LEAST = 1e-3
# mean jumps, in plants, from which a kernel's is taken; and how often the rows are preferred
_REACHES = (0.7, 1.5, 3.0, 6.0, 12.0)
_ALONG = (0.33, 1.0, 3.0)
_WAYS = ("no_change", "evenly", "thesis", "kernel", "weighed")
_N_KERNELS = len(_REACHES) * len(_ALONG)
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
        ``(n,)`` which plants were infested.
    half
        ``(n,)`` which half of the plot each plant is in.
    earlier
        Earlier intervals of the map.
    unknown
        ``(n,)`` whose state nobody knows on one of the dates, or who stood there on neither; None:
        all are known.
    """

    name: str
    grid: PlantGrid
    before: Mask
    after: Mask
    half: Mask
    earlier: tuple[Interval, ...] = ()
    unknown: Mask | None = None

    @property
    def clean(self) -> Mask:
        """Return who was known to be clean before, and of whom it is known after ``(n,)``."""
        return ~self.before if self.unknown is None else ~(self.before | self.unknown)


@dataclass(frozen=True)
class MapScores:
    """Logarithmic scores of one interval, less is better.

    Parameters
    ----------
    name
        Map and dates.
    clean, new
        Plants that were clean, and that were infested by the second date.
    unknown
        Plants that are left out, as nobody knows their state on one of the dates.
    no_change
        Nothing happens.
    evenly
        So many are infested anywhere, all alike.
    thesis
        The thesis's rule: with a chance each plant next to an infested one.
    kernel
        An exponential kernel with arrivals from outside.
    weighed
        All such kernels and as many anywhere, weighed by what they foretold so far.
    reach
        Mean jump of the one kernel in plants, of either half.
    """

    name: str
    clean: int
    new: int
    no_change: float
    evenly: float
    thesis: float
    kernel: float
    weighed: float
    reach: tuple[float, float]
    unknown: int = 0

    def sentence(self) -> str:
        """Return them in words."""
        return (
            f"{self.name:34} {self.new:3d} of {self.clean:4d} new; log score: no change "
            f"{self.no_change:.3f}, evenly {self.evenly:.3f}, the thesis's rule {self.thesis:.3f}, "
            f"kernel {self.kernel:.3f} (mean jump {self.reach[0]:g} and {self.reach[1]:g} plants), "
            f"kernels weighed {self.weighed:.3f}"
            + (
                f"; {counted(self.unknown, 'plant')} of unknown state left out"
                if self.unknown
                else ""
            )
        )


def intervals_in(folder: Path) -> list[Interval]:
    """Return the dates that follow each other on the public maps of a folder and its folders."""
    maps = read_plant_maps(folder, DATED)
    made = [interval for each in maps for interval in _intervals(each)]
    if not made:
        names = ", ".join(each.name for each in maps)
        raise FileProblem(
            f"A map must have two dates between which {_FEW} plants or more were infested, and "
            f"after which {_FEW} or more were still clean, with one infested before. None of these "
            f"has: {names}."
        )
    return made


def _intervals(of: PlantMap) -> list[Interval]:
    grid = of.aisles().grid
    half = np.arange(len(grid)) % of.n_plants >= of.n_plants // 2
    made: list[Interval] = []
    for k in range(len(of.dates) - 1):
        before, after = of.infested[k], of.infested[k + 1]
        name, known = f"{of.name} {of.dates[k]} to {of.dates[k + 1]}", of.known[k] & of.known[k + 1]
        one = Interval(name, grid, before, after, half, tuple(made), ~known)
        new, clean = np.count_nonzero(after & one.clean), np.count_nonzero(one.clean)
        if new >= _FEW and clean - new >= _FEW and before.any():
            made.append(one)
    return made


def scores(of: Interval) -> MapScores:
    """Return how well each way of spreading foretells an interval."""
    clean = of.clean
    total, reaches, ways = dict.fromkeys(_WAYS, 0.0), [], _ways(of)
    before = np.zeros(1 + _N_KERNELS)
    for past in of.earlier:
        before += [one.evidence for one in _fits(past, _ways(past), past.clean)]
    for half in (False, True):
        told, asked = (clean & (of.half == side) for side in (half, not half))
        each = _fits(of, ways, told)
        best = 1 + int(np.argmax([one.evidence for one in each[1:]]))
        reaches.append(_REACHES[(best - 1) // len(_ALONG)])
        chances = {
            "no_change": _chance(_nothing, np.zeros(1), of),
            "evenly": each[0].chance,
            "thesis": _fitted((1, _from_adjacent(of)), of, told).chance,
            "kernel": each[best].chance,
            "weighed": _weighed(each, before),
        }
        for name, chance in chances.items():
            total[name] += float(_minus_log(chance[asked], of.after[asked]).sum())
    n = np.count_nonzero(clean)
    scored = {name: one / n for name, one in total.items()}
    new = int(np.count_nonzero(of.after & clean))
    unknown = 0 if of.unknown is None else int(np.count_nonzero(of.unknown))
    reach = reaches[0], reaches[1]
    return MapScores(of.name, int(n), new, **scored, reach=reach, unknown=unknown)


class _Fit(NamedTuple):
    """The evidence for a way, fitted, and every plant's chance by it ``(n,)``.

    The evidence is the logarithm of the likelihood, less what numbers that were fitted gain by
    themselves (Schwarz 1978, Ann. Stat. 6:461).
    """

    evidence: float
    chance: Floats


def _weighed(each: list[_Fit], before: Floats) -> Floats:
    """Return the chances by all ways, as likely as what was seen so far makes each."""
    known = before + np.array([one.evidence for one in each])
    # as likely as not the infested stand tells nothing; else each kernel is as likely
    known += np.log(np.append(0.5, np.full(_N_KERNELS, 0.5 / _N_KERNELS)))
    weight = np.exp(known - known.max())
    chance: Floats = weight / weight.sum() @ np.array([one.chance for one in each])
    return chance


def _nothing(_: Floats) -> Floats:
    none: Floats = np.zeros(1)
    return none


def _evenly(numbers: Floats) -> Floats:
    rate: Floats = np.exp(numbers[:1])
    return rate


def _from_adjacent(of: Interval) -> Callable[[Floats], Floats]:
    """Return what the thesis's rule brings to each plant, by the rate."""
    start, other = of.grid.adjacent
    plants = np.repeat(np.arange(len(of.before)), np.diff(start))
    near = np.bincount(plants, of.before[other], len(of.before))

    def brought(numbers: Floats) -> Floats:
        rates: Floats = np.exp(numbers[0]) * near
        return rates

    return brought


def _ways(of: Interval) -> list[_Way]:
    """Return what evenly, and each kernel, brings to each plant, and how many numbers it has."""
    spacing_m = float(np.sqrt(of.grid.row_spacing_m * of.grid.plant_spacing_m))
    kernels = [
        _by_kernel(of, DistanceKernel("exponential", reach * spacing_m, 1.0 / along))
        for reach in _REACHES
        for along in _ALONG
    ]
    return [(1, _evenly), *((2, one) for one in kernels)]


def _by_kernel(of: Interval, kernel: DistanceKernel) -> Callable[[Floats], Floats]:
    landed = Dispersal.of(of.grid, kernel).landed(of.before.astype(float))

    def brought(numbers: Floats) -> Floats:
        rates: Floats = np.exp(numbers[0]) * landed + np.exp(numbers[1])
        return rates

    return brought


def _fits(of: Interval, ways: list[_Way], told: Mask) -> list[_Fit]:
    return [_fitted(way, of, told) for way in ways]


def _fitted(way: _Way, of: Interval, told: Mask) -> _Fit:
    """Return a way with the numbers that fit the plants told best."""
    numbers, brought = way

    def score(tried: Floats) -> float:
        return float(_minus_log(_chance(brought, tried, of)[told], of.after[told]).sum())

    begins = np.log(np.array([0.2, 0.02])[:numbers])
    made = minimize(score, begins, method="Nelder-Mead", options={"maxiter": 200})
    n = max(int(np.count_nonzero(told)), 1)
    evidence = -made.fun - 0.5 * numbers * np.log(n)
    return _Fit(float(evidence), _chance(brought, made.x, of))


def _chance(brought: Callable[[Floats], Floats], numbers: Floats, of: Interval) -> Floats:
    rates = np.broadcast_to(brought(np.clip(numbers, -12.0, 4.0)), of.before.shape)
    chance: Floats = np.clip(-np.expm1(-rates), _LEAST, 1.0 - _LEAST)
    return chance


def _minus_log(chance: Floats, seen: Mask) -> Floats:
    return -np.log(np.where(seen, chance, 1.0 - chance))
