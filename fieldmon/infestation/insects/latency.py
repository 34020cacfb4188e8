"""For how many nights a new infestation cannot be seen, as a season's own inspections tell it.

Where nobody named the pest, insects may be seen from the first morning on, or hide for some nights
while they spread. Each is a candidate with a chance of its own that a plant shows something: what
a night brought is in it once it no longer hides. Clean inspections lower that and not what hides.
So finds at plants that seemed clean for some mornings speak for hiding, and finds of what came
last night against it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Floats32 = NDArray[np.float32]

#: for how many nights infestations may hide, and how likely each is at first (our choice)
HIDDEN_NIGHTS = (0, 2, 4, 7)
_LIKELY = np.log(np.array([0.85, 0.05, 0.065, 0.035]))
#: infestations of so many nights are told apart
NIGHTS = max(HIDDEN_NIGHTS)
# ``(candidates, NIGHTS)`` whether each hides what came so many nights ago
_HIDES = np.arange(NIGHTS)[None, :] < np.array(HIDDEN_NIGHTS)[:, None]
# how many finds of a day the number expected is worth, as rates are not known (our choice)
_PRIOR_FINDS = 5.0
# finds of one colony share their fate, so each counts half; and nothing is settled for good, as a
# logarithm of chances: what hides is not looked for, so that little speaks for it once it is taken
# to be unlikely
_TEMPER, _SETTLED = 0.5, 5.0
# no find is less likely than this; and no plant's chances are levelled by more
_LEAST_SHOWN, _MOST_LEVELLED = 1e-4, 1e3
_NOTHING, _MOST = 1e-12, 0.9


@dataclass(frozen=True, eq=False)
class Latency:
    """What came to each plant in the last nights, and for how long that hides.

    Parameters
    ----------
    came
        ``(NIGHTS, n)`` float32 chance that each plant was infested in each of the last nights, the
        last one first.
    shows
        ``(4, n)`` float32 chance that each plant shows an infestation, with each of
        `HIDDEN_NIGHTS`.
    evidence
        ``(4,)`` logarithms of how likely the season's inspections are with each.
    told
        ``(n,)`` int8 for how many nights more an inspection at which each plant seemed clean tells
        new infestations from those of before.
    """

    came: Floats32
    shows: Floats32
    evidence: Floats
    told: NDArray[np.int8]

    def __repr__(self) -> str:
        return f"<Latency: {self.nights:.1f} nights>"

    @classmethod
    def none(cls, chance: Floats) -> Latency:
        """Return what is known on a first morning of chances ``(n,)``: nothing hides then."""
        n, candidates = len(chance), len(HIDDEN_NIGHTS)
        came = np.zeros((NIGHTS, n), np.float32)
        shows = np.repeat(chance.astype(np.float32)[None], candidates, axis=0)
        return cls(came, shows, np.zeros(candidates), np.zeros(n, np.int8))

    @property
    def likely(self) -> Floats:
        """Chance of each of `HIDDEN_NIGHTS`, ``(4,)``."""
        log = self.evidence + _LIKELY
        weights = np.exp(log - log.max())
        chances: Floats = weights / weights.sum()
        return chances

    @property
    def nights(self) -> float:
        """Expected number of nights for which an infestation hides."""
        return float(self.likely @ HIDDEN_NIGHTS)

    @property
    def hides(self) -> Floats:
        """Chance that what came so many nights ago is hidden, ``(NIGHTS,)``."""
        hides: Floats = self.likely @ _HIDES
        return hides

    @property
    def matters(self) -> bool:
        """Tell whether anything may hide at all: each of `HIDDEN_NIGHTS` stays possible."""
        return bool(self.came.any())

    def hidden(self, chance: Floats, plants: NDArray[np.int32] | None = None) -> Floats:
        """Return the share of plants' chances ``(k,)`` that no inspection can see; None: of all."""
        came = self.came if plants is None else self.came[:, plants]
        hidden = _mixed(self.hides, came)
        share: Floats = np.minimum(hidden / np.maximum(chance, _NOTHING), _MOST)
        return share

    def inspected(
        self,
        plants: NDArray[np.int32],
        found: NDArray[np.bool_],
        detects: Floats,
    ) -> Latency:
        """Return what is believed after a day's inspections.

        Parameters
        ----------
        plants, found
            ``(k,)`` what was inspected, with what result.
        detects
            ``(k,)`` chance to find what can be seen.
        """
        which = self.told[plants] > 0
        evidence = self.evidence + _TEMPER * self._said(plants[which], found[which], detects[which])
        came, shows = self.came.copy(), self.shows.copy()
        clean, misses = plants[~found], 1.0 - detects[~found]
        own = shows[:, clean].astype(np.float64)
        shows[:, clean] = own * misses / (1.0 - own * (1.0 - misses))
        # a find is gone, or known
        came[:, plants[found]] = 0.0
        shows[:, plants[found]] = 0.0
        likely, told = evidence + _LIKELY, self.told.copy()
        kept = np.maximum(likely - likely.max(), -_SETTLED) - _LIKELY
        told[clean] = NIGHTS
        told[plants[found]] = 0
        return Latency(came, shows, kept, told)

    def levelled(self, chance: Floats) -> Latency:
        """Return the same, all candidates together having the chance ``(n,)`` of the map.

        So what was found beside a plant speaks for what was overlooked there as much as for what
        came.
        """
        both = _mixed(self.likely, self.shows) + _mixed(self.hides, self.came)
        factor = np.minimum(chance / np.maximum(both, _NOTHING), _MOST_LEVELLED).astype(np.float32)
        came, shows = self.came * factor, self.shows * factor
        for chances in (came, shows):
            np.minimum(chances, np.float32(_MOST), out=chances)
        return replace(self, came=came, shows=shows)

    def _said(self, plants: NDArray[np.int32], found: NDArray[np.bool_], detects: Floats) -> Floats:
        """Return what inspections of plants that seemed clean say of each candidate, ``(4,)``.

        The day's finds are taken to come at a rate of which `_PRIOR_FINDS` are known (negative
        binomial), so that it counts where they are, more than how many.
        """
        finds = np.maximum(detects * self.shows[:, plants], _LEAST_SHOWN)
        likely = np.log(finds[:, found]).sum(axis=1)
        n_finds = np.count_nonzero(found)
        said = likely - (_PRIOR_FINDS + n_finds) * np.log(_PRIOR_FINDS + finds.sum(axis=1))
        told: Floats = said - said.max()
        return told

    def overnight(self, before: Floats, after: Floats) -> Latency:
        """Return what is believed the next morning, from chances ``(n,)`` before and after."""
        gain = np.clip(after - before, 0.0, 1.0).astype(np.float32)
        shows = self.shows.copy()
        for k, hidden in enumerate(HIDDEN_NIGHTS):
            more = gain if hidden == 0 else self.came[hidden - 1]
            shows[k] += more * (1.0 - shows[k])
        came = np.concatenate([gain[None], self.came[:-1]])
        return replace(self, came=came, shows=shows, told=np.maximum(self.told - 1, 0))

    def treated(self, left: Floats) -> Latency:
        """Return what is believed after a treatment that a share ``(n,)`` outlives."""
        share = left.astype(np.float32)
        return replace(self, came=self.came * share, shows=self.shows * share)


def _mixed(shares: Floats, chances: Floats32) -> Floats32:
    """Return the sum of ``chances (k, n)``, each line times its share ``(k,)``."""
    # not by a matrix library, whose last digits hang on the processor
    mixed: Floats32 = np.einsum("k,ki->i", shares.astype(np.float32), chances)
    return mixed
