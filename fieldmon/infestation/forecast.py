"""What a chance map comes to in the next days if nobody inspects: how many plants are infested."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.compute.wording import counted
from fieldmon.infestation.plot_estimate import estimate_plot
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.infestation.unwatched import (
    LEVEL_DOUBT,
    MOST_GROWN,
    OF_A_PEST,
    RATE_DOUBT,
    Unwatched,
    arrivals_known,
)

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
_DRAWS = 4000
# an interval of 90 % is so many standard deviations wide
_SIGMAS = 3.29
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

    def sentence(self) -> str:
        """Return it in words."""
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
    told = _told_tonight(evening, nights)
    with ThreadPoolExecutor(1) as beside:
        # but for what came from outside and its offspring
        here = beside.submit(_numbers, _without_arrivals(evening), nights, told)
        expected = _numbers(evening, nights, told)
        inside = np.minimum(here.result(), expected)
    found = evening.arrivals_found if isinstance(evening, TracedPairs) else 0.0
    named = evening.pest is not None
    # days without inspections until now are drawn as those to come
    since, tonight = Unwatched(), now
    if isinstance(evening, TracedPairs) and evening.unwatched.days:
        since, tonight = evening.unwatched, None
    if tonight is None:
        tonight = estimate_plot(
            grid, evening.chance, evening.pair_chance, doubt=evening.doubt, named=named
        )
    if now is not None and expected[0] > 0.0:
        # rounding must not let it be more than all
        inside[0] = min(inside[0] * (now.expected / expected[0]), now.expected)
        expected[0] = now.expected
    doubts = _deviation(tonight), OF_A_PEST if named else LEVEL_DOUBT
    low, high = _interval((inside, expected - inside), doubts, found, (since, len(evening.chance)))
    if now is not None:
        # it is never surer than what is known this evening
        grows = expected / max(float(expected[0]), _LEAST)
        low, high = np.minimum(low, now.low * grows), np.maximum(high, now.high * grows)
        low[0], high[0] = now.low, now.high
    for night in range(1, len(low)):
        # without inspections there are no fewer but for those that die
        left = min(1.0, expected[night] / max(expected[night - 1], _LEAST))
        low[night] = max(low[night], low[night - 1] * left)
    low, high = np.floor(low), np.minimum(np.ceil(high), len(evening.chance))
    return Forecast(expected, low, high, weather)


def _without_arrivals(evening: Belief) -> Belief:
    return evening.without_arrivals if isinstance(evening, TracedPairs) else evening


def _told_tonight(evening: Belief, nights: Sequence[Spread]) -> Floats | None:
    """Return what the first night tells by the ancestry of finds: by what it multiplies chances.

    ``(n,)``; None: nothing. So tomorrow's map is that of tomorrow's plan.
    """
    if not isinstance(evening, TracedPairs) or len(nights) == 0:
        return None
    if evening.ancestry is None or not evening.ancestry.waits:
        return None
    told: Floats = evening.overnight(nights[0]).chance / evening.untold_night(nights[0]).chance
    return told


def _numbers(evening: Belief, nights: Sequence[Spread], told: Floats | None) -> Floats:
    """Return how many are expected to be infested this evening and after each night, ``(d,)``."""
    numbers, belief = [float(evening.chance.sum())], evening
    for k, spread in enumerate(nights):
        if isinstance(belief, TracedPairs):
            belief = belief.untold_night(spread)
            belief = belief.times(told) if told is not None and k == 0 else belief
        else:
            belief = belief.overnight(spread)
        numbers.append(float(belief.chance.sum()))
    return np.array(numbers)


def _deviation(made: PlotEstimate) -> float:
    """Return the standard deviation of the number, over the number; never none."""
    return max((made.high - made.low) / max(made.expected, _LEAST) / _SIGMAS, 0.01)


def _interval(
    expected: tuple[Floats, Floats],
    doubts: tuple[float, float],
    found: float,
    of: tuple[Unwatched, int],
) -> Floats:
    """Return the interval of 90 % on each morning, ``(2, d)``, from whole numbers that are drawn.

    What is on the plot, and what arrives, multiply each by chance, as fast as was expected or as
    the rate is doubted: where nothing is, nothing comes of it.

    Parameters
    ----------
    expected
        ``(d,)`` each, of what is on the plot this evening, and of what came from outside.
    doubts
        How far tonight's number may be off, as a share: as the chance map says, and beyond that.
    found
        How many finds tell what arrives.
    of
        What came about since somebody inspected last, and how many plants there are.
    """
    (inside, arrived), (since, most) = expected, of
    draws = RandomStreams(0).of("forecast")
    known = arrivals_known(found)
    doubt, beyond = doubts
    level = draws.gamma(beyond**-2.0, beyond**2.0, _DRAWS)
    faster = np.exp(draws.normal(0.0, RATE_DOUBT, _DRAWS))
    arrives = draws.gamma(known, 1.0 / known, _DRAWS)
    level = level * np.exp(np.minimum(since.grown * (faster - 1.0), MOST_GROWN))
    # of what was there when somebody inspected last the map knows how doubtful it is
    new = since.arrived * (inside[0] + arrived[0])
    before = _tonight(inside[0] + arrived[0] - new, new, doubt, draws)
    tonight = draws.poisson(np.minimum(level * (before + arrives * new), most))
    ends = [np.quantile(tonight, (0.05, 0.95))]
    tonight = level * _tonight(inside[0], arrived[0], doubt, draws)
    here = draws.poisson(np.minimum(tonight, most))
    came = draws.poisson(np.minimum(level * arrives * arrived[0], most))
    for night in range(1, len(inside)):
        grows = max(inside[night], _LEAST) / max(inside[night - 1], _LEAST)
        new = max(arrived[night] - grows * arrived[night - 1], 0.0)
        here = _grown(here, grows**faster, draws)
        came = _grown(came, grows**faster, draws) + draws.poisson(arrives * new)
        ends.append(np.quantile(here + came, (0.05, 0.95)))
    return np.array(ends).T


def _tonight(inside: float, arrived: float, doubt: float, draws: np.random.Generator) -> Floats:
    """Draw how many are expected of what is on the plot, as far as that is in doubt.

    Its part of the doubt is as its part of the number; what is drawn as a whole number varies by
    itself, so that much of the doubt is not drawn here.
    """
    inside = max(inside, _LEAST)
    over = (doubt * (inside + arrived)) ** 2 / (inside + arrived) / inside - 1.0 / inside
    if over <= _LEAST:
        return np.full(_DRAWS, inside)
    variance = float(np.log1p(over))
    tonight: Floats = inside * draws.lognormal(-variance / 2.0, np.sqrt(variance), _DRAWS)
    return tonight


def _grown(
    number: NDArray[np.int64], times: Floats, draws: np.random.Generator
) -> NDArray[np.int64]:
    """Draw what becomes of whole numbers in a night in which each grows so many times.

    Each of them by itself, as in a birth process (Yule 1925); where they are to become fewer, each
    lives on by chance.
    """
    lives = np.minimum(times, 1.0)
    left = draws.binomial(number, lives)
    stays = np.clip(1.0 / np.maximum(times, 1.0), _LEAST, 1.0)
    born = draws.negative_binomial(np.maximum(left, 1), stays)
    grown: NDArray[np.int64] = left + np.where(left > 0, born, 0)
    return grown
