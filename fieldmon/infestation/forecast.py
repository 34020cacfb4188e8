"""What a chance map comes to in the next days if nobody inspects: how many plants are infested."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import gammaincinv

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.compute.wording import counted
from fieldmon.infestation.plot_estimate import estimate_plot
from fieldmon.infestation.traced_pairs import TracedPairs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.infestation.spread import Spread
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

#: how far ahead
NIGHTS = 14
# how far a rate that nobody measured on the plot may be off, as a share (1 sigma; our choice): so
# much of what is still to come
_RATE_DOUBT = 0.4
# what arrives from outside is a guess of ours: how many finds it is worth. So it may well be that
# nothing arrives, or four times as much (our choice)
_ARRIVALS_KNOWN = 0.5
_DRAWS = 2000
# an interval of 90 % is so many standard deviations wide
_SIGMAS = 3.29


@dataclass(frozen=True, eq=False)
class Forecast:
    """Infested plants of the next mornings, nobody inspecting.

    Parameters
    ----------
    expected
        ``(d,)`` expected number, this evening first.
    low, high
        ``(d,)`` the interval that holds it with 90 %.
    weather
        How many of the nights had weather that was measured or forecast; of the others the usual
        was taken. None: no weather is known of.
    """

    expected: Floats
    low: Floats
    high: Floats
    weather: int | None = None

    def __repr__(self) -> str:
        return f"<Forecast: {self.sentence()}>"

    @property
    def nights(self) -> int:
        """Return how many nights ahead it goes."""
        return len(self.expected) - 1

    def sentence(self) -> str:
        """Return it in words."""
        nights = counted(self.nights, "night")
        return (
            f"{self.expected[-1]:.0f} plants infested after {nights} without inspections "
            f"({self.low[-1]:.0f} to {self.high[-1]:.0f} with a chance of 90 %), now "
            f"{self.expected[0]:.0f}; {self.basis()}"
        )

    def basis(self) -> str:
        """Return in words what weather it is made from."""
        if self.weather is None:
            return "no weather is known of"
        if self.weather >= self.nights:
            return "by the weather forecast"
        if self.weather == 0:
            return "by the usual weather of the date"
        return f"by the weather forecast for {counted(self.weather, 'night')}, then the usual"


def forecast(
    evening: Belief,
    grid: PlantGrid,
    nights: Sequence[Spread],
    weather: int | None = None,
    now: PlotEstimate | None = None,
) -> Forecast:
    """Return what is expected after each of some nights, from what is believed in the evening.

    Parameters
    ----------
    evening
        What is believed.
    grid
        The plants.
    nights
        What the insects are taken to do in each night.
    weather
        As `Forecast` has it.
    now
        How many are infested this evening, where that was worked out already.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.infestation.spread import Spread
    >>> from fieldmon.infestation.traced_pairs import TracedPairs
    >>> from fieldmon.plot.layout import rectangle
    >>> grid = rectangle(9, 9)
    >>> ahead = forecast(TracedPairs.of(grid, np.full(81, 0.02)), grid, [Spread(0.02)] * 14)
    >>> bool(ahead.low[-1] < ahead.expected[-1] < ahead.high[-1])
    True
    """
    mornings = [evening]
    for spread in nights:
        mornings.append(mornings[-1].overnight(spread))
    expected = np.array([float(one.chance.sum()) for one in mornings])
    arrived = expected - _from_inside(evening, nights, expected)
    found = evening.arrivals_found if isinstance(evening, TracedPairs) else 0.0
    # what is more now than believed sends out more: as a share, it stays in doubt
    tonight = _deviation(now or _estimate(evening, grid, evening.doubt))
    to_come = max(1.0 - expected[0] / max(expected[-1], 1e-9), 0.0)
    fields = _deviation(_estimate(mornings[-1], grid, 0.0))
    later = float(np.sqrt(tonight**2 + (_RATE_DOUBT * to_come) ** 2 + fields**2))
    known = _ARRIVALS_KNOWN + max(found - 2.0, 0.0)
    ends = [
        _ends((inside, outside), doubt, known)
        for inside, outside, doubt in zip(
            (expected - arrived)[[0, -1]], arrived[[0, -1]], (tonight, later), strict=True
        )
    ]
    # drawn tonight and for the last morning, which takes longest; between them evenly
    begin, end = ends
    low, high = (np.linspace(begin[k], end[k], len(expected)) for k in range(2))
    return Forecast(expected, np.floor(expected * low), np.ceil(expected * high), weather)


def _from_inside(evening: Belief, nights: Sequence[Spread], expected: Floats) -> Floats:
    """Return the expected number each morning, but for what came from outside and its offspring."""
    if not isinstance(evening, TracedPairs):
        return expected
    belief = evening.without_arrivals
    inside = [float(belief.chance.sum())]
    for spread in nights:
        belief = belief.overnight(spread)
        inside.append(float(belief.chance.sum()))
    least: Floats = np.minimum(np.array(inside), expected)
    return least


def _estimate(belief: Belief, grid: PlantGrid, doubt: float) -> PlotEstimate:
    return estimate_plot(grid, belief.chance, belief.pair_chance, doubt=doubt)


def _deviation(made: PlotEstimate) -> float:
    """Return the standard deviation of the number, over the number; never none."""
    return max((made.high - made.low) / made.expected / _SIGMAS, 0.01)


def _ends(parts: tuple[float, float], doubt: float, known: float) -> tuple[float, float]:
    """Return the ends of the interval over the expected number.

    Parameters
    ----------
    parts
        Expected of what was on the plot, and of what arrives.
    doubt
        How far the first may be off, as a share.
    known
        As many finds tell how much arrives.
    """
    draws = RandomStreams(0).of("forecast").random((2, _DRAWS))
    inside, outside = (
        part * gammaincinv(shape, drawn) / shape
        for part, shape, drawn in zip(parts, (doubt**-2.0, known), draws, strict=True)
    )
    low, high = np.quantile(inside + outside, (0.05, 0.95)) / sum(parts)
    return float(low), float(high)
