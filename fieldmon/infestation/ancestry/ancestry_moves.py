"""The moves by which one ancestry of finds follows from another.

An infestation gets another time and parent (drawn from all that are possible); one that was not
found is put between an infestation and its parent; such a one is taken out; or it goes to another
plant, drawn from a few. The second and third are accepted as Metropolis and Hastings have it, the
last is iterated sampling importance resampling (Andrieu, Doucet & Holenstein 2010).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inner_loop
from fieldmon.infestation.ancestry.ancestry_arrays import OPEN, REMOVABLE
from fieldmon.infestation.ancestry.ancestry_children import (
    hang,
    hangs_on_one,
    is_only_child,
    join,
    list_children,
    note_removable,
)
from fieldmon.infestation.ancestry.ancestry_origins import (
    came_from,
    draw_origin,
    explained,
    of_parent,
    row_of,
    weigh,
    when_by,
)
from fieldmon.infestation.cell_squares import (
    NOBODY,
    SINCE,
    UNTIL,
    by_cells_apart,
    leave,
    stand,
)
from fieldmon.infestation.cells import cell_of, in_one_cell

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.ancestry_arrays import Weights, Worked
    from fieldmon.infestation.ancestry.infestations import Infestations

    Ints = NDArray[np.int64]

# among so many plants one that was not found goes to another
TRIED = 4


@inner_loop
def begin(infestations: Infestations, weights: Weights, worked: Worked) -> int:
    """Note where infestations stand and what may change; return how many were not found."""
    hidden = 0
    by_cells_apart(worked.squares, weights.kernel, worked.kernel)
    for i in range(infestations.plant.size):
        if infestations.there[i]:
            stand(worked.squares, weights.cells, infestations.plant[i], i)
            _date(infestations, i, infestations.begins[i], weights, worked)
            note_removable(infestations, i, worked)
            if infestations.parent[i] != NOBODY:
                join(worked, infestations.parent[i], i)
            hidden += 0 if infestations.found[i] else 1
        # as many are drawn in each sweep, however many infestations there are by then
        if not infestations.there[i] or infestations.seen[i] > weights.settled:
            worked.open[worked.many[OPEN]] = i
            worked.many[OPEN] += 1
    return hidden


@inner_loop
def move(infestations: Infestations, i: int, weights: Weights, worked: Worked) -> None:
    """Draw another beginning and parent of an infestation.

    The only child of one that was not found keeps its parent: that would be without a find.
    """
    latest = list_children(infestations, i, weights, worked)
    earliest = infestations.earliest[i]
    if latest < earliest:
        return
    when = (infestations.plant[i], earliest, latest, row_of(infestations, i, weights))
    parent, alone = infestations.parent[i], is_only_child(infestations, i)
    total = weigh(when, (i, NOBODY), weights, worked)
    if alone:
        begins = when_by(infestations, parent, when, weights, worked)
    else:
        other, begins = draw_origin(infestations, total, when, weights, worked)
        hang(infestations, i, other, worked)
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
    if is_only_child(infestations, i):
        return
    plant, many = came_from(weights, infestations.plant[i])
    if plant < 0 or at[plant] >= 0 or plant == infestations.plant[i]:
        return
    begins = infestations.begins[i]
    earliest = max(0, last_find[plant] + 1)
    latest = int(weights.grown_by[begins - 1]) if begins > 0 else -1
    if latest < earliest:
        return
    last = weights.roots.shape[1] - 1
    now = explained(infestations, i, NOBODY, weights, worked)
    when = (plant, earliest, latest, plant)
    total = weigh(when, (i, NOBODY), weights, worked)
    other, since = draw_origin(infestations, total, when, weights, worked)
    removable = worked.many[REMOVABLE] + 1
    if other != parent:
        # the one before has a child less then, and the new one's parent one more
        if parent >= 0 and not infestations.found[parent] and infestations.children[parent] == 2:
            removable += 1
        if other >= 0 and hangs_on_one(infestations, other):
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
    hang(infestations, place, other, worked)
    hang(infestations, i, place, worked)


@inner_loop
def take_out(
    infestations: Infestations, at: Ints, weights: Weights, worked: Worked, takes: float
) -> None:
    """Try to do without one that was not found and has a single child."""
    removable = worked.many[REMOVABLE]
    if removable == 0:
        return
    place = worked.removable[np.random.randint(removable)]  # noqa: NPY002
    if is_only_child(infestations, place):
        return
    list_children(infestations, place, weights, worked)
    child = worked.child[0]
    if infestations.seen[child] <= weights.settled:
        return
    begins, plant = infestations.begins[child], infestations.plant[place]
    latest = int(weights.grown_by[begins - 1])
    when = (plant, infestations.earliest[place], latest, plant)
    total = weigh(when, (place, child), weights, worked)
    now = explained(infestations, child, place, weights, worked)
    many = in_one_cell(weights.cells, plant)
    loss = weights.sends[begins - 1] * many * total * worked.many[OPEN] * takes
    if np.random.random() * loss >= now * removable:  # noqa: NPY002
        return
    when = (infestations.plant[child], begins, begins, row_of(infestations, child, weights))
    total = weigh(when, (child, place), weights, worked)
    other, _ = draw_origin(infestations, total, when, weights, worked)
    hang(infestations, child, other, worked)
    hang(infestations, place, NOBODY, worked)
    leave(worked.squares, place)
    infestations.there[place] = False
    note_removable(infestations, place, worked)
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
    latest = list_children(infestations, i, weights, worked)
    children, d = infestations.children[i], weights.kernel.shape[0]
    anchor = worked.child[np.random.randint(children)]  # noqa: NPY002
    parent, alone = infestations.parent[i], is_only_child(infestations, i)
    squares, sum_of = worked.squares, 0.0
    for k in range(TRIED):
        plant, many = came_from(weights, infestations.plant[anchor])
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
        total = weigh(when, (i, NOBODY), weights, worked)
        worked.likely[k] = likely * (of_parent(parent, worked) if alone else total)
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
    latest = list_children(infestations, i, weights, worked)
    when = (plant, max(0, last_find[plant] + 1), latest, plant)
    total = weigh(when, (i, NOBODY), weights, worked)
    if is_only_child(infestations, i):
        begins = when_by(infestations, parent, when, weights, worked)
    else:
        parent, begins = draw_origin(infestations, total, when, weights, worked)
    at[infestations.plant[i]] = NOBODY
    at[plant] = i
    infestations.plant[i], infestations.earliest[i] = plant, when[1]
    leave(worked.squares, i)
    stand(worked.squares, weights.cells, plant, i)
    _date(infestations, i, begins, weights, worked)
    hang(infestations, i, parent, worked)


@inner_loop
def _date(
    infestations: Infestations, i: int, begins: int, weights: Weights, worked: Worked
) -> None:
    """Let an infestation begin on a morning."""
    infestations.begins[i] = begins
    places = worked.squares.places
    places[i, SINCE], places[i, UNTIL] = weights.grown[begins] + 1, infestations.ends[i] + 1


@inner_loop
def _free(infestations: Infestations) -> int:
    """Return a place that is not taken, or `NOBODY`."""
    place = NOBODY
    for j in range(infestations.plant.size):
        if not infestations.there[j]:
            place = j
            break
    return place
