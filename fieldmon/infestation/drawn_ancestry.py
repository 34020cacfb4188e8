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
    at_start
        ``(2,)`` how many there were on the first morning of the season, and their squares.
    """

    active: Floats
    hidden: Floats
    jumps: Floats
    roots: Floats
    at_start: Floats

    @classmethod
    def none(cls, t: int, n: int, d: int) -> DrawnSums:
        """Return sums of nothing."""
        active, roots = np.zeros((2, t, n))
        return cls(active, np.zeros(n), np.zeros((2, d, d)), roots, np.zeros(2))

    def __repr__(self) -> str:
        return f"<Drawn: {self.jumps.sum():.0f} jumps>"


class _Worked(NamedTuple):
    """What is worked out on the way, and again at each move.

    Parameters
    ----------
    by_parent, by_none
        What explains an infestation, as running sums over mornings: by a parent, and by none.
    so_far
        The same as a running sum over parents.
    across, along
        The cell of each infestation.
    removable
        ``(1,)`` how many were not found and have a single child.
    """

    by_parent: Floats
    by_none: Floats
    so_far: Floats
    across: Ints
    along: Ints
    removable: Ints


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
    drawn
        Sums of nothing (`DrawnSums.none`), which are filled.
    """
    seed, sweeps, left_out = draws
    np.random.seed(seed)  # noqa: NPY002 - a compiled loop has no other
    mornings, places = weights.roots.shape[0], infestations.plant.size
    worked = _Worked(
        np.empty(mornings + 1), np.empty(mornings + 1), np.empty(places),
        np.zeros(places, np.int64), np.zeros(places, np.int64), np.zeros(1, np.int64),
    )  # fmt: skip
    for i in range(places):
        if infestations.there[i]:
            _stand(weights, infestations.plant[i], i, worked)
            worked.removable[0] += _hangs_on_one(infestations, i)
    for sweep in range(sweeps):
        # as many in each sweep, however many infestations there are by then
        for _ in range(_MOVES * places):
            i, kind = np.random.randint(places), np.random.random()  # noqa: NPY002
            if kind >= _TIMES_AND_MORE:
                _take_out(infestations, at, weights, worked)
            elif not infestations.there[i] or infestations.ends[i] <= weights.settled:
                continue
            elif kind < _TIMES:
                _move(infestations, i, weights, worked)
            else:
                _put_in(infestations, i, (at, last_find), weights, worked)
        if sweep >= left_out:
            _sum_up(infestations, weights.season, worked, drawn)
    for morning in range(1, mornings):
        drawn.active[morning] += drawn.active[morning - 1]
    return max(sweeps - left_out, 0)


@part
def _move(infestations: Infestations, i: int, weights: Weights, worked: _Worked) -> None:
    """Draw another beginning and parent of an infestation.

    The only child of one that was not found keeps its parent: that would be without a find.
    """
    latest, left = infestations.ends[i], infestations.children[i]
    for j in range(infestations.plant.size):
        if left == 0:
            break
        if infestations.there[j] and infestations.parent[j] == i:
            latest = min(latest, infestations.begins[j] - 1)
            left -= 1
    earliest = infestations.earliest[i]
    if latest < earliest:
        return
    when = (infestations.plant[i], earliest, latest, infestations.ends[i])
    parent = infestations.parent[i]
    alone = parent >= 0 and _hangs_on_one(infestations, parent)
    total = _weigh(infestations, when, (i, NOBODY), weights, worked)
    if alone:
        infestations.begins[i] = _when_by(infestations, parent, when, worked)
        return
    other, begins = _draw_origin(infestations, total, when, worked)
    _hang(infestations, i, other, worked)
    infestations.begins[i] = begins


@part
def _put_in(
    infestations: Infestations,
    i: int,
    places: tuple[Ints, Ints],
    weights: Weights,
    worked: _Worked,
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
    now = _explained(infestations, i, NOBODY, weights, worked)
    when = (plant, earliest, latest, last)
    total = _weigh(infestations, when, (i, NOBODY), weights, worked)
    other, since = _draw_origin(infestations, total, when, worked)
    removable = worked.removable[0] + 1
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
    _stand(weights, plant, place, worked)
    at[plant] = place
    _hang(infestations, place, other, worked)
    _hang(infestations, i, place, worked)


@part
def _take_out(infestations: Infestations, at: Ints, weights: Weights, worked: _Worked) -> None:
    """Try to do without one that was not found and has a single child."""
    removable = worked.removable[0]
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
    total = _weigh(infestations, when, (place, child), weights, worked)
    now = _explained(infestations, child, place, weights, worked)
    cell = weights.cells.of_plant[plant]
    many = weights.cells.start[cell + 1] - weights.cells.start[cell]
    loss = weights.sends[begins - 1] * many * total * infestations.plant.size
    if np.random.random() * loss >= now * removable:  # noqa: NPY002
        return
    when = (infestations.plant[child], begins, begins, infestations.ends[child])
    total = _weigh(infestations, when, (child, place), weights, worked)
    other, _ = _draw_origin(infestations, total, when, worked)
    _hang(infestations, child, other, worked)
    _hang(infestations, place, NOBODY, worked)
    infestations.there[place] = False
    at[plant] = NOBODY


@part
def _weigh(
    infestations: Infestations,
    when: tuple[int, int, int, int],
    without: tuple[int, int],
    weights: Weights,
    worked: _Worked,
) -> float:
    """Weigh all origins of an infestation; return their sum.

    `when` is its plant, the first and the last morning on which it may begin, and when it ends;
    `without` are two infestations from which it does not come.
    """
    plant, earliest, latest, ends = when
    worked.by_parent[0] = worked.by_none[0] = 0.0
    for k in range(latest - earliest + 1):
        begins = earliest + k
        lasts = weights.lasting[begins, plant] / weights.lasting[ends, plant]
        sends = weights.sends[begins - 1] if begins > 0 else 0.0
        worked.by_parent[k + 1] = worked.by_parent[k] + lasts * sends
        worked.by_none[k + 1] = worked.by_none[k] + lasts * weights.roots[begins, plant]
    half, y, x = weights.kernel.shape[0] // 2, *_cell(weights, plant)
    total = 0.0
    for j in range(infestations.plant.size):
        across, along = y - worked.across[j] + half, x - worked.along[j] + half
        if (
            0 <= across <= 2 * half
            and 0 <= along <= 2 * half
            and infestations.there[j]
            and j != without[0]
            and j != without[1]
        ):
            first = max(infestations.begins[j] + 1, earliest)
            last = min(infestations.ends[j], latest)
            if last >= first:
                times = worked.by_parent[last - earliest + 1] - worked.by_parent[first - earliest]
                total += times * weights.kernel[across, along]
        worked.so_far[j] = total
    return float(total + worked.by_none[latest - earliest + 1])


@part
def _draw_origin(
    infestations: Infestations,
    total: float,
    when: tuple[int, int, int, int],
    worked: _Worked,
) -> tuple[int, int]:
    """Return a parent and a beginning, drawn from what was weighed."""
    _, earliest, latest, _ = when
    u = np.random.random() * total  # noqa: NPY002
    if u < worked.so_far[-1]:
        parent = int(np.searchsorted(worked.so_far, u, side="right"))
        return parent, _when_by(infestations, parent, when, worked)
    u = np.random.random() * worked.by_none[latest - earliest + 1]  # noqa: NPY002
    k = 0
    while earliest + k < latest and worked.by_none[k + 1] <= u:
        k += 1
    return NOBODY, earliest + k


@part
def _when_by(
    infestations: Infestations,
    parent: int,
    when: tuple[int, int, int, int],
    worked: _Worked,
) -> int:
    """Return when an infestation by this parent began, drawn from what was weighed."""
    _, earliest, latest, _ = when
    first = max(infestations.begins[parent] + 1, earliest)
    last = min(infestations.ends[parent], latest)
    low, high = worked.by_parent[first - earliest], worked.by_parent[last - earliest + 1]
    u = low + np.random.random() * (high - low)  # noqa: NPY002
    begins = first
    while begins < last and worked.by_parent[begins - earliest + 1] <= u:
        begins += 1
    return int(begins)


@part
def _explained(
    infestations: Infestations, i: int, without: int, weights: Weights, worked: _Worked
) -> float:
    """Return how well an infestation that begins when it does is explained by all others."""
    begins, ends, plant = infestations.begins[i], infestations.ends[i], infestations.plant[i]
    total = _weigh(infestations, (plant, begins, begins, ends), (i, without), weights, worked)
    return float(total * weights.lasting[ends, plant] / weights.lasting[begins, plant])


@part
def _cell(weights: Weights, plant: int) -> tuple[int, int]:
    """Return in which cell a plant stands, across and along."""
    cell, along = weights.cells.of_plant[plant], weights.cells.shape[1]
    return cell // along, cell % along


@part
def _stand(weights: Weights, plant: int, place: int, worked: _Worked) -> None:
    """Note where the infestation at a place stands."""
    worked.across[place], worked.along[place] = _cell(weights, plant)


@part
def _came_from(weights: Weights, plant: int) -> tuple[int, int]:
    """Return a plant from which something may have come to this one, drawn by the kernel.

    And how many stand in its cell; -1: none stands there.
    """
    cells, d = weights.cells, weights.kernel.shape[0]
    across, along = cells.shape[0], cells.shape[1]
    k = np.searchsorted(weights.so_far, np.random.random())  # noqa: NPY002
    y, x = _cell(weights, plant)
    y, x = y - (k // d - d // 2), x - (k % d - d // 2)
    if k >= d * d or y < 0 or y >= across or x < 0 or x >= along:
        return NOBODY, 0
    first, end = cells.start[y * along + x], cells.start[y * along + x + 1]
    if first == end:
        return NOBODY, 0
    return int(cells.plant[np.random.randint(first, end)]), int(end - first)  # noqa: NPY002


@part
def _hang(infestations: Infestations, i: int, parent: int, worked: _Worked) -> None:
    """Give an infestation another parent."""
    before = infestations.parent[i]
    if before >= 0:
        worked.removable[0] -= _hangs_on_one(infestations, before)
        infestations.children[before] -= 1
        worked.removable[0] += _hangs_on_one(infestations, before)
    if parent >= 0:
        worked.removable[0] -= _hangs_on_one(infestations, parent)
        infestations.children[parent] += 1
        worked.removable[0] += _hangs_on_one(infestations, parent)
    infestations.parent[i] = parent


@part
def _hangs_on_one(infestations: Infestations, j: int) -> bool:
    """Tell whether an infestation is only there for a single child."""
    return bool(not infestations.found[j] and infestations.children[j] == 1)


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
def _sum_up(infestations: Infestations, season: int, worked: _Worked, drawn: DrawnSums) -> None:
    """Add an ancestry to the sums; of who is active only where that begins and ends."""
    half, at_start = drawn.jumps.shape[1] // 2, 0.0
    for i in range(infestations.plant.size):
        if not infestations.there[i]:
            continue
        plant, begins = infestations.plant[i], infestations.begins[i]
        drawn.active[begins, plant] += 1.0
        drawn.active[infestations.ends[i], plant] -= 1.0
        at_start += 1.0 if begins <= season else 0.0
        drawn.hidden[plant] += 0.0 if infestations.found[i] else 1.0
        parent = infestations.parent[i]
        if parent < 0:
            drawn.roots[begins, plant] += 1.0
            continue
        y, x = worked.across[i] - worked.across[parent], worked.along[i] - worked.along[parent]
        drawn.jumps[0 if begins <= season else 1, y + half, x + half] += 1.0
    drawn.at_start[0] += at_start
    drawn.at_start[1] += at_start**2
