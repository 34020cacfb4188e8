"""What an earlier season learnt of its insects, as the first belief of another one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import SettingError
from fieldmon.infestation.ancestry.origins import (
    ANYWHERE,
    BY_ADJACENT,
    BY_EDGE,
    JUMPED,
    N_ORIGINS,
    OVERLOOKED,
    OriginCounts,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.infestation.tracing.traced_pairs import TracedPairs
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

# what another season learnt counts half as much as what this one learns (power prior: Ibrahim &
# Chen 2000, Stat. Sci. 15:46), and as so many finds of an origin at most: with five or twenty,
# intervals held far less often where insects came otherwise than in the earlier season (chosen on
# twenty seasons in each of six worlds; see docs/season_results.md)
_WORTH, _MOST_FINDS = 0.5, 2.0
# plants that stand otherwise by more are not jumped over alike (our choice)
_SPACED_ALIKE = 0.1
# how infested plants may stand together
_N_WAYS = 4


@dataclass(frozen=True)
class Believed:
    """What the numbers that a season learns are multiples of.

    Parameters
    ----------
    pest
        Name of the pest; empty: nobody named it.
    rate_per_day
        Chance per night that a plant infests its neighbour, as told.
    detection
        Chance that an inspection finds what is there, as told.
    row_m, plant_m
        Distances between rows and between plants.
    """

    pest: str
    rate_per_day: float
    detection: float
    row_m: float
    plant_m: float

    @classmethod
    def of(cls, grid: PlantGrid, pest: str, rate_per_day: float, detection: float) -> Self:
        """Return it of a season on a `grid`."""
        return cls(
            pest, float(rate_per_day), float(detection),
            float(grid.row_spacing_m), float(grid.plant_spacing_m),
        )  # fmt: skip

    def spaced_as(self, other: Believed) -> bool:
        """Tell whether plants stand as far apart."""
        own, others = (np.array([one.row_m, one.plant_m]) for one in (self, other))
        return bool(np.allclose(own, others, rtol=_SPACED_ALIKE, atol=0.0))


@dataclass(frozen=True)
class EarlierSeason:
    """What an earlier season learnt of its insects: a first belief of the next one.

    Learnt are the detection, how many arrive, whether insects jump and how far. How many were
    infested at the start is not carried over, as that is another season's, nor whether new
    infestations hide, as late in a season that cannot be told from what was not inspected. It
    counts half, and as two finds of an origin at most.

    Parameters
    ----------
    plot, until
        The plot on which it was learnt, and the last day of which it was.
    believed
        What its numbers are multiples of.
    found, expected
        ``(N_ORIGINS,)`` finds of each origin, and those expected, as they count now.
    stands
        ``(4,)`` evidence of how infested plants stand together, as it counts now.

    Examples
    --------
    Begin a season with what an earlier one learnt:

    >>> import fieldmon as fm
    >>> earlier = fm.Season("last_year.gpkg").as_earlier()  # doctest: +SKIP
    >>> belief = fm.BeliefSettings(earlier=earlier)  # doctest: +SKIP
    >>> season = fm.Season.create("season.gpkg", plot, belief=belief)  # doctest: +SKIP
    """

    plot: str
    until: date
    believed: Believed
    found: tuple[float, ...]
    expected: tuple[float, ...]
    stands: tuple[float, ...]

    def __post_init__(self) -> None:
        lengths = {"found": N_ORIGINS, "expected": N_ORIGINS, "stands": _N_WAYS}
        for name, length in lengths.items():
            values = np.array(getattr(self, name), float)
            if values.shape != (length,) or not np.isfinite(values).all():
                raise SettingError(
                    worded(
                        "What an earlier season learnt must be {length} numbers ({name}), but it "
                        "is {values}. Take it from Season(path).as_earlier().",
                        length=length,
                        name=name,
                        values=values.tolist(),
                    )
                )

    @classmethod
    def of(cls, evening: TracedPairs, believed: Believed, plot: str, until: date) -> Self:
        """Return what was learnt until an `evening`, as it counts in another season."""
        found, expected = np.zeros(N_ORIGINS), np.zeros(N_ORIGINS)
        for origin in (ANYWHERE, BY_EDGE, BY_ADJACENT, OVERLOOKED, *range(JUMPED, N_ORIGINS)):
            finds = evening.counts.found[origin], evening.counts.expected[origin]
            worth = min(_WORTH, _MOST_FINDS / max(*finds, 1e-12))
            found[origin], expected[origin] = worth * np.array(finds)
        return cls(
            plot, until, believed, _numbers(found), _numbers(expected),
            _numbers(_WORTH * evening.evidence),
        )  # fmt: skip

    def begin(self, first: TracedPairs, believed: Believed) -> TracedPairs:
        """Return a `first` belief with what was learnt before, so far as it holds here."""
        if not self.is_of(believed.pest):
            return first
        found, expected = np.array(self.found), np.array(self.expected)
        left_out = self._left_out(believed)
        found[left_out] = expected[left_out] = 0.0
        counts, stands = OriginCounts(found, expected), np.array(self.stands)
        return replace(first, counts=counts, evidence=stands)

    def must_end_before(self, begins: date) -> None:
        """Raise `SettingError` unless it ended before the day on which another one begins."""
        if self.until >= begins:
            raise SettingError(
                worded(
                    "An earlier season must end before the new one begins on {begins}, but that on "
                    "{plot} goes on until {until}. Begin later, or without it.",
                    begins=begins,
                    plot=self.plot,
                    until=self.until,
                )
            )

    def is_of(self, pest: str) -> bool:
        """Tell whether it was learnt of this pest; empty: of one that nobody named."""
        return self.believed.pest == pest

    def sentence(self, believed: Believed) -> Worded:
        """Return what of it counts, in a season in which this is believed."""
        if not self.is_of(believed.pest):
            return worded(
                "What was learnt on {plot} until {until} does not count: it was of another pest.",
                plot=self.plot,
                until=self.until,
            )
        left_out, anew = self._left_out(believed), []
        if OVERLOOKED in left_out:
            anew.append(worded("detection"))
        if BY_ADJACENT in left_out:
            anew.append(worded("spread to neighbours"))
        if JUMPED in left_out:
            anew.append(worded("jumps"))
        if anew:
            return worded(
                "Begun with what was learnt on {plot} until {until}, which counts little against "
                "this season's finds. Learnt anew, as settings or spacings differ: {anew}.",
                plot=self.plot,
                until=self.until,
                anew=joined(", ", anew),
            )
        return worded(
            "Begun with what was learnt on {plot} until {until}, which counts little against this "
            "season's finds.",
            plot=self.plot,
            until=self.until,
        )

    def _left_out(self, believed: Believed) -> list[int]:
        """Return the origins of which it tells nothing where this is believed."""
        beyond = list(range(JUMPED, N_ORIGINS))
        left_out = [] if self.believed.detection == believed.detection else [OVERLOOKED]
        if not believed.pest and self.believed.rate_per_day != believed.rate_per_day:
            return [*left_out, BY_ADJACENT, *beyond]
        return left_out if self.believed.spaced_as(believed) else [*left_out, *beyond]


def earlier_from(plain: dict[str, Any] | None) -> EarlierSeason | None:
    """Return it as `dataclasses.asdict` and JSON wrote it; None: there is none."""
    if plain is None:
        return None
    learnt = {name: tuple(plain[name]) for name in ("found", "expected", "stands")}
    until, believed = date.fromisoformat(plain["until"]), Believed(**plain["believed"])
    return EarlierSeason(plain["plot"], until, believed, **learnt)


def _numbers(values: Floats) -> tuple[float, ...]:
    return tuple(float(value) for value in values)
