"""Where an infestation of an ancestry may come from, and when: weighed, and drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import inner_loop
from fieldmon.infestation.ancestry.ancestry_arrays import NEAR
from fieldmon.infestation.cell_squares import AFTER, CELL, NOBODY, SINCE, UNTIL, within
from fieldmon.infestation.cells import cell_of

if TYPE_CHECKING:
    from fieldmon.infestation.ancestry.ancestry_arrays import Weights, Worked
    from fieldmon.infestation.ancestry.infestations import Infestations


@inner_loop
def weigh(
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
    worked.many[NEAR] = near
    return float(total + by_none[latest + 1])


@inner_loop
def of_parent(parent: int, worked: Worked) -> float:
    """Return how much of what was weighed is due to one parent."""
    of = before = 0.0
    for k in range(worked.many[NEAR]):
        if worked.near[k] == parent:
            of = worked.so_far[k] - before
            break
        before = worked.so_far[k]
    return of


@inner_loop
def draw_origin(
    infestations: Infestations,
    total: float,
    when: tuple[int, int, int, int],
    weights: Weights,
    worked: Worked,
) -> tuple[int, int]:
    """Return a parent and a beginning, drawn from what was weighed."""
    earliest, latest = when[1:3]
    u, near = np.random.random() * total, worked.many[NEAR]  # noqa: NPY002
    if near > 0 and u < worked.so_far[near - 1]:
        k = 0
        while worked.so_far[k] <= u:
            k += 1
        parent = int(worked.near[k])
        return parent, when_by(infestations, parent, when, weights, worked)
    u = np.random.random() * worked.by_none[latest + 1]  # noqa: NPY002
    begins = earliest
    while begins < latest and worked.by_none[begins + 1] <= u:
        begins += 1
    return NOBODY, begins


@inner_loop
def when_by(
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
def explained(
    infestations: Infestations, i: int, without: int, weights: Weights, worked: Worked
) -> float:
    """Return how well an infestation that begins when it does is explained by all others."""
    begins, row = infestations.begins[i], row_of(infestations, i, weights)
    when = (infestations.plant[i], begins, begins, row)
    total = weigh(when, (i, without), weights, worked)
    return float(total / weights.lasting[row, begins])


@inner_loop
def row_of(infestations: Infestations, i: int, weights: Weights) -> int:
    """Return the line of an infestation in `Weights.lasting`."""
    plant = int(infestations.plant[i])
    return weights.roots.shape[0] + i if infestations.found[i] else plant


@inner_loop
def came_from(weights: Weights, plant: int) -> tuple[int, int]:
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
