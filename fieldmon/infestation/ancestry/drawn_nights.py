"""Nights that were drawn of late: who asks for one of them again need not wait.

Drawing who infested whom takes most of a night. The evening in hindsight and the morning after it
are told by the same draws; so is a season that is opened again, changed on a later day, or undone.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from fieldmon.compute.arrays import read_only
from fieldmon.compute.digest import digest, places_by_name
from fieldmon.infestation.ancestry.ancestry_night import ToldNight, overnight
from fieldmon.infestation.ancestry.kept_ancestry import arrays_of
from fieldmon.infestation.insects.jump_reach import reach_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.ancestry import Ancestry

    Morning = tuple[Ancestry, NDArray[np.float64] | None]


#: on larger plots nothing is kept: of a million plants one morning is some 160 MB
KEPT_PLANTS = 50_000
# up to four maps are believed, and each has its own; of 10 000 plants one is some 1.6 MB
_kept = places_by_name(32)


def overnight_once(of: Ancestry, night: ToldNight) -> Morning:
    """Return what `overnight` does, to the last bit; a night is drawn once if its plot is small."""
    if not of.waits or len(of.grid) > KEPT_PLANTS:  # nothing is drawn, or it is too much to keep
        return overnight(of, night)
    kept = _kept(_causes(of, night))
    if not kept:
        ancestry, chance = overnight(of, night)
        if chance is not None:
            read_only(chance)  # others get it, too
        nowhere: Any = None  # the plot may be read again, and this one be let go
        kept.append((replace(ancestry, grid=nowhere), chance))
    ancestry, chance = kept[0]
    return replace(ancestry, grid=of.grid), chance


def _causes(of: Ancestry, night: ToldNight) -> str:
    """Return a name for all from which a morning follows."""
    reach, arrays = reach_of(of.grid), arrays_of(of)
    where = reach.cells.of_plant, reach.cells.shape, reach.cells.size_m, reach.at_edge
    kinds = [(one.shape, one.dtype.str) for one in arrays.values()]
    return digest(*where, kinds, *arrays.values(), of.new, of.new_left, of.pest, night)
