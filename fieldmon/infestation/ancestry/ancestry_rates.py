"""How often infestations come about, and how far they go, by the ancestries drawn for the finds.

Rates are estimated anew each night: what the ancestries have, over what would have been seen of it
(an EM step: Dempster, Laird & Rubin 1977; with Gamma priors, which count as so many finds).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.infestation.ancestry.infestation_course import BEFORE
from fieldmon.infestation.ancestry.origins import ARRIVE, ARRIVE_BY_EDGE
from fieldmon.infestation.chance_bounds import LEAST_CHANCE
from fieldmon.infestation.insects.jump_landing import SHARES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.drawn_ancestry import DrawnSums
    from fieldmon.infestation.insects.jump_landing import Landing

    Floats = NDArray[np.floating[Any]]

# what share of the infestations that come from none began on the first of them (our choice:
# clusters mostly are of one age)
_OF_ONE_AGE = 0.7
# what an infested plant sent out in a night then, and how many finds that is worth (our choice)
_SENT_BEFORE, _SENT_BEFORE_FINDS = 0.4, 4.0
#: how many kernels there are
KERNELS = len(SHARES)
#: how many finds the first guess of what arrives is worth (our choice)
ARRIVAL_FINDS = 0.5
# the same of the share at the start (our choice)
_START_FINDS = 3.0
# the share of the start that came by the edge, and how many finds that is worth (our choice)
_BY_EDGE, _BY_EDGE_FINDS = 0.1, 2.0
# how often what came from none is shared out anew between the edge and elsewhere
_SHARED_OUT = 5
# how infestations that come from none are shared out over the mornings before
_AGES = np.full(BEFORE + 1, (1.0 - _OF_ONE_AGE) / (BEFORE + 1))
_AGES[0] += _OF_ONE_AGE
_FIRST, _LATER = slice(0, BEFORE + 1), slice(BEFORE + 1, None)


class DrawnEvidence(NamedTuple):
    """What the ancestries of a night have, and what would have been seen of it, on t mornings.

    Parameters
    ----------
    start
        ``(n,)`` the chances of the first morning.
    sends
        ``(t,)`` what an infested plant sends out in a night.
    kernel
        ``(d, d)`` where jumps were taken to land.
    seen
        ``(t, n)`` how likely something is seen of an infestation that begins then and there.
    taken
        ``(t, n)`` how likely the plant is infested already.
    drawn, active
        Means over the ancestries; the second is `DrawnSums.active`.
    unseen
        ``(t, n)`` how many infestations send something out of which nothing was seen.
    arrive
        The share of all plants that is told to be infested from outside in a night: anywhere, and
        by the edge.
    earlier
        ``(2, 10)`` what ancestries before these taught, see `Rates.taught`.
    """

    start: Floats
    sends: Floats
    kernel: Floats
    seen: Floats
    taken: Floats
    drawn: DrawnSums
    active: Floats
    unseen: Floats
    arrive: tuple[float, float]
    earlier: Floats

    def __repr__(self) -> str:
        return f"<Evidence of {len(self.sends)} mornings>"


class Exposure(NamedTuple):
    """How many jumps and arrivals would have been seen.

    Parameters
    ----------
    by_kernel
        ``(8,)`` so many jumps if all go by that kernel.
    before
        So many before the season, if every infestation sends out one a night.
    at_start
        ``(n,)`` so many that came from none before the season, if one does at each plant.
    nightly
        ``(2,)`` so many arrivals at a rate of 1, anywhere and by the edge.
    """

    by_kernel: Floats
    before: float
    at_start: Floats
    nightly: Floats

    def __repr__(self) -> str:
        return f"<Exposure to {len(self.by_kernel)} kernels>"


class Rates(NamedTuple):
    """What is believed of how infestations come about.

    Parameters
    ----------
    shares
        ``(8,)`` how much of what is sent out goes by each kernel.
    before
        What an infested plant sent out in a night before the season.
    start, start_by_edge
        How many times as many as was told came from none before the season: as the first map has
        it, and by the edge.
    anywhere, by_edge
        Share of the plants infested from outside in a night: anywhere, and by the edge.
    """

    shares: Floats
    before: float = _SENT_BEFORE
    start: float = 1.0 - _BY_EDGE
    start_by_edge: float = _BY_EDGE
    anywhere: float = ARRIVE
    by_edge: float = ARRIVE_BY_EDGE

    @classmethod
    def at_first(cls, first: Floats = SHARES) -> Rates:
        """Return what is believed before anything was found, with the `first` of a `Landing`."""
        return cls(first / first.sum())

    def roots(self, start: Floats, at_edge: Floats, mornings: int) -> Floats:
        """Return how many infestations come to each plant from none, ``(mornings, n)``.

        Parameters
        ----------
        start
            ``(n,)`` the chances of the first morning.
        at_edge
            ``(n,)`` as `KernelsOnCells` has it.
        """
        roots = np.empty((mornings, len(start)), np.float32)
        at_start, later = (sum(both) for both in self._from_none(start, at_edge))
        roots[_FIRST] = _AGES[:, None] * at_start
        roots[_LATER] = later
        return roots

    def after(self, night: DrawnEvidence, exposure: Exposure, landing: Landing) -> Rates:
        """Return the rates by what ancestries have, over what would have been seen of it."""
        with_jumps = self.with_jumps(night, exposure, landing)
        return with_jumps.with_roots(night, exposure, landing.at_edge)

    def _from_none(self, start: Floats, at_edge: Floats) -> tuple[tuple[Floats, Floats], ...]:
        """Return how many come from none before the season and in each of its nights, ``(n,)``.

        Of both first those that come as they were told or anywhere, then those by the edge.
        """
        told = self._told(start)
        return (
            (told * self.start, told.mean() * self.start_by_edge * at_edge),
            (np.full(len(told), self.anywhere), self.by_edge * at_edge),
        )

    def _told(self, start: Floats) -> Floats:
        """How many came from none before the season, as the first map has it, ``(n,)``.

        By the first morning each had become as many as it sent out.
        """
        nights = np.arange(BEFORE, -1, -1)
        told: Floats = start / float(_AGES @ (1.0 + self.before) ** nights)
        return told

    def exposure(self, night: DrawnEvidence, landing: Landing) -> Exposure:
        """Return how many would have been seen, had all gone by each kernel.

        Also infestations of which nothing was seen would have sent out some that were.
        """
        sent = night.active + night.unseen
        sent *= night.sends[:, None].astype(sent.dtype)
        meets = 1.0 - night.taken
        meets *= night.seen
        before, all_nights = landing.met(sent[:-1], meets[1:], BEFORE)
        later = night.seen[_LATER].sum(axis=0)
        return Exposure(
            all_nights, float(before @ self.shares) / self.before, _AGES @ night.seen[_FIRST],
            np.array([float(later.sum()), float(later @ landing.at_edge)]),
        )  # fmt: skip

    def with_jumps(self, night: DrawnEvidence, exposure: Exposure, landing: Landing) -> Rates:
        """Return the same with the jumps that were drawn."""
        jumps = landing.first + night.earlier[0, :KERNELS] + self._jumps(night, landing)
        shares = jumps / (landing.first.sum() + night.earlier[1, :KERNELS] + exposure.by_kernel)
        before = _SENT_BEFORE_FINDS + float(night.drawn.jumps[0].sum())
        before /= _SENT_BEFORE_FINDS / _SENT_BEFORE + exposure.before
        return self._replace(shares=shares / shares.sum(), before=before)

    def _jumps(self, night: DrawnEvidence, landing: Landing) -> Floats:
        """How many of the jumps that were drawn went by each kernel, ``(8,)``."""
        all_jumps = night.drawn.jumps.sum(axis=0) / np.maximum(night.kernel, LEAST_CHANCE)
        jumps: Floats = self.shares * np.einsum("kij,ij->k", landing.kernels, all_jumps)
        return jumps

    def with_roots(self, night: DrawnEvidence, exposure: Exposure, at_edge: Floats) -> Rates:
        """Return the same with those that were drawn as coming from none."""
        told, first = self._told(night.start), exposure.at_start
        seen = float(first @ told), float(first @ at_edge * told.mean())
        found, known = night.earlier[:, KERNELS:]
        expected = ARRIVAL_FINDS / np.array(night.arrive)
        parts, rates = self._parts(night, at_edge), self
        for _ in range(_SHARED_OUT):
            start, start_by_edge = _shared_out(parts[0], rates.start, rates.start_by_edge)
            arrived = _shared_out(parts[1], rates.anywhere, rates.by_edge)
            anywhere, by_edge = (ARRIVAL_FINDS + found + arrived) / (
                expected + known + exposure.nightly
            )
            rates = rates._replace(
                start=(_START_FINDS * (1.0 - _BY_EDGE) + start) / (_START_FINDS + seen[0]),
                start_by_edge=(_BY_EDGE_FINDS * _BY_EDGE + start_by_edge)
                / (_BY_EDGE_FINDS + seen[1]),
                anywhere=float(anywhere),
                by_edge=float(by_edge),
            )
        return rates

    def taught(self, night: DrawnEvidence, exposure: Exposure, landing: Landing) -> Floats:
        """Return what these ancestries and those before teach of the season, ``(2, 10)``.

        How many finds went by each kernel and came from outside, anywhere and by the edge, and how
        many would have at a rate of 1.
        """
        arrived = _shared_out(self._parts(night, landing.at_edge)[1], self.anywhere, self.by_edge)
        found = np.concatenate([self._jumps(night, landing), arrived])
        expected = np.concatenate([exposure.by_kernel, exposure.nightly])
        taught: Floats = night.earlier + np.array([found, expected])
        return taught

    def _parts(self, night: DrawnEvidence, at_edge: Floats) -> list[tuple[Floats, Floats, Floats]]:
        """Return what `_shared_out` takes, of those that came before the season and in it."""
        once = Rates(self.shares, self.before, *[1.0] * 4)
        return [
            (drawn[drawn > 0.0], others[drawn > 0.0], by_edge[drawn > 0.0])
            for drawn, (others, by_edge) in zip(
                night.drawn.roots, once._from_none(night.start, at_edge), strict=True
            )
        ]


def _shared_out(
    part: tuple[Floats, Floats, Floats], elsewhere: float, at_edge: float
) -> tuple[float, float]:
    """Share out those drawn between elsewhere and the edge; return both numbers.

    `part` are those drawn, and those expected elsewhere and by the edge at a rate of 1, ``(m,)``
    each; the other two are the rates.
    """
    drawn, others, by_edge = part
    by_edge = at_edge * by_edge
    from_edge = float(drawn @ (by_edge / (elsewhere * others + by_edge)))
    return float(drawn.sum()) - from_edge, from_edge
