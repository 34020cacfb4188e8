"""What compiled loops are handed that draw ancestries."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.cell_squares import Squares
    from fieldmon.infestation.cells import Cells

    Floats = NDArray[np.floating[Any]]
    Ints = NDArray[np.int64]

#: what `Worked.many` counts
REMOVABLE, NEAR, OPEN = range(3)


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
        ``(t,)`` as `fieldmon.infestation.ancestry.infestation_course.Course` has them.
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
