"""What a night teaches of the ancestry of finds, and the chances by it the next morning."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.infestation.ancestry.ancestry_rates import DrawnEvidence
from fieldmon.infestation.ancestry.infestation_course import BEFORE
from fieldmon.infestation.ancestry.infestations import LEAST_ROOM
from fieldmon.infestation.ancestry.nightly_draws import SETTLED, NightlyDraws
from fieldmon.infestation.ancestry.origins import ARRIVE, ARRIVE_BY_EDGE
from fieldmon.infestation.cell_squares import NOBODY
from fieldmon.infestation.chance_bounds import LEAST_CHANCE, MOST_CHANCE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.ancestry import Ancestry
    from fieldmon.infestation.ancestry.drawn_ancestry import DrawnSums
    from fieldmon.infestation.ancestry.infestations import Infestations
    from fieldmon.infestation.insects.jump_landing import Landing

    Floats = NDArray[np.floating[Any]]

# rates are estimated after so many draws of few sweeps each, and after a last one of many, by
# which chances are told: days 0, 1, 2 and later. In the first nights there are two rounds, as what
# stays unseen hangs on rates, too
_UPDATES, _ROUNDS = (9, 5, 3, 2), (2, 2, 1)
_FEW_SWEEPS, _MANY_SWEEPS, _LEAST_SWEEPS = 30, 180, 4
# of many infestations there are fewer sweeps, so that there are no more than so many moves
_FEW_MOVES, _MANY_MOVES = 2000, 8000
# with so many infestations an ancestry begins anew
_MOST_INFESTATIONS = 1500
# places for infestations that were not found, as a share of all
_ROOM = 0.25
# how far the number at the start may be off beyond what drawn ancestries say of it, since they take
# the rates as known: as a share of it (our choice), and of what was not found of it (chosen on 400
# seasons of ten worlds)
_START_DOUBT, _UNFOUND_DOUBT = 0.1, 0.5
# the draws of a night have other seeds than all others: days, rounds and updates
_SEEDS = (100_000, 8, 16)
# never surer than this
_MOST = 0.95


class ToldNight(NamedTuple):
    """What is told of a night.

    Parameters
    ----------
    sends
        How many infestations an infested plant sends out.
    arrive
        The share of all plants that is infested from outside: anywhere, and by the edge.
    length
        How long it is with its day, in days, and how warm for each stage of the pest.
    wind_m_s
        Where the wind has gone of late.
    """

    sends: float
    arrive: tuple[float, float] = (ARRIVE, ARRIVE_BY_EDGE)
    length: tuple[float, ...] = (1.0,)
    wind_m_s: tuple[float, float] = (0.0, 0.0)


def overnight(of: Ancestry, night: ToldNight) -> tuple[Ancestry, NDArray[np.float64] | None]:
    """Return what is known the next morning, and each plant's chance ``(n,)``.

    There are no chances (None) where nothing was inspected since the night before: what was found
    has had its say. Those `left` infested are certain.
    """
    day, n = len(of.sends), len(of.grid)
    hears = bool(of.new) or bool(of.missed[day:].any())
    nothing = np.zeros((day + 1 - len(of.missed), n), np.float16)
    anywhere, by_edge = night.arrive
    after = _with_finds(
        replace(
            of,
            missed=np.concatenate([of.missed, nothing]),
            sends=np.append(of.sends, night.sends),
            nights=of.nights if of.pest is None else np.concatenate([of.nights, [night.length]]),
            rates=of.rates
            if day or of.began_anew
            else of.rates._replace(anywhere=anywhere, by_edge=by_edge),
            heard=of.heard + hears,
            idle=of.idle + (of.knows and not hears),
        )
    )
    if not hears:
        return after, None
    infestations, landing = after.infestations, of.landing(night.wind_m_s)
    many = int(np.count_nonzero(infestations.there & (infestations.seen > 0)))
    for k in range(_on(after.heard - 1, _ROUNDS)):
        after, hidden, unseen = _drawn(after, landing, k, night.arrive)
    after = replace(after, idle=0)
    chance = np.clip(1.0 - np.exp(-unseen) * (1.0 - np.minimum(hidden, 1.0)), LEAST_CHANCE, _MOST)
    chance[after.left] = MOST_CHANCE
    if after.is_old or many > _MOST_INFESTATIONS:
        after = after.anew(chance)
    return after, chance


def sweeps_of(of: Ancestry) -> tuple[int, ...]:
    """Return how many sweeps there are in each draw of a night that has begun."""
    last = BEFORE + len(of.sends)
    settled = of.infestations.there & (of.infestations.seen <= last - SETTLED)
    moving = max(int(np.count_nonzero(~settled)), 1)
    few = max(_LEAST_SWEEPS, min(_FEW_SWEEPS, _FEW_MOVES // moving))
    many = max(_LEAST_SWEEPS, min(_MANY_SWEEPS, _MANY_MOVES // moving))
    # nights that taught nothing left their share of the work to this one
    updates = _on(of.heard - 1, _UPDATES) * (1 + of.idle)
    return (*[few] * min(updates, _SEEDS[2] - 1), many)


def _on(day: int, numbers: tuple[int, ...]) -> int:
    """Return the number of a day, the last one on all later days."""
    return numbers[min(day, len(numbers) - 1)]


def _with_finds(of: Ancestry) -> Ancestry:
    """Return the same with the last day's finds among the infestations."""
    day = len(of.sends) - 1
    morning = BEFORE + day
    last_find = of.last_find.copy()
    used = int(np.count_nonzero(of.infestations.there)) + len(of.new)
    spare = max(LEAST_ROOM, int(_ROOM * used))
    made = of.infestations.copied(max(0, used + spare - len(of.infestations.plant)))
    at, left = made.places(len(of.grid), morning), set(of.new_left)
    goes_on = made.goes_on(morning)
    made.ends[goes_on] = morning + 1
    made.seen[goes_on & ~made.found] = morning + 1
    free = np.flatnonzero(~made.there)
    for k, plant in enumerate(of.new):
        place = at[plant]
        if place == NOBODY:
            place = free[k]
            earliest = max(0, BEFORE + int(last_find[plant]) + 1)
            made.plant[place], made.earliest[place] = plant, earliest
            made.begins[place] = min(max(earliest, BEFORE), morning)
            made.parent[place], made.children[place] = NOBODY, 0
            made.there[place] = True
        if not made.found[place]:
            made.found[place], made.seen[place] = True, morning
        made.ends[place] = morning + 1 if plant in left else morning
        last_find[plant] = day
    return replace(of, infestations=made, last_find=last_find, new=(), new_left=())


def _drawn(
    of: Ancestry, landing: Landing, nth: int, arrive: tuple[float, float]
) -> tuple[Ancestry, Floats, NDArray[np.float64]]:
    """Draw ancestries for the `nth` time in a night, and estimate rates by them.

    Return also how likely each plant is infested as the ancestor of a find, and how many
    infestations of which nothing was seen are expected there.
    """
    draws, rates, day = NightlyDraws.begun(of, landing), of.rates, len(of.sends) - 1
    drawn, seen = draws.drawn, 1.0 - draws.inspected.unseen.chance
    sweeps, left = sweeps_of(of), of.left
    for k, many in enumerate(sweeps):
        weights = draws.weights(rates)
        kept = draws.draw(weights, int(np.ravel_multi_index((day, nth, k), _SEEDS)), many)
        # between the first draw and the last, nothing hangs on these
        if k in (0, len(sweeps) - 1):
            counted = draws.counted(kept, weights, rates.shares)
        if k == 0:
            # what arrives where an infestation goes on is not seen
            seen[BEFORE + 1 :, left] *= 1.0 - counted.taken[BEFORE:-1, left]
        night = DrawnEvidence(
            of.start, weights.sends, weights.kernel, seen, counted.taken, drawn, counted.active,
            draws.inspected.course.sending(counted.unfound), arrive, of.earlier,
        )  # fmt: skip
        if k == 0:
            exposure = rates.exposure(night, landing)
        rates = rates.after(night, exposure, landing)
    # several may have come to one plant
    unfound_at_start = float(-np.expm1(-counted.unfound[BEFORE]).sum())
    made = replace(
        of,
        infestations=draws.infestations,
        taken=counted.taken.astype(np.float16),
        rates=rates,
        at_start=of.at_start
        if of.began_anew
        else _at_start(drawn, draws.infestations, unfound_at_start),
        arrived=float(drawn.roots[1].sum()),
        taught=rates.taught(night, exposure, landing),
    )
    return made, drawn.hidden, counted.unfound[-1].astype(np.float64)


def _at_start(drawn: DrawnSums, infestations: Infestations, unfound: float) -> Floats:
    """Return how many there were on the first morning, ``(3,)`` as `Ancestry.at_start` has it.

    `unfound` are those of which nothing was seen; they vary by chance.
    """
    known, square = drawn.at_start
    number, variance = known + unfound, square - known**2 + unfound
    found = infestations.there & infestations.found
    not_found = max(number - np.count_nonzero(found), 0.0)
    variance += (_START_DOUBT * number) ** 2 + (_UNFOUND_DOUBT * not_found) ** 2
    return np.array([number, variance, np.count_nonzero(found & (infestations.seen == BEFORE))])
