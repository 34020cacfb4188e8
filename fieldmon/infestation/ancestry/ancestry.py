"""Chances by the ancestry of finds: from where each came, as all of the season's inspections say.

Infestations are taken to come about as a branching process: from none on the first morning or from
outside, and from one another by jumps. In a night (`ancestry_night`), who infested whom is drawn
many times for the finds (`nightly_draws`, each by `drawn_ancestry`), and of what was never seen the
number is worked out (`unseen_offspring`). How far jumps go, and how many were there at first and
arrive, is estimated by that (`ancestry_rates`).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.infestation.ancestry.ancestry_rates import ARRIVAL_FINDS, KERNELS, Rates
from fieldmon.infestation.ancestry.infestation_course import BEFORE, Course
from fieldmon.infestation.ancestry.infestations import LEAST_ROOM, Infestations
from fieldmon.infestation.ancestry.origins import SIGMAS, Estimate
from fieldmon.infestation.cell_squares import NOBODY
from fieldmon.infestation.chance_bounds import KNOWN, LEAST_CHANCE
from fieldmon.infestation.insects.cohorts import Age
from fieldmon.infestation.insects.jump_landing import landing_of, pest_landing_of
from fieldmon.infestation.insects.latency import HIDDEN_NIGHTS
from fieldmon.infestation.insects.pest_in_weather import kernel_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.jump_landing import Landing
    from fieldmon.pests.pest import Pest
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.floating[Any]]

#: a plot of more plants does without: each night would take seconds
MOST_PLANTS = 10_000
# after so many days an ancestry begins anew
_MOST_DAYS = 30
# and of a pest that grows before it spreads: those that have not must be told from others
_MOST_DAYS_OF_GROWING = 90


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
    infestations: Infestations = field(default_factory=lambda: Infestations.empty(LEAST_ROOM))
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
        return Infestations.left_on(plants)

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
    def is_old(self) -> bool:
        """Tell whether it goes back so far that it is to begin anew."""
        grows = self.pest is not None and not Age().mobile(self.pest)
        return len(self.sends) >= (_MOST_DAYS_OF_GROWING if grows else _MOST_DAYS)
