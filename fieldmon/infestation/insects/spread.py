"""What the insects do in a night."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fieldmon.compute.arguments import is_one_of
from fieldmon.compute.jit import loop
from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.random_streams import coin, coin_bits, coin_limit
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Csr, PlantGrid

_EACH, _ONE, _ALL = 0, 1, 2
_TO = {"each": _EACH, "one": _ONE, "all": _ALL}
# every plant owns 16 coins a night: one per neighbour, the last for arrivals
_COINS, _ARRIVAL = 16, 15


#: chance per night to infest each neighbour where simulations are told nothing (our choice; the
#: thesis's, which `Spread` has, is far more)
SIMULATED_PER_DAY = 0.1


@dataclass(frozen=True)
class Spread:
    """The thesis's adjacent-plant rule: a missed insect may spread to the plants next to it.

    Parameters
    ----------
    rate_per_day
        Chance per night (thesis: 0.3, 0.5, 0.8). What it is the chance of, `to` says. Unless told
        it is the thesis's 0.5, as in the studies of its chapters and of teams. Commands that
        simulate take `SIMULATED_PER_DAY` (0.1), and seasons on disk 0.02: see the glossary.
    to
        The thesis leaves open who infects whom. ``"each"``: every infested plant infects each of
        its neighbours with that chance, independently. ``"one"``: with that chance it infects one
        neighbour, drawn evenly. ``"all"``: with that chance it infects all its neighbours.
    arrivals_per_day
        Chance per night that a clean plant is infested from outside the plot.

    Raises
    ------
    SettingError
        If a chance is not in 0..1 (``0.3``, not ``30``), or `to` is none of the three.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.Spread(rate_per_day=0.3, arrivals_per_day=0.0002)
    Spread(rate_per_day=0.3, to='each', arrivals_per_day=0.0002)
    """

    rate_per_day: float = 0.5
    to: Literal["each", "one", "all"] = "each"
    arrivals_per_day: float = 0.0

    def __post_init__(self) -> None:
        if not is_one_of(self.to, _TO):
            raise SettingError(
                f"Spread goes to 'each', 'one' or 'all' of the neighbours, but it is {self.to!r}."
            )
        must_hold_kinds(self, "The spread's")
        for name in ("rate_per_day", "arrivals_per_day"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise SettingError(
                    f"The spread's {name} must be a chance in 0..1, "
                    f"but it is {getattr(self, name)}."
                )


def night(
    grid: PlantGrid, infested: NDArray[np.bool_], spread: Spread, key: np.uint64
) -> NDArray[np.bool_]:
    """Return which plants are infested the next morning, ``(n,)``; `infested` stays as it is.

    Every coin belongs to a pair of plants (or to a plant), not to the order of asking: with the
    same `key` two histories differ only where they differ.
    """
    after = infested.copy()
    rule = coin_limit(spread.rate_per_day), _TO[spread.to]
    _infect(np.flatnonzero(infested), after, grid.adjacent, rule, key)
    if spread.arrivals_per_day > 0.0:
        _arrive(infested, after, coin_limit(spread.arrivals_per_day), key)
    return after


@loop
def _infect(
    infested: NDArray[np.intp],
    after: NDArray[np.bool_],
    adjacent: Csr,
    rule: tuple[np.uint64, int],
    key: np.uint64,
) -> None:
    """Let the infested plants infect others."""
    limit, to = rule
    start, plant = adjacent
    for i in infested:
        # unsigned: an index that may be negative is checked for it
        first, end = np.uint32(start[i]), np.uint32(start[i + 1])
        if to == _EACH:
            for k in range(first, end):
                # written either way: to foresee a coin is what costs
                after[np.uint32(plant[k])] |= coin_bits(key, _COINS * i + (k - first)) < limit
        elif end > first and coin_bits(key, _COINS * i) < limit:
            if to == _ONE:
                first += np.uint32(coin(key, _COINS * i + 1) * (end - first))
                end = np.uint32(first + 1)
            for k in range(first, end):
                after[np.uint32(plant[k])] = True


@loop
def _arrive(
    infested: NDArray[np.bool_], after: NDArray[np.bool_], limit: np.uint64, key: np.uint64
) -> None:
    """Let insects arrive from outside the plot on clean plants."""
    for i in range(infested.size):
        if not infested[i] and coin_bits(key, _COINS * i + _ARRIVAL) < limit:
            after[i] = True
