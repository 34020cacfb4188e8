"""The moves by which one ancestry of finds follows from another.

An infestation gets another time and parent (drawn from all that are possible); one that was not
found is put between an infestation and its parent; such a one is taken out; or it goes to another
plant, drawn from a few. The second and third are accepted as Metropolis and Hastings have it, the
last is iterated sampling importance resampling (Andrieu, Doucet & Holenstein 2010).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_loop
from fieldmon.infestation.cell_squares import (
    AFTER,
    CELL,
    NOBODY,
    SINCE,
    UNTIL,
    Squares,
    by_cells_apart,
    leave,
    stand,
    within,
)
from fieldmon.infestation.cells import cell_of, in_one_cell

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.cells import Cells
    from fieldmon.infestation.infestations import Infestations

    Floats = NDArray[np.floating[Any]]
    Ints = NDArray[np.int64]

# among so many plants one that was not found goes to another
TRIED = 4


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
        ``(n, t)`` how many infestations come to a plant from none, by the morning on which they
        begin.
    season, settled
        The first morning of the season, and that until which infestations were found that stay as
        they are.
    grown, grown_by
        ``(t,)`` as `fieldmon.infestation.infestation_course.Course` has them.
    lasting
        ``(n + m, t)`` how likely it is that an infestation that begins on a morning goes on to its
        end as it was seen, if it sends out only what the ancestry has: of one that was not found at
        each plant, and of each place's find. Only ratios count.
    """

    cells: Cells
    kernel: Floats
    so_far: Floats
    sends: Floats
    roots: Floats
    season: int
    settled: int
    grown: Ints
    grown_by: Ints
    lasting: Floats


class Worked(NamedTuple):
    """What is worked out on the way, and again at each move.

    Parameters
    ----------
    kernel
        The weights' by how far apart two cells are by their numbers, see `by_cells_apart`.
    by_parent, by_none
        What explains an infestation, as running sums over mornings: by a parent, and by none.
    near, so_far
        Its possible parents, and the same as a running sum over them.
    squares
        Where infestations stand.
    removable, rank
        The places that were not found and have a single child, and where each is in that list;
        -1: it is not.
    child
        The children of one.
    tried, likely
        Plants to which one may go, and how likely.
    open
        The places that are free, or where what stands there may change.
    first_child, siblings
        A child of each place, and ``(2, places)`` the next child of the same parent and the one
        before; `NOBODY`: there is none.
    many
        ``(3,)`` how many are removable, were near, and are open.
    """

    kernel: Floats
    by_parent: Floats
    by_none: Floats
    near: Ints
    so_far: Floats
    squares: Squares
    removable: Ints
    rank: Ints
    child: Ints
    tried: Ints
    likely: Floats
    open: Ints
    first_child: Ints
    siblings: Ints
    many: Ints


_REMOVABLE, _NEAR, OPEN = range(3)


@inner_loop
def begin(infestations: Infestations, weights: Weights, worked: Worked) -> int:
    """Note where infestations stand and what may change; return how many were not found."""
    hidden = 0
    by_cells_apart(worked.squares, weights.kernel, worked.kernel)
    for i in range(infestations.plant.size):
        if infestations.there[i]:
            stand(worked.squares, weights.cells, infestations.plant[i], i)
            _date(infestations, i, infestations.begins[i], weights, worked)
            _note_removable(infestations, i, worked)
            if infestations.parent[i] != NOBODY:
                _join(worked, infestations.parent[i], i)
            hidden += 0 if infestations.found[i] else 1
        # as many are drawn in each sweep, however many infestations there are by then
        if not infestations.there[i] or infestations.seen[i] > weights.settled:
            worked.open[worked.many[OPEN]] = i
            worked.many[OPEN] += 1
    return hidden


@inner_loop
def _children(infestations: Infestations, i: int, weights: Weights, worked: Worked) -> int:
    """List the children of an infestation; return the last morning on which it may have begun."""
    latest, k, j = int(infestations.seen[i]), 0, worked.first_child[i]
    while j != NOBODY:
        worked.child[k] = j
        latest = min(latest, int(weights.grown_by[infestations.begins[j] - 1]))
        k += 1
        j = worked.siblings[0, j]
    return latest


@inner_loop
def move(infestations: Infestations, i: int, weights: Weights, worked: Worked) -> None:
    """Draw another beginning and parent of an infestation.

    The only child of one that was not found keeps its parent: that would be without a find.
    """
    latest = _children(infestations, i, weights, worked)
    earliest = infestations.earliest[i]
    if latest < earliest:
        return
    when = (infestations.plant[i], earliest, latest, _row(infestations, i, weights))
    parent, alone = infestations.parent[i], _only_child(infestations, i)
    total = _weigh(when, (i, NOBODY), weights, worked)
    if alone:
        begins = _when_by(infestations, parent, when, weights, worked)
    else:
        other, begins = _draw_origin(infestations, total, when, weights, worked)
        _hang(infestations, i, other, worked)
    _date(infestations, i, begins, weights, worked)


@inner_loop
def put_in(
    infestations: Infestations,
    i: int,
    found_at: tuple[Ints, Ints],
    weights: Weights,
    worked: Worked,
    takes: float,
) -> None:
    """Try one that was not found as the parent of an infestation."""
    at, last_find = found_at
    parent = infestations.parent[i]
    if _only_child(infestations, i):
        return
    plant, many = _came_from(weights, infestations.plant[i])
    if plant < 0 or at[plant] >= 0 or plant == infestations.plant[i]:
        return
    begins = infestations.begins[i]
    earliest = max(0, last_find[plant] + 1)
    latest = int(weights.grown_by[begins - 1]) if begins > 0 else -1
    if latest < earliest:
        return
    last = weights.roots.shape[1] - 1
    now = _explained(infestations, i, NOBODY, weights, worked)
    when = (plant, earliest, latest, plant)
    total = _weigh(when, (i, NOBODY), weights, worked)
    other, since = _draw_origin(infestations, total, when, weights, worked)
    removable = worked.many[_REMOVABLE] + 1
    if other != parent:
        # the one before has a child less then, and the new one's parent one more
        if parent >= 0 and not infestations.found[parent] and infestations.children[parent] == 2:
            removable += 1
        if other >= 0 and _hangs_on_one(infestations, other):
            removable -= 1
    # each open place is drawn as often, taken or not
    gain = weights.sends[begins - 1] * many * total * worked.many[OPEN] * takes
    if np.random.random() * now * removable >= gain:  # noqa: NPY002
        return
    place = _free(infestations)
    if place < 0:
        return
    infestations.plant[place] = plant
    infestations.ends[place] = infestations.seen[place] = last
    infestations.earliest[place] = earliest
    infestations.found[place], infestations.there[place] = False, True
    infestations.parent[place], infestations.children[place] = NOBODY, 0
    stand(worked.squares, weights.cells, plant, place)
    _date(infestations, place, since, weights, worked)
    at[plant] = place
    _hang(infestations, place, other, worked)
    _hang(infestations, i, place, worked)


@inner_loop
def take_out(
    infestations: Infestations, at: Ints, weights: Weights, worked: Worked, takes: float
) -> None:
    """Try to do without one that was not found and has a single child."""
    removable = worked.many[_REMOVABLE]
    if removable == 0:
        return
    place = worked.removable[np.random.randint(removable)]  # noqa: NPY002
    if _only_child(infestations, place):
        return
    _children(infestations, place, weights, worked)
    child = worked.child[0]
    if infestations.seen[child] <= weights.settled:
        return
    begins, plant = infestations.begins[child], infestations.plant[place]
    latest = int(weights.grown_by[begins - 1])
    when = (plant, infestations.earliest[place], latest, plant)
    total = _weigh(when, (place, child), weights, worked)
    now = _explained(infestations, child, place, weights, worked)
    many = in_one_cell(weights.cells, plant)
    loss = weights.sends[begins - 1] * many * total * worked.many[OPEN] * takes
    if np.random.random() * loss >= now * removable:  # noqa: NPY002
        return
    when = (infestations.plant[child], begins, begins, _row(infestations, child, weights))
    total = _weigh(when, (child, place), weights, worked)
    other, _ = _draw_origin(infestations, total, when, weights, worked)
    _hang(infestations, child, other, worked)
    _hang(infestations, place, NOBODY, worked)
    leave(worked.squares, place)
    infestations.there[place] = False
    _note_removable(infestations, place, worked)
    at[plant] = NOBODY


@inner_loop
def try_others(
    infestations: Infestations,
    i: int,
    found_at: tuple[Ints, Ints],
    weights: Weights,
    worked: Worked,
) -> float:
    """Weigh the plants at which one that was not found may stand; return the sum.

    The first is where it is, the others are drawn as where one of its children came from.
    """
    at, last_find = found_at
    latest = _children(infestations, i, weights, worked)
    children, d = infestations.children[i], weights.kernel.shape[0]
    anchor = worked.child[np.random.randint(children)]  # noqa: NPY002
    parent, alone = infestations.parent[i], _only_child(infestations, i)
    squares, sum_of = worked.squares, 0.0
    for k in range(TRIED):
        plant, many = _came_from(weights, infestations.plant[anchor])
        if k == 0:
            plant = infestations.plant[i]
            many = in_one_cell(weights.cells, plant)
        worked.tried[k], worked.likely[k] = plant, 0.0
        if plant < 0 or (k > 0 and at[plant] >= 0) or last_find[plant] >= latest:
            continue
        y, x = cell_of(weights.cells, plant)
        likely = float(many)
        for c in range(children):
            j = worked.child[c]
            if j != anchor:
                across, along = squares.across[j] - y + d // 2, squares.along[j] - x + d // 2
                inside = 0 <= across < d and 0 <= along < d
                likely *= weights.kernel[across, along] if inside else 0.0
        if likely == 0.0:
            continue
        when = (plant, max(0, last_find[plant] + 1), latest, plant)
        total = _weigh(when, (i, NOBODY), weights, worked)
        worked.likely[k] = likely * (_of_parent(parent, worked) if alone else total)
        sum_of += worked.likely[k]
    return sum_of


@inner_loop
def go_to_one(
    infestations: Infestations,
    i: int,
    found_at: tuple[Ints, Ints],
    weights: Weights,
    worked: Worked,
    tried: float,
) -> None:
    """Draw one of the plants that were weighed for one that was not found."""
    at, last_find = found_at
    u, k = np.random.random() * tried, 0  # noqa: NPY002
    while k < TRIED - 1 and worked.likely[k] <= u:
        u -= worked.likely[k]
        k += 1
    if k == 0 or worked.likely[k] <= 0.0:
        return
    plant, parent = worked.tried[k], infestations.parent[i]
    latest = _children(infestations, i, weights, worked)
    when = (plant, max(0, last_find[plant] + 1), latest, plant)
    total = _weigh(when, (i, NOBODY), weights, worked)
    if _only_child(infestations, i):
        begins = _when_by(infestations, parent, when, weights, worked)
    else:
        parent, begins = _draw_origin(infestations, total, when, weights, worked)
    at[infestations.plant[i]] = NOBODY
    at[plant] = i
    infestations.plant[i], infestations.earliest[i] = plant, when[1]
    leave(worked.squares, i)
    stand(worked.squares, weights.cells, plant, i)
    _date(infestations, i, begins, weights, worked)
    _hang(infestations, i, parent, worked)


@inner_loop
def _weigh(
    when: tuple[int, int, int, int],
    without: tuple[int, int],
    weights: Weights,
    worked: Worked,
) -> float:
    """Weigh all origins of an infestation; return their sum.

    `when` is its plant, the first and the last morning on which it may begin, and its line in
    `Weights.lasting`; `without` are two infestations from which it does not come.
    """
    plant, earliest, latest, row = when
    by_parent, by_none, places = worked.by_parent, worked.by_none, worked.squares.places
    by_parent[: earliest + 1] = by_none[: earliest + 1] = 0.0
    for begins in range(earliest, latest + 1):
        lasts = weights.lasting[row, begins]
        sends = weights.sends[begins - 1] if begins > 0 else 0.0
        by_parent[begins + 1] = by_parent[begins] + lasts * sends
        by_none[begins + 1] = by_none[begins] + lasts * weights.roots[plant, begins]
    by_parent[latest + 2 :] = by_parent[latest + 1]
    y, x = cell_of(weights.cells, plant)
    middle = y * worked.squares.width + x + worked.kernel.size // 2
    total, near = 0.0, 0
    begin_y, end_y, begin_x, end_x = within(worked.squares, y, x, weights.kernel.shape[0] // 2)
    for square_y in range(begin_y, end_y):
        for square_x in range(begin_x, end_x):
            j = worked.squares.first[square_y, square_x]
            while j != NOBODY:
                times = by_parent[places[j, UNTIL]] - by_parent[places[j, SINCE]]
                if j == without[0] or j == without[1]:
                    times = 0.0
                weight = max(times, 0.0) * worked.kernel[middle - places[j, CELL]]
                total += weight
                worked.near[near], worked.so_far[near] = j, total
                near += 1 if weight > 0.0 else 0
                j = places[j, AFTER]
    worked.many[_NEAR] = near
    return float(total + by_none[latest + 1])


@inner_loop
def _of_parent(parent: int, worked: Worked) -> float:
    """Return how much of what was weighed is due to one parent."""
    of = before = 0.0
    for k in range(worked.many[_NEAR]):
        if worked.near[k] == parent:
            of = worked.so_far[k] - before
            break
        before = worked.so_far[k]
    return of


@inner_loop
def _draw_origin(
    infestations: Infestations,
    total: float,
    when: tuple[int, int, int, int],
    weights: Weights,
    worked: Worked,
) -> tuple[int, int]:
    """Return a parent and a beginning, drawn from what was weighed."""
    earliest, latest = when[1:3]
    u, near = np.random.random() * total, worked.many[_NEAR]  # noqa: NPY002
    if near > 0 and u < worked.so_far[near - 1]:
        k = 0
        while worked.so_far[k] <= u:
            k += 1
        parent = int(worked.near[k])
        return parent, _when_by(infestations, parent, when, weights, worked)
    u = np.random.random() * worked.by_none[latest + 1]  # noqa: NPY002
    begins = earliest
    while begins < latest and worked.by_none[begins + 1] <= u:
        begins += 1
    return NOBODY, begins


@inner_loop
def _when_by(
    infestations: Infestations,
    parent: int,
    when: tuple[int, int, int, int],
    weights: Weights,
    worked: Worked,
) -> int:
    """Return when an infestation by this parent began, drawn from what was weighed."""
    _, earliest, latest, _ = when
    first = max(weights.grown[infestations.begins[parent]] + 1, earliest)
    last = min(infestations.ends[parent], latest)
    low, high = worked.by_parent[first], worked.by_parent[last + 1]
    u = low + np.random.random() * (high - low)  # noqa: NPY002
    begins = first
    while begins < last and worked.by_parent[begins + 1] <= u:
        begins += 1
    return int(begins)


@inner_loop
def _date(
    infestations: Infestations, i: int, begins: int, weights: Weights, worked: Worked
) -> None:
    """Let an infestation begin on a morning."""
    infestations.begins[i] = begins
    places = worked.squares.places
    places[i, SINCE], places[i, UNTIL] = weights.grown[begins] + 1, infestations.ends[i] + 1


@inner_loop
def _explained(
    infestations: Infestations, i: int, without: int, weights: Weights, worked: Worked
) -> float:
    """Return how well an infestation that begins when it does is explained by all others."""
    begins, row = infestations.begins[i], _row(infestations, i, weights)
    when = (infestations.plant[i], begins, begins, row)
    total = _weigh(when, (i, without), weights, worked)
    return float(total / weights.lasting[row, begins])


@inner_loop
def _row(infestations: Infestations, i: int, weights: Weights) -> int:
    """Return the line of an infestation in `Weights.lasting`."""
    plant = int(infestations.plant[i])
    return weights.roots.shape[0] + i if infestations.found[i] else plant


@inner_loop
def _came_from(weights: Weights, plant: int) -> tuple[int, int]:
    """Return a plant from which something may have come to this one, drawn by the kernel.

    And how many stand in its cell; -1: none stands there.
    """
    cells, d = weights.cells, weights.kernel.shape[0]
    across, along = cells.shape[0], cells.shape[1]
    k = np.searchsorted(weights.so_far, np.random.random())  # noqa: NPY002
    y, x = cell_of(weights.cells, plant)
    y, x = y - (k // d - d // 2), x - (k % d - d // 2)
    if k >= d * d or y < 0 or y >= across or x < 0 or x >= along:
        return NOBODY, 0
    first, end = cells.start[y * along + x], cells.start[y * along + x + 1]
    if first == end:
        return NOBODY, 0
    return int(cells.plant[np.random.randint(first, end)]), int(end - first)  # noqa: NPY002


@inner_loop
def _hang(infestations: Infestations, i: int, parent: int, worked: Worked) -> None:
    """Give an infestation another parent."""
    before = infestations.parent[i]
    if parent == before:
        return
    infestations.parent[i] = parent
    if before >= 0:
        _part_with(worked, before, i)
        infestations.children[before] -= 1
        _note_removable(infestations, before, worked)
    if parent >= 0:
        _join(worked, parent, i)
        infestations.children[parent] += 1
        _note_removable(infestations, parent, worked)


@inner_loop
def _join(worked: Worked, parent: int, i: int) -> None:
    """Put an infestation before the other children of a parent."""
    after = worked.first_child[parent]
    worked.siblings[0, i], worked.siblings[1, i] = after, NOBODY
    if after != NOBODY:
        worked.siblings[1, after] = i
    worked.first_child[parent] = i


@inner_loop
def _part_with(worked: Worked, parent: int, i: int) -> None:
    """Take an infestation from the children of its parent."""
    after, before = worked.siblings[0, i], worked.siblings[1, i]
    if before == NOBODY:
        worked.first_child[parent] = after
    else:
        worked.siblings[0, before] = after
    if after != NOBODY:
        worked.siblings[1, after] = before


@inner_loop
def _note_removable(infestations: Infestations, j: int, worked: Worked) -> None:
    """Keep the list of those that are only there for a single child."""
    many, rank = worked.many[_REMOVABLE], worked.rank[j]
    removable = infestations.there[j] and _hangs_on_one(infestations, j)
    if removable and rank < 0:
        worked.removable[many], worked.rank[j] = j, many
        worked.many[_REMOVABLE] = many + 1
    elif not removable and rank >= 0:
        last = worked.removable[many - 1]
        worked.removable[rank], worked.rank[last] = last, rank
        worked.rank[j] = -1
        worked.many[_REMOVABLE] = many - 1


@inner_loop
def _hangs_on_one(infestations: Infestations, j: int) -> bool:
    """Tell whether an infestation is only there for a single child."""
    return bool(not infestations.found[j] and infestations.children[j] == 1)


@inner_loop
def _only_child(infestations: Infestations, i: int) -> bool:
    """Tell whether an infestation is all that its parent is there for."""
    parent = infestations.parent[i]
    return bool(parent >= 0 and _hangs_on_one(infestations, parent))


@inner_loop
def _free(infestations: Infestations) -> int:
    """Return a place that is not taken, or `NOBODY`."""
    place = NOBODY
    for j in range(infestations.plant.size):
        if not infestations.there[j]:
            place = j
            break
    return place
