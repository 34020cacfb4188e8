"""What an inspection teaches about the plants, and what a night does to the chance map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from fieldmon.compute.jit import inlined, loop, part
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.spread import Spread
    from fieldmon.plot.grid import Csr, Linked, PlantGrid

# no plant is ever taken as certainly clean or certainly infested: evidence must be able to undo it
_LEAST, _MOST = 1e-6, 1.0 - 1e-6
# what is added to it is an int64
_0 = np.int64(0)
_1, _2, _3 = np.uint32(1), np.uint32(2), np.uint32(3)
_64 = np.uint64(1)
# a look is heard as far as three plants away, and as long as it changes a chance by this
_RINGS = 3
# round a loop the same news arrives twice: no plant settles its neighbour more than this
_CLOSEST = 0.9
# how many finds beside finds the belief's own idea of clusters is worth; the most it grows a day
_HABIT, _MORE = 3.0, 1.5
_LEAST_SAY = 1e-6
# correlation of neighbours before anything was found beside a find: where clusters are believed
# in more, single infested plants cost more looks, and the other way round; it is learnt soon
CLUSTERING = 0.25
# rows of the room for the plants beside one: chance that each infects it; that it does not
# where there is an infestation beside it; and that with the most infested one left out
_SHARED, _FREE, _FREE_BUT = 0, 1, 2


@dataclass(frozen=True)
class Learning:
    """How findings change the chance map.

    Parameters
    ----------
    detection
        Chance that an inspection finds what is there; ``(k,)`` for each where they differ.
    beside_find
        Chance that a plant next to a find is infested too, whatever was believed before
        (infestations come in clusters; our choice).
    treated
        Whether a find is destroyed at once (the thesis's rule), or only flagged.
    """

    detection: float | NDArray[np.float64] = 0.84
    beside_find: float = 0.3
    treated: bool = True

    def __post_init__(self) -> None:
        for name in ("detection", "beside_find"):
            values = np.atleast_1d(getattr(self, name))
            if not ((values >= 0.0) & (values <= 1.0)).all():
                raise SettingError(
                    f"{name} must be a chance in 0..1, but it is {getattr(self, name)}."
                )

    def detects(self, looks: int) -> NDArray[np.float64]:
        """Return the detection of each of so many looks, ``(k,)``."""
        return np.full(looks, self.detection, np.float64)


def learn(
    chance: NDArray[np.float64],
    grid: PlantGrid,
    plants: NDArray[np.int32],
    found: NDArray[np.bool_],
    learning: Learning,
) -> NDArray[np.float64]:
    """Return the chance map ``(n,)`` after inspecting `plants` ``(k,)`` with results `found`.

    A clean look lowers a plant's chance by Bayes' rule, p' = p (1 - d) / (1 - p d) with detection
    d; a find settles the plant and raises its neighbours to at least `beside_find`.
    """
    after = chance.copy()
    rule = (learning.detects(len(plants)), learning.beside_find, learning.treated)
    inspected = np.zeros(after.size, np.bool_)
    _learn((after, inspected), grid.adjacent, plants, found, rule)
    return after


@loop
def _learn(
    plot: tuple[NDArray[np.float64], NDArray[np.bool_]],
    adjacent: Csr,
    plants: NDArray[np.int32],
    found: NDArray[np.bool_],
    rule: tuple[NDArray[np.float64], float, bool],
) -> None:
    after, inspected = plot
    detects, beside_find, treated = rule
    for k in range(plants.size):
        i = plants[k]
        inspected[i] = True
        if found[k]:
            after[i] = _LEAST if treated else _MOST
        else:
            p, d = after[i], detects[k]
            after[i] = min(max(p * (1.0 - d) / (1.0 - p * d), _LEAST), _MOST)
    for k in range(plants.size):
        if not found[k]:
            continue
        for e in range(adjacent.start[plants[k]], adjacent.start[plants[k] + 1]):
            j = adjacent.plant[e]
            if not inspected[j]:
                after[j] = min(max(after[j], beside_find), _MOST)


def overnight(chance: NDArray[np.float64], grid: PlantGrid, spread: Spread) -> NDArray[np.float64]:
    """Return the chance map ``(n,)`` of the next morning, neighbours taken as independent."""
    each = spread.rate_per_day
    after, spares = np.empty_like(chance), np.empty_like(chance)
    _spare(chance, spares, grid.adjacent.start, (each, spread.to == "one"))
    _overnight(chance, after, grid.adjacent, spares, spread.arrivals_per_day)
    return after


@loop
def _spare(
    chance: NDArray[np.float64],
    spares: NDArray[np.float64],
    start: NDArray[np.int32],
    rule: tuple[float, bool],
) -> None:
    """Find the chance that a plant does not infest a given neighbour in a night."""
    rate, one = rule
    for i in range(chance.size):
        share = rate / (start[i + 1] - start[i]) if one else rate
        spares[i] = 1.0 - chance[i] * share


@loop
def _overnight(
    chance: NDArray[np.float64],
    after: NDArray[np.float64],
    adjacent: Csr,
    spares: NDArray[np.float64],
    arrivals: float,
) -> None:
    start, plant = adjacent
    for i in range(chance.size):
        # unsigned: an index that may be negative is checked for it
        k, end = np.uint32(start[i]), np.uint32(start[i + 1])
        clean = (1.0 - chance[i]) * (1.0 - arrivals)
        if end - k == 4:  # most plants; a loop of unknown length costs twice this
            clean *= spares[np.uint32(plant[k])]
            clean *= spares[np.uint32(plant[k + _1])]
            clean *= spares[np.uint32(plant[k + _2])]
            clean *= spares[np.uint32(plant[k + _3])]
        else:
            for e in range(k, end):
                clean *= spares[np.uint32(plant[e])]
        infested = 1.0 - clean
        infested = infested if infested < _MOST else _MOST  # noqa: FURB136 - min is slower
        after[i] = infested if infested > _LEAST else _LEAST  # noqa: FURB136 - max is slower


def pairs(
    chance: NDArray[np.float64], grid: PlantGrid, company: float = CLUSTERING
) -> NDArray[np.float64]:
    """Return the chance that both of two plants side by side are infested, ``(e,)``.

    In the order of ``grid.adjacent``. `company` is the correlation of the two: about the chance
    that a plant beside an infested one is infested too, where few are.
    """
    pair_chance = np.empty(len(grid.adjacent.plant))
    _pairs(np.ascontiguousarray(chance), grid.adjacent, company, pair_chance)
    return pair_chance


@loop
def _pairs(
    chance: NDArray[np.float64], adjacent: Csr, company: float, pair_chance: NDArray[np.float64]
) -> None:
    for i in range(chance.size):
        for e in range(adjacent.start[i], adjacent.start[i + 1]):
            p, q = chance[i], chance[adjacent.plant[e]]
            together = p * q + company * np.sqrt(p * (1.0 - p) * q * (1.0 - q))
            pair_chance[e] = min(together, p, q)


class Belief(Protocol):
    """What is believed of a plot on a morning; never changed, each step returns another."""

    @property
    def chance(self) -> NDArray[np.float64]:
        """Chance of infestation of every plant, ``(n,)``."""
        ...

    @property
    def pair_chance(self) -> NDArray[np.float64] | None:
        """Chance that two plants side by side are both infested, ``(e,)``; None: no idea."""
        ...

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> Belief:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`."""
        ...

    def overnight(self, spread: Spread) -> Belief:
        """Return what is believed the next morning."""
        ...

    def treated(self, left: NDArray[np.float64]) -> Belief:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        ...


@dataclass(frozen=True, eq=False)
class IndependentPlants:
    """Plants taken as independent of each other: see :func:`learn` and :func:`overnight`."""

    grid: PlantGrid
    chance: NDArray[np.float64]
    pair_chance: None = None

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> IndependentPlants:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`."""
        return IndependentPlants(self.grid, learn(self.chance, self.grid, plants, found, learning))

    def overnight(self, spread: Spread) -> IndependentPlants:
        """Return what is believed the next morning."""
        return IndependentPlants(self.grid, overnight(self.chance, self.grid, spread))

    def treated(self, left: NDArray[np.float64]) -> IndependentPlants:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        return IndependentPlants(self.grid, np.maximum(self.chance * left, _LEAST))


@dataclass(frozen=True, eq=False)
class Pairs:
    """A chance for every plant and for every two plants side by side.

    The pair approximation of epidemics on lattices (Keeling 1999, Proc. R. Soc. B 266:859): what
    a plant's other neighbours do is taken as independent once its own state is given.
    """

    grid: PlantGrid
    chance: NDArray[np.float64]
    pair_chance: NDArray[np.float64]

    @classmethod
    def of(cls, grid: PlantGrid, chance: NDArray[np.float64], company: float = CLUSTERING) -> Pairs:
        """Begin with a chance map, see :func:`pairs`."""
        chance = np.clip(chance, _LEAST, _MOST)
        return cls(grid, chance, pairs(chance, grid, company))

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> Pairs:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`."""
        mind = self.chance.copy(), self.pair_chance.copy()
        looks = plants, found, learning.detects(len(plants))
        _regroup(mind, self.grid.linked, looks, ClusterEstimate.none(len(self.chance)))
        _learn_pairs(mind, self.grid.linked, looks, learning.treated, near(len(self.chance)))
        return Pairs(self.grid, *mind)

    def overnight(self, spread: Spread) -> Pairs:
        """Return what is believed the next morning."""
        after = np.empty_like(self.chance), np.empty_like(self.pair_chance)
        close, spared = np.empty_like(self.chance), np.empty_like(self.pair_chance)
        mind, linked = (self.chance, self.pair_chance), self.grid.linked
        rule = spread.rate_per_day, spread.to == "one", spread.arrivals_per_day
        beside = np.empty((3, int(np.diff(linked.start).max(initial=0))))
        _stand_close(mind, close, linked)
        _spare_pairs(mind, (after[0], close, spared), linked, beside, rule)
        _overnight_pairs(mind, (*after, close, spared), linked, rule[0])
        return Pairs(self.grid, *after)

    def treated(self, left: NDArray[np.float64]) -> Pairs:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        start, other = self.grid.adjacent
        one = np.repeat(left, np.diff(start))
        chance = np.maximum(self.chance * left, _LEAST)
        return Pairs(self.grid, chance, self.pair_chance * one * left[other])


class Near(NamedTuple):
    """Room to note the plants that a look has touched, for :func:`look`."""

    plant: NDArray[np.int64]
    ring: NDArray[np.int64]
    after: NDArray[np.float64]


def near(n: int) -> Near:
    """Return such room for `n` plants."""
    return Near(np.empty(n, np.int64), np.zeros(n, np.int64), np.empty(n))


@part
def look(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    result: tuple[int, bool],
    rule: tuple[float, bool],
    touched: Near,
) -> int:
    """Let one look teach what it can about a plant and those near it; return how many it touched.

    `mind` is ``chance (n,)`` and ``pair_chance (e,)``, changed in place; `rule` the detection and
    whether finds are treated. Exact where the plants' neighbourhood is a tree; round the loops of a
    lattice the messages that arrive by several ways are combined as if independent. What a look
    says about plants farther than three away is left out.
    """
    chance, pair_chance = mind
    i, found = result
    detection, treated = rule
    p = chance[i]
    after = _MOST if found else p * (1.0 - detection) / (1.0 - p * detection)
    touched.plant[0], touched.ring[i], touched.after[i] = i, 1, _sure(after)
    # unsigned, here and below: an index that may be negative is checked for it
    n, first = np.uint64(1), np.uint64(0)
    for ring in range(2, _RINGS + 2):
        end = n
        for t in range(first, end):
            n = _propagate(mind, linked, (np.uint64(touched.plant[t]), ring), touched, n)
        first = end
    for t in range(n):
        _keep_company(mind, linked, np.uint64(touched.plant[t]), touched)
    for t in range(n):
        j = np.uint64(touched.plant[t])
        chance[j], touched.ring[j] = touched.after[j], 0
    if found and treated:
        chance[i] = _LEAST
        for e in range(linked.start[i], linked.start[i + 1]):
            pair_chance[e] = pair_chance[linked.back[e]] = 0.0
    return int(n)


# the next two are copied into `look`: calling them costs a quarter of what they do
@inlined
def _propagate(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    teller: tuple[np.uint64, int],
    touched: Near,
    n: np.uint64,
) -> np.uint64:
    """Pass on what a plant has learnt to its neighbours in the next ring."""
    chance, pair_chance = mind
    j, ring = teller
    p, after = chance[j], touched.after[j]
    if abs(after - p) < _LEAST_SAY:
        return n
    for e in range(np.uint32(linked.start[j]), np.uint32(linked.start[j + _64])):
        k = np.uint32(linked.plant[e])
        q, its_ring = chance[k], touched.ring[k]
        own = q if its_ring == 0 else touched.after[k]
        if its_ring == 0:
            touched.plant[n], touched.ring[k] = k, ring
            n += _64
        elif its_ring != ring:
            continue
        told = _conditional(p, q, pair_chance[e], after)
        if told < q:
            own *= told / q
        else:
            own = 1.0 - (1.0 - own) * (1.0 - told) / (1.0 - q)
        touched.after[k] = _sure(own)
    return n


@inlined
def _keep_company(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    j: np.uint64,
    touched: Near,
) -> None:
    """Bring the pairs of a plant and those farther out to their new chances.

    What an infested plant says about its neighbour changes by as much as the neighbour has heard
    from others.
    """
    chance, pair_chance = mind
    p, after, ring = chance[j], touched.after[j], touched.ring[j]
    for e in range(np.uint32(linked.start[j]), np.uint32(linked.start[j + _64])):
        k = np.uint32(linked.plant[e])
        its_ring = touched.ring[k]
        if its_ring != 0 and (its_ring < ring or (its_ring == ring and k < j)):
            continue
        q = chance[k]
        own = q if its_ring == 0 else touched.after[k]
        told = _conditional(p, q, pair_chance[e], after)
        from_others = own / (1.0 - own) * (1.0 - told) / told
        beside = _least(pair_chance[e] / p, 1.0)
        beside = beside * from_others / (beside * from_others + 1.0 - beside + _LEAST)
        c = _bounded(beside * after, own, after)
        pair_chance[e] = pair_chance[np.uint32(linked.back[e])] = c


@inlined
def _least(a: float, b: float) -> float:
    """Return the lesser of two numbers: as `min`, which looks out for NaN and so is slower."""
    return a if a < b else b  # noqa: FURB136 - see above


@inlined
def _most(a: float, b: float) -> float:
    """Return the greater of two numbers, likewise."""
    return a if a > b else b  # noqa: FURB136 - see above


@inlined
def _sure(chance: float) -> float:
    """Return a chance that evidence can undo."""
    return _least(_most(chance, _LEAST), _MOST)


@inlined
def _bounded(pair_chance: float, p: float, q: float) -> float:
    """Return the chance of both of two plants, within what their own chances p and q allow."""
    apart = p * q
    most = apart + _CLOSEST * (_least(p, q) - apart)
    return _most(_least(pair_chance, most), _most(p + q - 1.0, 0.0))


@inlined
def _conditional(p: float, q: float, pair_chance: float, after: float) -> float:
    """Return the chance of a plant, q until now, when its neighbour's goes from p to `after`."""
    c = _bounded(pair_chance, p, q)
    return _sure(c / p * after + (q - c) / (1.0 - p) * (1.0 - after))


class ClusterEstimate(NamedTuple):
    """What a day's looks tell of how much infested plants stand together.

    Parameters
    ----------
    outcome
        ``(n,)`` 1 for a find, 0 for none, -1 where nobody looked.
    detects
        ``(n,)`` the detection of that look.
    finds
        ``(2,)`` finds beside finds: those there were, and those expected, both beyond what
        independent plants would give. A few expected ones are added to both, so that a day of
        few finds changes little.
    """

    outcome: NDArray[np.int8]
    detects: NDArray[np.float64]
    finds: NDArray[np.float64]

    @classmethod
    def none(cls, n: int) -> ClusterEstimate:
        """Return what is known of `n` plants before anybody looked."""
        return cls(np.full(n, -1, np.int8), np.zeros(n), np.full(2, _HABIT))


@part
def update_clusters(
    dawn: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    result: tuple[int, bool, float],
    company: ClusterEstimate,
) -> None:
    """Note a look (plant, found, detection), and what it says beside other looks of the day.

    `dawn` is ``chance (n,)`` and ``pair_chance (e,)`` as believed before the first of them.
    """
    chance, pair_chance = dawn
    i, found, detects = result
    company.outcome[i], company.detects[i] = found, detects
    for e in range(linked.start[i], linked.start[i + 1]):
        j = linked.plant[e]
        if company.outcome[j] < 0:
            continue
        if found:
            company.finds[0] += company.outcome[j] - company.detects[j] * chance[j]
            company.finds[1] += company.detects[j] * (pair_chance[e] / chance[i] - chance[j])
        if company.outcome[j] == 1:
            company.finds[0] += found - detects * chance[i]
            company.finds[1] += detects * (pair_chance[e] / chance[j] - chance[i])


@part
def closeness(company: ClusterEstimate) -> float:
    """Return by how much infested plants stand closer together than believed at dawn."""
    return float(min(max(company.finds[0], 0.0) / max(company.finds[1], _HABIT), _MORE))


@part
def regroup(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]], linked: Linked, scale: float
) -> None:
    """Scale what pairs have in common, all over the plot."""
    chance, pair_chance = mind
    for i in range(np.uint64(chance.size)):
        p = chance[i]
        for e in range(np.uint32(linked.start[i]), np.uint32(linked.start[i + _64])):
            q = chance[np.uint32(linked.plant[e])]
            pair_chance[e] = _bounded(p * q + scale * (pair_chance[e] - p * q), p, q)


@loop
def _regroup(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    looks: tuple[NDArray[np.int32], NDArray[np.bool_], NDArray[np.float64]],
    company: ClusterEstimate,
) -> None:
    """Learn from a day's looks beside its finds how much infested plants stand together."""
    plants, found, detects = looks
    for k in range(plants.size):
        update_clusters(mind, linked, (_0 + plants[k], found[k], detects[k]), company)
    regroup(mind, linked, closeness(company))


@loop
def _learn_pairs(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    looks: tuple[NDArray[np.int32], NDArray[np.bool_], NDArray[np.float64]],
    treated: bool,  # noqa: FBT001 - a rule, in a compiled loop
    touched: Near,
) -> None:
    plants, found, detects = looks
    for k in range(plants.size):
        look(mind, linked, (_0 + plants[k], found[k]), (detects[k], treated), touched)


@loop
def _stand_close(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    close: NDArray[np.float64],
    linked: Linked,
) -> None:
    """Find how close infested plants stand about each, ``(n,)``."""
    chance, pair_chance = mind
    for i in range(np.uint64(chance.size)):
        first, end = np.uint32(linked.start[i]), np.uint32(linked.start[i + _64])
        beside = 0.0
        for e in range(first, end):
            beside += pair_chance[e] / chance[i]
        close[i] = beside / (end - first) if end > first else 0.0


@loop
def _spare_pairs(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    after: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    room: NDArray[np.float64],
    rule: tuple[float, bool, float],
) -> None:
    """Find every plant's chance in the morning, and what else a night of pairs needs.

    `after` is that chance ``(n,)``, how close infested plants stand about each ``(n,)``, and the
    chance that a clean plant stays so but for one of those beside it ``(e,)``; `room` ``(3, d)``
    holds what concerns the d plants beside one.

    Neighbours of a clean plant are infested together: there is an infestation beside it with the
    chance g, and if so each neighbour belongs to it with the chance beside / g, so that where
    one does another does with the chance `kin`. Independent neighbours are the case of g = 1.
    """
    chance, morning = mind[0], after[0]
    for i in range(np.uint64(chance.size)):
        # most plants; a loop of unknown length costs three times this
        if linked.start[i + _64] - linked.start[i] == 4:
            stays = _spare_four(i, mind, after, linked, rule)
        else:
            stays = _spare_any(i, mind, after, linked, (room, rule))
        morning[i] = _sure(1.0 - (1.0 - chance[i]) * stays)


@part
def _spare_any(
    i: int,
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    after: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    given: tuple[NDArray[np.float64], tuple[float, bool, float]],
) -> float:
    """Return the chance that a clean plant stays so; find it but for each of those beside it."""
    chance, (_, close, spared) = mind[0], after
    room, (rate, one, arrivals) = given
    first, degree = linked.start[i], linked.start[i + _64] - linked.start[i]
    weight, kin = 0.0, 0.0
    # the most infested plant beside it, and the next
    most, second, which = 0.0, 0.0, -1
    for k in range(degree):
        j, beside = _beside(mind, linked, np.uint64(first + k), 1.0 - chance[i])
        weight += beside
        kin += beside * close[j] ** 2
        room[_SHARED, k] = _share(linked, (rate, one), j) * beside
        if beside > most:
            most, second, which = beside, most, k
        elif beside > second:
            second = beside
    g, g_but = _one_infestation(weight, kin, (most, second))
    for k in range(degree):
        room[_FREE, k], room[_FREE_BUT, k] = (
            _free(room[_SHARED, k], g),
            _free(room[_SHARED, k], g_but),
        )
    for k in range(degree):
        row, there = (_FREE_BUT, g_but) if k == which else (_FREE, g)
        free = 1.0
        for other in range(degree):
            if other != k:
                free *= room[row, other]
        spared[first + k] = (1.0 - arrivals) * (1.0 - there * (1.0 - free))
    free = 1.0
    for k in range(degree):
        free *= room[_FREE, k]
    return (1.0 - arrivals) * (1.0 - g * (1.0 - free))


@inlined
def _one_infestation(
    weight: float, kin: float, infested: tuple[float, float]
) -> tuple[float, float]:
    """Return the chance of an infestation beside a clean plant.

    And of one where the most infested plant beside it is left out.
    """
    most, second = infested
    kin = kin / weight if weight > 0.0 else 0.0
    g, g_but = _most(kin, most), _most(kin, second)
    return most / g if g > 0.0 else 0.0, second / g_but if g_but > 0.0 else 0.0


@inlined
def _spare_four(
    i: int,
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    after: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    rule: tuple[float, bool, float],
) -> float:
    """Do the same for a plant with four beside it, to the same digits."""
    chance, (_, close, spared) = mind[0], after
    rate, one, arrivals = rule
    stay, clean = 1.0 - arrivals, 1.0 - chance[i]
    e0 = np.uint64(np.uint32(linked.start[i]))
    e1, e2, e3 = e0 + _64, e0 + np.uint64(2), e0 + np.uint64(3)
    j0, b0 = _beside(mind, linked, e0, clean)
    j1, b1 = _beside(mind, linked, e1, clean)
    j2, b2 = _beside(mind, linked, e2, clean)
    j3, b3 = _beside(mind, linked, e3, clean)
    kin = b0 * close[j0] ** 2 + b1 * close[j1] ** 2 + b2 * close[j2] ** 2 + b3 * close[j3] ** 2
    # the most infested of them, and the next
    more, less = (b1, b0) if b1 > b0 else (b0, b1)
    other_more, other_less = (b3, b2) if b3 > b2 else (b2, b3)
    first_two = other_more <= more
    most = more if first_two else other_more
    second = _most(other_more, less) if first_two else _most(more, other_less)
    which = b1 > b0 if first_two else 2 + (b3 > b2)
    g, g_but = _one_infestation(b0 + b1 + b2 + b3, kin, (most, second))
    s0, s1 = _share(linked, (rate, one), j0) * b0, _share(linked, (rate, one), j1) * b1
    s2, s3 = _share(linked, (rate, one), j2) * b2, _share(linked, (rate, one), j3) * b3
    f0, f1, f2, f3 = _free(s0, g), _free(s1, g), _free(s2, g), _free(s3, g)
    spared[e0] = stay * (1.0 - g * (1.0 - f1 * f2 * f3))
    spared[e1] = stay * (1.0 - g * (1.0 - f0 * f2 * f3))
    spared[e2] = stay * (1.0 - g * (1.0 - f0 * f1 * f3))
    spared[e3] = stay * (1.0 - g * (1.0 - f0 * f1 * f2))
    low, middle, high = s1 if which == 0 else s0, s2 if which <= 1 else s1, s2 if which == 3 else s3
    free_but = _free(low, g_but) * _free(middle, g_but) * _free(high, g_but)
    spared[e0 + np.uint64(which)] = stay * (1.0 - g_but * (1.0 - free_but))
    return stay * (1.0 - g * (1.0 - f0 * f1 * f2 * f3))


@inlined
def _beside(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    e: np.uint64,
    clean: float,
) -> tuple[np.uint32, float]:
    """Return the plant of an entry, and its chance if the one it stands beside is clean."""
    j = np.uint32(linked.plant[e])
    return j, _most(mind[0][j] - mind[1][e], 0.0) / clean


@inlined
def _share(linked: Linked, rule: tuple[float, bool], j: np.uint32) -> float:
    """Return the chance that an infested plant infests a given one beside it."""
    rate, one = rule
    return rate / (linked.start[np.uint64(j) + _64] - linked.start[j]) if one else rate


@inlined
def _free(share: float, g: float) -> float:
    """Return the chance that a neighbour does not infest a plant where an infestation is near."""
    return 1.0 - share / g if g > 0.0 else 1.0


@loop
def _overnight_pairs(
    mind: tuple[NDArray[np.float64], NDArray[np.float64]],
    after: tuple[
        NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]
    ],
    linked: Linked,
    rate: float,
) -> None:
    """Find the chances of pairs in the morning from what `_spare_pairs` has found."""
    (chance, pair_chance), (morning, pair, close, spared) = mind, after
    twice = 1.0 - (1.0 - rate) ** 2
    for i in range(np.uint64(chance.size)):
        for e in range(np.uint32(linked.start[i]), np.uint32(linked.start[i + _64])):
            j = np.uint32(linked.plant[e])
            a, b = 1.0 - spared[e], 1.0 - spared[np.uint32(linked.back[e])]
            # what comes to two neighbours at once mostly comes from one infestation
            at_once = _most(a * b, twice * _least(close[i], close[j]) * _least(a, b))
            neither = _most(1.0 - chance[i] - chance[j] + pair_chance[e], 0.0) * (
                1.0 - a - b + at_once
            )
            c = morning[i] + morning[j] - 1.0 + neither
            c = _most(c, _most(0.0, morning[i] + morning[j] - 1.0))
            pair[e] = _least(_least(c, morning[i]), morning[j])
