"""What a night changes in a traced map: what insects bring, as origins and ancestry have it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.compute.jit import loop
from fieldmon.infestation.ancestry.ancestry_night import ToldNight
from fieldmon.infestation.ancestry.drawn_nights import overnight_once
from fieldmon.infestation.ancestry.origins import ANYWHERE, BY_ADJACENT, BY_EDGE, JUMPED, N_ORIGINS
from fieldmon.infestation.chance_bounds import (
    AS_GOOD_AS_CLEAN,
    LEAST_CHANCE,
    MOST_CHANCE,
    greater,
)
from fieldmon.infestation.insects.pest_in_weather import PestSpread
from fieldmon.infestation.pairs.clustering import leaning
from fieldmon.infestation.pairs.pair_changes import pairs_after_arrivals
from fieldmon.infestation.pairs.pair_nights import night_of_pairs

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.jump_reach import Reach
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.tracing.traced_map import Map, TracedMap

    Floats = NDArray[np.float64]

# an infested plant is taken to have sent out no more than so many unseen: clusters of eight, with
# `SENT` before the season (our choice)
_MOST_SENT = 7.0
# the wind by which finds are traced: so much of it is that of the nights before the last, told
# apart by metres a second
_LATE, _WIND_M_S = 0.5, 1.0
# two maps are believed: the odds by the ancestry of finds and those by origins with such powers,
# times so much (chosen on 560 seasons of ten worlds)
_ANCESTRY, _ORIGINS, _BOTH = 0.63, 0.42, 1.15


def by_origins(evening: Map, spread: Spread, *, tells_apart: bool) -> Map:
    """Return the map of the next morning, as origins alone have it.

    Unless origins are told apart, no find can be traced by it, but it is worked out in half the
    time.
    """
    degree, sends = _degree(evening), _sends(evening, spread)
    reach, moves = evening.reach, evening.chance
    if isinstance(spread, PestSpread) and evening.cohorts is not None:
        moves = evening.chance * (1.0 - evening.cohorts.still)
        reach = evening.reach_in(spread.wind_m_s)
        each = spread.sends * reach.adjacent / max(degree, 1.0) if evening.known_to_jump else None
        spread = _moving(spread, each, float(moves.sum() / evening.chance.sum()))
    # of a pest with a kernel of its own, the rate is of the plants beside it already
    beside = 1.0 if evening.known_to_jump else 1.0 - evening.jumps * (1.0 - reach.adjacent)
    rate = spread.rate_per_day * min(1.0, beside * evening.counts.scale[BY_ADJACENT])
    near = replace(spread, rate_per_day=rate, arrivals_per_day=0.0)
    pairs = evening.chance, evening.pair_chance
    believed = night_of_pairs(pairs, evening.grid.linked, near, leaning(evening.evidence))
    brought = brought_from_afar(evening, reach, (moves, sends), spread, tells_apart=tells_apart)
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
        shares = _shares_after(evening, believed[0] - evening.chance, gain, brought)
        morning = replace(morning, shares=shares)
    return _aged(evening, morning, spread)


def with_ancestry(evening: Map, morning: Map, spread: Spread) -> Map:
    """Return a `morning` by origins as the ancestry of finds has it, too."""
    if evening.ancestry is None:
        return morning
    hiding = evening.latency.likely if evening.latency is not None else evening.ancestry.hiding
    # what goes far comes from anywhere
    sends = _sends(evening, spread) * (1.0 - evening.reach.anywhere)
    night = ToldNight(sends, evening.told_from_outside(spread), wind_m_s=morning.wind_m_s)
    if isinstance(spread, PestSpread):
        night = night._replace(length=(spread.days, *spread.warmth))
    ancestry, chance = overnight_once(replace(evening.ancestry, hiding=hiding), night)
    if chance is not None:
        # a logarithmic pool of both maps (Genest & Zidek 1986)
        odds = _BOTH * _odds(chance) ** _ANCESTRY * _odds(morning.chance) ** _ORIGINS
        both = np.where(ancestry.left, morning.chance, odds / (1.0 + odds))
        morning = morning.times(both / morning.chance)
    elif ancestry.is_old:
        ancestry = ancestry.anew(morning.chance)
    return replace(morning, ancestry=ancestry).levelled()


def in_hindsight(evening: Map, spread: Spread) -> Map:
    """Return a map of an evening as the ancestry of finds has it, before the night of a `spread`.

    The ancestry is the one that the next morning is told by: another draw may believe twice as
    much, and the number would jump overnight.
    """
    if evening.ancestry is None or not evening.ancestry.waits:
        return evening
    night = by_origins(evening, spread, tells_apart=False)
    morning = with_ancestry(evening, night, spread)
    # what was found and treated today can only come back in the night
    scale = np.where(evening.chance > AS_GOOD_AS_CLEAN, morning.chance / night.chance, 1.0)
    told = evening.times(scale)
    return replace(told, ancestry=morning.ancestry).levelled()


def _degree(of: TracedMap) -> float:
    """Return how many plants stand beside one, on average."""
    return float(np.diff(of.grid.adjacent.start).mean())


def _sends(evening: TracedMap, spread: Spread) -> float:
    """Return what an infested plant sends out in a night."""
    if isinstance(spread, PestSpread) and evening.known_to_jump:
        return spread.sends
    return spread.rate_per_day * (_degree(evening) if spread.to != "one" else 1.0)


def _aged(evening: TracedMap, morning: Map, spread: Spread) -> Map:
    """Return a morning with the young a night older, and with the wind of late."""
    if evening.latency is not None:
        return replace(morning, latency=evening.latency.overnight(evening.chance, morning.chance))
    if evening.cohorts is None or not isinstance(spread, PestSpread):
        return morning
    gain = np.maximum(morning.chance - evening.chance, 0.0)
    cohorts = evening.cohorts.overnight(evening.chance, gain, morning.chance, spread)
    if spread.mortality_per_day > 0.0:
        left = (1.0 - spread.mortality_per_day) ** spread.days
        morning = morning.treated(np.full(len(gain), left))
    return replace(morning, cohorts=cohorts, wind_m_s=_of_late(evening.wind_m_s, spread.wind_m_s))


def brought_from_afar(
    evening: TracedMap,
    reach: Reach,
    sent: tuple[Floats, float],
    spread: Spread,
    *,
    tells_apart: bool,
) -> Floats:
    """Return what a night brings each plant from farther than beside it, ``(o, n)``.

    `sent` is the chance ``(n,)`` that a plant is infested and sends something out, and how
    much that is. Unless kernels are told apart, the first holds what all of them bring.
    """
    (moves, sends), scale = sent, evening.counts.scale
    brought = np.zeros((N_ORIGINS, len(evening.chance)))
    by_jumps = sends * evening.jumps * (reach.beyond * scale[JUMPED:])
    if tells_apart:
        brought[JUMPED:] = reach.brought_by_each(moves) * by_jumps[:, None]
    else:
        brought[JUMPED] = reach.landed(moves, reach.mixed(by_jumps))
    brought[ANYWHERE], brought[BY_EDGE] = evening.from_outside(reach, spread)
    if isinstance(spread, PestSpread):
        brought[ANYWHERE] += reach.anywhere * sends * float(moves.mean())
    return brought


def _shares_after(
    evening: TracedMap, beside: Floats, gain: Floats, brought: Floats
) -> NDArray[np.float32]:
    """Return the shares of the origins after a night that brought so much."""
    shares = np.empty_like(evening.shares)
    _add_brought(as_compiled(evening.shares), evening.chance, (beside, gain, brought), shares)
    shares /= shares.sum(axis=1, keepdims=True)
    return shares


@loop
def _add_brought(
    before: NDArray[np.float32],
    chance: Floats,
    came: tuple[Floats, Floats, Floats],
    parts: NDArray[np.float32],
) -> None:
    """Find how much of each chance each origin brought, ``(n, o)``; plant by plant, in one walk."""
    beside, gain, brought = came
    for i in range(chance.size):
        total = 0.0
        for o in range(N_ORIGINS):
            total += brought[o, i]
        share = gain[i] / greater(total, 1e-12)
        for o in range(N_ORIGINS):
            parts[i, o] = before[i, o] * np.float32(chance[i])
            if o == BY_ADJACENT:
                parts[i, o] += np.float32(greater(beside[i], 0.0))
            parts[i, o] += np.float32(brought[o, i] * share)


def _odds(chance: Floats) -> Floats:
    odds: Floats = chance / (1.0 - chance)
    return odds


def _moving(spread: PestSpread, rate: float | None, moves: float) -> PestSpread:
    """Return a night in which a share of the infested plants sends something to each beside it.

    `rate` is what each gets of one that sends, if the pest has a kernel; else as it was.
    """
    rate = -np.log1p(-spread.rate_per_day) if rate is None else rate
    return replace(spread, rate_per_day=float(-np.expm1(-rate * moves)))


def _of_late(before: tuple[float, float], now: tuple[float, float]) -> tuple[float, float]:
    """Return the wind of the last nights, as told apart as those of nights are."""
    x, y = (
        float(np.rint((_LATE * a + (1.0 - _LATE) * b) / _WIND_M_S) * _WIND_M_S) + 0.0
        for a, b in zip(before, now, strict=True)
    )
    return x, y
