"""Ancestries are drawn as often as they are likely: compared with all that there are."""

from itertools import product

import numpy as np
import pytest

from fieldmon.infestation.ancestry.ancestry_arrays import Weights
from fieldmon.infestation.ancestry.drawn_ancestry import (
    DrawnSums,
    draw_ancestries,
)
from fieldmon.infestation.ancestry.infestations import Infestations
from fieldmon.infestation.cell_squares import NOBODY
from fieldmon.infestation.insects.jump_landing import landing_of
from fieldmon.plot.layout import rectangle

ROW = rectangle(1, 4)
N, MORNINGS, PLACES = len(ROW), 4, 8
SEASON = 1


def believed(seed=0, grown=(0, 1, 2, 3)):
    """Return what some ancestries are weighed by, in which all may come from each other."""
    rng = np.random.default_rng(seed)
    landing = landing_of(ROW)
    kernel = np.einsum("k,kij->ij", rng.dirichlet(np.ones(8)), landing.kernels)
    kernel /= kernel.sum()
    sends = rng.uniform(0.5, 3.0, MORNINGS)
    lasting = rng.uniform(0.2, 1.0, (N + PLACES, MORNINGS)).astype(np.float32)
    roots = rng.uniform(0.01, 0.3, (N, MORNINGS)).astype(np.float32)
    grown = np.array(grown)
    grown_by = np.searchsorted(grown, np.arange(MORNINGS), side="right") - 1
    return Weights(
        landing.cells, kernel, np.cumsum(kernel), sends, roots, SEASON, -1, grown, grown_by, lasting
    )


def with_finds(finds, *, left=False):
    """Return infestations that were found at plants on mornings, and where others may not be.

    They end by that, or are `left` to go on.
    """
    made = Infestations.empty(PLACES)
    for place, (plant, morning) in enumerate(finds):
        made.plant[place], made.seen[place] = plant, morning
        made.ends[place] = MORNINGS - 1 if left else morning
        made.begins[place], made.found[place], made.there[place] = morning, True, True
    last_find = np.full(N, -1)
    for plant, morning in finds:
        last_find[plant] = morning
    return made, last_find


def jump(world, sender, plant):
    """Return how much lands on a plant of the row of what another sends."""
    half = len(world.kernel) // 2
    along = world.cells.of_plant[plant] - world.cells.of_plant[sender]
    return world.kernel[half, half + along]


def all_ancestries(world, finds, last_find, *, left=False):
    """Yield all ancestries as (weight, nodes), a node being (plant, begins, ends, parent)."""
    last = MORNINGS - 1
    taken = {p for p, _ in finds} if left else set()
    hidden = [p for p in range(N) if last_find[p] + 1 <= last and p not in taken]
    for there in product([False, True], repeat=len(hidden)):
        ends = [(p, 0, last if left else e) for p, e in finds]
        seen = [e for _, e in finds]
        ends += [(p, last_find[p] + 1, last) for p, on in zip(hidden, there, strict=True) if on]
        seen += [last] * sum(there)
        for begins in product(
            *(range(low, e + 1) for (_, low, _), e in zip(ends, seen, strict=True))
        ):
            choices = [
                [NOBODY]
                + [
                    j
                    for j, b in enumerate(begins)
                    if j != i and world.grown[b] < begins[i] <= ends[j][2]
                ]
                for i in range(len(ends))
            ]
            for parents in product(*choices):
                if any(i not in parents for i in range(len(finds), len(ends))):
                    continue
                weight = 1.0
                for k, ((plant, *_), b, parent) in enumerate(
                    zip(ends, begins, parents, strict=True)
                ):
                    weight *= world.lasting[N + k if k < len(finds) else plant, b]
                    if parent == NOBODY:
                        weight *= world.roots[plant, b]
                    else:
                        weight *= world.sends[b - 1] * jump(world, ends[parent][0], plant)
                yield (
                    weight,
                    [
                        (plant, b, end, parent)
                        for (plant, _, end), b, parent in zip(ends, begins, parents, strict=True)
                    ],
                )


@pytest.mark.parametrize("grown", [(0, 1, 2, 3), (0, 2, 3, 3)])
@pytest.mark.parametrize(
    ("finds", "left"),
    [
        ([(0, 3)], False), ([(1, 2)], False), ([(0, 3), (2, 2)], False),
        ([(1, 1), (1, 3), (3, 3)], False), ([(1, 1)], True), ([(0, 1), (2, 2)], True),
    ],
)  # fmt: skip
def test_ancestries_are_drawn_as_often_as_they_are_likely(finds, left, grown):
    """Four moves that fit together: each sum is that over all ancestries there are."""
    world = believed(len(finds), grown)
    delays = grown != (0, 1, 2, 3)
    made, last_find = with_finds(finds, left=left)
    at = np.full(N, NOBODY)
    if left:
        at[made.plant[made.there]] = np.flatnonzero(made.there)
    if finds[0][0] == finds[-2 % len(finds)][0] and len(finds) == 3:
        made.earliest[1] = made.ends[0] + 1
    there, active = np.zeros((2, MORNINGS, N))
    hidden, roots = np.zeros(N), np.zeros((2, N))
    total = 0.0
    for weight, nodes in all_ancestries(world, finds, last_find, left=left):
        if len(finds) == 3 and nodes[1][1] <= finds[0][1]:
            continue  # the plant was found before
        total += weight
        for k, (plant, begins, end, parent) in enumerate(nodes):
            there[begins:end, plant] += weight
            active[world.grown[begins] : end, plant] += weight
            hidden[plant] += weight * (k >= len(finds))
            roots[int(begins > SEASON), plant] += weight * (parent == NOBODY)
    drawn = DrawnSums.none(MORNINGS, N, len(world.kernel), delays=delays)
    kept = draw_ancestries(made, at, world, last_find, (1, 100_000, 1_000), drawn)
    assert kept == 99_000
    assert drawn.hidden / kept == pytest.approx(hidden / total, abs=0.015)
    assert drawn.there / kept == pytest.approx(there / total, abs=0.02)
    assert (drawn.active is not None) == delays
    if drawn.active is not None:
        assert drawn.active / kept == pytest.approx(active / total, abs=0.02)
    assert drawn.roots / kept == pytest.approx(roots / total, abs=0.02)
    # whatever does not come from none has jumped
    assert drawn.jumps.sum() + drawn.roots.sum() == pytest.approx(
        kept * len(finds) + drawn.hidden.sum()
    )


def test_a_jump_from_before_the_wind_dropped_is_counted_in_no_other_cell():
    """It stays as it was drawn; what lay beyond the kernel was written beyond its array."""
    row = rectangle(1, 40)
    landing, mornings = landing_of(row), 16
    kernel = np.einsum("k,kij->ij", np.full(8, 0.125), landing.kernels)
    made = Infestations.empty(8)
    for place, (plant, begins, ends) in enumerate([(0, 0, 3), (30, 2, 3)]):
        made.plant[place], made.begins[place], made.ends[place] = plant, begins, ends
        made.found[place] = made.there[place] = True
        made.seen[place] = ends
    made.parent[1], made.children[0] = 0, 1
    grown = np.arange(mornings)
    world = Weights(
        landing.cells, kernel, np.cumsum(kernel) / kernel.sum(), np.full(mornings, 0.3),
        np.full((40, mornings), 1e-3, np.float32), 2, mornings - 2, grown, grown,
        np.ones((48, mornings), np.float32),
    )  # fmt: skip
    last_find = np.where(np.isin(np.arange(40), [0, 30]), 3, -1)
    drawn = DrawnSums.none(mornings, 40, len(kernel))
    kept = draw_ancestries(made, np.full(40, NOBODY), world, last_find, (1, 20, 2), drawn)
    assert made.parent[1] == 0
    assert drawn.jumps.sum() == 0.0
    assert drawn.roots.sum() == kept
