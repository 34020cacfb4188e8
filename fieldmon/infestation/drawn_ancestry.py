"""Who infested whom: ancestries of the finds, drawn one after the other (Markov chain Monte Carlo).

An ancestry says of every find when its plant was infested, and from where: by a find, by a plant
that was not found, or by none. Of plants that were not found it has only those from which a find
descends; all others are summed up in `unseen_offspring`. Three moves change it: an infestation gets
another time and parent (drawn from all that are possible); one that was not found is put between
an infestation and its parent; or such a one is taken out. The last two are accepted as Metropolis
and Hastings have it.

Mornings and nights are counted from the first night that is thought of; the night i lies between
the mornings i and i + 1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import part, routine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.cells import Cells

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

NOBODY = -1
# of the moves tried, so many are of the first kind, and of the first two
_TIMES, _TIMES_AND_MORE = 0.5, 0.75
# per place, in a sweep
_MOVES = 2


class Infestations(NamedTuple):
    """The infestations of an ancestry, ``(m,)`` each, with room for more.

    Parameters
    ----------
    plant
        Where each is.
    begins, ends
        From which morning on the plant sends something out at night, and until which: that of its
        find, or the last.
    found
        Whether it was found.
    parent, children
        The infestation from which it came (`NOBODY`: none), and how many came from it.
    there
        Whether the place is taken.
    earliest
        The first morning on which it may have begun: after the plant's find before.
    """

    plant: Ints
    begins: Ints
    ends: Ints
    found: NDArray[np.bool_]
    parent: Ints
    children: Ints
    there: NDArray[np.bool_]
    earliest: Ints

    @classmethod
    def room(cls, places: int) -> Infestations:
        """Return places for so many."""
        ints = np.zeros((6, places), np.int64)
        ints[3] = NOBODY
        plant, begins, ends, parent, children, earliest = ints
        found, there = np.zeros((2, places), np.bool_)
        return cls(plant, begins, ends, found, parent, children, there, earliest)

    def __repr__(self) -> str:
        hidden = np.count_nonzero(self.there & ~self.found)
        return f"<Infestations: {np.count_nonzero(self.found)} found, {hidden} not>"

    def copied(self, places: int) -> Infestations:
        """Return the same with so many places more."""
        wider = Infestations.room(len(self.plant) + places)
        for mine, own in zip(wider, self, strict=True):
            mine[: len(own)] = own
        return wider


class Weights(NamedTuple):
    """What ancestries are weighed by, on t mornings.

    Parameters
    ----------
    cells
        The plants in cells.
    kernel, so_far
        ``(d, d)`` where jumps land about a plant, and its running sum ``(d * d,)``, up to 1.
    sends
        ``(t,)`` what an infested plant sends out in a night.
    roots
        ``(t, n)`` how many infestations come to a plant from none, by the morning on which they
        begin.
    season, settled
        The first morning of the season, and that until which infestations have ended that stay as
        they are.
    lasting
        ``(t, n)`` how likely it is that an infestation goes on from a morning to the last as it
        was seen, if it sends out only what the ancestry has: up to another morning it is the ratio
        of both.
    """

    cells: Cells
    kernel: Floats
    so_far: Floats
    sends: Floats
    roots: Floats
    season: int
    settled: int
    lasting: Floats


class DrawnSums(NamedTuple):
    """Sums over the ancestries drawn.

    Parameters
    ----------
    active
        ``(t, n)`` in how many each plant sent something out in a night.
    hidden
        ``(n,)`` in how many it is infested now.
    jumps
        ``(2, d, d)`` how many jumps of each length and direction, before the season and in it.
    roots
        ``(t, n)`` how many came from none.
    """

    active: Floats
    hidden: Floats
    jumps: Floats
    roots: Floats

    @classmethod
    def none(cls, t: int, n: int, d: int) -> DrawnSums:
        """Return sums of nothing."""
        return cls(np.zeros((t, n)), np.zeros(n), np.zeros((2, d, d)), np.zeros((t, n)))

    def __repr__(self) -> str:
        return f"<Drawn: {self.jumps.sum():.0f} jumps>"


class _Origins(NamedTuple):
    """Room for what explains an infestation: running sums over mornings, and over parents."""

    by_parent: Floats
    by_none: Floats
    so_far: Floats


@routine
def draw_ancestries(
    infestations: Infestations,
    at: Ints,
    weights: Weights,
    last_find: Ints,
    draws: tuple[int, int, int],
    drawn: DrawnSums,
) -> int:
    """Draw ancestries, each from the one before, in place; return how many were summed up.

    Parameters
    ----------
    at
        ``(n,)`` which infestation not found is at each plant, or `NOBODY`.
    last_find
        ``(n,)`` the morning of each plant's last find, or less than 0.
    draws
        The seed, how many sweeps there are, and how many of them are left out at the beginning.
    """
    seed, sweeps, left_out = draws
    np.random.seed(seed)  # noqa: NPY002 - a compiled loop has no other
    mornings, places = weights.roots.shape[0], infestations.plant.size
    origins = _Origins(np.empty(mornings + 1), np.empty(mornings + 1), np.empty(places))
    for sweep in range(sweeps):
        # as many in each sweep, however many infestations there are by then
        for _ in range(_MOVES * places):
            i, kind = np.random.randint(places), np.random.random()  # noqa: NPY002
            if kind >= _TIMES_AND_MORE:
                _take_out(infestations, at, weights, origins)
            elif not infestations.there[i] or infestations.ends[i] <= weights.settled:
                continue
            elif kind < _TIMES:
                _move(infestations, i, weights, origins)
            else:
                _put_in(infestations, i, (at, last_find), weights, origins)
        if sweep >= left_out:
            _sum_up(infestations, weights, drawn)
    return max(sweeps - left_out, 0)


@part
def _move(infestations: Infestations, i: int, weights: Weights, origins: _Origins) -> None:
    """Draw another beginning and parent of an infestation.

    The only child of one that was not found keeps its parent: that would be without a find.
    """
    latest = infestations.ends[i]
    for j in range(infestations.plant.size):
        if infestations.there[j] and infestations.parent[j] == i:
            latest = min(latest, infestations.begins[j] - 1)
    earliest = infestations.earliest[i]
    if latest < earliest:
        return
    when = (infestations.plant[i], earliest, latest, infestations.ends[i])
    parent = infestations.parent[i]
    alone = parent >= 0 and _hangs_on_one(infestations, parent)
    total = _weigh(infestations, when, (i, NOBODY), weights, origins)
    if alone:
        infestations.begins[i] = _when_by(infestations, parent, when, origins)
        return
    other, begins = _draw_origin(infestations, total, when, origins)
    _hang(infestations, i, other)
    infestations.begins[i] = begins


@part
def _put_in(
    infestations: Infestations,
    i: int,
    places: tuple[Ints, Ints],
    weights: Weights,
    origins: _Origins,
) -> None:
    """Try one that was not found as the parent of an infestation."""
    at, last_find = places
    parent = infestations.parent[i]
    if parent >= 0 and _hangs_on_one(infestations, parent):
        return
    plant, many = _came_from(weights, infestations.plant[i])
    if plant < 0 or at[plant] >= 0 or plant == infestations.plant[i]:
        return
    begins = infestations.begins[i]
    earliest, latest = max(0, last_find[plant] + 1), begins - 1
    place = _free(infestations)
    if latest < earliest or place < 0:
        return
    last = weights.roots.shape[0] - 1
    now = _explained(infestations, i, NOBODY, weights, origins)
    when = (plant, earliest, latest, last)
    total = _weigh(infestations, when, (i, NOBODY), weights, origins)
    other, since = _draw_origin(infestations, total, when, origins)
    removable = _n_removable(infestations) + 1
    if other != parent:
        # the one before has a child less then, and the new one's parent one more
        if parent >= 0 and not infestations.found[parent] and infestations.children[parent] == 2:
            removable += 1
        if other >= 0 and _hangs_on_one(infestations, other):
            removable -= 1
    # each place is drawn as often, taken or not
    gain = weights.sends[begins - 1] * many * total * infestations.plant.size
    if np.random.random() * now * removable >= gain:  # noqa: NPY002
        return
    infestations.plant[place], infestations.begins[place] = plant, since
    infestations.ends[place], infestations.earliest[place] = last, earliest
    infestations.found[place], infestations.there[place] = False, True
    infestations.parent[place], infestations.children[place] = NOBODY, 0
    at[plant] = place
    _hang(infestations, place, other)
    _hang(infestations, i, place)


@part
def _take_out(infestations: Infestations, at: Ints, weights: Weights, origins: _Origins) -> None:
    """Try to do without one that was not found and has a single child."""
    removable = _n_removable(infestations)
    if removable == 0:
        return
    wanted = np.random.randint(removable)  # noqa: NPY002
    place = NOBODY
    for j in range(infestations.plant.size):
        if infestations.there[j] and _hangs_on_one(infestations, j):
            if wanted == 0:
                place = j
                break
            wanted -= 1
    parent = infestations.parent[place]
    if parent >= 0 and _hangs_on_one(infestations, parent):
        return
    child = NOBODY
    for j in range(infestations.plant.size):
        if infestations.there[j] and infestations.parent[j] == place:
            child = j
            break
    if infestations.ends[child] <= weights.settled:
        return
    begins, plant = infestations.begins[child], infestations.plant[place]
    when = (plant, infestations.earliest[place], begins - 1, infestations.ends[place])
    total = _weigh(infestations, when, (place, child), weights, origins)
    now = _explained(infestations, child, place, weights, origins)
    cell = weights.cells.of_plant[plant]
    many = weights.cells.start[cell + 1] - weights.cells.start[cell]
    loss = weights.sends[begins - 1] * many * total * infestations.plant.size
    if np.random.random() * loss >= now * removable:  # noqa: NPY002
        return
    when = (infestations.plant[child], begins, begins, infestations.ends[child])
    total = _weigh(infestations, when, (child, place), weights, origins)
    other, _ = _draw_origin(infestations, total, when, origins)
    _hang(infestations, child, other)
    _hang(infestations, place, NOBODY)
    infestations.there[place] = False
    at[plant] = NOBODY


@part
def _weigh(
    infestations: Infestations,
    when: tuple[int, int, int, int],
    without: tuple[int, int],
    weights: Weights,
    origins: _Origins,
) -> float:
    """Weigh all origins of an infestation; return their sum.

    `when` is its plant, the first and the last morning on which it may begin, and when it ends;
    `without` are two infestations from which it does not come.
    """
    plant, earliest, latest, ends = when
    origins.by_parent[0] = origins.by_none[0] = 0.0
    for k in range(latest - earliest + 1):
        begins = earliest + k
        lasts = weights.lasting[begins, plant] / weights.lasting[ends, plant]
        sends = weights.sends[begins - 1] if begins > 0 else 0.0
        origins.by_parent[k + 1] = origins.by_parent[k] + lasts * sends
        origins.by_none[k + 1] = origins.by_none[k] + lasts * weights.roots[begins, plant]
    total = 0.0
    for j in range(infestations.plant.size):
        if infestations.there[j] and j != without[0] and j != without[1]:
            first = max(infestations.begins[j] + 1, earliest)
            last = min(infestations.ends[j], latest)
            if last >= first:
                times = origins.by_parent[last - earliest + 1] - origins.by_parent[first - earliest]
                total += times * _jumps(weights, infestations.plant[j], plant)
        origins.so_far[j] = total
    return float(total + origins.by_none[latest - earliest + 1])


@part
def _draw_origin(
    infestations: Infestations,
    total: float,
    when: tuple[int, int, int, int],
    origins: _Origins,
) -> tuple[int, int]:
    """Return a parent and a beginning, drawn from what was weighed."""
    _, earliest, latest, _ = when
    u = np.random.random() * total  # noqa: NPY002
    if u < origins.so_far[-1]:
        parent = int(np.searchsorted(origins.so_far, u, side="right"))
        return parent, _when_by(infestations, parent, when, origins)
    u = np.random.random() * origins.by_none[latest - earliest + 1]  # noqa: NPY002
    k = 0
    while earliest + k < latest and origins.by_none[k + 1] <= u:
        k += 1
    return NOBODY, earliest + k


@part
def _when_by(
    infestations: Infestations,
    parent: int,
    when: tuple[int, int, int, int],
    origins: _Origins,
) -> int:
    """Return when an infestation by this parent began, drawn from what was weighed."""
    _, earliest, latest, _ = when
    first = max(infestations.begins[parent] + 1, earliest)
    last = min(infestations.ends[parent], latest)
    low, high = origins.by_parent[first - earliest], origins.by_parent[last - earliest + 1]
    u = low + np.random.random() * (high - low)  # noqa: NPY002
    begins = first
    while begins < last and origins.by_parent[begins - earliest + 1] <= u:
        begins += 1
    return int(begins)


@part
def _explained(
    infestations: Infestations, i: int, without: int, weights: Weights, origins: _Origins
) -> float:
    """Return how well an infestation that begins when it does is explained by all others."""
    begins, ends, plant = infestations.begins[i], infestations.ends[i], infestations.plant[i]
    total = _weigh(infestations, (plant, begins, begins, ends), (i, without), weights, origins)
    return float(total * weights.lasting[ends, plant] / weights.lasting[begins, plant])


@part
def _jumps(weights: Weights, sender: int, plant: int) -> float:
    """Return how much of what a plant sends out lands on another."""
    half = weights.kernel.shape[0] // 2
    y, x = _apart(weights, sender, plant)
    if -half <= y <= half and -half <= x <= half:
        return float(weights.kernel[y + half, x + half])
    return 0.0


@part
def _apart(weights: Weights, one: int, other: int) -> tuple[int, int]:
    """Return how many cells a plant stands from another, across and along."""
    cells = weights.cells
    a, b, along = cells.of_plant[one], cells.of_plant[other], cells.shape[1]
    return b // along - a // along, b % along - a % along


@part
def _came_from(weights: Weights, plant: int) -> tuple[int, int]:
    """Return a plant from which something may have come to this one, drawn by the kernel.

    And how many stand in its cell; -1: none stands there.
    """
    cells, d = weights.cells, weights.kernel.shape[0]
    across, along = cells.shape[0], cells.shape[1]
    k = np.searchsorted(weights.so_far, np.random.random())  # noqa: NPY002
    y = cells.of_plant[plant] // along - (k // d - d // 2)
    x = cells.of_plant[plant] % along - (k % d - d // 2)
    if k >= d * d or y < 0 or y >= across or x < 0 or x >= along:
        return NOBODY, 0
    first, end = cells.start[y * along + x], cells.start[y * along + x + 1]
    if first == end:
        return NOBODY, 0
    return int(cells.plant[np.random.randint(first, end)]), int(end - first)  # noqa: NPY002


@part
def _hang(infestations: Infestations, i: int, parent: int) -> None:
    """Give an infestation another parent."""
    before = infestations.parent[i]
    if before >= 0:
        infestations.children[before] -= 1
    if parent >= 0:
        infestations.children[parent] += 1
    infestations.parent[i] = parent


@part
def _hangs_on_one(infestations: Infestations, j: int) -> bool:
    """Tell whether an infestation is only there for a single child."""
    return bool(not infestations.found[j] and infestations.children[j] == 1)


@part
def _n_removable(infestations: Infestations) -> int:
    n = 0
    for j in range(infestations.plant.size):
        if infestations.there[j] and _hangs_on_one(infestations, j):
            n += 1
    return n


@part
def _free(infestations: Infestations) -> int:
    """Return a place that is not taken, or `NOBODY`."""
    place = NOBODY
    for j in range(infestations.plant.size):
        if not infestations.there[j]:
            place = j
            break
    return place


@part
def _sum_up(infestations: Infestations, weights: Weights, drawn: DrawnSums) -> None:
    half = weights.kernel.shape[0] // 2
    for i in range(infestations.plant.size):
        if not infestations.there[i]:
            continue
        plant, begins = infestations.plant[i], infestations.begins[i]
        for night in range(begins, infestations.ends[i]):
            drawn.active[night, plant] += 1.0
        drawn.hidden[plant] += 0.0 if infestations.found[i] else 1.0
        parent = infestations.parent[i]
        if parent < 0:
            drawn.roots[begins, plant] += 1.0
            continue
        y, x = _apart(weights, infestations.plant[parent], plant)
        drawn.jumps[0 if begins <= weights.season else 1, y + half, x + half] += 1.0
