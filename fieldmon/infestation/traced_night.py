"""A night of a traced map: what each origin brings each plant, and what that makes of the chances.

To the plants beside, infestations spread as `fieldmon.infestation.pairs` has it. What comes from
farther is drawn from none: kernels of jumps and arrivals from outside bring each plant so much.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.chance_bounds import LEAST_CHANCE, MOST_CHANCE
from fieldmon.infestation.clustering import leaning
from fieldmon.infestation.origins import (
    ANYWHERE,
    ARRIVE,
    ARRIVE_BY_EDGE,
    BY_ADJACENT,
    BY_EDGE,
    JUMPED,
    N_ORIGINS,
)
from fieldmon.infestation.pair_changes import pairs_after_arrivals
from fieldmon.infestation.pair_nights import night_of_pairs
from fieldmon.infestation.pest_in_weather import PestSpread

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.jump_reach import Reach
    from fieldmon.infestation.spread import Spread
    from fieldmon.infestation.traced_pairs import TracedPairs

    Floats = NDArray[np.float64]

# an infested plant has sent out no more than so many unseen: clusters of eight (our choice)
_MOST_SENT = 7.0
# the wind by which finds are traced: so much of it is that of the nights before the last, told
# apart by metres a second
_LATE, _WIND_M_S = 0.5, 1.0


@dataclass(frozen=True, eq=False)
class TracedNight:
    """The night after an evening, by the spread that the insects are taken to have.

    Parameters
    ----------
    evening
        What is believed before it.
    spread
        What the insects do in it.
    """

    evening: TracedPairs
    spread: Spread

    @cached_property
    def _plants_beside(self) -> float:
        """How many plants stand beside one, on average."""
        return float(np.diff(self.evening.grid.adjacent.start).mean())

    @cached_property
    def sends(self) -> float:
        """What an infested plant sends out."""
        spread = self.spread
        if isinstance(spread, PestSpread) and self.evening.known_to_jump:
            return spread.sends
        return spread.rate_per_day * (self._plants_beside if spread.to != "one" else 1.0)

    def morning(self, *, tells_apart: bool) -> TracedPairs:
        """Return what is believed after it, and where that came from if it `tells_apart` origins.

        Without that it takes half the time.
        """
        evening, spread, sends = self.evening, self.spread, self.sends
        reach, moves = evening.reach, evening.chance
        if isinstance(spread, PestSpread) and evening.cohorts is not None:
            moves = evening.chance * (1.0 - evening.cohorts.still)
            reach = evening.reach_in(spread.wind_m_s)
            each = None
            if evening.known_to_jump:
                each = spread.sends * reach.adjacent / max(self._plants_beside, 1.0)
            spread = _moving(spread, each, float(moves.sum() / evening.chance.sum()))
        believed = self._beside(spread, reach)
        brought = self._brought(reach, moves, tells_apart=tells_apart)
        arrives = 1.0 - np.exp(-brought.sum(axis=0))
        gain = (1.0 - believed[0]) * arrives
        after = np.clip(believed[0] + gain, LEAST_CHANCE, MOST_CHANCE)
        morning = replace(
            evening,
            chance=after,
            pair_chance=pairs_after_arrivals(believed, evening.grid.adjacent, arrives, after),
            unseen=np.minimum(evening.unseen + sends, _MOST_SENT),
        )
        if tells_apart:
            shares = self._shares_after(believed[0] - evening.chance, gain, brought)
            morning = replace(morning, shares=shares)
        return self._aged(morning, spread)

    def _beside(self, spread: Spread, reach: Reach) -> tuple[Floats, Floats]:
        """Return the chances of plants and pairs after what plants send to those beside them."""
        evening = self.evening
        # of a pest with a kernel of its own, the rate is of the plants beside it already
        beside = 1.0 if evening.known_to_jump else 1.0 - evening.jumps * (1.0 - reach.adjacent)
        rate = spread.rate_per_day * min(1.0, beside * evening.counts.scale[BY_ADJACENT])
        near = replace(spread, rate_per_day=rate, arrivals_per_day=0.0)
        pairs = evening.chance, evening.pair_chance
        return night_of_pairs(pairs, evening.grid.linked, near, leaning(evening.evidence))

    def _brought(self, reach: Reach, moves: Floats, *, tells_apart: bool) -> Floats:
        """Return what it brings each plant from farther than beside it, ``(o, n)``.

        `moves` is the chance ``(n,)`` that a plant is infested and sends something out. Unless
        kernels are told apart, the first holds what all of them bring.
        """
        evening, sends = self.evening, self.sends
        brought = np.zeros((N_ORIGINS, len(evening.chance)))
        by_jumps = sends * evening.jumps * (reach.beyond * evening.counts.scale[JUMPED:])
        if tells_apart:
            brought[JUMPED:] = reach.brought_by_each(moves) * by_jumps[:, None]
        else:
            brought[JUMPED] = reach.brought(moves, by_jumps)
        brought[ANYWHERE], brought[BY_EDGE] = self.from_outside(reach)
        if isinstance(self.spread, PestSpread):
            brought[ANYWHERE] += reach.anywhere * sends * float(moves.mean())
        return brought

    def from_outside(self, reach: Reach) -> tuple[float, Floats]:
        """Return what it brings a plant from outside: anywhere, and by the edge ``(n,)``."""
        scale = self.evening.counts.scale
        anywhere, by_edge = told_from_outside(self.evening.reach, self.spread)
        return anywhere * float(scale[ANYWHERE]), by_edge * scale[BY_EDGE] * reach.at_edge

    def _shares_after(self, beside: Floats, gain: Floats, brought: Floats) -> NDArray[np.float32]:
        """Return the shares of the origins after a night that brought so much."""
        parts = self.evening.shares * self.evening.chance[:, None].astype(np.float32)
        parts[:, BY_ADJACENT] += np.maximum(beside, 0.0).astype(np.float32)
        parts += (brought * (gain / np.maximum(brought.sum(axis=0), 1e-12))).T.astype(np.float32)
        shares: NDArray[np.float32] = parts / parts.sum(axis=1, keepdims=True)
        return shares

    def _aged(self, morning: TracedPairs, spread: Spread) -> TracedPairs:
        """Return a morning with the young a night older, and with the wind of late."""
        evening = self.evening
        if evening.latency is not None:
            latency = evening.latency.overnight(evening.chance, morning.chance)
            return replace(morning, latency=latency)
        if evening.cohorts is None or not isinstance(spread, PestSpread):
            return morning
        gain = np.maximum(morning.chance - evening.chance, 0.0)
        cohorts = evening.cohorts.overnight(evening.chance, gain, morning.chance, spread)
        if spread.mortality_per_day > 0.0:
            left = (1.0 - spread.mortality_per_day) ** spread.days
            morning = morning.treated(np.full(len(gain), left))
        wind_m_s = wind_of_late(evening.wind_m_s, spread.wind_m_s)
        return replace(morning, cohorts=cohorts, wind_m_s=wind_m_s)


def told_from_outside(reach: Reach, spread: Spread) -> tuple[float, float]:
    """Return the share of all plants taken to be infested from outside in a night.

    Anywhere, and by the edge: as said, but never less than a little. What is said may be wrong, and
    a find far from all others must have come from somewhere.
    """
    anywhere, by_edge = said_from_outside(reach, spread)
    return max(anywhere, ARRIVE), max(by_edge, ARRIVE_BY_EDGE)


def said_from_outside(reach: Reach, spread: Spread) -> tuple[float, float]:
    """Return the share of all plants that is said to be infested from outside in a night.

    Anywhere, and by the edge.
    """
    if not isinstance(spread, PestSpread):
        return spread.arrivals_per_day, 0.0
    # said of plants at the edge
    return spread.arrivals_per_day, spread.edge_per_day / float(reach.at_edge.max())


def _moving(spread: PestSpread, rate: float | None, moves: float) -> PestSpread:
    """Return a night in which a share of the infested plants sends something to each beside it.

    `rate` is what each gets of one that sends, if the pest has a kernel; else as it was.
    """
    rate = -np.log1p(-spread.rate_per_day) if rate is None else rate
    return replace(spread, rate_per_day=float(-np.expm1(-rate * moves)))


def wind_of_late(before: tuple[float, float], now: tuple[float, float]) -> tuple[float, float]:
    """Return the wind of the last nights, as told apart as those of nights are."""
    x, y = (
        float(np.rint((_LATE * a + (1.0 - _LATE) * b) / _WIND_M_S) * _WIND_M_S) + 0.0
        for a, b in zip(before, now, strict=True)
    )
    return x, y
