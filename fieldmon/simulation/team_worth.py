"""What each further robot saves: infested plant-days, seed by seed."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.simulation.statistics import summary_statistics

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from fieldmon.simulation.statistics import SummaryStatistics

_ORDINAL = {2: "second", 3: "third", 4: "fourth", 5: "fifth", 6: "sixth", 7: "seventh", 8: "eighth"}


class MarginalGain(NamedTuple):
    """What more robots save beyond fewer of them.

    Parameters
    ----------
    fewer, robots
        How many instead of how many.
    saved
        Infested plant-days of a season, seed by seed.
    """

    fewer: int
    robots: int
    saved: SummaryStatistics

    def __repr__(self) -> str:
        return f"<MarginalGain: {self.robots} for {self.fewer}, {self.saved.mean:.1f} saved>"

    @property
    def known(self) -> bool:
        """Tell whether it is more than nothing, as far as the seasons show."""
        return bool(self.saved.low > 0)


def marginal_gains(losses: Mapping[int, NDArray[np.float64]]) -> list[MarginalGain]:
    """Return what each number of robots saves beyond the next lesser one.

    Parameters
    ----------
    losses
        By number of robots, the infested plant-days ``(s,)`` of the same seeds in the same order.

    Examples
    --------
    >>> import numpy as np
    >>> gains = marginal_gains({1: np.array([70.0, 80.0]), 2: np.array([10.0, 22.0])})
    >>> [(gain.robots, gain.saved.mean) for gain in gains]
    [(2, 59.0)]
    """
    return [
        MarginalGain(fewer, more, summary_statistics(np.asarray(losses[fewer] - losses[more])))
        for fewer, more in pairwise(sorted(losses))
    ]


def worth_sentence(gains: Sequence[MarginalGain]) -> str:
    """Return for people what each further robot would save; empty without gains.

    Examples
    --------
    >>> import numpy as np
    >>> losses = {1: np.array([70.0, 80.0, 90.0]), 2: np.array([10.0, 22.0, 28.0])}
    >>> worth_sentence(marginal_gains(losses))
    'A second robot would save 60 (55 to 65) infested plant-days.'
    """
    if not gains:
        return ""
    parts: list[str] = []
    for gain in gains:
        saved = _interval(gain.saved)
        first = not parts
        if gain.robots == gain.fewer + 1 and gain.robots in _ORDINAL:
            who = f"{'A' if first else 'a'} {_ORDINAL[gain.robots]}{' robot' if first else ''}"
        else:
            who = f"{gain.robots} robots instead of {gain.fewer}"
        parts.append(f"{who} would save {saved} infested plant-days" if first else f"{who} {saved}")
    return "; ".join(parts) + "."


def _interval(saved: SummaryStatistics) -> str:
    if np.isnan(saved.low):
        return f"{_round(saved.mean)}"
    return f"{_round(saved.mean)} ({_round(saved.low)} to {_round(saved.high)})"


def _round(value: float) -> str:
    """Return a number with as many places as a count of plants bears."""
    shown = f"{value:.0f}" if abs(value) >= 10 else f"{value:.1f}"
    return shown.lstrip("-") if float(shown) == 0 else shown
