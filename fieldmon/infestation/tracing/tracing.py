"""Tracing: a find speaks for the plants that it may have infested, and for those it came from."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import as_compiled, as_seen
from fieldmon.compute.jit import inlined, inner_loop, loop
from fieldmon.infestation.calibration_slope import no_inspections
from fieldmon.infestation.cells import Cells
from fieldmon.infestation.chance_bounds import bounded_chance, lesser
from fieldmon.infestation.pairs.clustering import no_evidence

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Linked

    Floats = NDArray[np.float64]

# the relative of a find is never surer than this; and what changes less is left as it is
_MOST, _LEAST = 0.9, 1e-5
# a plant that was as good as known to be infested has said so before
_KNOWN = 0.5
# a chance is rescaled where that changes it by this share
_NOTABLE = 1e-4


class Traces(NamedTuple):
    """What a day needs to trace a find.

    Parameters
    ----------
    cells
        The plants in cells.
    kernel
        ``(d, d)`` how jumps beyond neighbours are shared out over the cells about a plant, if
        insects jump; ``(1, 1)``: they are not traced.
    unseen
        ``(n,)`` how many infestations a plant would have sent out since it was seen clean.
    from_afar
        ``(n,)`` the share of each plant's chance that jumps brought.
    evidence
        ``(4,)`` of how infested plants stand, see `ClusterEstimate`.
    slope_sums
        ``(6,)`` how far differences between chances came true, see `calibration_slope`.
    """

    cells: Cells
    kernel: Floats
    unseen: Floats
    from_afar: Floats
    evidence: Floats
    slope_sums: Floats

    def __repr__(self) -> str:
        return f"<Traces on {self.cells!r}>"

    @classmethod
    def none(cls, n: int) -> Traces:
        """Return what traces nothing."""
        nothing = np.zeros(n), np.zeros(n), no_evidence(), no_inspections()
        return cls(Cells.none(), np.zeros((1, 1)), *nothing)

    def seen(self) -> Traces:
        """Return the same, whose numbers cannot be written to."""
        numbers = self._asdict()
        cells = numbers.pop("cells")
        return Traces(cells, **{name: as_seen(value) for name, value in numbers.items()})

    def own(self) -> Traces:
        """Return the same with arrays that may be changed."""
        changing = {k: getattr(self, k).copy() for k in ("unseen", "from_afar", "slope_sums")}
        fixed = {k: as_compiled(getattr(self, k)) for k in ("kernel", "evidence")}
        return self._replace(**changing, **fixed)


class Raised(NamedTuple):
    """Room for the plants that a find has raised: ``plant (n,)``, and by how much ``(n,)``."""

    plant: NDArray[np.int64]
    by: Floats

    @classmethod
    def of(cls, n: int) -> Raised:
        """Return room for `n` plants."""
        return cls(np.empty(n, np.int64), np.empty(n))


@inner_loop
def trace(
    believed: tuple[Floats, Floats],
    linked: Linked,
    traces: Traces,
    find: tuple[int, float, float],
    raised: Raised,
) -> int:
    """Raise the plants within reach of a find; return how many.

    With u for what a plant would have sent out unseen, and K for the kernel, the plant j may have
    been infested by the find i, u_j K(i to j), and the find by it, u_i K(j to i) p_j / p_i: the
    more the find was a surprise, the more its parent is looked for. `believed` is
    ``chance (n,)`` and ``pair_chance (e,)``, changed in place; `find` the plant, what its chance
    was, and the chance that insects jump.
    """
    chance, cells, kernel = believed[0], traces.cells, traces.kernel
    i, p, jumps = find
    if p > _KNOWN or kernel.size == 1:
        return 0
    across, along = cells.shape[0], cells.shape[1]
    y, x, h = cells.of_plant[i] // along, cells.of_plant[i] % along, kernel.shape[0] // 2
    n, weight = 0, jumps * (1.0 - p)
    for a in range(max(0, y - h), min(across, y + h + 1)):
        for b in range(max(0, x - h), min(along, x + h + 1)):
            to, back = kernel[a - y + h, b - x + h], kernel[y - a + h, x - b + h]
            cell = a * along + b
            for t in range(cells.start[cell], cells.start[cell + 1]):
                j = cells.plant[t]
                q = chance[j]
                parent = lesser(q / p, 1.0) * traces.unseen[i] * back
                more = lesser(weight * (traces.unseen[j] * to + parent), _MOST)
                if j == i or more < _LEAST:
                    continue
                _raise(believed, linked, j, more)
                raised.plant[n], raised.by[n] = j, chance[j] - q
                own = traces.from_afar[j] * q + raised.by[n]
                traces.from_afar[j] = own / chance[j]
                n += 1
    return n


@inlined
def _raise(believed: tuple[Floats, Floats], linked: Linked, j: int, more: float) -> None:
    """Raise a plant's chance by an infestation that concerns no other."""
    chance, pair_chance = believed
    chance[j] = bounded_chance(chance[j] + (1.0 - chance[j]) * more)
    for e in range(linked.start[j], linked.start[j + 1]):
        both = pair_chance[e] + more * (chance[linked.plant[e]] - pair_chance[e])
        pair_chance[e] = pair_chance[linked.back[e]] = both


@loop
def rescale_traced(
    believed: tuple[Floats, Floats], linked: Linked, from_afar: Floats, ratio: float
) -> None:
    """Believe in what jumps brought `ratio` times as much, all over the plot, in place."""
    chance, pair_chance = believed
    for i in range(chance.size):
        scale = 1.0 - from_afar[i] + from_afar[i] * ratio
        if abs(scale - 1.0) < _NOTABLE:
            continue
        p, q = chance[i], lesser(bounded_chance(chance[i] * scale), _MOST)
        if q > p:
            _raise(believed, linked, i, (q - p) / (1.0 - p))
        else:
            for e in range(linked.start[i], linked.start[i + 1]):
                pair_chance[e] = pair_chance[linked.back[e]] = pair_chance[e] * q / p
            chance[i] = q
        from_afar[i] *= ratio / scale
