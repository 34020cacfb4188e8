"""The number infested may have been told wrongly: heavier infestations that finds speak for.

A map that was told of few puts finds beside finds down to clusters, however many there are. So from
the first inspection on, maps that were told of more are kept beside it (contaminated prior: Berger
& Berliner 1986), and the one is believed by which all inspections so far were likeliest, each as it
was expected just before (prequential: Dawid 1984). What is hardly possible any more is dropped.
Once none is left and a day speaks against the map, they are thought of again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# the shares of plants that may be infested instead (our choice: finds tell what lies between)
_SHARES = (0.05, 0.15, 0.4)
# what was told is right with this chance (chosen on 40 seasons of ten worlds, of which a few were
# taken for heavier with 0.9, and on 28 with 3 to 10 % infested), and up to so many times as many
# are no others (our choice)
_RIGHT, _APART = 0.97, 2.0
#: the logarithm of that
TOLD = float(np.log(_RIGHT))
#: shares that lie so far apart leave so much of the number in doubt (chosen on 33 seasons with 3 to
#: 60 % infested)
IN_DOUBT = 0.7
# so few finds may be of one spot to which somebody was sent: what was told is believed (our choice)
_FEW_FINDS = 5
# what is less likely than the likeliest by that, as a logarithm, is dropped (our choice)
_DROPPED = 7.0
# a day speaks against a map that is less likely by that, as a logarithm, than if all plants
# inspected had the chance that was found (our choice: two or three would be worth one number)
_REFUTED = 5.0


class Heavier(NamedTuple):
    """A heavier infestation that is possible.

    Parameters
    ----------
    share
        Share of the plants that is infested.
    likely
        The logarithm of how likely it is before anything was inspected.
    """

    share: float
    likely: float


def heavier_than(told: float, found: NDArray[np.bool_], detects: Floats) -> tuple[Heavier, ...]:
    """Return which heavier infestations are possible where a share of the plants was `told`.

    Three times as many are a third as likely. What so many finds among the first inspections rule
    out twice over is left out at once: `found` and `detects` ``(k,)`` are their results, and the
    chances to find what is there.
    """
    shares = np.array([share for share in _SHARES if share > _APART * told])
    likely = np.log((1.0 - _RIGHT) / shares / (1.0 / shares).sum())
    finds, seen = np.count_nonzero(found), float(detects.mean())
    clean = np.log((1.0 - seen * shares) / (1.0 - seen * told))
    counts = finds * np.log(shares / told) + (len(found) - finds) * clean
    possible = likely + counts > TOLD - 2.0 * _DROPPED
    return tuple(map(Heavier, shares[possible].tolist(), likely[possible].tolist()))


def refuted(likely: float, found: NDArray[np.bool_]) -> bool:
    """Tell whether a day's results ``(k,)`` speak against a map by which they were so likely.

    `likely` is a logarithm. A map should do better than one chance for all plants inspected; few
    finds speak against none, as they may be of one spot.

    Examples
    --------
    >>> import numpy as np
    >>> found = np.arange(10) < 5
    >>> [refuted(10 * np.log(p), found) for p in (0.5, 0.2)]
    [False, True]
    """
    n, finds = len(found), int(np.count_nonzero(found))
    if finds < _FEW_FINDS:
        return False
    each = [k * np.log(k / n) for k in (finds, n - finds) if k]
    return bool(likely < sum(each) - _REFUTED)


def odds_times(chance: NDArray[np.floating[Any]], factor: float) -> Floats:
    """Return chances ``(n,)`` whose odds are so many times as high."""
    times: Floats = factor * chance / (1.0 + (factor - 1.0) * chance)
    return times


class _Weighed(Protocol):
    @property
    def likely(self) -> float: ...


M = TypeVar("M", bound=_Weighed)


def likeliest(maps: Sequence[M], finds: float) -> tuple[M, tuple[M, ...]]:
    """Return the likeliest of some maps after so many finds, and those that are possible still.

    The first was the likeliest before, and is after few finds.
    """
    most = max(maps, key=lambda one: one.likely)
    best = maps[0] if finds < _FEW_FINDS else most
    return best, tuple(
        one for one in maps if one is not best and one.likely > most.likely - _DROPPED
    )


def doubt_between(likely: Floats, expected: Floats) -> float:
    """Return how far a number may be off (1 sigma, as a share), as several maps are possible.

    Parameters
    ----------
    likely, expected
        ``(m,)`` the logarithm of how likely each is, and the number that it expects.
    """
    weight = np.exp(likely - likely.max())
    weight /= weight.sum()
    number = np.log(expected)
    return float(np.sqrt(weight @ (number - weight @ number) ** 2))
