"""Sections of a sprayer along the rows, and the switching of each that gains most."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import routine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


class Strips(NamedTuple):
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


def strips_of(grid: PlantGrid, rows: int) -> Strips:
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
    return Strips(first, (cells % wide) * step_m, step.astype(np.int64), begins, step_m)


@routine
def switch(
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
