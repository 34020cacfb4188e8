"""What the chance map decides: whether so much is infested that treating pays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csc_array

from fieldmon.compute.array_arguments import plants_marked
from fieldmon.compute.arrays import read_only
from fieldmon.compute.wording import chance_figure, counted, joined, worded
from fieldmon.decisions.sequential import INSPECT_MORE, LEAVE, TREAT, Verdict
from fieldmon.errors import SettingError
from fieldmon.infestation.pairs.pairs import pairs_of
from fieldmon.infestation.plot_estimate import doubted, draw_fields, known_infested

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.pairs.uninspected_days import Since
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

_DRAWS = 400
# shares are sums of the plants' parts, which are rounded
_ROUNDED = 1e-9
# fields drawn at a time, so that a million plants need no gigabyte
_CELLS_AT_ONCE = 20_000_000


@dataclass(frozen=True)
class MapVerdict:
    """Whether treating pays, as the chance map has it.

    Parameters
    ----------
    verdict
        ``"treat"``, ``"do not treat"`` or ``"inspect more"``.
    level
        Share of plants infested from which on treating pays.
    chance_above
        Chance that the true share is at the level or above.
    share, low, high
        Share of plants infested as expected, and the interval that holds it with `sure`.
    sure
        How sure a verdict must be.
    inspected
        Whether anybody has inspected; else the verdict is to inspect more, whatever was told.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> fm.Monitor(plot).verdict(level=0.05).verdict
    'inspect more'
    """

    verdict: Verdict
    level: float
    chance_above: float
    share: float
    low: float
    high: float
    sure: float
    inspected: bool = True

    def where(self, *, inspected: bool) -> MapVerdict:
        """Return it where anybody has inspected, or nobody: then there is no verdict yet."""
        return self if inspected else replace(self, verdict=INSPECT_MORE, inspected=False)

    @property
    def wrong(self) -> float:
        """Return the chance that the verdict is wrong; of "inspect more", that "treat" would be."""
        return self.chance_above if self.verdict == LEAVE else 1.0 - self.chance_above

    def sentence(self) -> str:
        """Return it as an answer to "do I have to spray?"."""
        answer = (
            worded("Treat:") if self.verdict == TREAT
            else worded("Do not treat:") if self.verdict == LEAVE
            else worded("Keep inspecting before you decide:")
        )  # fmt: skip
        return joined(" ", (answer, self.believed()))

    def believed(self) -> str:
        """Return what the answer rests on."""
        # its interval hangs on rates alone: another than that of the status, it would confuse
        return worded(
            "{share:.1%} of the plants are believed infested. Treating pays if it is {level:.1%} "
            "or more; the chance of that is {chance}.",
            share=self.share, level=self.level,
            chance=chance_figure(self.chance_above, drawn=True),
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class AskedVerdict:
    """What is asked of a verdict.

    Parameters
    ----------
    level
        Share of the plants from which on treating pays, between 0 and 1.
    sure
        A verdict needs this chance of being right, between 0.5 and 1.
    doubt
        How far the expected share may be off beyond what the chances say, as a share of it
        (`Belief.doubt_of_rates`).
    since
        What the number may have become on days without inspections (`Belief.since_inspected`).
    found
        ``(n,)`` plants of which nothing is in doubt, as they were found infested and left or are
        told to be infested. None: there are none.

    Raises
    ------
    SettingError
        If the level or `sure` cannot be.
    """

    level: float
    sure: float = 0.9
    doubt: float = 0.0
    since: Since | None = None
    found: NDArray[np.bool_] | None = None

    @classmethod
    def on(
        cls,
        belief: Belief,
        level: float,
        sure: float = 0.9,
        found: NDArray[np.bool_] | None = None,
    ) -> AskedVerdict:
        """Return what is asked of a belief, which says itself how doubtful its number is."""
        known = known_infested(belief, found)
        return cls(level, sure, belief.doubt_of_rates, belief.since_inspected, known)

    def __post_init__(self) -> None:
        if not 0.0 < self.level < 1.0:
            raise SettingError(
                worded(
                    "The share of plants from which treating pays must lie between 0 and 1, but it "
                    "is {level:g}.",
                    level=self.level,
                )
            )
        if not 0.5 < self.sure < 1.0:
            raise SettingError(
                worded(
                    "A verdict must be asked to be right with a chance between 0.5 and 1, but it "
                    "is {sure:g}.",
                    sure=self.sure,
                )
            )

    def of(self, shares: Floats, share: float) -> MapVerdict:
        """Return the verdict on drawn shares ``(draws,)`` of plants, `share` of them expected."""
        above = float(np.mean(shares >= self.level * (1.0 - _ROUNDED)))
        verdict: Verdict = (
            TREAT if above >= self.sure else LEAVE if above <= 1 - self.sure else INSPECT_MORE
        )
        low, high = np.quantile(shares, [0.5 - self.sure / 2, 0.5 + self.sure / 2])
        return MapVerdict(verdict, self.level, above, share, float(low), float(high), self.sure)


def map_verdict(
    grid: PlantGrid,
    chance: Floats,
    asked: AskedVerdict,
    pair_chance: Floats | None = None,
    *,
    plants: NDArray[np.bool_] | None = None,
    key: np.uint64 = np.uint64(0),  # noqa: B008 - a number, not a call with effects
) -> MapVerdict:
    """Return whether a plot, or a part of it, has to be treated.

    Whole fields are drawn from the chance map, neighbours together: were plants taken as
    independent, the share would seem far surer than it is.

    Parameters
    ----------
    grid
        The plants.
    chance
        ``(n,)`` chance that each plant is infested.
    asked
        From which share on treating pays, and how sure the answer must be.
    pair_chance
        ``(e,)`` chance that two neighbours are both infested; None: as records have it.
    plants
        ``(n,)`` the part of the plot that is asked about; None: all.
    key
        Which fields are drawn: the same key, the same answer.

    Raises
    ------
    SettingError
        If no plant is asked about.

    Examples
    --------
    >>> import numpy as np, fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> chance = np.full(plot.n_plants, 0.002)
    >>> map_verdict(plot.grid, chance, AskedVerdict(0.05)).verdict
    'do not treat'
    """
    of = np.ones(len(grid), bool) if plants is None else _asked(plants, len(grid))
    if not of.any():
        raise SettingError(
            worded("A verdict must be about a plant or more, but the area holds none.")
        )
    pairs = pairs_of((chance, pair_chance), grid)
    weights = csc_array(of[:, None] / np.count_nonzero(of))
    shares = _drawn(grid, (chance, pairs), weights, asked, key)
    return asked.of(shares[:, 0], float(chance[of].mean()))


def verdict_of(
    grid: PlantGrid,
    belief: Belief,
    level: float,
    sure: float = 0.9,
    found: NDArray[np.bool_] | None = None,
    *,
    plants: NDArray[np.bool_] | None = None,
) -> MapVerdict:
    """Return the same of a belief, with the doubt that it tells of itself, see `AskedVerdict`."""
    asked = AskedVerdict.on(belief, level, sure, found)
    return map_verdict(grid, belief.chance, asked, belief.pair_chance, plants=plants)


def _asked(plants: object, n: int) -> NDArray[np.bool_]:
    """Return which plants are asked about, ``(n,)``."""
    return plants_marked(
        "The mask of plants asked about", plants, n,
        lambda size: worded(
            "Whether it is asked about must be said of each of the {n} plants, but it is of "
            "{size}.",
            n=n, size=size,
        ),
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class ZoneVerdicts:
    """What is said of each zone by itself, and of the plot once they are treated.

    Parameters
    ----------
    zones
        The verdict of each zone, in their order.
    enough
        Chance that the plot is below the level after all of them are treated.
    """

    zones: tuple[MapVerdict, ...]
    enough: float

    def __repr__(self) -> str:
        enough = chance_figure(self.enough, drawn=True)
        return f"<ZoneVerdicts: {counted(len(self.zones), 'zone')}, enough: {enough}>"


def zone_verdicts(
    grid: PlantGrid,
    believed: tuple[Floats, Floats | None],
    zones: NDArray[np.int64],
    asked: AskedVerdict,
    works: float,
) -> ZoneVerdicts:
    """Return the verdict of each zone, and the chance that treating them all is enough.

    Parameters
    ----------
    grid
        The plants.
    believed
        ``(n,)`` chance of each plant, and ``(e,)`` of two neighbours, None: as records have it.
    zones
        ``(n,)`` the zone of each plant, from 0; -1: none.
    asked
        From which share on treating pays, of a zone and of the plot, and how sure a verdict must
        be.
    works
        Chance that treating cleans an infested plant.
    """
    chance, pairs = believed[0], pairs_of(believed, grid)
    n, count = len(grid), int(zones.max(initial=-1)) + 1
    inside = np.flatnonzero(zones >= 0)
    each = np.bincount(zones[inside], minlength=max(count, 1)).clip(1)
    left = np.where(zones >= 0, 1.0 - works, 1.0) / n
    weights = csc_array(
        (
            np.concatenate([1.0 / each[zones[inside]], left]),
            (
                np.concatenate([inside, np.arange(n)]),
                np.concatenate([zones[inside], np.full(n, count)]),
            ),
        ),
        (n, count + 1),
    )
    shares = _drawn(grid, (chance, pairs), weights, asked)
    expected = chance @ weights
    made = [asked.of(shares[:, k], float(expected[k])) for k in range(count)]
    return ZoneVerdicts(tuple(made), float(np.mean(shares[:, count] < asked.level)))


def _drawn(
    grid: PlantGrid,
    believed: tuple[Floats, Floats],
    weights: csc_array,
    asked: AskedVerdict,
    key: np.uint64 = np.uint64(0),  # noqa: B008 - a number, not a call with effects
) -> Floats:
    """Return sums over the infested plants of each drawn field, ``(draws, k)``.

    `weights` ``(n, k)`` is what each plant counts in each sum, and `key` names the fields.
    """
    n, chance = len(grid), believed[0]
    known = np.zeros(n, np.bool_) if asked.found is None else asked.found
    at_once = int(np.clip(_CELLS_AT_ONCE // n, 1, _DRAWS))
    sums, numbers = np.empty((_DRAWS, weights.shape[1])), np.empty(_DRAWS)
    for first in range(0, _DRAWS, at_once):
        fields = np.empty((min(at_once, _DRAWS - first), n), bool)
        draw_fields(believed, grid.adjacent, key + np.uint64(first), fields)
        if asked.found is not None:
            fields[:, known] = False
        sums[first : first + len(fields)] = fields @ weights
        if asked.since is not None:
            numbers[first : first + len(fields)] = np.count_nonzero(fields, axis=1)
    # round the loops of a lattice the drawn fields are a little off the map: put right together
    unknown = np.where(known, 0.0, chance)
    right = unknown @ weights
    sums *= right / np.maximum(sums.mean(axis=0), 1e-12)
    factors = doubted(asked.doubt) if asked.doubt > 0.0 else np.ones(_DRAWS)
    if asked.since is None:
        sums *= factors[:, None]
    else:
        expected = max(float(unknown.sum()), 1e-12)
        became = asked.since.numbers(factors, expected, n - int(np.count_nonzero(known)))
        # where none is drawn, what arrived since stands where it is expected
        sums = np.where(
            numbers[:, None] > 0.0,
            sums * (became * numbers.mean() / expected / np.maximum(numbers, 1.0))[:, None],
            became[:, None] * (right / expected),
        )
    # of plants that were found nothing is in doubt
    certain = known.astype(np.float64) @ weights
    return read_only(np.minimum(sums + certain, 1.0))
