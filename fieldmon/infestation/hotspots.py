"""Where finds cluster more than chance allows, among the plants that were inspected.

The test is exact and asks only about finds: were the finds strewn at random over the inspected
plants, how likely would the window round this find hold that many others? That is the local join
count (Anselin & Li 2019, Journal of Geographical Systems 21:189-210) with its permutations summed
in closed form: N - 1 other inspected plants, K - 1 other finds, n - 1 of those plants in the window
give a hypergeometric tail. A find alone in its window has p = 1, and windows without a find are
not asked, so neither can become a hot spot. The p-values of overlapping windows rise and fall
together, which Benjamini & Hochberg's (1995) procedure allows (Benjamini & Yekutieli 2001).
"""

from __future__ import annotations

from dataclasses import dataclass
from types import NoneType
from typing import TYPE_CHECKING

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from fieldmon.compute.arguments import must_be, must_be_in
from fieldmon.compute.array_arguments import array_of_plants, must_hold_shapes
from fieldmon.compute.jit import routine
from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.ranges import AllowedRange
from fieldmon.compute.wording import counted
from fieldmon.errors import ObservationError
from fieldmon.infestation.nearby_plants import outside_m
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.plot.grid import PlantGrid
from fieldmon.plot.plot import Plot

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.records import Records

    Floats = NDArray[np.float64]

# plants on the rim of a window belong to it, whatever the last digit of their positions says
_RIM = 1.01
# a window's radius is learned from this many of the inspected plants, and reaches so many others
_ASKED, _NEIGHBOURS = 1000, 12
# records farther from the plot than this belong to none of its plants
_NEARBY_M = 1000.0
# no plot is wider, or has more plants
_RADIUS_M = AllowedRange(0.0, 100_000.0, above=True, unit=" m")
_SHARE = AllowedRange(0.0, 1.0, above=True, below=True)
_FINDS = AllowedRange(2, 100_000_000)


@dataclass(frozen=True)
class HotSpotSettings:
    """What counts as a hot spot.

    Parameters
    ----------
    radius_m
        Radius of the windows. None: the median distance from an inspected plant to its 12th
        nearest inspected one (or the square root of N-th, if that is less): about 2 plant
        spacings where all plants were inspected, and wider where few were. In trials on clusters
        of 5 to 20 m, windows of 20 found no more of them and drew them half again too large;
        windows of 8 missed the looser ones.
    false_share
        Share of false ones among the finds called central to a hot spot that is tolerated on
        average (Benjamini-Hochberg).
    least_finds
        Finds a hot spot must hold. Our choice: of two finds side by side a list is no help.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.HotSpotSettings(radius_m=10).radius_m
    10
    """

    radius_m: float | None = None
    false_share: float = 0.05
    least_finds: int = 3

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A hot spot's")
        if self.radius_m is not None:
            must_be_in("A hot spot's radius_m", _RADIUS_M, self.radius_m)
        must_be_in("A hot spot's false_share", _SHARE, self.false_share)
        must_be_in("A hot spot's least_finds", _FINDS, self.least_finds)


@dataclass(frozen=True, eq=False)
class HotSpots:
    """The hot spots of a plot, the most certain first: number h is entry h of every column.

    Parameters
    ----------
    of_plant
        ``(n,)`` number of the hot spot in whose windows a plant stands, -1 for none. That takes in
        clean plants and plants never inspected: they stand among the finds.
    found, inspected, plants
        ``(h,)`` plants found infested, inspected at all, and standing there.
    expected
        ``(h,)`` finds that would be there if they were strewn over all inspected plants alike.
    p, q
        ``(h,)`` of its strongest window: chance of so many finds by chance alone, and the same
        after allowing for all the windows asked.
    centre_m
        ``(h, 2)`` mean position of its finds, metres of the grid's frame.
    radius_m
        Radius of the windows.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> seen = np.zeros(plot.n_plants, np.int8)
    >>> seen[:40] = 1
    >>> spots = fm.hot_spots(plot.grid, seen)
    >>> spots.found.tolist(), bool(spots.q.max() < 0.05)
    ([40], True)
    """

    of_plant: NDArray[np.int32]
    found: NDArray[np.int64]
    inspected: NDArray[np.int64]
    plants: NDArray[np.int64]
    expected: Floats
    p: Floats
    q: Floats
    centre_m: Floats
    radius_m: float

    def __post_init__(self) -> None:
        must_hold_kinds(self, "Hot spots'")
        h = self.found.size
        counted_ = ("found", "inspected", "plants", "expected", "p", "q")
        shapes = dict.fromkeys(counted_, (h,)) | {"centre_m": (h, 2)}
        must_hold_shapes(self, "Hot spots'", shapes)
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)

    def __repr__(self) -> str:
        finds = counted(int(self.found.sum()), "find")
        return f"<HotSpots: {counted(len(self), 'hot spot')} with {finds}>"

    def __len__(self) -> int:
        """Return the number of hot spots."""
        return len(self.found)


def states(n: int, plants: NDArray[np.integer], found: NDArray[np.bool_]) -> NDArray[np.int8]:
    """Return `PRESENT`, `ABSENT` or `UNKNOWN` for each of n plants, from inspections ``(k,)``.

    A plant inspected more than once was infested if it was found so once.
    """
    state = np.full(n, UNKNOWN, np.int8)
    state[plants] = ABSENT
    state[plants[found]] = PRESENT
    return state


@dataclass(frozen=True, eq=False)
class NewestRecords:
    """What the newest record of each plant says.

    Parameters
    ----------
    state
        ``(n,)`` `PRESENT`, `ABSENT`, or `UNKNOWN` where no record speaks of the plant.
    day
        ``(n,)`` datetime64[D] of that record; NaT: no record, or one without a date.
    """

    state: NDArray[np.int8]
    day: NDArray[np.datetime64]


def record_states(
    grid: PlantGrid, records: Records, within_m: float | None = None
) -> NDArray[np.int8]:
    """Return the state ``(n,)`` that records give the plants nearest to them; see below."""
    return newest_records(grid, records, within_m).state


def newest_records(
    grid: PlantGrid, records: Records, within_m: float | None = None
) -> NewestRecords:
    """Return what the newest records of the plants nearest to them say.

    The newest record of a plant counts, an undated one as older than all; of several of one day a
    find. Records farther than `within_m` (default: half a row spacing, and the record's own
    accuracy on top) from any plant say nothing.
    """
    says = (records.present != UNKNOWN) & (outside_m(grid, records.lonlat) < _NEARBY_M)
    said = records.take(says)
    metres, plant = grid.tree.query(grid.frame.xy_m(said.lonlat))
    own_m = np.where(said.accuracy_m >= 0.0, said.accuracy_m, 0.0)
    near = metres <= (grid.row_spacing_m / 2 + own_m if within_m is None else within_m)
    # the last one written counts; a day that is no time is the least of all numbers
    order = np.lexsort((said.present, said.day.astype(np.int64)))
    last = order[near[order]]
    state = np.full(len(grid), UNKNOWN, np.int8)
    state[plant[last]] = said.present[last]
    day = np.full(len(grid), "NaT", "datetime64[D]")
    day[plant[last]] = said.day[last]
    return NewestRecords(state, day)


def hot_spots(
    plot: Plot | PlantGrid, state: NDArray[np.int8], settings: HotSpotSettings | None = None
) -> HotSpots:
    """Return where finds cluster, from each plant's `state` ``(n,)``.

    The two faces of a vine count as one plant, infested if either is.

    Parameters
    ----------
    plot
        The plot, or its plants alone.
    state
        ``(n,)`` int8: 1 found infested, 0 only found clean, -1 never inspected.
    settings
        Windows and the false discovery rate; None: the defaults.

    Raises
    ------
    ObservationError
        If `state` has not one entry a plant, or one is not 1, 0 or -1.
    SettingError
        If something is of another kind.

    Examples
    --------
    >>> import numpy as np, fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> state = np.zeros(plot.n_plants, np.int8)
    >>> state[1000:1006] = 1
    >>> len(fm.hot_spots(plot, state))
    1
    """
    must_be("A plot must be what read_plot returns", plot, (Plot, PlantGrid), "Give the plot.")
    grid = plot.grid if isinstance(plot, Plot) else plot
    must_be(
        "Settings must be HotSpotSettings", settings, (HotSpotSettings, NoneType),
        "Leave them out, or give HotSpotSettings(radius_m=10).",
    )  # fmt: skip
    settings = settings or HotSpotSettings()
    vine = grid.vine
    either = np.full(len(grid), UNKNOWN, np.int8)
    np.maximum.at(either, vine, _states(state, len(grid)))
    inspected_m, finds_m = grid.xy_m[either != UNKNOWN], grid.xy_m[either == PRESENT]
    radius_m = settings.radius_m or _learned_radius_m(inspected_m, grid.row_spacing_m)
    p = _window_p(inspected_m, finds_m, radius_m, settings.least_finds)
    q = _false_shares(p)
    # a share that is met exactly is met, however the last digit was rounded
    core = q <= settings.false_share * (1.0 + 1e-9)
    spot = _numbered(finds_m[core], p[core], radius_m)
    of_plant = _around(grid, finds_m[core], spot, radius_m)[vine]
    # each vine once, under its first face
    once = np.where(vine == np.arange(len(grid)), of_plant, -1)
    n_spots = int(spot.max(initial=-1)) + 1
    of_find = once[either == PRESENT]
    found = _count(of_find, n_spots)
    inspected = _count(once[either != UNKNOWN], n_spots)
    return HotSpots(
        of_plant=of_plant,
        found=found,
        inspected=inspected,
        plants=_count(once, n_spots),
        expected=inspected * np.float64(len(finds_m) / max(len(inspected_m), 1)),
        p=_least(p[core], spot, n_spots),
        q=_least(q[core], spot, n_spots),
        centre_m=_centre_m(finds_m, of_find, found),
        radius_m=radius_m,
    )


def _states(given: object, n: int) -> NDArray[np.int8]:
    """Return the state of each of `n` plants; refuse what is none."""
    states = array_of_plants(np.float64, "The states of the plants", given)
    if states.shape != (n,):
        raise ObservationError(
            f"The states of the plants must have one entry a plant ({n}), "
            f"but their shape is {states.shape}."
        )
    odd = states[~np.isin(states, (UNKNOWN, ABSENT, PRESENT))]
    if odd.size:
        raise ObservationError(
            "The state of a plant must be 1 (found infested), 0 (only found clean) or -1 (never "
            f"inspected), but one is {odd[0]:g}."
        )
    return states.astype(np.int8)


def outlines_m(grid: PlantGrid, spots: HotSpots) -> list[shapely.Polygon]:
    """Return the outline of each hot spot on a map, metres of the grid's frame."""
    margin_m = 0.75 * max(grid.row_spacing_m, grid.plant_spacing_m)
    inside = np.flatnonzero(spots.of_plant >= 0)
    outlines = []
    for k in range(len(spots)):
        own = shapely.multipoints(grid.xy_m[inside[spots.of_plant[inside] == k]])
        outlines.append(shapely.buffer(shapely.convex_hull(own), margin_m))
    return outlines


def _learned_radius_m(inspected_m: Floats, at_least_m: float) -> float:
    neighbours = min(_NEIGHBOURS, int(np.sqrt(len(inspected_m))))
    if neighbours < 2:
        return at_least_m
    asked = inspected_m[:: -(-len(inspected_m) // _ASKED)]
    metres, _ = cKDTree(inspected_m).query(asked, k=[neighbours + 1])
    return float(np.median(metres))


def _window_p(inspected_m: Floats, finds_m: Floats, radius_m: float, least: int) -> Floats:
    """Return the p-value of the window round each find, ``(k,)``; 1 with fewer than `least`."""
    if not len(finds_m):
        return np.empty(0)
    inspected, found = (
        cKDTree(points).query_ball_point(finds_m, _RIM * radius_m, return_length=True)
        for points in (inspected_m, finds_m)
    )
    windows, which = np.unique(np.stack([inspected, found], 1), axis=0, return_inverse=True)
    p = _tails(windows, len(inspected_m), len(finds_m))
    p[windows[:, 1] < least] = 1.0
    return p[which]


def _false_shares(p: Floats) -> Floats:
    """Return the share of false ones among all that are at least as unlikely as each.

    Y. Benjamini and Y. Hochberg, J. R. Stat. Soc. B 57 (1995) 289. SciPy has the same, among
    statistics that take half a second to load.
    """
    order = np.argsort(p)
    shares = p[order] * len(p) / np.arange(1, len(p) + 1)
    q = np.empty(len(p))
    q[order] = np.minimum.accumulate(shares[::-1])[::-1].clip(max=1.0)
    return q


def _numbered(cores_m: Floats, p: Floats, radius_m: float) -> NDArray[np.int32]:
    """Return the hot spot of each core: one where windows overlap, the most certain first."""
    if not len(cores_m):
        return np.empty(0, np.int32)
    a, b = cKDTree(cores_m).query_pairs(2.0 * _RIM * radius_m, output_type="ndarray").T
    links = coo_array((np.ones(len(a), bool), (a, b)), shape=(len(cores_m),) * 2)
    spot: NDArray[np.int32]
    count, spot = connected_components(links, directed=False)
    order = np.lexsort((-np.bincount(spot), _least(p, spot, count)))
    number = np.empty(count, np.int32)
    number[order] = np.arange(count)
    return number[spot]


def _around(
    grid: PlantGrid, cores_m: Floats, spot: NDArray[np.int32], radius_m: float
) -> NDArray[np.int32]:
    """Return in whose windows each plant stands, ``(n,)``; -1 for none."""
    of_plant = np.full(len(grid), -1, np.int32)
    if len(cores_m):
        windows = grid.tree.query_ball_point(cores_m, _RIM * radius_m)
        near = np.unique(np.concatenate(windows).astype(np.intp))
        _, core = cKDTree(cores_m).query(grid.xy_m[near])
        of_plant[near] = spot[core]
    return of_plant


def _count(spot: NDArray[np.int32], n_spots: int) -> NDArray[np.int64]:
    return np.bincount(spot[spot >= 0], minlength=n_spots)


def _least(values: Floats, spot: NDArray[np.integer], n_spots: int) -> Floats:
    least = np.ones(n_spots)
    np.minimum.at(least, spot, values)
    return least


def _centre_m(finds_m: Floats, of_find: NDArray[np.int32], found: NDArray[np.int64]) -> Floats:
    inside = of_find >= 0
    sums = [np.bincount(of_find[inside], axis[inside], len(found)) for axis in finds_m.T]
    return np.stack(sums, axis=1) / found[:, None]


@routine
def _tails(windows: NDArray[np.int64], inspected: int, found: int) -> Floats:
    """Return P(at least as many finds) for windows ``(w, 2)`` of (inspected, found) plants.

    Each window stands round a find, which is taken as given: the others are drawn.
    """
    p = np.empty(len(windows))
    for w in range(len(windows)):
        p[w] = _tail(windows[w, 1] - 1, windows[w, 0] - 1, found - 1, inspected - 1)
    return p


@routine
def _tail(x: int, drawn: int, special: int, total: int) -> float:
    """Return P(X >= x) for `drawn` of `total` plants of which `special` are finds.

    Sums the shorter way from one term, by ratios of terms, so that small tails keep their digits
    (scipy's ``hypergeom.sf`` agrees, but takes half a millisecond a window).
    """
    if x <= max(0, drawn + special - total):
        return 1.0
    if x > min(drawn, special):
        return 0.0
    upper = x * (total + 2.0) > (drawn + 1.0) * (special + 1.0)  # beyond the mode
    j = x if upper else x - 1
    log_term = 0.0
    for i in range(j):
        log_term += np.log((drawn - i) / (i + 1.0) * (special - i) / (total - i))
    for i in range(drawn - j):
        log_term += np.log((total - special - i) / (total - j - i))
    term = np.exp(log_term)
    sum_ = 0.0
    while term > sum_ * 1e-17:
        sum_ += term
        ahead = (drawn - j) * (special - j)
        behind = j * (total - special - drawn + j)
        if upper:
            term *= ahead / ((j + 1.0) * (total - special - drawn + j + 1.0))
            j += 1
        else:
            term *= behind / ((drawn - j + 1.0) * (special - j + 1.0))
            j -= 1
    return min(sum_, 1.0) if upper else max(1.0 - sum_, 0.0)
