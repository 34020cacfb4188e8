"""What a chance map comes to in the next days if nobody inspects: how many plants are infested."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import counted
from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.infestation.tracing.traced_pairs import TracedPairs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from pandas import DataFrame

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

#: how far ahead
NIGHTS = 14
_LEAST = 1e-9


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
        was taken. None: no weather is known.
    measured
        How many of these nights had weather that was measured.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> ahead = fm.Monitor(plot).forecast(nights=3)
    >>> ahead.nights, bool(ahead.high[0] < ahead.high[3])
    (3, True)
    """

    expected: Floats
    low: Floats
    high: Floats
    weather: int | None = None
    measured: int = 0

    def __repr__(self) -> str:
        return f"<Forecast: {self.sentence()}>"

    @property
    def nights(self) -> int:
        """Return how many nights ahead it goes."""
        return len(self.expected) - 1

    def to_pandas(self) -> DataFrame:
        """Return a line for each night ahead: ``night`` (0: this evening), and the columns.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> ahead = fm.Monitor(plot).forecast(nights=3).to_pandas()
        >>> list(ahead.columns), len(ahead)
        (['night', 'expected', 'low', 'high'], 4)
        """
        import pandas as pd  # noqa: PLC0415 - loaded when it is asked for

        night = np.arange(len(self.expected))
        columns = {"expected": self.expected, "low": self.low, "high": self.high}
        return pd.DataFrame({"night": night, **columns})

    def sentence(self) -> str:
        """Return in words how many are infested at the end, and now."""
        nights = counted(self.nights, "night")
        return (
            f"{self.expected[-1]:,.0f} plants infested after {nights} without inspections "
            f"({self.low[-1]:,.0f} to {self.high[-1]:,.0f} with a chance of 90 %), now "
            f"{self.expected[0]:,.0f}; {self.basis()}"
        )

    def basis(self) -> str:
        """Return in words what weather it is made from."""
        if self.weather is None:
            return "no weather is known"
        if self.weather == 0:
            return "by the usual weather of the date"
        ahead = self.weather - self.measured
        each = {"measured": self.measured, "forecast": ahead}
        if self.nights in each.values():
            return f"by the weather {'forecast' if ahead else 'measured'}"
        parts = [f"{how} for {counted(n, 'night')}" for how, n in each.items() if n]
        then = ", then the usual" if self.weather < self.nights else ""
        return f"by the weather {' and '.join(parts)}{then}"


def forecast(
    evening: Belief,
    grid: PlantGrid,
    nights: Sequence[Spread],
    weather: int | None = None,
    now: PlotEstimate | None = None,
    found: NDArray[np.bool_] | None = None,
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
        How many are infested this evening, where more is known of that than `evening` says.
    found
        ``(n,)`` plants that were found infested and left: of them nothing is in doubt. None: there
        are none.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.infestation.insects.spread import Spread
    >>> from fieldmon.infestation.tracing.traced_pairs import TracedPairs
    >>> from fieldmon.plot.layout import rectangle
    >>> grid = rectangle(9, 9)
    >>> ahead = forecast(TracedPairs.of(grid, np.full(81, 0.02)), grid, [Spread(0.02)] * 14)
    >>> bool(ahead.low[-1] < ahead.expected[-1] < ahead.high[-1])
    True
    """
    made, morning = [estimate_of(grid, evening, found=found) if now is None else now], evening
    for k, night in enumerate(nights):
        # what the finds tell, the first night brings
        if k > 0 and isinstance(morning, TracedPairs):
            morning = morning.untold_night(night)
        else:
            morning = morning.overnight(night)
        made.append(estimate_of(grid, morning, found=found))
    if found is not None:
        made = [one.beside(int(np.count_nonzero(found))) for one in made]
    expected, low, high = (
        np.array([getattr(one, of) for one in made], float) for of in ("expected", "low", "high")
    )
    for k in range(1, len(low)):
        # without inspections there are no fewer but for those that die
        left = min(1.0, expected[k] / max(expected[k - 1], _LEAST))
        low[k] = max(low[k], math.floor(low[k - 1] * left))
    return Forecast(expected, low, high, weather)
