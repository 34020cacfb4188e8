"""Where to treat: strips along the rows that a sprayer can switch, at the least expected loss.

A sprayer's section covers some rows side by side. Along them it is on or off, and each stretch
that is on, or off between two that are, has a least length. Which stretches cost least is found
exactly, section by section: plants stand in order along the rows, so that the best of all
switchings up to a plant follows from the best up to the one before.

With a knapsack plants are chosen one by one, each with the ring of plants around it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from fieldmon.compute.arrays import read_only
from fieldmon.compute.jit import routine
from fieldmon.compute.wording import counted, worded
from fieldmon.decisions.rings import best_rings, rings_bound
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

# the price at which zones keep within the ground allowed is halved so often
_STEPS = 50


@dataclass(frozen=True)
class Sprayer:
    """What can be switched.

    Parameters
    ----------
    rows
        Rows that one section covers; 0: plants are sprayed one by one, with a knapsack.
    least_on_m, least_off_m
        Least length along the rows of a stretch that is sprayed, and of a gap between two.
    ring
        With a knapsack: how many plants around each chosen one are sprayed with it.

    Raises
    ------
    SettingError
        If a number is below 0.
    """

    rows: int = 2
    least_on_m: float = 6.0
    least_off_m: float = 6.0
    ring: int = 0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not 0 <= value < np.inf:
                raise SettingError(
                    worded(
                        "A sprayer's {name} must be 0 or more, but it is {value:g}.",
                        name=name.replace("_", " "),
                        value=value,
                    )
                )

    @classmethod
    def of_boom(
        cls, boom_m: float, sections: int, row_spacing_m: float, least_on_m: float = 6.0
    ) -> Sprayer:
        """Return the sprayer of a boom: as many rows a section as stand under one, at least one.

        Raises
        ------
        SettingError
            If the boom has no width or no section.

        Examples
        --------
        >>> Sprayer.of_boom(12.0, 4, row_spacing_m=1.5).rows
        2
        """
        if not (boom_m > 0.0 and sections >= 1):
            raise SettingError(
                worded(
                    "A boom must have a width above 0 and a section or more, but it has {boom_m:g} "
                    "m and {sections}.",
                    boom_m=boom_m,
                    sections=sections,
                )
            )
        rows = max(1, int(boom_m / sections / row_spacing_m + 1e-9))
        return cls(rows, least_on_m, least_on_m)


@dataclass(frozen=True)
class TreatmentCosts:
    """What treating costs, and what not treating does; in one currency.

    Parameters
    ----------
    per_ha
        Product, water and work for a hectare sprayed.
    per_zone
        Each zone: switching on and off, slowing down, overlap.
    infested_plant_day
        Loss by a plant that is infested for a day.
    days
        How long an infested plant stays so if it is not treated.
    works
        Chance that an infested plant is clean after the treatment.
    reserve
        Share of the plot that is never sprayed, from which predators and mites that no product
        was tried on come back (resistance).

    Raises
    ------
    SettingError
        If a number cannot be.
    """

    per_ha: float = 100.0
    per_zone: float = 0.5
    infested_plant_day: float = 0.1
    days: float = 14.0
    works: float = 0.9
    reserve: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.reserve < 1.0:
            raise SettingError(
                worded(
                    "The share that is never sprayed must be 0 or more and below 1, but it is "
                    "{reserve:g}.",
                    reserve=self.reserve,
                )
            )
        for name, value in vars(self).items():
            if not 0.0 <= value < np.inf:
                raise SettingError(
                    worded(
                        "The cost {name!r} must be 0 or more, but it is {value:g}.",
                        name=name.replace("_", " "),
                        value=value,
                    )
                )
        if not 0.0 < self.works <= 1.0:
            raise SettingError(
                worded(
                    "The chance that a treatment works must be above 0 and at most 1, but it is "
                    "{works:g}.",
                    works=self.works,
                )
            )

    @property
    def per_infested_plant(self) -> float:
        """Return what treating an infested plant saves."""
        return self.infested_plant_day * self.days * self.works


@dataclass(frozen=True, eq=False)
class Zones:
    """Where to treat, and what that comes to.

    Parameters
    ----------
    treated
        ``(n,)`` whether each plant is sprayed.
    zone
        ``(n,)`` number of the zone it is in, from 0; -1: not sprayed.
    m2, plot_m2
        Area sprayed, and of all plants.
    inside, outside
        Infested plants expected where it is sprayed, and elsewhere.
    cost, saved
        What spraying costs, and what it is expected to save.
    whole_cost
        What spraying the whole plot would cost.
    """

    treated: NDArray[np.bool_]
    zone: Ints
    m2: float
    plot_m2: float
    inside: float
    outside: float
    cost: float
    saved: float
    whole_cost: float = 0.0

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                read_only(value)

    def __repr__(self) -> str:
        return f"<Zones: {counted(len(self), 'zone')} of {self.m2:.0f} m2>"

    def __len__(self) -> int:
        """Return the number of zones."""
        return int(self.zone.max(initial=-1)) + 1

    def only(
        self, grid: PlantGrid, chance: Floats, kept: NDArray[np.bool_], costs: TreatmentCosts
    ) -> Zones:
        """Return some of the zones, ``(zones,)`` whether each is kept, numbered anew."""
        number = np.append(np.where(kept, np.cumsum(kept) - 1, -1), -1)
        return _zones(number[self.zone], chance, _Plants.of(grid, chance, costs), costs)

    def sentence(self) -> str:
        """Return it in words, beside treating the whole plot."""
        if not len(self):
            return worded(
                "Treat nowhere: {outside:.1f} infested plants are expected, and nowhere would "
                "spraying save more than it costs.",
                outside=self.outside,
            )
        return worded(
            "Treat {area:.2f} ha in {zones}, {share:.0%} of the plot: {inside:.1f} infested plants "
            "are expected there and {outside:.1f} elsewhere. It costs {cost:.2f} and saves "
            "{saved:.2f}.",
            area=self.m2 / 10_000, zones=counted(len(self), "zone"), share=self.m2 / self.plot_m2,
            inside=self.inside, outside=self.outside, cost=self.cost, saved=self.saved,
        )  # fmt: skip


def best_zones(
    grid: PlantGrid,
    chance: Floats,
    sprayer: Sprayer | None = None,
    costs: TreatmentCosts | None = None,
) -> Zones:
    """Return the zones whose spraying is expected to lose least; the plot as one if that does.

    Parameters
    ----------
    grid
        The plants.
    chance
        ``(n,)`` chance that each plant is infested.
    sprayer, costs
        What can be switched, and what it costs; None: the defaults.

    Examples
    --------
    >>> import numpy as np, fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> chance = np.full(plot.n_plants, 1e-4)
    >>> chance[1000:1006] = 0.9
    >>> len(best_zones(plot.grid, chance))
    1
    """
    sprayer, costs = sprayer or Sprayer(), costs or TreatmentCosts()
    plants = _Plants.of(grid, chance, costs)
    choose = _knapsack if sprayer.rows == 0 else _switched
    zone = choose(grid, plants, sprayer, costs)
    most = (1.0 - costs.reserve) * plants.area_m2
    if costs.reserve > 0.0 and plants.m2 * np.count_nonzero(plants.once & (zone >= 0)) > most:
        zone = _within(lambda dearer: choose(grid, dearer, sprayer, costs), plants, most)
    zones = _zones(zone, chance, plants, costs)
    if costs.reserve > 0.0:
        return zones
    # where so many zones pay that switching costs more than what lies between them
    whole = whole_plot(grid, chance, costs)
    return whole if whole.saved - whole.cost > zones.saved - zones.cost else zones


def whole_plot(grid: PlantGrid, chance: Floats, costs: TreatmentCosts | None = None) -> Zones:
    """Return the plot as one zone, which is what most growers treat.

    Examples
    --------
    >>> import numpy as np, fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> len(whole_plot(plot.grid, np.full(plot.n_plants, 0.1)))
    1
    """
    costs = costs or TreatmentCosts()
    return _zones(np.zeros(len(grid), np.int64), chance, _Plants.of(grid, chance, costs), costs)


class _Plants(NamedTuple):
    """What spraying each plant gains ``(n,)``, which are counted once, and the ground of each."""

    gain: Floats
    once: NDArray[np.bool_]
    m2: float

    @classmethod
    def of(cls, grid: PlantGrid, chance: Floats, costs: TreatmentCosts) -> _Plants:
        once = grid.vine == np.arange(len(grid))
        m2 = grid.row_spacing_m * grid.plant_spacing_m
        gain = chance * costs.per_infested_plant - costs.per_ha * m2 / 10_000
        return cls(np.where(once, gain, 0.0), once, m2)

    @property
    def area_m2(self) -> float:
        """Return the ground of all plants."""
        return float(self.once.sum()) * self.m2

    def dearer(self, by: float) -> _Plants:
        """Return the same, each plant by so much less worth spraying."""
        return self._replace(gain=np.where(self.once, self.gain - by, 0.0))


def _zones(zone: Ints, chance: Floats, plants: _Plants, costs: TreatmentCosts) -> Zones:
    """Return zones with all that is said of them."""
    treated, n_zones = zone >= 0, int(zone.max(initial=-1)) + 1
    sprayed = plants.once & treated
    inside, area_m2 = float(chance[sprayed].sum()), float(sprayed.sum()) * plants.m2
    return Zones(
        treated,
        zone,
        area_m2,
        plants.area_m2,
        inside,
        float(chance[plants.once & ~treated].sum()),
        area_m2 / 10_000 * costs.per_ha + n_zones * costs.per_zone,
        inside * costs.per_infested_plant,
        plants.area_m2 / 10_000 * costs.per_ha + costs.per_zone,
    )


def _within(choose: Callable[[_Plants], Ints], plants: _Plants, most_m2: float) -> Ints:
    """Return the best zones of at most so much ground: spraying is made dearer until they are."""
    low, high = 0.0, float(np.max(plants.gain, initial=0.0)) * len(plants.gain) + 1.0
    best = np.full(len(plants.gain), -1)
    for _ in range(_STEPS):
        middle = (low + high) / 2
        zone = choose(plants.dearer(middle))
        if np.count_nonzero(plants.once & (zone >= 0)) * plants.m2 > most_m2:
            low = middle
        else:
            high, best = middle, zone
    return best


def _switched(grid: PlantGrid, plants: _Plants, sprayer: Sprayer, costs: TreatmentCosts) -> Ints:
    """Return the zone of each plant ``(n,)``, -1: none, as sections are switched."""
    strips = _strips(grid, sprayer.rows)
    on = np.zeros(len(strips.start_m), bool)
    per_step = np.bincount(strips.step, plants.gain, len(on)).astype(np.float64)
    _switch(
        (strips.first, strips.start_m, per_step),
        (sprayer.least_on_m, sprayer.least_off_m, costs.per_zone),
        strips.step_m,
        on,
    )
    new = on & ~np.concatenate([[False], on[:-1] & ~strips.begins[1:]])
    zone: Ints = np.where(on[strips.step], (np.cumsum(new) - 1)[strips.step], -1)
    return zone


def _knapsack(grid: PlantGrid, plants: _Plants, sprayer: Sprayer, costs: TreatmentCosts) -> Ints:
    """Return the zone of each plant ``(n,)``, -1: none: plants that pay, with their rings.

    Rings that touch are one zone. Without a ring that is the best choice; with one it is near it
    (`ring_bound`).
    """
    if sprayer.ring > 0:
        treated = best_rings(grid, plants.gain, sprayer.ring, costs.per_zone)
        return _touching(grid, treated[grid.vine])
    treated = (plants.gain > max(costs.per_zone, 0.0))[grid.vine]
    alone = np.cumsum(treated & plants.once) - 1
    return np.where(treated, alone[grid.vine], -1)


def ring_bound(
    grid: PlantGrid, chance: Floats, ring: int, costs: TreatmentCosts | None = None
) -> float:
    """Return what no choice of plants with their rings can save more than, less what it costs.

    A linear program in which rings may be sprayed in part, if near each plant a ring is paid for,
    and zones cost nothing: how far the choice of `best_zones` with a knapsack may be from the best.

    Parameters
    ----------
    grid
        The plants.
    chance
        ``(n,)`` chance that each plant is infested.
    ring
        Plants around each chosen one, as `Sprayer` has it.
    costs
        What treating costs; None: the defaults.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.plot.layout import rectangle
    >>> grid, chance = rectangle(9, 9), np.full(81, 1e-4)
    >>> chance[40] = 0.9
    >>> zones = best_zones(grid, chance, Sprayer(rows=0, ring=1), TreatmentCosts(per_zone=0.0))
    >>> bound = ring_bound(grid, chance, 1, TreatmentCosts(per_zone=0.0))
    >>> bool(abs(zones.saved - zones.cost - bound) < 1e-9)
    True
    """
    gain = _Plants.of(grid, chance, costs or TreatmentCosts()).gain
    return rings_bound(grid, gain, ring)


def _touching(grid: PlantGrid, treated: NDArray[np.bool_]) -> Ints:
    """Return the number of the piece that each treated plant is in ``(n,)``, -1: not treated."""
    start, other = grid.adjacent
    own = np.repeat(np.arange(len(grid)), np.diff(start))
    both = treated[own] & treated[other]
    # the two faces of a plant are one
    rows = np.concatenate([own[both], np.flatnonzero(treated)])
    columns = np.concatenate([other[both], grid.vine[treated]])
    links = csr_array((np.ones(len(rows)), (rows, columns)), (len(grid), len(grid)))
    piece = connected_components(links, directed=False)[1]
    _, number = np.unique(piece[treated], return_inverse=True)
    zone = np.full(len(grid), -1)
    zone[treated] = number
    return zone


def outlines(grid: PlantGrid, zones: Zones) -> list[shapely.MultiPolygon]:
    """Return the area of each zone, lon/lat, that the plants of its rows fill.

    Each plant stands for the ground half a spacing around it; touching grounds are one.
    """
    return [outline_of(grid, zones.zone == k) for k in range(len(zones))]


def outline_of(grid: PlantGrid, plants: NDArray[np.bool_]) -> shapely.MultiPolygon:
    """Return the area, lon/lat, that some plants ``(n,)`` fill, each half a spacing around it."""
    half_m = np.array([grid.plant_spacing_m, grid.row_spacing_m]) / 2 * 1.001
    x, y = grid.xy_m[plants].T
    order = np.lexsort((x, y))
    x, y = x[order], y[order]
    # plants on one line that touch are one cell: a hundredth of the cells to unite
    parted, edge = (
        (np.diff(y) != 0.0) | (np.diff(x) > 2.0 * half_m[0]),
        np.full(min(len(x), 1), True),
    )
    first = np.flatnonzero(np.concatenate([edge, parted]))
    last = np.flatnonzero(np.concatenate([parted, edge]))
    # turned along each row where rows bend would gain centimetres: squares follow the plants
    cells = shapely.box(
        x[first] - half_m[0], y[first] - half_m[1], x[last] + half_m[0], y[first] + half_m[1]
    )
    whole = shapely.union_all(cells)
    outline: shapely.MultiPolygon = grid.frame.geometry_lonlat(
        shapely.MultiPolygon(list(shapely.get_parts(whole)))
    )
    return outline


class _Strips(NamedTuple):
    """Steps along the sections of a sprayer, section after section.

    `first` ``(s + 1,)`` says where each section's steps begin, `start_m` ``(k,)`` where along the
    rows each step is, `step` ``(n,)`` in which step a plant stands, and `begins` ``(k,)`` whether
    a step is the first of its section.
    """

    first: Ints
    start_m: Floats
    step: Ints
    begins: NDArray[np.bool_]
    step_m: float


def _strips(grid: PlantGrid, rows: int) -> _Strips:
    """Cut the plot into sections of so many lines, and those into steps of a plant's spacing."""
    step_m = grid.plant_spacing_m
    line = grid.row_line[grid.row].astype(np.int64)
    block = np.zeros(len(grid), np.int64) if grid.block is None else grid.block[grid.row]
    section = line // rows * (int(block.max()) + 1) + block
    at = np.floor((grid.along_m - grid.along_m.min()) / step_m).astype(np.int64)
    wide = int(at.max()) + 1
    cells, step = np.unique(section * wide + at, return_inverse=True)
    begins = np.diff(cells // wide, prepend=-1) != 0
    first = np.append(np.flatnonzero(begins), len(cells)).astype(np.int64)
    return _Strips(first, (cells % wide) * step_m, step.astype(np.int64), begins, step_m)


@routine
def _switch(
    strips: tuple[Ints, Floats, Floats],
    limits: tuple[float, float, float],
    step_m: float,
    on: NDArray[np.bool_],
) -> None:
    """Switch each section for the greatest gain, in place.

    The best with a stretch that ends behind step i begins it at the best j that is far enough
    back; the best before j ends its last stretch at the best e that is far enough before j. Both
    are running maxima, for what is far enough once stays so: a section takes one pass.
    """
    first, start_m, gain = strips
    for s in range(first.size - 1):
        a, b = first[s], first[s + 1]
        ends, began, before = _ends((start_m[a:b], gain[a:b]), limits, step_m)
        at = int(np.argmax(ends))
        while at > 0 and ends[at] > 0.0:
            on[a + began[at] : a + at] = True
            at = before[at]


@routine
def _ends(
    section: tuple[Floats, Floats], limits: tuple[float, float, float], step_m: float
) -> tuple[Floats, Ints, Ints]:
    """Return the best of the first i steps, the last of them on, ``(n + 1,)``.

    And at which step that stretch began, and where the one before it ended.
    """
    start_m, gain = section
    least_on_m, least_off_m, per_zone = limits
    n = gain.size
    ends = np.full(n + 1, -np.inf)
    began, before = np.zeros(n + 1, np.int64), np.zeros(n + 1, np.int64)
    ready, of_ready = np.zeros(n), np.zeros(n, np.int64)
    ahead = np.zeros(n + 1)  # of all gains up to a step
    e = j = prior_at = from_at = 0
    prior, from_j = 0.0, -np.inf
    for i in range(1, n + 1):
        ahead[i] = ahead[i - 1] + gain[i - 1]
        here_m, end_m = start_m[i - 1], start_m[i - 1] + step_m
        while e < i - 1 and here_m - start_m[e] - step_m >= least_off_m - 1e-9:
            e += 1
            if ends[e] > prior:
                prior, prior_at = ends[e], e
        ready[i - 1], of_ready[i - 1] = prior, prior_at
        while j < i and end_m - start_m[j] >= least_on_m - 1e-9:
            if ready[j] - ahead[j] > from_j:
                from_j, from_at = ready[j] - ahead[j], j
            j += 1
        if j > 0:
            ends[i] = ahead[i] + from_j - per_zone
            began[i], before[i] = from_at, of_ready[from_at]
    if j == 0:
        # a section shorter than the least stretch is sprayed whole, or not at all
        ends[n] = ahead[n] - per_zone
    return ends, began, before
