"""Where to treat: strips along the rows that a sprayer can switch, at the least expected loss.

A sprayer's section covers some rows side by side. Along them it is on or off, and each stretch
that is on, or off between two that are, has a least length. Which stretches cost least is found
exactly, section by section: plants stand in order along the rows, so that the best of all
switchings up to a plant follows from the best up to the one before.

With a knapsack plants are chosen one by one, each with the ring of plants around it.

Where both faces of a row are inspected, each face is a plant that may be infested, loses and counts
as everywhere else. Both are sprayed together, and their ground is paid for once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from fieldmon.compute.arrays import read_only
from fieldmon.compute.units import Units
from fieldmon.compute.wording import counted, estimate, share_figure, worded
from fieldmon.decisions.rings import best_rings, rings_bound
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.decisions.switching import strips_of, switch
from fieldmon.plot.polygons import polygons_of, without_slits

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

# the price at which zones keep within the ground allowed is halved so often
_STEPS = 50


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
        Infested plants expected where it is sprayed, and elsewhere; each face counts.
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
                "Treat nowhere: {outside} infested plants are expected, and nowhere would "
                "spraying save more than it costs.",
                outside=estimate(self.outside),
            )
        return worded(
            "To treat {area} in {zones}, {share} of the {of} under plants, costs {cost:,.2f} and "
            "saves {saved:,.2f}, in your currency: {inside} infested plants are expected there and "
            "{outside} elsewhere.",
            area=Units().square(self.m2), zones=counted(len(self), "zone"),
            share=share_figure(self.m2 / self.plot_m2), of=Units().square(self.plot_m2),
            inside=estimate(self.inside), outside=estimate(self.outside), cost=self.cost,
            saved=self.saved,
        )  # fmt: skip


def best_zones(
    grid: PlantGrid,
    chance: Floats,
    sprayer: Sprayer | None = None,
    costs: TreatmentCosts | None = None,
    spared: NDArray[np.bool_] | None = None,
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
    spared
        ``(n,)`` plants that must not be sprayed, whatever their chance; None: none.

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
    if spared is not None:
        plants = plants.without(np.bincount(grid.vine, spared, len(grid)) > 0.0)
    choose = _knapsack if sprayer.rows == 0 else _switched
    zone = choose(grid, plants, sprayer, costs)
    most = (1.0 - costs.reserve) * plants.area_m2
    if costs.reserve > 0.0 and plants.m2 * np.count_nonzero(plants.once & (zone >= 0)) > most:
        zone = _within(lambda dearer: choose(grid, dearer, sprayer, costs), plants, most)
    zones = _zones(zone, chance, plants, costs)
    if costs.reserve > 0.0 or (spared is not None and spared.any()):
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
    """What spraying each plant gains ``(n,)``, which stand for their ground, and that of each.

    Of two faces the first one stands for both, and has what spraying them gains.
    """

    gain: Floats
    once: NDArray[np.bool_]
    m2: float

    @classmethod
    def of(cls, grid: PlantGrid, chance: Floats, costs: TreatmentCosts) -> _Plants:
        once = grid.vine == np.arange(len(grid))
        m2 = grid.row_spacing_m * grid.plant_spacing_m
        infested = np.bincount(grid.vine, chance, len(grid))
        gain = infested * costs.per_infested_plant - costs.per_ha * m2 / 10_000
        return cls(np.where(once, gain, 0.0), once, m2)

    @property
    def area_m2(self) -> float:
        """Return the ground of all plants."""
        return float(self.once.sum()) * self.m2

    def without(self, spared: NDArray[np.bool_]) -> _Plants:
        """Return the same, some plants so dear that all others together do not pay for one."""
        never = -1.0 - float(self.gain.clip(0.0).sum())
        return self._replace(gain=np.where(spared & self.once, never, self.gain))

    def dearer(self, by: float) -> _Plants:
        """Return the same, each plant by so much less worth spraying."""
        return self._replace(gain=np.where(self.once, self.gain - by, 0.0))


def _zones(zone: Ints, chance: Floats, plants: _Plants, costs: TreatmentCosts) -> Zones:
    """Return zones with all that is said of them."""
    treated, n_zones = zone >= 0, int(zone.max(initial=-1)) + 1
    inside = float(chance[treated].sum())
    area_m2 = float(np.count_nonzero(plants.once & treated)) * plants.m2
    return Zones(
        treated,
        zone,
        area_m2,
        plants.area_m2,
        inside,
        float(chance[~treated].sum()),
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
    strips = strips_of(grid, sprayer.rows)
    on = np.zeros(len(strips.start_m), bool)
    per_step = np.bincount(strips.step, plants.gain, len(on)).astype(np.float64)
    switch(
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
    start, other = grid.vines_beside
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


def ground_m2(grid: PlantGrid, plants: NDArray[np.bool_]) -> float:
    """Return the ground of some plants ``(n,)``: as far as rows and plants stand apart, each.

    That is what is sprayed, however the plants were named. Two faces of a plant are one.
    """
    each_m2 = grid.row_spacing_m * grid.plant_spacing_m
    return int(np.count_nonzero(grid.vines_of(plants))) * each_m2


def outlines(grid: PlantGrid, zones: Zones) -> list[shapely.MultiPolygon]:
    """Return the area of each zone, lon/lat, that the plants of its rows fill.

    Each plant stands for the ground half a spacing around it; touching grounds are one, and no
    slits remain where measured plants stand a little wider apart.
    """
    grounds = [_ground_of(grid, zones.zone == k) for k in range(len(zones))]
    return [_lonlat(grid, one) for one in without_slits(grounds)]


def outline_of(grid: PlantGrid, plants: NDArray[np.bool_]) -> shapely.MultiPolygon:
    """Return the area, lon/lat, that some plants ``(n,)`` fill, as `outlines` has it."""
    (ground,) = without_slits([_ground_of(grid, plants)])
    return _lonlat(grid, ground)


def _lonlat(grid: PlantGrid, ground: shapely.MultiPolygon) -> shapely.MultiPolygon:
    """Return ground in degrees: edges that nearly meet in metres may cross there."""
    area = grid.frame.geometry_lonlat(ground)
    if area.is_valid:
        return area
    return polygons_of(shapely.make_valid(area, method="structure", keep_collapsed=False))


def _ground_of(grid: PlantGrid, plants: NDArray[np.bool_]) -> shapely.MultiPolygon:
    """Return the ground of some plants ``(n,)``, metres of the grid's frame, with its slits."""
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
    return polygons_of(shapely.union_all(cells))
