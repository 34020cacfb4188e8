"""Chances by the ancestry of finds: from where each came, as all of the season's inspections say.

Infestations are taken to come about as a branching process: from none on the first morning or from
outside, and from one another by jumps. Who infested whom is drawn many times for the finds
(`drawn_ancestry`), and of what was never seen the number is worked out (`unseen_offspring`). How
far jumps go, and how many were there at first and arrive, is estimated by that (`ancestry_rates`).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.infestation.ancestry_moves import Infestations, Weights
from fieldmon.infestation.ancestry_rates import (
    ARRIVAL_FINDS,
    KERNELS,
    DrawnEvidence,
    Rates,
)
from fieldmon.infestation.cell_squares import NOBODY
from fieldmon.infestation.chance_bounds import KNOWN, LEAST_CHANCE, MOST_CHANCE
from fieldmon.infestation.cohorts import Age
from fieldmon.infestation.drawn_ancestry import DrawnSums, draw_ancestries
from fieldmon.infestation.infestation_course import BEFORE, Course
from fieldmon.infestation.jump_landing import SHARES, landing_of, pest_landing_of
from fieldmon.infestation.latency import HIDDEN_NIGHTS
from fieldmon.infestation.origins import ARRIVE, ARRIVE_BY_EDGE, SIGMAS, Estimate
from fieldmon.infestation.pest_in_weather import kernel_of
from fieldmon.infestation.unseen_offspring import Unseen, stays_unseen, unseen_now

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.jump_landing import Landing
    from fieldmon.pests.pest import Pest
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.floating[Any]]
    _Finds = tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]

# In a night, rates are estimated after so many draws of few sweeps each, and after a last one of
# many, by which chances are told: days 0, 1, 2 and later. In the first nights there are two rounds,
# as what stays unseen hangs on rates, too
_UPDATES, _ROUNDS = (9, 5, 3, 2), (2, 2, 1)
_FEW_SWEEPS, _MANY_SWEEPS, _LEAST_SWEEPS = 30, 180, 4
# of many infestations there are fewer sweeps, so that there are no more than so many moves
_FEW_MOVES, _MANY_MOVES = 2000, 8000
# so much of each draw is left out at the beginning
_LEFT_OUT = 0.1
# finds older than so many days keep their origin
_SETTLED = 10
#: a plot of more plants does without: each night would take seconds
MOST_PLANTS = 10_000
# after so many days, or with so many infestations, an ancestry begins anew
_MOST_DAYS, _MOST_INFESTATIONS = 30, 1500
# and of a pest that grows before it spreads: those that have not must be told from others
_MOST_DAYS_OF_GROWING = 90
# places for infestations that were not found: at least, and as a share of all
_LEAST_ROOM, _ROOM = 32, 0.25
# how far the number at the start may be off beyond what drawn ancestries say of it, since they take
# the rates as known: as a share of it (our choice), and of what was not found of it (chosen on 400
# seasons of ten worlds)
_START_DOUBT, _UNFOUND_DOUBT = 0.1, 0.5
# the draws of a night have other seeds than all others: days, rounds and updates
_SEEDS = (100_000, 8, 16)
# never surer than this
_MOST = 0.95
# what is divided by is never nothing
_TINY = float(np.finfo(np.float32).tiny)


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


@dataclass(frozen=True, eq=False)
class Ancestry:
    """What is known of who infested whom; never changed, each step returns another.

    Parameters
    ----------
    grid
        The plants.
    start
        ``(n,)`` the chances of the first morning.
    missed
        ``(t, n)`` the logarithm of the chance that each day's inspections of a plant overlook it.
        It and `taken` have few digits, since a season's file keeps them.
    sends
        ``(t,)`` what an infested plant sent out in each night, once it was grown.
    last_find
        ``(n,)`` the day of each plant's last find, or -1 minus the nights before the season.
    new, new_left
        Plants found since the last night, and those of them that were left infested.
    taken
        ``(m, n)`` how likely each plant was infested already by the ancestry of finds.
    infestations
        The ancestry drawn last.
    rates
        What is believed of how infestations come about.
    at_start
        ``(3,)`` how many plants are taken to have been infested on the first morning of the season,
        the variance of that, and how many were found on that day; NaN: nothing is known yet.
    arrived
        How many of the infestations drawn arrived from outside.
    began_anew
        Whether it began later than the season.
    heard, idle
        In how many nights there was something new to learn from, and how many have passed since.
    hiding
        ``(4,)`` how likely infestations hide for each of `HIDDEN_NIGHTS`.
    earlier, taught
        ``(2, 10)`` what ancestries before this one taught of jumps and arrivals, and what all have,
        see `Rates.taught`.
    pest
        What lives on the plot; None: nobody named it.
    nights
        ``(t, 1 + stages)`` how long each night and its day were, and how warm for each stage of the
        pest, as `Course.of_pest` takes them; empty: nobody named it.
    """

    grid: PlantGrid
    start: Floats
    missed: NDArray[np.float16]
    sends: Floats
    last_find: NDArray[np.int64]
    new: tuple[int, ...]
    taken: NDArray[np.float16]
    infestations: Infestations = field(default_factory=lambda: Infestations.empty(_LEAST_ROOM))
    rates: Rates = field(default_factory=Rates.at_first)
    at_start: Floats = field(default_factory=lambda: np.full(3, np.nan))
    arrived: float = 0.0
    began_anew: bool = False
    heard: int = 0
    idle: int = 0
    hiding: Floats = field(default_factory=lambda: np.eye(len(HIDDEN_NIGHTS))[0])
    earlier: Floats = field(default_factory=lambda: np.zeros((2, KERNELS + 2)))
    taught: Floats = field(default_factory=lambda: np.zeros((2, KERNELS + 2)))
    pest: Pest | None = None
    nights: Floats = field(default_factory=lambda: np.zeros((0, 1)))
    new_left: tuple[int, ...] = ()

    def __repr__(self) -> str:
        return f"<Ancestry of {np.count_nonzero(self.infestations.found)} finds>"

    @classmethod
    def of(cls, grid: PlantGrid, chance: Floats) -> Ancestry:
        """Begin with the `chance` ``(n,)`` of each plant of a `grid`."""
        nothing = np.zeros((0, len(grid)), np.float16)
        never = np.full(len(grid), -BEFORE - 1)
        return cls(grid, chance, nothing, np.zeros(0), never, (), nothing)

    def of_pest(self, pest: Pest) -> Ancestry:
        """Return one that has just begun, of a plot on which this pest lives."""
        of = replace(self, pest=pest, nights=np.zeros((0, 1 + len(pest.stages))))
        return replace(of, rates=Rates.at_first(of.landing().first))

    def landing(self, wind_m_s: tuple[float, float] = (0.0, 0.0)) -> Landing:
        """Return where jumps land if the wind has gone there of late."""
        if self.pest is None or self.pest.movement.kernel == "adjacent":
            return landing_of(self.grid)
        return pest_landing_of(self.grid, kernel_of(self.pest.movement), wind_m_s)

    @property
    def course(self) -> Course:
        """When infestations can be seen, and send something out."""
        if self.pest is None:
            return Course.that_may_hide(BEFORE + len(self.sends) + 1, self.hiding)
        return Course.of_pest(self.pest, self.nights)

    def learn(
        self,
        plants: NDArray[np.int32],
        found: NDArray[np.bool_],
        detects: Floats,
        *,
        treated: bool = True,
    ) -> Ancestry:
        """Return what is known after inspecting `plants` ``(k,)``.

        `treated` is whether finds are destroyed; else they stay infested.
        """
        today = np.zeros((1, len(self.grid)))
        overlooked = np.log1p(-np.minimum(detects[~found], 1.0 - LEAST_CHANCE))
        np.add.at(today[0], plants[~found], overlooked)
        finds = plants[found].tolist()
        new = tuple(dict.fromkeys((*self.new, *finds)))
        new_left = tuple(set(self.new_left).difference(finds)) + (() if treated else tuple(finds))
        days = len(self.sends)
        before, first = self.missed[:days], self.missed[days:].sum(axis=0)
        missed = np.concatenate([before, (today + first).astype(np.float16)])
        return replace(self, missed=missed, new=new, new_left=new_left)

    def without_left(self, plants: NDArray[np.int32]) -> Ancestry:
        """Return the same, those left infested on `plants` ``(k,)`` having ended by last night.

        What came from them last night came from none.
        """
        morning = BEFORE + len(self.sends)
        gone = self.infestations.goes_on(morning) & self.infestations.found
        gone &= np.isin(self.infestations.plant, plants)
        if not gone.any():
            return self
        infestations = self.infestations.copied(0)
        infestations.ends[gone] = morning - 1
        parent = infestations.parent
        late = infestations.there & (infestations.begins == morning) & (parent != NOBODY)
        late[late] = gone[parent[late]]
        np.subtract.at(infestations.children, parent[late], 1)
        parent[late] = NOBODY
        return replace(self, infestations=infestations)

    def anew(self, chance: Floats) -> Ancestry:
        """Return an ancestry that begins today with other chances ``(n,)``, as after a treatment.

        Of how infestations come about it knows what was learnt, but for how many were at the start,
        and which plants were left infested, unless they may be clean by now.
        """
        start = Rates(self.rates.shares)
        rates = self.rates._replace(start=start.start, start_by_edge=start.start_by_edge)
        begun = Ancestry.of(self.grid, chance)
        return replace(
            begun, infestations=self._left_infested(chance), rates=rates, at_start=self.at_start,
            began_anew=True, heard=self.heard, idle=self.idle, hiding=self.hiding,
            earlier=self.taught, taught=self.taught, pest=self.pest, nights=self.nights[:0],
        )  # fmt: skip

    @property
    def left(self) -> NDArray[np.bool_]:
        """Which plants were found until last night and left infested, ``(n,)``."""
        left, infestations = np.zeros(len(self.grid), np.bool_), self.infestations
        goes_on = infestations.goes_on(BEFORE + len(self.sends))
        left[infestations.plant[goes_on & infestations.found]] = True
        return left

    def _left_infested(self, chance: Floats) -> Infestations:
        """Return those left infested and still known to be, as known from the first morning on."""
        left = self.left
        left[list(self.new)] = False
        left[list(self.new_left)] = True
        plants = np.flatnonzero(left & (chance > KNOWN))
        made = Infestations.empty(max(_LEAST_ROOM, len(plants)))
        known = slice(0, len(plants))
        made.plant[known] = plants
        made.begins[known] = made.ends[known] = made.earliest[known] = BEFORE
        made.found[known] = made.there[known] = True
        return made

    @property
    def waits(self) -> bool:
        """Tell whether inspections wait to be learnt from, as a night brings it."""
        return bool(self.new) or len(self.missed) > len(self.sends)

    @property
    def infested_at_start(self) -> Estimate | None:
        """How many plants were infested on the season's first morning; None: nothing is known yet.

        What was found on that day was there.
        """
        mean, variance, least = map(float, self.at_start)
        if np.isnan(mean):
            return None
        off = SIGMAS * float(np.sqrt(variance))
        # what was never seen may be believed where something was found, too
        return Estimate(*np.clip([mean, mean - off, mean + off], least, len(self.grid)).tolist())

    @property
    def arrivals(self) -> Estimate:
        """How many plants are infested from outside in a night, known by as many as were drawn."""
        nightly = (self.rates.anywhere + self.rates.by_edge) * len(self.grid)
        known = 2.0 * ARRIVAL_FINDS + float(self.earlier[0, KERNELS:].sum()) + self.arrived
        return Estimate.of_rate(known, known, nightly)

    @property
    def knows(self) -> bool:
        """Tell whether anything was inspected yet: before, the first map says all there is."""
        return bool(self.new or self.infestations.there.any() or self.missed.any())

    def sent(self, rates: Rates) -> Floats:
        """Return what an infested plant sends out in each night that is thought of, ``(t,)``."""
        return np.concatenate([np.full(BEFORE, rates.before), self.sends, [0.0]])

    @property
    def sweeps(self) -> tuple[int, ...]:
        """How many sweeps there are in each draw of a night that has begun."""
        last = BEFORE + len(self.sends)
        settled = self.infestations.there & (self.infestations.seen <= last - _SETTLED)
        moving = max(int(np.count_nonzero(~settled)), 1)
        few = max(_LEAST_SWEEPS, min(_FEW_SWEEPS, _FEW_MOVES // moving))
        many = max(_LEAST_SWEEPS, min(_MANY_SWEEPS, _MANY_MOVES // moving))
        # nights that taught nothing left their share of the work to this one
        updates = _on(self.heard - 1, _UPDATES) * (1 + self.idle)
        return (*[few] * min(updates, _SEEDS[2] - 1), many)

    def overnight(self, night: ToldNight) -> tuple[Ancestry, NDArray[np.float64] | None]:
        """Return what is known the next morning, and each plant's chance ``(n,)``.

        There are no chances (None) where nothing was inspected since the night before: what was
        found has had its say. Those `left` infested are certain.
        """
        day, n = len(self.sends), len(self.grid)
        hears = bool(self.new) or bool(self.missed[day:].any())
        nothing = np.zeros((day + 1 - len(self.missed), n), np.float16)
        anywhere, by_edge = night.arrive
        after = _with_finds(
            replace(
                self,
                missed=np.concatenate([self.missed, nothing]),
                sends=np.append(self.sends, night.sends),
                nights=self.nights
                if self.pest is None
                else np.concatenate([self.nights, [night.length]]),
                rates=self.rates
                if day or self.began_anew
                else self.rates._replace(anywhere=anywhere, by_edge=by_edge),
                heard=self.heard + hears,
                idle=self.idle + (self.knows and not hears),
            )
        )
        if not hears:
            return after, None
        infestations, landing = after.infestations, self.landing(night.wind_m_s)
        many = int(np.count_nonzero(infestations.there & (infestations.seen > 0)))
        for k in range(_on(after.heard - 1, _ROUNDS)):
            after, hidden, unseen = _drawn(after, landing, k, night.arrive)
        after = replace(after, idle=0)
        chance = np.clip(
            1.0 - np.exp(-unseen) * (1.0 - np.minimum(hidden, 1.0)), LEAST_CHANCE, _MOST
        )
        chance[after.left] = MOST_CHANCE
        if after.is_old or many > _MOST_INFESTATIONS:
            after = after.anew(chance)
        return after, chance

    @property
    def is_old(self) -> bool:
        """Tell whether it goes back so far that it is to begin anew."""
        grows = self.pest is not None and not Age().mobile(self.pest)
        return len(self.sends) >= (_MOST_DAYS_OF_GROWING if grows else _MOST_DAYS)

    @property
    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """What to keep of it on a morning, beside the plants, by name."""
        return {
            "start": self.start,
            "missed": self.missed,
            "sends": self.sends,
            "last_find": self.last_find,
            "taken": self.taken,
            "infestations": np.array(self.infestations, np.int64),
            "rates": np.concatenate([self.rates.shares, self.rates[1:]]),
            "at_start": self.at_start,
            "since": np.array([self.arrived, self.began_anew, self.heard, self.idle]),
            "hiding": self.hiding,
            "earlier": self.earlier,
            "taught": self.taught,
            **({} if self.pest is None else {"nights": self.nights}),
        }

    @classmethod
    def of_arrays(
        cls, grid: PlantGrid, arrays: dict[str, NDArray[Any]], pest: Pest | None = None
    ) -> Ancestry:
        """Return what such arrays have kept; raise `ValueError` if they are none of its plants."""
        kept: dict[str, Any] = dict(arrays)
        plant, begins, ends, found, parent, children, there, earliest, seen = kept.pop(
            "infestations"
        )
        shares, others = np.split(kept.pop("rates"), [len(SHARES)])
        arrived, anew, heard, idle = kept.pop("since").tolist()
        n = len(grid)
        if any(kept[name].shape[-1:] != (n,) for name in ("start", "missed", "last_find", "taken")):
            raise ValueError(f"An ancestry of {n} plants must have arrays of so many.")
        infestations = Infestations(
            plant, begins, ends, found != 0, parent, children, there != 0, earliest, seen
        )
        rates = Rates(shares, *map(float, others))
        return cls(
            grid, new=(), infestations=infestations, rates=rates,
            arrived=arrived, began_anew=bool(anew),
            heard=int(heard), idle=int(idle), pest=pest, **kept,
        )  # fmt: skip


def _with_finds(of: Ancestry) -> Ancestry:
    """Return the same with the last day's finds among the infestations."""
    day = len(of.sends) - 1
    morning = BEFORE + day
    last_find = of.last_find.copy()
    used = int(np.count_nonzero(of.infestations.there)) + len(of.new)
    spare = max(_LEAST_ROOM, int(_ROOM * used))
    made = of.infestations.copied(max(0, used + spare - len(of.infestations.plant)))
    at, left = _places(made, len(of.grid), morning), set(of.new_left)
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


class _Inspected(NamedTuple):
    """What inspections say of infestations by the morning on which they begin, ``(t, n)`` each.

    Parameters
    ----------
    missed
        How likely all from that morning on overlook one, if nothing hides, as a logarithm.
    overlooked
        How likely they do, if it hides as it may.
    unseen
        How likely nothing is seen of it and of what comes from it.
    course
        When they can be seen, and send something out.
    """

    missed: Floats
    overlooked: Floats
    unseen: Unseen
    course: Course

    @classmethod
    def by(cls, of: Ancestry, landing: Landing) -> _Inspected:
        """Return what the inspections up to the last night say."""
        t, n = BEFORE + len(of.sends) + 1, len(of.grid)
        # half the digits: on a large plot it is memory that takes the time
        taken = np.zeros((t, n), np.float32)
        taken[: len(of.taken)] = of.taken
        missed = np.zeros((t, n), np.float32)
        np.cumsum(of.missed[::-1], axis=0, out=missed[BEFORE:-1][::-1])
        missed[:BEFORE] = missed[BEFORE]
        course = of.course
        overlooked = _overlooked(missed, course)
        alone = overlooked.copy()
        alone[np.arange(t)[:, None] <= of.last_find + BEFORE] = 0.0
        # nor does another begin where one goes on
        alone[:, of.left] = 0.0
        unseen = stays_unseen(alone, taken, (of.sent(of.rates), of.rates.shares), landing, course)
        return cls(missed, overlooked, unseen, course)


@dataclass(frozen=True, eq=False)
class _Draws:
    """Ancestries that are drawn in a night, each from the one before, in place.

    Parameters
    ----------
    of, landing
        What is known, and where jumps land.
    inspected
        What inspections say.
    infestations, at
        The ancestry drawn last, and which infestation not found is at each plant.
    finds
        The mornings on which finds were first seen, on which they end, and their plants, ``(k,)``.
    lasting
        As `Weights` has it.
    drawn
        Sums over the ancestries of the last draw.
    """

    of: Ancestry
    landing: Landing
    inspected: _Inspected
    infestations: Infestations
    at: NDArray[np.int64]
    finds: _Finds
    lasting: Floats
    drawn: DrawnSums

    @classmethod
    def begun(cls, of: Ancestry, landing: Landing) -> _Draws:
        """Return none yet."""
        inspected, infestations = _Inspected.by(of, landing), of.infestations.copied(0)
        found = infestations.there & infestations.found
        finds = infestations.seen[found], infestations.ends[found], infestations.plant[found]
        t, n = inspected.missed.shape
        lasting = np.ones((n + len(found), t), np.float32)
        np.multiply(inspected.overlooked.T, inspected.unseen.offspring.T, out=lasting[:n])
        lasting[n:][found] = _until_found(
            inspected.missed, inspected.unseen, finds, inspected.course
        )
        np.maximum(lasting, _TINY, out=lasting)
        drawn = DrawnSums.none(t, n, landing.kernels.shape[1], delays=inspected.course.delays)
        at = _places(infestations, n, t - 1)
        return cls(of, landing, inspected, infestations, at, finds, lasting, drawn)

    def weights(self, rates: Rates) -> Weights:
        """Return what ancestries are weighed by at such rates."""
        t = len(self.inspected.missed)
        kernel = np.einsum("k,kij->ij", rates.shares, self.landing.kernels)
        roots = rates.roots(self.of.start, self.landing.at_edge, t)
        return Weights(
            self.landing.cells, kernel, np.cumsum(kernel) / kernel.sum(), self.of.sent(rates),
            np.ascontiguousarray(roots.T), BEFORE, max(t - 1 - _SETTLED, 0),
            self.inspected.course.grown, self.inspected.course.grown_by, self.lasting,
        )  # fmt: skip

    def draw(self, weights: Weights, seed: int, sweeps: int) -> int:
        """Draw anew, and sum up; but for who was there, return means. Return of how many."""
        for sums in self.drawn:
            sums.fill(0.0)
        draws = seed, sweeps, int(_LEFT_OUT * sweeps)
        last_find = self.of.last_find + BEFORE
        kept = draw_ancestries(self.infestations, self.at, weights, last_find, draws, self.drawn)
        for sums in self.drawn[2:]:
            np.divide(sums, kept, out=sums)
        return kept

    def counted(self, kept: int, weights: Weights, shares: Floats) -> _Counted:
        """Return what the last draw says of each plant, of so many ancestries."""
        taken, active = self.drawn.there, self.drawn.active
        taken /= kept
        if active is None:
            active = taken.copy()
        else:
            active /= kept
        taken[self.finds[1:]] = 1.0
        unfound = unseen_now(
            self.inspected.unseen, active, weights.roots.T, (weights.sends, shares),
            self.landing, self.inspected.course,
        )  # fmt: skip
        return _Counted(active, taken, unfound)


class _Counted(NamedTuple):
    """What drawn ancestries say of each plant on each morning, ``(t, n)`` each.

    Parameters
    ----------
    active
        How likely it sends something out in the night.
    taken
        How likely it is infested already by the ancestry of finds.
    unfound
        How many infestations of which nothing was seen are expected there.
    """

    active: Floats
    taken: Floats
    unfound: Floats


def _drawn(
    of: Ancestry, landing: Landing, nth: int, arrive: tuple[float, float]
) -> tuple[Ancestry, Floats, NDArray[np.float64]]:
    """Draw ancestries for the `nth` time in a night, and estimate rates by them.

    Return also how likely each plant is infested as the ancestor of a find, and how many
    infestations of which nothing was seen are expected there.
    """
    draws, rates, day = _Draws.begun(of, landing), of.rates, len(of.sends) - 1
    drawn, seen = draws.drawn, 1.0 - draws.inspected.unseen.chance
    sweeps, left = of.sweeps, of.left
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


def _overlooked(missed: Floats, course: Course) -> Floats:
    """Return how likely infestations are overlooked until the last morning, ``(t, n)``.

    Parameters
    ----------
    missed
        ``(t, n)`` the same if nothing hides, as a logarithm, of an infestation that begins on each
        morning.
    course
        When they can be seen.
    """
    once_shown = np.exp(missed)
    overlooked = np.zeros_like(once_shown)
    for shows, likely in zip(course.shows, course.likely.tolist(), strict=True):
        for begins, shown in enumerate(shows):
            overlooked[begins] += likely * once_shown[shown]
    return overlooked


def _until_found(
    missed: Floats,
    unseen: Unseen,
    finds: _Finds,
    course: Course,
) -> Floats:
    """Return how likely it is to find what was found, when it was, ``(k, t)``, by its beginning.

    `finds` are as `_Draws` has them; `missed` and `course` as `_overlooked` has them.
    """
    first, ends, plant = finds
    chance = np.zeros((len(plant), len(missed)))
    for shows, likely in zip(course.shows, course.likely, strict=True):
        seen = shows <= first[:, None]
        overlooked = missed[:, plant][shows].T - missed[first, plant][:, None]
        chance += likely * seen * np.exp(np.where(seen, overlooked, 0.0))
    sent_later = np.maximum(unseen.sent_since[ends, plant], _TINY)
    sent = unseen.offspring[:, plant].T / sent_later[:, None]
    return chance * np.minimum(sent, 1.0)


def _on(day: int, numbers: tuple[int, ...]) -> int:
    """Return the number of a day, the last one on all later days."""
    return numbers[min(day, len(numbers) - 1)]


def _places(infestations: Infestations, n: int, last: int) -> NDArray[np.int64]:
    """Return which infestation goes on at each plant on the last morning, ``(n,)``, or `NOBODY`."""
    at = np.full(n, NOBODY)
    goes_on = np.flatnonzero(infestations.goes_on(last))
    at[infestations.plant[goes_on]] = goes_on
    return at
