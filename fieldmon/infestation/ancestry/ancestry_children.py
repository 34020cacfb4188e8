"""Who hangs on whom in an ancestry, and which infestations are only there for a single child."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.jit import inner_loop
from fieldmon.infestation.ancestry.ancestry_arrays import REMOVABLE
from fieldmon.infestation.cell_squares import NOBODY

if TYPE_CHECKING:
    from fieldmon.infestation.ancestry.ancestry_arrays import Weights, Worked
    from fieldmon.infestation.ancestry.infestations import Infestations


@inner_loop
def list_children(infestations: Infestations, i: int, weights: Weights, worked: Worked) -> int:
    """List the children of an infestation; return the last morning on which it may have begun."""
    latest, k, j = int(infestations.seen[i]), 0, worked.first_child[i]
    while j != NOBODY:
        worked.child[k] = j
        latest = min(latest, int(weights.grown_by[infestations.begins[j] - 1]))
        k += 1
        j = worked.siblings[0, j]
    return latest


@inner_loop
def hang(infestations: Infestations, i: int, parent: int, worked: Worked) -> None:
    """Give an infestation another parent."""
    before = infestations.parent[i]
    if parent == before:
        return
    infestations.parent[i] = parent
    if before >= 0:
        _part_with(worked, before, i)
        infestations.children[before] -= 1
        note_removable(infestations, before, worked)
    if parent >= 0:
        join(worked, parent, i)
        infestations.children[parent] += 1
        note_removable(infestations, parent, worked)


@inner_loop
def join(worked: Worked, parent: int, i: int) -> None:
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
def note_removable(infestations: Infestations, j: int, worked: Worked) -> None:
    """Keep the list of those that are only there for a single child."""
    many, rank = worked.many[REMOVABLE], worked.rank[j]
    removable = infestations.there[j] and hangs_on_one(infestations, j)
    if removable and rank < 0:
        worked.removable[many], worked.rank[j] = j, many
        worked.many[REMOVABLE] = many + 1
    elif not removable and rank >= 0:
        last = worked.removable[many - 1]
        worked.removable[rank], worked.rank[last] = last, rank
        worked.rank[j] = -1
        worked.many[REMOVABLE] = many - 1


@inner_loop
def hangs_on_one(infestations: Infestations, j: int) -> bool:
    """Tell whether an infestation is only there for a single child."""
    return bool(not infestations.found[j] and infestations.children[j] == 1)


@inner_loop
def is_only_child(infestations: Infestations, i: int) -> bool:
    """Tell whether an infestation is all that its parent is there for."""
    parent = infestations.parent[i]
    return bool(parent >= 0 and hangs_on_one(infestations, parent))
