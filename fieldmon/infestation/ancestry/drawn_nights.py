"""Nights that were drawn of late: who asks for one of them again need not wait.

Drawing who infested whom takes most of a night. The evening in hindsight and the morning after it
are told by the same draws; so is a season that is opened again, or changed on a later day.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from fieldmon.compute.digest import digest
from fieldmon.infestation.ancestry.ancestry_night import ToldNight, overnight
from fieldmon.infestation.ancestry.kept_ancestry import arrays_of
from fieldmon.infestation.insects.jump_reach import reach_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.ancestry import Ancestry

    Morning = tuple[Ancestry, NDArray[np.float64] | None]


@dataclass(frozen=True)
class _Asked:
    """A night, the same as another where all is the same from which its morning follows."""

    told: ToldNight
    causes: str
    of: Ancestry = field(compare=False)


def overnight_once(of: Ancestry, night: ToldNight) -> Morning:
    """Return what `overnight` does, to the last bit; a night is drawn once."""
    if not of.waits:  # nothing is drawn
        return overnight(of, night)
    reach, arrays = reach_of(of.grid), arrays_of(of)
    where = reach.cells.of_plant, reach.cells.shape, reach.cells.size_m, reach.at_edge
    kinds = [(one.shape, one.dtype.str) for one in arrays.values()]
    causes = digest(*where, kinds, *arrays.values(), of.new, of.new_left, of.pest)
    ancestry, chance = _drawn(_Asked(night, causes, of))
    # the same plot may have been read again
    return replace(ancestry, grid=of.grid), chance


# of a plot of 10 000 plants each is some 4 MB
@lru_cache(maxsize=8)
def _drawn(asked: _Asked) -> Morning:
    ancestry, chance = overnight(asked.of, asked.told)
    if chance is not None:
        chance.flags.writeable = False  # others get it, too
    return ancestry, chance
