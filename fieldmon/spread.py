"""What the insects do in a night."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fieldmon.chance import coin
from fieldmon.compiled import loop, part
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.grid import Csr, PlantGrid

_EACH, _ONE, _ALL = 0, 1, 2
_TO = {"each": _EACH, "one": _ONE, "all": _ALL}
# every plant owns 16 coins a night: one per neighbour, the last for arrivals
_COINS, _ARRIVAL = 16, 15


@dataclass(frozen=True)
class Spread:
    """The thesis's adjacent-plant rule: a missed insect may spread to the plants next to it.

    Parameters
    ----------
    rate_per_day
        Chance per night (thesis: 0.3, 0.5, 0.8). What it is the chance of, `to` says.
    to
        The thesis leaves open who infects whom. ``"each"``: every infested plant infects each of
        its neighbours with that chance, independently. ``"one"``: with that chance it infects one
        neighbour, drawn evenly. ``"all"``: with that chance it infects all its neighbours.
    arrivals_per_day
        Chance per night that a clean plant is infested from outside the plot.
    """

    rate_per_day: float = 0.5
    to: Literal["each", "one", "all"] = "each"
    arrivals_per_day: float = 0.0

    def __post_init__(self) -> None:
        for name in ("rate_per_day", "arrivals_per_day"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise SettingError(
                    f"The spread's {name} must be a chance in 0..1, "
                    f"but it is {getattr(self, name)}."
                )
        if self.to not in _TO:
            raise SettingError(
                f"Spread goes to 'each', 'one' or 'all' of the neighbours, but it is {self.to!r}."
            )


def night(
    grid: PlantGrid, infested: NDArray[np.bool_], spread: Spread, key: np.uint64
) -> NDArray[np.bool_]:
    """Return who is infested the next morning, ``(n,)``; `infested` stays as it is.

    Every coin belongs to a pair of plants (or to a plant), not to the order of asking: with the
    same `key` two histories differ only where they differ.
    """
    after = infested.copy()
    rule = (spread.rate_per_day, _TO[spread.to], spread.arrivals_per_day)
    _night(infested, after, grid.adjacent, rule, key)
    return after


@loop
def _night(
    infested: NDArray[np.bool_],
    after: NDArray[np.bool_],
    adjacent: Csr,
    rule: tuple[float, int, float],
    key: np.uint64,
) -> None:
    rate, to, arrivals = rule
    for i in range(infested.size):
        if infested[i]:
            _infect(i, after, adjacent, (rate, to), key)
        elif arrivals > 0.0 and coin(key, _COINS * i + _ARRIVAL) < arrivals:
            after[i] = True


@part
def _infect(
    i: int, after: NDArray[np.bool_], adjacent: Csr, rule: tuple[float, int], key: np.uint64
) -> None:
    rate, to = rule
    first, end = adjacent.start[i], adjacent.start[i + 1]
    if to == _EACH:
        for k in range(first, end):
            if coin(key, _COINS * i + (k - first)) < rate:
                after[adjacent.plant[k]] = True
    elif end > first and coin(key, _COINS * i) < rate:
        if to == _ONE:
            first += int(coin(key, _COINS * i + 1) * (end - first))
            end = first + 1
        for k in range(first, end):
            after[adjacent.plant[k]] = True
