"""What a chance map says of the plot as a whole: how many are still infested, and is it clean."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import gammaincinv, ndtri

from fieldmon.compute.arrays import read_only
from fieldmon.compute.digest import digest, places_by_name
from fieldmon.compute.jit import inner_inlined, loop, routine
from fieldmon.compute.random_streams import coin
from fieldmon.compute.wording import chance_figure, worded
from fieldmon.errors import SettingError
from fieldmon.infestation.chance_bounds import AS_GOOD_AS_CLEAN, KNOWN
from fieldmon.infestation.pairs.pairs import pairs_of
from fieldmon.infestation.pairs.uninspected_days import of_odds

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.plot.grid import Csr, PlantGrid

    Floats = NDArray[np.float64]
    _Table = tuple[NDArray[np.int64], NDArray[np.int64], Floats, Floats, Floats]

_DRAWS = 400
# which fields are drawn: the same ones always, so that an answer is the same when asked again
_KEY = np.uint64(0)
# the fields of a map are drawn once: what is there now and what was at the start are told by them
_kept = places_by_name(8)
# fields drawn side by side: a plant's neighbours are looked up once for all of them
_SIDE_BY_SIDE = 16
# of fewer plants one processor draws fields while threads would begin
_ALONE = 2000
# steps of this spread evenly over [0, 1)
_GOLDEN, _SILVER = 0.6180339887498949, 0.4142135623730950
# degrees of freedom of the tails of doubt, and the most, in sigmas (chosen on 40 seasons in each of
# ten worlds, on no seeds that the documentation reports)
_TAILS, _MOST_OFF = 3.0, 6.0
# of so many expected among plants that are as good as clean, none is infested
_HARDLY_ANY = 0.001
# a chance of none that is too small for a number is no certainty: where one is infested it is 0
_HARDLY = float(np.finfo(np.float64).tiny)


@dataclass(frozen=True)
class PlotEstimate:
    """How many plants are infested, as believed.

    Parameters
    ----------
    expected
        Expected number of infested plants.
    low, high
        Interval that holds the number with the chance asked for (90 % unless told).
    chance_clean
        Chance that no plant is infested.
    found
        So many more were found infested and only flagged; the others do not count them.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> believed = fm.Monitor(plot).estimate()
    >>> believed.low < believed.expected < believed.high
    True
    """

    expected: float
    low: int
    high: int
    chance_clean: float
    found: int = 0

    def beside(self, found: int) -> PlotEstimate:
        """Return the same with so many more plants, which were found infested and left."""
        low, high = self.low + found, self.high + found
        return PlotEstimate(self.expected + found, low, high, 0.0 if found else self.chance_clean)

    def sentence(self) -> str:
        """Return the estimate in words."""
        within, clean = (
            f"between {self.low:,} and {self.high:,}",
            chance_figure(self.chance_clean),
        )
        if self.found == 0:
            return (
                f"About {self.expected:,.0f} plants are still infested ({within}); "
                f"the chance that the plot is clean is {clean}."
            )
        return (
            f"About {self.expected:,.0f} plants are infested ({within}) beside the {self.found:,} "
            f"that were found and only flagged; the chance that the plot is clean is {clean}."
        )


def estimate_plot(
    grid: PlantGrid,
    chance: NDArray[np.float64],
    pair_chance: NDArray[np.float64] | None = None,
    sure: float = 0.9,
    doubt: float = 0.0,
) -> PlotEstimate:
    """Return what a chance map ``(n,)`` says of the whole plot.

    Parameters
    ----------
    pair_chance
        Chance ``(e,)`` that two plants side by side are both infested (`Belief.pair_chance`);
        without it they share their fate as `fieldmon.infestation.pairs.pairs.pair_chances` has it.
        Taken as independent, the number would seem far surer than it is.
    sure
        Chance that the interval holds the number.
    doubt
        How far the expected number may be off beyond that, as a share (`Belief.doubt`).
    """
    must_be_sure(sure)
    every = np.ones(len(chance), np.bool_)
    numbers, clean = _of_map(grid, (chance, pair_chance), every, doubt)
    return _estimate(float(chance.sum()), numbers, (clean, sure), exact=doubt <= 0.0)


def estimate_of(
    grid: PlantGrid,
    belief: Belief,
    sure: float = 0.9,
    found: NDArray[np.bool_] | None = None,
) -> PlotEstimate:
    """Return what a belief says of the whole plot, with the doubt that it tells of itself.

    Parameters
    ----------
    grid
        The plants.
    belief
        What is believed.
    sure
        Chance that the interval holds the number.
    found
        ``(n,)`` plants that were found infested and left, which do not count: of them nothing is
        in doubt (see `PlotEstimate.beside`). None: there are none.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.infestation.insects.spread import Spread
    >>> from fieldmon.infestation.tracing.traced_pairs import TracedPairs
    >>> from fieldmon.plot.layout import rectangle
    >>> grid = rectangle(20, 20)
    >>> tonight = TracedPairs.of(grid, np.full(400, 0.05))
    >>> in_two_days = tonight.overnight(Spread(0.05)).overnight(Spread(0.05))
    >>> estimate_of(grid, in_two_days).high > estimate_of(grid, tonight).high
    True
    """
    must_be_sure(sure)
    chance, doubt = belief.chance, level_doubt(belief)
    known = known_infested(belief, found)
    asked, n_known = ~known, np.count_nonzero(known)
    expected = float(chance[asked].sum())
    if (since := belief.since_inspected) is not None:
        factors = doubted_level(doubt)
        numbers = since.numbers(factors, expected, int(np.count_nonzero(asked)))
        clean = since.chance_of_none(factors, expected)
    else:
        numbers, clean = _of_map(grid, (chance, belief.pair_chance), asked, doubt)
    unknown = _estimate(expected, numbers, (clean, sure), exact=doubt <= 0.0)
    could_be = chance[asked] > AS_GOOD_AS_CLEAN
    if float(chance[asked][~could_be].sum()) < _HARDLY_ANY:
        most = max(unknown.low, int(np.count_nonzero(could_be)))
        unknown = replace(unknown, high=min(unknown.high, most))
    n_found = 0 if found is None else int(np.count_nonzero(found))
    return replace(unknown.beside(int(n_known) - n_found), found=n_found)


def known_infested(belief: Belief, found: NDArray[np.bool_] | None = None) -> NDArray[np.bool_]:
    """Return of which plants it is certain that they are infested, ``(n,)``.

    Those that were `found` and left, and those that are told to be by a chance near 1; none that
    came so near only while nobody inspected.
    """
    told, since = belief.chance > KNOWN, belief.since_inspected
    if since is not None and np.count_nonzero(told) > since.counted.known:
        told[np.argsort(-belief.chance, kind="stable")[since.counted.known :]] = False
    return told if found is None else told | found


def level_doubt(belief: Belief) -> float:
    """Return how far the expected number may be off, as a share.

    On days without inspections it is that of their first morning: nobody learns anything since.
    """
    since = belief.since_inspected
    return belief.doubt if since is None else since.counted.doubt


def _of_map(
    grid: PlantGrid,
    believed: tuple[Floats, Floats | None],
    asked: NDArray[np.bool_],
    doubt: float,
) -> tuple[Floats, float]:
    """Return how many of the plants asked about there may be by a map, and the chance of none."""
    numbers, none = drawn_numbers(grid, (believed[0], pairs_of(believed, grid)), asked)
    if doubt <= 0.0:
        return numbers, float(np.exp(none))
    factors, n = doubted_level(doubt), max(int(np.count_nonzero(asked)), 1)
    return of_odds(numbers, factors, n), float(np.exp(none * factors).mean())


def _estimate(
    expected: float, numbers: Floats, clean_sure: tuple[float, float], *, exact: bool
) -> PlotEstimate:
    clean, sure = clean_sure
    # there is one with no higher chance than so many are expected (Markov)
    clean = max(clean, 1.0 - expected, _HARDLY)
    below, above = _ends(sure)
    low, high = map(float, np.quantile(numbers, [below, above]))
    # doubted, to the nearest: outwards, an interval of a few plants would hold far more than asked
    ends = (math.floor(low), math.ceil(high)) if exact else (round(low), round(high))
    return PlotEstimate(expected, 0 if clean > below else ends[0], ends[1], clean)


def drawn_numbers(
    grid: PlantGrid, believed: tuple[Floats, Floats], asked: NDArray[np.bool_]
) -> tuple[Floats, float]:
    """Return how many of the plants asked about are infested in drawn fields, ``(400,)``.

    And the logarithm of the chance that none is, all others being known to be. `believed` is
    ``chance (n,)`` and ``pair_chance (e,)``.
    """
    chance, pair_chance = believed
    table = _table(chance, pair_chance, grid.adjacent)
    kept = _kept(digest(*table, asked))
    if not kept:
        kept.append(_drawn(table, _KEY, asked))
    drawn = kept[0]
    # round the loops of a lattice the drawn fields are a little off the map: put right together
    right = float(chance[asked].sum()) / max(float(drawn.mean()), 1e-9)
    # of the others, the chain of plants draws no infested one
    none = float(np.log1p(-_beside_known(table, ~asked)[asked]).sum())
    return (drawn * right).clip(0.0, np.count_nonzero(asked)), none


def must_be_sure(sure: float) -> None:
    """Raise `SettingError` if an interval cannot hold a number with such a chance."""
    if not 0.0 < sure < 1.0:
        raise SettingError(
            worded("'sure' must be a chance between 0 and 1, but it is {sure}.", sure=sure)
        )


def _ends(sure: float) -> list[float]:
    return [0.5 - sure / 2, 0.5 + sure / 2]


def doubted(doubt: float) -> Floats:
    """Return what the number in each drawn field is multiplied by: even draws of a gamma."""
    places = ((np.arange(_DRAWS) + 1) * _GOLDEN) % 1.0
    factors: Floats = gammaincinv(doubt**-2.0, places) * doubt**2.0
    return factors


@lru_cache(maxsize=8)
def doubted_level(doubt: float) -> Floats:
    """Return what a plot's odds may have to be multiplied by, as the doubt itself may be off.

    A logarithm with Student's tails: on mornings of seasons that no map was told of, nine tenths of
    a gamma held six to nine numbers of ten, and of pests that were named one to ten.
    """
    places = ((np.arange(_DRAWS) + 1) * _SILVER) % 1.0
    wide = np.sqrt(_TAILS / (2.0 * gammaincinv(_TAILS / 2.0, places)))
    even = ndtri(((np.arange(_DRAWS) + 1) * _GOLDEN) % 1.0)
    off = np.clip(even * wide, -_MOST_OFF, _MOST_OFF)
    return read_only(np.exp(np.sqrt(np.log1p(doubt**2)) * off))


def _drawn(table: _Table, key: np.uint64, asked: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return how many plants asked about are infested in each drawn field; all processors draw."""
    counts, n = np.empty(_DRAWS, np.int64), len(asked)

    def draw(a: int, b: int) -> None:
        room = np.zeros((n, _SIDE_BY_SIDE), np.bool_)
        _draw(table, key, (a, asked, room), counts[a:b])

    if n < _ALONE:
        draw(0, _DRAWS)
        return counts
    first = np.linspace(0, _DRAWS, (os.cpu_count() or 1) + 1).astype(np.int64).tolist()
    with ThreadPoolExecutor(len(first) - 1) as pool:
        for part in [pool.submit(draw, a, b) for a, b in pairwise(first)]:
            part.result()
    return counts


@loop
def _draw(
    table: _Table,
    key: np.uint64,
    fields: tuple[int, NDArray[np.bool_], NDArray[np.bool_]],
    counts: NDArray[np.int64],
) -> None:
    """Count the infested of fields drawn plant after plant, given neighbours drawn before.

    `fields` are the number of the first one, which its draws hang on, the plants asked about, and
    room for some ``(n, f)``.
    """
    first, asked, drawn = fields
    n, most = drawn.shape
    for k in range(0, counts.size, most):
        some = min(most, counts.size - k)
        counts[k : k + some] = 0
        for i in range(n):
            for f in range(some):
                drawn[i, f] = coin(key, (first + k + f) * n + i) < _given(table, drawn, i, f)
                counts[k + f] += drawn[i, f] and asked[i]


@routine
def draw_fields(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    adjacent: Csr,
    key: np.uint64,
    fields: NDArray[np.bool_],
) -> None:
    """Draw whole fields ``(m, n)`` in place from ``chance (n,)`` and ``pair_chance (e,)``."""
    chance, pair_chance = believed
    table = _table(chance, pair_chance, adjacent)
    drawn = fields.T
    for k in range(fields.shape[0]):
        for i in range(chance.size):
            drawn[i, k] = coin(key, k * chance.size + i) < _given(table, drawn, i, k)


@routine
def _table(chance: NDArray[np.float64], pair_chance: NDArray[np.float64], adjacent: Csr) -> _Table:
    """Return what a neighbour of lower number does to each plant's odds: drawn hundreds of times.

    Start of each plant's neighbours, the neighbours, the factor of an infested and of a clean one,
    the odds without any, and the chance if all are clean.
    """
    n = chance.size
    start = np.zeros(n + 1, np.int64)
    plant = np.empty(adjacent.plant.size, np.int64)
    factor = np.empty((adjacent.plant.size, 2))
    odds = chance / (1.0 - chance)
    alone = np.empty(n)
    at = 0
    for i in range(n):
        p, given = chance[i], odds[i]
        for e in range(adjacent.start[i], adjacent.start[i + 1]):
            j = adjacent.plant[e]
            if j > i:
                continue
            q = chance[j]
            c = min(pair_chance[e], p, q)
            plant[at] = j
            factor[at, 0] = (1.0 - c / p) / max(1.0 - (q - c) / (1.0 - p), 1e-9)
            factor[at, 1] = (c / p) / max((q - c) / (1.0 - p), 1e-9)
            given *= factor[at, 0]
            at += 1
        start[i + 1] = at
        alone[i] = min(given / (1.0 + given), 1.0 - 1e-9)
    return start, plant[:at], factor[:at], odds, alone


@routine
def _beside_known(table: _Table, known: NDArray[np.bool_]) -> Floats:
    """Return the chance of each plant if of those before it only the known ones are infested."""
    field, given = known.reshape((known.size, 1)), np.empty(known.size)
    for i in range(known.size):
        given[i] = _given(table, field, i, 0)
    return given


@inner_inlined
def _given(table: _Table, drawn: NDArray[np.bool_], i: int, field: int) -> float:
    """Return the chance of plant i given its neighbours of lower number in one of the fields."""
    start, plant, factor, odds, alone = table
    infested = 0
    for e in range(start[i], start[i + 1]):
        infested += drawn[plant[e], field]
    if infested == 0:
        return float(alone[i])
    given = odds[i]
    for e in range(start[i], start[i + 1]):
        given *= factor[e, int(drawn[plant[e], field])]
    return float(min(given / (1.0 + given), 1.0 - 1e-9))
