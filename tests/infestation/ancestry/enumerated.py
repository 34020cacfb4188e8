"""Every state of a small plot, each with its chance: what a belief should come to, exactly.

Nothing is shared with the code under test but the words of a rule: who may be infested by a plant
in a night comes as the chances of sets of plants, so that any kernel fits.
"""

from dataclasses import dataclass

import numpy as np


def by_adjacency(grid, spread, lean=0.5):
    """Return for every plant the sets it may infest in a night, with their chances.

    As `Spread` says it: each neighbour by itself, one of them, or all of them at once. A set is a
    number whose bit j stands for plant j. A kernel by distance would return the like. `lean` is
    the share of what goes to neighbours that goes along the row.
    """
    start, neighbour = grid.adjacent
    told = []
    for i in range(len(grid)):
        near = neighbour[start[i] : start[i + 1]].tolist()
        rate = spread.rate_per_day if near else 0.0
        rates = {j: 2 * rate * (lean if abs(i - j) == 1 else 1.0 - lean) for j in near}
        if spread.to == "each":
            told.append(independently(rates))
        elif spread.to == "one":
            ways = {1 << j: each / len(near) for j, each in rates.items()}
            told.append(ways | {0: 1.0 - sum(ways.values())})
        else:  # whom less goes to is infested only together with the others
            less = min(rates.values(), default=0.0)
            more = [j for j, each in rates.items() if each > less]
            sets = {sum(1 << j for j in near): less}
            if more:
                sets[sum(1 << j for j in more)] = max(rates.values()) - less
            told.append(sets | {0: 1.0 - sum(sets.values())})
    return told


def by_kernels(cell, kernels, sent):
    """Return the like for jumps: a plant sends ``sent[k]`` insects by each kernel, as Poisson.

    Of each plant the chance ``(n,)`` that it is infested so: each is by itself. `cell` ``(n, 2)``
    are the plants' places across and along, whole numbers; the middle of each kernel ``(d, d)`` is
    the plant itself. What lands on nobody is lost.
    """
    radius = (np.array(kernels.shape[1:]) - 1) // 2
    told = []
    for here in cell:
        away = cell - here + radius
        on = ((away >= 0) & (away < kernels.shape[1:])).all(axis=1)
        landed = np.zeros(len(cell))
        landed[on] = np.einsum("k,kj->j", sent, kernels[:, away[on, 0], away[on, 1]])
        told.append(1.0 - np.exp(-landed))
    return told


def together(*rules):
    """Return what plants infest by several rules in the same night."""
    return [*zip(*rules, strict=True)]


def independently(chances):
    """Return the chances of all sets of plants, each of which is in it by itself."""
    sets = {0: 1.0}
    for j, chance in chances.items():
        sets = {
            s | (bit << j): p * (chance if bit else 1.0 - chance)
            for s, p in sets.items() for bit in (0, 1)
        }  # fmt: skip
    return sets


def chance_within(infects, n):
    """Return for each set of n plants the chance that what one plant infests lies in it."""
    if isinstance(infects, tuple):
        return np.prod([chance_within(rule, n) for rule in infects], axis=0)
    if isinstance(infects, np.ndarray):  # each by itself
        inside = np.ones(1)
        for chance in infects:
            inside = np.concatenate([inside * (1.0 - chance), inside])
        return inside
    states = np.arange(1 << n)
    return sum(p * ((s & ~states) == 0) for s, p in infects.items())


@dataclass(frozen=True)
class Enumerated:
    """The chance ``(2^n,)`` of each state of n plants; bit j of a state's number is plant j."""

    weight: np.ndarray

    @classmethod
    def of(cls, chance):
        """Return independent plants."""
        weight = np.ones(1)
        for p in chance:  # the last plant is the highest bit
            weight = np.concatenate([weight * (1.0 - p), weight * p])
        return cls(weight)

    @classmethod
    def chain(cls, chance, both):
        """Return a row in which a plant knows of the others through those beside it only.

        `chance` ``(n,)``; `both` ``(n - 1,)`` of each two plants side by side.
        """
        here = cls.of(chance[:1]).weight
        for k, (p, q, pair) in enumerate(zip(chance, chance[1:], both, strict=False)):
            last = (np.arange(len(here)) >> k & 1).astype(bool)
            if_last = np.where(last, pair / p, (q - pair) / (1.0 - p))
            here = np.concatenate([here * (1.0 - if_last), here * if_last])
        return cls(here)

    @property
    def n(self):
        """Return the number of plants."""
        return len(self.weight).bit_length() - 1

    def infested(self, i):
        """Return ``(2^n,)`` whether plant i is infested."""
        return (np.arange(len(self.weight)) >> i & 1).astype(bool)

    @property
    def chance(self):
        """Return the chance of every plant, ``(n,)``."""
        return np.array([self.weight[self.infested(i)].sum() for i in range(self.n)])

    def pair_chance(self, grid):
        """Return the chance that both are infested of each two side by side, ``(e,)``."""
        start, neighbour = grid.adjacent
        own = np.repeat(np.arange(len(grid)), np.diff(start))
        both = [self.infested(i) & self.infested(j) for i, j in zip(own, neighbour, strict=True)]
        return np.array([self.weight[each].sum() for each in both])

    def inspected(self, i, found, detection):
        """Return what is known after an inspection: Bayes' rule for the whole plot."""
        sick = detection if found else 1.0 - detection
        weight = self.weight * np.where(self.infested(i), sick, 0.0 if found else 1.0)
        return Enumerated(weight / weight.sum())

    def thinned(self, left):
        """Return what is left of it: an infested plant stays so with the chance `left` ``(n,)``."""
        weight = self.weight
        for i in range(self.n):
            now, clean = np.zeros_like(weight), np.arange(len(weight)) & ~(1 << i)
            stays = np.where(self.infested(i), left[i], 1.0)
            np.add.at(now, np.arange(len(weight)), weight * stays)
            np.add.at(now, clean, weight * (1.0 - stays))
            weight = now
        return Enumerated(weight)

    def overnight(self, infects, arrivals=0.0):
        """Return what is true the next morning.

        `infects` as `by_adjacency` returns it, `arrivals` one chance or one of each plant. For
        every set T: the chance that nobody outside it
        is infested is that of all states within T from which nobody outside is reached.
        """
        n_states, n = len(self.weight), self.n
        states = np.arange(n_states)
        within = [chance_within(of_plant, n) for of_plant in infects]
        stays_away = np.broadcast_to(1.0 - np.asarray(arrivals, float), n)
        inside = np.empty(n_states)
        for only in range(n_states):
            some = states[(states & ~only) == 0]
            reach = self.weight[some]
            for i in range(n):
                reach = reach * np.where(some >> i & 1, within[i][only], 1.0)
            outside = ~(int(only) >> np.arange(n)) & 1 == 1
            inside[only] = reach.sum() * stays_away[outside].prod()
        for i in range(n):  # from "within the set" to "exactly the set"
            has = (states >> i & 1).astype(bool)
            inside[has] -= inside[states[has] & ~(1 << i)]
        return Enumerated(np.maximum(inside, 0.0))  # differences round to a little less
