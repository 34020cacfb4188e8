"""What a night does to chances of plants and of pairs: infections come from where infestations are.

Neighbours of a clean plant are infested together. There is an infestation beside it with the
chance `g`; if so each neighbour belongs to it with the chance that it is infested beside a clean
plant, over `g`, so that where one does another does with the chance that infested plants have of
an infested neighbour. Independent neighbours are the case of g = 1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inlined, inner_loop, loop
from fieldmon.infestation.chance_bounds import bounded_chance, greater, lesser

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.plot.grid import Linked

    # along the row, and across
    _Rates = tuple[float, float]

_1 = np.uint64(1)
# rows of the room for the neighbours of a plant: chance that each infects it; that it escapes each
# where there is an infestation beside it; and that with the most infested neighbour left out
_INFECTS, _ESCAPES, _ESCAPES_BUT = 0, 1, 2


def night_of_pairs(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    spread: Spread,
    lean: float = 0.5,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return ``chance (n,)`` and ``pair_chance (e,)`` of the next morning from those of a night.

    `lean` is the share of what goes to neighbours that goes along the row.
    """
    chance, pair_chance = believed
    after, pair_after = np.empty_like(chance), np.empty_like(pair_chance)
    density, escape = np.empty_like(chance), np.empty_like(pair_chance)
    along, across = (min(2.0 * share * spread.rate_per_day, 1.0) for share in (lean, 1.0 - lean))
    rule = (along, across), spread.to == "one", spread.arrivals_per_day
    room = np.empty((3, int(np.diff(linked.start).max(initial=0))))
    _find_local_density(believed, density, linked)
    _find_escapes(believed, (after, density, escape), linked, room, rule)
    _find_pairs(believed, (after, pair_after, density, escape), linked, spread.rate_per_day)
    return after, pair_after


@loop
def _find_local_density(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    density: NDArray[np.float64],
    linked: Linked,
) -> None:
    """Find the share of infested neighbours that each plant has if it is infested, ``(n,)``."""
    chance, pair_chance = believed
    for i in range(np.uint64(chance.size)):
        first, end = np.uint32(linked.start[i]), np.uint32(linked.start[i + _1])
        infested = 0.0
        for e in range(first, end):
            infested += pair_chance[e] / chance[i]
        density[i] = infested / (end - first) if end > first else 0.0


@loop
def _find_escapes(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    after: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    room: NDArray[np.float64],
    rule: tuple[_Rates, bool, float],
) -> None:
    """Find every plant's chance in the morning, and what its pairs need.

    `after` is that chance ``(n,)``, the local density ``(n,)``, and the chance that a clean plant
    escapes all its neighbours but one ``(e,)``; `room` ``(3, d)`` holds what concerns the d
    neighbours of a plant.
    """
    chance, morning = believed[0], after[0]
    for i in range(np.uint64(chance.size)):
        # most plants; a loop of unknown length costs three times this
        if linked.start[i + _1] - linked.start[i] == 4:
            stays = _escape_four(i, believed, after, linked, rule)
        else:
            stays = _escape_any(i, believed, after, linked, (room, rule))
        morning[i] = bounded_chance(1.0 - (1.0 - chance[i]) * stays)


@inner_loop
def _escape_any(
    i: int,
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    after: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    given: tuple[NDArray[np.float64], tuple[_Rates, bool, float]],
) -> float:
    """Return the chance that a clean plant stays so; find it but for each of its neighbours."""
    chance, (_, density, escape) = believed[0], after
    room, (rate, to_one, arrivals) = given
    rates = rate, to_one
    first, degree = linked.start[i], linked.start[i + _1] - linked.start[i]
    total, together = 0.0, 0.0
    # the most infested neighbour, and the next
    most, second, which = 0.0, 0.0, -1
    for k in range(degree):
        j, infested = _given_clean(believed, linked, np.uint64(first + k), 1.0 - chance[i])
        total += infested
        together += infested * density[j] ** 2
        room[_INFECTS, k] = _transmits(linked, rates, (i, j)) * infested
        if infested > most:
            most, second, which = infested, most, k
        elif infested > second:
            second = infested
    g, g_but = _one_infestation(total, together, (most, second))
    for k in range(degree):
        room[_ESCAPES, k], room[_ESCAPES_BUT, k] = (
            _escapes(room[_INFECTS, k], g),
            _escapes(room[_INFECTS, k], g_but),
        )
    for k in range(degree):
        row, there = (_ESCAPES_BUT, g_but) if k == which else (_ESCAPES, g)
        escapes = 1.0
        for other in range(degree):
            if other != k:
                escapes *= room[row, other]
        escape[first + k] = (1.0 - arrivals) * (1.0 - there * (1.0 - escapes))
    escapes = 1.0
    for k in range(degree):
        escapes *= room[_ESCAPES, k]
    return (1.0 - arrivals) * (1.0 - g * (1.0 - escapes))


@inlined
def _one_infestation(
    total: float, together: float, infested: tuple[float, float]
) -> tuple[float, float]:
    """Return the chance of an infestation beside a clean plant.

    And of one where its most infested neighbour is left out.
    """
    most, second = infested
    shared = together / total if total > 0.0 else 0.0
    g, g_but = greater(shared, most), greater(shared, second)
    return most / g if g > 0.0 else 0.0, second / g_but if g_but > 0.0 else 0.0


@inlined
def _escape_four(
    i: int,
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    after: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    rule: tuple[_Rates, bool, float],
) -> float:
    """Do the same for a plant with four neighbours, to the same digits."""
    chance, (_, density, escape) = believed[0], after
    rate, to_one, arrivals = rule
    rates = rate, to_one
    stay, clean = 1.0 - arrivals, 1.0 - chance[i]
    e0 = np.uint64(np.uint32(linked.start[i]))
    e1, e2, e3 = e0 + _1, e0 + np.uint64(2), e0 + np.uint64(3)
    j0, b0 = _given_clean(believed, linked, e0, clean)
    j1, b1 = _given_clean(believed, linked, e1, clean)
    j2, b2 = _given_clean(believed, linked, e2, clean)
    j3, b3 = _given_clean(believed, linked, e3, clean)
    d0, d1, d2, d3 = density[j0], density[j1], density[j2], density[j3]
    together = b0 * d0**2 + b1 * d1**2 + b2 * d2**2 + b3 * d3**2
    # the most infested of them, and the next
    more, less = (b1, b0) if b1 > b0 else (b0, b1)
    other_more, other_less = (b3, b2) if b3 > b2 else (b2, b3)
    first_two = other_more <= more
    most = more if first_two else other_more
    second = greater(other_more, less) if first_two else greater(more, other_less)
    which = b1 > b0 if first_two else 2 + (b3 > b2)
    g, g_but = _one_infestation(b0 + b1 + b2 + b3, together, (most, second))
    s0 = _transmits(linked, rates, (i, j0)) * b0
    s1 = _transmits(linked, rates, (i, j1)) * b1
    s2 = _transmits(linked, rates, (i, j2)) * b2
    s3 = _transmits(linked, rates, (i, j3)) * b3
    f0, f1, f2, f3 = _escapes(s0, g), _escapes(s1, g), _escapes(s2, g), _escapes(s3, g)
    escape[e0] = stay * (1.0 - g * (1.0 - f1 * f2 * f3))
    escape[e1] = stay * (1.0 - g * (1.0 - f0 * f2 * f3))
    escape[e2] = stay * (1.0 - g * (1.0 - f0 * f1 * f3))
    escape[e3] = stay * (1.0 - g * (1.0 - f0 * f1 * f2))
    low, middle, high = s1 if which == 0 else s0, s2 if which <= 1 else s1, s2 if which == 3 else s3
    escapes_but = _escapes(low, g_but) * _escapes(middle, g_but) * _escapes(high, g_but)
    escape[e0 + np.uint64(which)] = stay * (1.0 - g_but * (1.0 - escapes_but))
    return stay * (1.0 - g * (1.0 - f0 * f1 * f2 * f3))


@inlined
def _given_clean(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    e: np.uint64,
    clean: float,
) -> tuple[np.uint32, float]:
    """Return the neighbour of an entry, and its chance if the plant it stands beside is clean."""
    j = np.uint32(linked.plant[e])
    return j, greater(believed[0][j] - believed[1][e], 0.0) / clean


@inlined
def _transmits(linked: Linked, rule: tuple[_Rates, bool], way: tuple[int, np.uint32]) -> float:
    """Return the chance that an infested plant j infests its neighbour i."""
    (along, across), to_one = rule
    i, j = way
    rate = along if j + _1 == i or i + _1 == j else across
    return rate / (linked.start[np.uint64(j) + _1] - linked.start[j]) if to_one else rate


@inlined
def _escapes(infects: float, g: float) -> float:
    """Return the chance that a plant escapes a neighbour where an infestation is beside it."""
    return 1.0 - infects / g if g > 0.0 else 1.0


@loop
def _find_pairs(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    after: tuple[
        NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]
    ],
    linked: Linked,
    rate: float,
) -> None:
    """Find the chances of pairs in the morning from what `_find_escapes` has found."""
    (chance, pair_chance), (morning, pair, density, escape) = believed, after
    twice = 1.0 - (1.0 - rate) ** 2
    for i in range(np.uint64(chance.size)):
        for e in range(np.uint32(linked.start[i]), np.uint32(linked.start[i + _1])):
            j = np.uint32(linked.plant[e])
            a, b = 1.0 - escape[e], 1.0 - escape[np.uint32(linked.back[e])]
            # what comes to two neighbours at once mostly comes from one infestation
            at_once = greater(a * b, twice * lesser(density[i], density[j]) * lesser(a, b))
            neither = greater(1.0 - chance[i] - chance[j] + pair_chance[e], 0.0) * (
                1.0 - a - b + at_once
            )
            both = morning[i] + morning[j] - 1.0 + neither
            both = greater(both, greater(0.0, morning[i] + morning[j] - 1.0))
            pair[e] = lesser(lesser(both, morning[i]), morning[j])
