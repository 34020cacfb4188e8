"""What a chance map comes to in the next days if nobody inspects: how many plants are infested."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import counted
from fieldmon.infestation.plot_estimate import estimate_plot

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
_RATE_DOUBT = 0.25
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
    belief, first = evening, float(evening.chance.sum())
    expected, begins = [first], _ratios(now or _estimate(evening, grid, evening.doubt))
    # what is more now than believed sends out more: as a share, it stays in doubt
    doubt = (begins[1] - begins[0]) / _SIGMAS
    for spread in nights:
        belief = belief.overnight(spread)
        expected.append(float(belief.chance.sum()))
    to_come = max(expected[-1] - first, 0.0) / max(expected[-1], 1e-9)
    doubt = float(np.hypot(doubt, _RATE_DOUBT * to_come))
    ends = _ratios(_estimate(belief, grid, doubt))
    of = np.array(expected)
    # drawn tonight and for the last morning, which takes longest; between them evenly
    low, high = (np.linspace(*pair, len(of)) for pair in zip(begins, ends, strict=True))
    return Forecast(of, np.floor(of * low), np.ceil(of * high), weather)


def _estimate(belief: Belief, grid: PlantGrid, doubt: float) -> PlotEstimate:
    return estimate_plot(grid, belief.chance, belief.pair_chance, doubt=doubt)


def _ratios(made: PlotEstimate) -> tuple[float, float]:
    """Return the ends of the interval over the expected number."""
    return made.low / made.expected, made.high / made.expected
