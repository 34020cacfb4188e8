"""Who infested whom: ancestries of the finds, drawn one after the other (Markov chain Monte Carlo).

An ancestry says of every find when its plant was infested, and from where: by a find, by a plant
that was not found, or by none. Of plants that were not found it has only those from which a find
descends; all others are summed up in `unseen_offspring`. Each follows from the one before by
`ancestry_moves`. Where one stands that was not found is summed up not as it was drawn, but by the
chances of all plants that were tried (Rao & Blackwell), so that fewer draws tell as much.

Mornings and nights are counted from the first night that is thought of; the night i lies between
the mornings i and i + 1.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_loop, routine
from fieldmon.infestation.ancestry.ancestry_arrays import OPEN, Weights, Worked
from fieldmon.infestation.ancestry.ancestry_moves import (
    TRIED,
    begin,
    go_to_one,
    move,
    put_in,
    take_out,
    try_others,
)
from fieldmon.infestation.cell_squares import NOBODY, empty_squares

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.infestations import Infestations

    Floats = NDArray[np.floating[Any]]
    Ints = NDArray[np.int64]

# in a sweep, times and parents are drawn so often for each infestation, and a parent is put in
_TIMES, _PUT_IN = 1.0, 0.5
# and for each that was not found, and so many more, it is tried so often to do without one
_TAKE_OUT, _MORE = 2.0, 4


class DrawnSums(NamedTuple):
    """Sums over the ancestries drawn.

    Parameters
    ----------
    turned
        ``(t, n)`` in how many each plant became infested by a morning, less in how many it ended.
    grown
        The same of what sends something out; empty: all do at once.
    hidden
        ``(n,)`` in how many it is infested now, unfound.
    jumps
        ``(2, d, d)`` how many jumps of each length and direction, before the season and in it.
    roots
        ``(2, n)`` how many came from none, before the season and in it.
    at_start
        ``(2,)`` how many there were on the first morning of the season, and their squares.
    """

    turned: Floats
    grown: Floats
    hidden: Floats
    jumps: Floats
    roots: Floats
    at_start: Floats

    @classmethod
    def none(cls, t: int, n: int, d: int, *, delays: bool = False) -> DrawnSums:
        """Return sums of nothing, `delays` where infestations grow before they send out others."""
        turned = np.zeros((t, n), np.float32)
        grown = np.zeros((t, n) if delays else (0, n), np.float32)
        return cls(turned, grown, np.zeros(n), np.zeros((2, d, d)), np.zeros((2, n)), np.zeros(2))

    @property
    def there(self) -> Floats:
        """In how many each plant was infested on a morning, ``(t, n)``."""
        return _running(self.turned)

    @property
    def active(self) -> Floats | None:
        """In how many each plant sent something out in a night, ``(t, n)``; None: as `there`."""
        return _running(self.grown) if len(self.grown) else None

    def __repr__(self) -> str:
        return f"<Drawn: {self.jumps.sum():.0f} jumps>"


def _running(turned: Floats) -> Floats:
    running = turned.copy()
    for before, row in pairwise(running):
        np.add(before, row, out=row)
    return running


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
    mornings, places = weights.roots.shape[1], infestations.plant.size
    squares = empty_squares(weights.cells, places, weights.kernel.shape[0] // 2)
    worked = Worked(
        np.zeros(squares.width**2), np.zeros(mornings + 1), np.zeros(mornings + 1),
        np.zeros(places, np.int64), np.empty(places), squares,
        np.zeros(places, np.int64), np.full(places, -1), np.zeros(places, np.int64),
        np.zeros(TRIED, np.int64), np.zeros(TRIED), np.zeros(places, np.int64),
        np.full(places, NOBODY), np.full((2, places), NOBODY), np.zeros(3, np.int64),
    )  # fmt: skip
    hidden = begin(infestations, weights, worked)
    # how often one is taken out, over how often one is put in
    takes = _TAKE_OUT * (hidden + _MORE) / (_PUT_IN * max(worked.many[OPEN], 1))
    found_at = at, last_find
    for sweep in range(sweeps):
        _sweep(infestations, found_at, weights, worked, takes)
        counts = 1.0 if sweep >= left_out else 0.0
        _go_elsewhere(infestations, found_at, weights, worked, counts, drawn.hidden)
        if sweep >= left_out:
            _sum_up(infestations, weights, worked, drawn)
    return max(sweeps - left_out, 0)


@inner_loop
def _sweep(
    infestations: Infestations,
    found_at: tuple[Ints, Ints],
    weights: Weights,
    worked: Worked,
    takes: float,
) -> None:
    """Try the first three moves, so often for each place."""
    moves, places = _TIMES + _PUT_IN * (1.0 + takes), worked.many[OPEN]
    for _ in range(int(moves * places)):
        i = worked.open[np.random.randint(places)]  # noqa: NPY002
        kind = np.random.random() * moves  # noqa: NPY002
        if kind >= _TIMES + _PUT_IN:
            take_out(infestations, found_at[0], weights, worked, takes)
        elif not infestations.there[i]:
            continue
        elif kind < _TIMES:
            move(infestations, i, weights, worked)
        else:
            put_in(infestations, i, found_at, weights, worked, takes)


@inner_loop
def _go_elsewhere(
    infestations: Infestations,
    found_at: tuple[Ints, Ints],
    weights: Weights,
    worked: Worked,
    counts: float,
    hidden: Floats,
) -> None:
    """Let each that was not found go to another plant, and add where it may be to `hidden`."""
    for i in range(infestations.plant.size):
        if infestations.there[i] and not infestations.found[i]:
            total = try_others(infestations, i, found_at, weights, worked)
            for k in range(TRIED):
                if worked.likely[k] > 0.0:
                    hidden[worked.tried[k]] += counts * worked.likely[k] / total
            go_to_one(infestations, i, found_at, weights, worked, total)


@inner_loop
def _sum_up(infestations: Infestations, weights: Weights, worked: Worked, drawn: DrawnSums) -> None:
    """Add an ancestry to the sums."""
    season = weights.season
    half, at_start, squares = drawn.jumps.shape[1] // 2, 0.0, worked.squares
    for i in range(infestations.plant.size):
        if not infestations.there[i]:
            continue
        plant, begins = infestations.plant[i], infestations.begins[i]
        drawn.turned[begins, plant] += 1.0
        drawn.turned[infestations.ends[i], plant] -= 1.0
        if drawn.grown.shape[0] > 0 and weights.grown[begins] < infestations.ends[i]:
            drawn.grown[weights.grown[begins], plant] += 1.0
            drawn.grown[infestations.ends[i], plant] -= 1.0
        at_start += 1.0 if begins <= season else 0.0
        parent, in_season = infestations.parent[i], 0 if begins <= season else 1
        if parent < 0:
            drawn.roots[in_season, plant] += 1.0
            continue
        y, x = squares.across[i] - squares.across[parent], squares.along[i] - squares.along[parent]
        # of one that stays as it is, the wind may have been stronger than it is now
        if max(abs(y), abs(x)) <= half:
            drawn.jumps[in_season, y + half, x + half] += 1.0
    drawn.at_start[0] += at_start
    drawn.at_start[1] += at_start**2
